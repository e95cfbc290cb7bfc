"""The scene of a page (`pvfiblets.page`) for a browser that draws by itself, and the data that it fetches.

Data are named by a hash of their bytes, so that a browser fetches again only changed data: for another filter a
byte for each streamline. Results that take long to make are kept as long as the scene shows them.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from pvfiblets.page.scene import PageScene, encoded
from pvfiblets.web.scene.distance_label import names_of
from pvfiblets.web.scene.scalar_bars import bars_of
from pvfiblets.web.scene.slices.glyph_layers import GLYPHS
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.web.scene.scene import Scene

__all__ = ["LARGEST", "URL", "SentScene", "SentScenes"]

LARGEST = 64_000_000  # bytes of data up to which `--draw auto` lets browsers draw: pictures may never add up to more

MOST = 1_000_000_000  # bytes of data up to which `--draw there` does: browsers hold little more of one page's

URL = "/there"

Made = TypeVar("Made")
_NAMED = re.compile(r"'([a-z]+[0-9]+)'")


@dataclass(frozen=True)
class SentScene:
    """A scene that a browser can draw."""

    content: dict[str, Any]  # as `client/src/scene.ts` has it, but for the camera
    blobs: dict[str, bytes]  # its data, by their names
    pixels: frozenset[str] = frozenset()  # names of slices' pixels, which are sent compressed

    @property
    def bytes(self) -> int:
        """Bytes of all data together."""
        return sum(map(len, self.blobs.values()))


class SentScenes:
    """Makes a scene into what browsers draw, again and again."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._made: dict[tuple[Any, ...], tuple[tuple[Any, ...], Any]] = {}
        self._names: dict[int, tuple[bytes, str]] = {}

    def make(self, most: int = MOST) -> SentScene | str:
        """Return the current scene, or its part that a browser cannot draw: '' for an empty scene."""
        scene = self._scene
        if (found := _views(scene) or _too_large(scene, most)) is not None:
            return found
        page = _Remade("", before=self._made)
        unable = add_all(page, scene.plotter)
        self._made = page.made
        if unable:
            told = [one for one in unable if _NAMED.search(one)] or unable  # parts of layers have no name of their own
            return ", ".join(_readable(one, scene) for one in told)
        if not page.layers:
            return ""
        names = [self._name(blob) for blob in page.blobs]
        kept = {id(blob) for _, blob in page.made.values()}
        self._names = {key: found for key, found in self._names.items() if key in kept}
        content = page.plain()
        content["bars"] = _bars(scene)
        content["distances"] = [
            {"from": one.begin, "to": one.end, "text": one.text} for one in scene.state.measurements
        ]
        content["data"] = [
            {"bytes": len(blob), "file": f"{URL}/{name}"} for blob, name in zip(page.blobs, names, strict=True)
        ]
        pixels = frozenset(names[layer["pixels"]] for layer in page.layers if layer["kind"] == "image")
        return SentScene(content, dict(zip(names, page.blobs, strict=True)), pixels)

    def _name(self, blob: bytes) -> str:
        """Return the name of some bytes, cached for kept ones."""
        found = self._names.get(id(blob))
        if found is None or found[0] is not blob:
            found = self._names[id(blob)] = blob, hashlib.blake2b(blob, digest_size=24).hexdigest()
        return found[1]


def add_all(page: PageScene, plotter: pv.BasePlotter) -> list[str]:
    """Set a page to a plotter's scene without measured distances; return its unsupported parts."""
    from pvfiblets.plotting.page import page_scene  # PyVista is loaded by then

    return page_scene.add_all(page, plotter, controls=False, besides=names_of(plotter))[0]


class _Remade(PageScene):
    """A scene of a page that takes over what an earlier one made of the same things."""

    def __init__(self, title: str, *, before: dict[tuple[Any, ...], tuple[tuple[Any, ...], Any]]) -> None:
        super().__init__(title, values_apart=True)
        self._before = before
        self.made: dict[tuple[Any, ...], tuple[tuple[Any, ...], Any]] = {}

    def once(self, what: tuple[Any, ...], make: Callable[[], Made]) -> Made:
        """Return the result made of some things: texts are compared by content, others by identity."""
        key = tuple(part if isinstance(part, (str, tuple)) else id(part) for part in what)
        found = self._before.get(key) or (what, make())  # the things live as long as their addresses count
        self.made[key] = found
        made: Made = found[1]
        return made


def _views(scene: Scene) -> str | None:
    """Return what beside the 3-D view and its actors keeps a browser from drawing; None for nothing."""
    if scene.slicing.workspace is not None:
        if scene.slicing.view_3d is None:
            return "panes of slices"
        for layer in scene.layers:
            if layer.kind == "image" and layer.visible and layer.settings[GLYPHS] is not None:
                return f"the glyphs of {layer.name!r}"
    return None


def _too_large(scene: Scene, most: int) -> str | None:
    """Return why streamlines are too many to be sent; None where they are not."""
    shown = {id(set_): set_ for layer in scene.layers if layer.kind in LINES and layer.visible
             for set_ in (scene.actor(layer.id).fiblets,)}  # fmt: skip
    total = sum(set_.nbytes for set_ in shown.values())
    if total > most:
        return f"{total / 1e6:,.0f} MB of streamlines, more than the {most / 1e6:,.0f} MB that are sent to it"
    return None


def _readable(unable: str, scene: Scene) -> str:
    """Return what a page cannot show with the names of layers in the place of their ids."""
    layers = {layer.id: layer for layer in scene.layers}

    def named(found: re.Match[str]) -> str:
        layer = layers.get(found.group(1))
        if layer is None:
            return found.group()
        return f"the {layer.kind} {layer.name!r}" if found.group() == unable else repr(layer.name)

    what, apostrophe, rest = unable.partition("'")
    return _NAMED.sub(named, what.replace("_", " ") + apostrophe + rest)


def _bars(scene: Scene) -> list[dict[str, Any]]:
    """Return the colour bars, as client/browser_renderer.js draws them."""
    import pyvista as pv

    found = []
    for title, _, actor in bars_of([(layer, scene.actor(layer.id)) for layer in scene.layers]):
        table = actor.mapper.lookup_table
        colours = np.asarray(pv.convert_array(table.GetTable())).reshape(-1, 4)
        bar = {"title": title, "table": encoded(colours), "clim": [float(end) for end in actor.mapper.scalar_range],
               "log": bool(table.GetScale())}  # fmt: skip
        if getattr(actor, "shows_labels", False):
            count = table.GetNumberOfAnnotatedValues()
            values = [table.GetAnnotatedValue(k).ToDouble() for k in range(count)]
            bar["names"] = [str(table.GetAnnotation(k)) for k in range(count)]
            named = [[round(255 * part) for part in table.map_value(value)[:3]] for value in values]
            bar["colours"] = named or colours[:, :3].tolist()  # too many to be named
        found.append(bar)
    return found
