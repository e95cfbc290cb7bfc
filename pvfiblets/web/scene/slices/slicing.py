"""Images of a scene as slices: a workspace of panes and the 3-D view, made when the first image is shown.

A layer of the kind ``"image"`` is a :class:`.SliceLayer` of the workspace's one stack. How views are laid out and where
the cross-hair is are no part of what can be undone, as the camera is none: a :class:`SliceView` says it, and sessions
keep it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.slices.settings import MEANING
from pvfiblets.web.scene.layers import looks
from pvfiblets.web.scene.slices.glyph_layers import VECTORS, GlyphLayers, covers
from pvfiblets.web.session.document import Layer, volume_in
from pvfiblets.web.values import mapping, number, numbers, shown, truth

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.web.scene.actors import Colours
    from pvfiblets.web.scene.slices.label_images import LabelledImage

LAYOUTS = {
    "3d": "3-D",
    "beside": "3-D and three slices",
    "axial": "Axial, large",
    "coronal": "Coronal, large",
    "sagittal": "Sagittal, large",
    "grid": "All alike",
    "oblique": "Oblique, large",
}
"""Layouts of views, for people."""

CONVENTIONS = ("radiological", "neurological")
NAMES = ("axial", "coronal", "sagittal", "3d", "oblique")  # views in the order of the plotter's renderers
VIEWS = (1, len(NAMES))  # the `shape` of a plotter that has all of them
_THREE_D = NAMES.index("3d")

WEIGHTS = "modulate"  # the setting that names the image which a direction-coded one is as bright as

OBLIQUE = "oblique"
_THICKEST = 1000.0  # mm


@dataclass(frozen=True)
class SliceView:
    """The view of slices."""

    layout: str = "beside"  # of `LAYOUTS`
    convention: str = "radiological"  # of `CONVENTIONS`
    thickness: float = 3.0  # of the slabs whose streamlines are shown, mm
    cross_hair: bool = True
    planes: bool = True  # whether slices are shown in the 3-D view
    # the cross-hair, mm; the middle of the first image until it is known
    position: tuple[float, float, float] | None = None
    # of one more slice, through the cross-hair: how far it is tilted and turned, degrees. It is a part of the document,
    # so that it can be undone.
    oblique: tuple[float, float] | None = None

    def as_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(self).items()}


def check_view(value: Any) -> SliceView:
    """Return how slices are looked at, of what somebody sent."""
    usual = SliceView()
    given = mapping(value, "slices", (), tuple(asdict(usual)))
    found: dict[str, Any] = {}
    for name, choices in (("layout", tuple(LAYOUTS)), ("convention", CONVENTIONS)):
        if name in given:
            if not isinstance(given[name], str) or given[name] not in choices:
                raise ValueError(f"{name} of slices is {shown(given[name])}; choose one of {', '.join(choices)}")
            found[name] = given[name]
    if "thickness" in given:
        found["thickness"] = number(given["thickness"], "thickness of the slab", 1e-6, _THICKEST, unit=" of mm")
    for name in ("cross_hair", "planes"):
        if name in given:
            found[name] = truth(given[name], name)
    if given.get("position") is not None:
        x, y, z = numbers(given["position"], "position", 3)
        found["position"] = x, y, z
    if "oblique" in given:
        angles = None if given["oblique"] is None else numbers(given["oblique"], "angles of the oblique slice", 2)
        if angles is not None and not all(-180.0 <= angle <= 180.0 for angle in angles):
            raise ValueError(f"angles of the oblique slice are {angles}; give degrees from -180 to 180")
        found["oblique"] = None if angles is None else (angles[0], angles[1])
    return replace(usual, **found)


def image_looks(layer: Layer) -> dict[str, Any]:
    """Return what the settings of an image mean for its layer of the stack; under glyphs it is clear."""
    found = looks(layer.kind, layer.settings)
    return {**found, "opacity": 0.0} if covers(layer.settings) else found


def normal_of(oblique: tuple[float, float]) -> tuple[float, float, float]:
    """Return the normal of a slice that is tilted backwards out of the axial plane, and then turned to the left."""
    tilt, turn = (math.radians(angle) for angle in oblique)
    return -math.sin(tilt) * math.sin(turn), math.sin(tilt) * math.cos(turn), math.cos(tilt)


def angles_of(normal: Any) -> tuple[float, float]:
    """Return tilt, from -90 to 180, and turn, from -90 to 90 degrees, of a slice of a normal; see :func:`normal_of`."""
    x, y, z = (float(part) for part in normal)
    tilt = math.degrees(math.atan2(math.hypot(x, y), z))
    turn = math.degrees(math.atan2(-x, y)) if math.hypot(x, y) > 1e-9 else 0.0
    if abs(turn) > 90.0:
        tilt, turn = -tilt, turn - math.copysign(180.0, turn)
    return round(tilt, 2), round(turn, 2)


def to_3d_view(plotter: pv.BasePlotter) -> None:
    """Make the 3-D view the active one."""
    plotter.renderers.set_active_renderer(*plotter.renderers.index_to_loc(_THREE_D))


def ready_views(plotter: pv.BasePlotter) -> None:
    """Start a plotter of all views with the 3-D view alone, which is the active one."""
    for name, renderer in zip(NAMES, plotter.renderers, strict=False):
        renderer.SetDraw(name == "3d")
        renderer.SetInteractive(name == "3d")
        if name != "3d":
            renderer.SetViewport(0.0, 0.0, 0.001, 0.001)
    to_3d_view(plotter)
    plotter.renderer.SetViewport(0.0, 0.0, 1.0, 1.0)


class Slicing:
    """The images of a scene, as slices in its plotter."""

    def __init__(
        self,
        plotter: pv.BasePlotter,  # of the views `NAMES`, or of the first four, if there is to be an image
        # called with the angles of the oblique slice when it was turned by hand, and which drag of a handle does it,
        # None for none
        turned: Callable[[tuple[float, float], int | None], Any] = lambda *_: None,
        windowed: Callable[[Any], Any] = lambda _: None,  # called with a layer whose window a drag has changed
    ) -> None:
        self._plotter, self._turned, self._windowed = plotter, turned, windowed
        self._view = SliceView()
        self._glyphs = GlyphLayers()
        self.workspace: Any = None  # none as long as there is no image
        self._drawn_at: tuple[float, ...] = ()  # the cross-hair in the last frame, mm
        self.painted: Any = None  # of the stack, above all others

    # What is seen

    @property
    def view(self) -> SliceView:
        """The view of slices."""
        if self.workspace is None:
            return self._view
        x, y, z = (float(part) for part in self.workspace.position)
        return replace(self._view, position=(x, y, z))

    @view.setter
    def view(self, view: SliceView) -> None:
        self._view = view
        workspace = self.workspace
        if workspace is None:
            return
        self._tilt(view.oblique)
        there = workspace.oblique is not None and workspace.oblique.pane is not None and workspace.oblique.visible
        workspace.layout = view.layout if view.layout != OBLIQUE or there else "beside"
        workspace.convention = view.convention
        workspace.thickness, workspace.cross_hair = view.thickness, view.cross_hair
        for plane in workspace.slices:
            if plane.name != OBLIQUE and plane.visible != view.planes:
                plane.visible = view.planes
        if view.position is not None and tuple(workspace.position) != view.position:
            workspace.position = view.position

    def tilt(self, oblique: tuple[float, float] | None) -> None:
        """Turn the oblique slice to other angles, or remove it."""
        if oblique != self._view.oblique:
            self.view = replace(self.view, oblique=oblique)

    def _tilt(self, oblique: tuple[float, float] | None) -> None:
        """Turn the slice to an angle; it is made on first use."""
        workspace = self.workspace
        if workspace.oblique is None:
            if oblique is None:
                return
            workspace.add_oblique(normal_of(oblique), widget=False).on_turn(self._was_turned)
            self._smooth_alike()
        workspace.oblique.visible = oblique is not None
        if oblique is not None and not np.allclose(workspace.oblique.normal, normal_of(oblique)):
            workspace.oblique.normal = normal_of(oblique)

    def _was_turned(self, normal: Any) -> None:
        """Report a slice that is turned by hand, at whole hundredths of a degree."""
        angles = angles_of(normal)
        if self._view.oblique is None or not np.allclose(normal, normal_of(self._view.oblique), atol=1e-9):
            self._turned(angles, self.workspace.oblique.drag)

    @property
    def beside(self) -> bool:
        """Whether panes are shown, be it beside the 3-D view or in its place."""
        return self.workspace is not None and self.workspace.layout != "3d"

    @property
    def view_3d(self) -> Any:
        """The renderer of the 3-D view; None where it is not shown."""
        found = self._plotter.renderer if self.workspace is None else self._plotter.renderers[_THREE_D]
        return found if found.GetDraw() else None

    def postpones_3d(self, may: bool) -> bool:
        """Keep the 3-D view in the next frame if that may be and the cross-hair moved beside it; return whether so."""
        before, self._drawn_at = self._drawn_at, () if self.workspace is None else tuple(self.workspace.position)
        moved = () not in (before, self._drawn_at) and before != self._drawn_at
        if not (may and moved and self.beside) or self.view_3d is None:
            return False
        self.workspace.postpone(self.view_3d)
        return True

    def boxes(self) -> list[dict[str, Any]]:
        """Return where views are in the picture, as shares of it from its upper left, and how wide a pixel is, mm."""
        if self.workspace is None:
            return []
        found = []
        height = self._plotter.window_size[1]
        for name, renderer in zip(NAMES, self._plotter.renderers, strict=False):
            if not renderer.GetDraw():
                continue
            left, bottom, right, top = renderer.GetViewport()
            pane = self.workspace.panes.get(name)
            found.append({
                "name": name, "x": left, "y": 1.0 - top, "w": right - left, "h": top - bottom,
                "mm": 0.0 if pane is None else pane.scale * height,  # the picture's height
                "letters": {} if pane is None else dict(pane.sides),
            })  # fmt: skip
        return found

    def show_all(self) -> None:
        """Show all of the slice in each pane."""
        if self.workspace is not None:
            for pane in self.workspace.panes.values():
                pane.reset()

    def pane_at(self, x: float, y: float) -> Any:
        """Return the pane that a pixel of the picture, from the lower left, is in; None if it is in none."""
        return None if self.workspace is None else self.workspace.pane_at(x, y)

    # Layers

    def add(self, layer: Layer, image: LabelledImage, colours: Colours) -> Any:
        """Show an image above the others; return its layer of the stack."""
        # `colours` gives the image that a direction-coded one is as bright as.
        meaning = layer.settings[MEANING]
        made = {"kind": meaning, "labels": image.table if meaning == "labels" else None}
        if meaning == "direction" and layer.settings[VECTORS] != "scanner":
            made["vectors"] = layer.settings[VECTORS]
        weights = volume_in(layer.settings[WEIGHTS])
        if meaning == "direction" and weights is not None:
            made["modulate"] = colours(weights)
        made |= image_looks(layer)
        if self.workspace is None:
            self.workspace = self._plotter.slices.workspace(
                image, layout="3d", reset_camera=False, render=False, name="slices", **made
            )
            self._smooth_alike()
            self.workspace.told = False  # the page says it
            self.workspace.on_window(self._windowed)
            found = self.workspace.slices.layers[0]
            self.view = self._view
        else:
            found = self.workspace.slices.add(image, **made)
        self._call(found, layer, image)
        return found

    def look(self, image: Any, old: Layer, new: Layer, data: LabelledImage, colours: Colours) -> Any:
        """Bring an image in step with its layer; return its layer of the stack, which may be another one."""
        if any(old.settings[name] != new.settings[name] for name in (MEANING, WEIGHTS, VECTORS)):
            found = self.add(new, data, colours)
            self._glyphs.remove(self.workspace.slices, image)
            self.workspace.slices.remove_layer(image)
            return found
        before, after = image_looks(old), image_looks(new)
        try:
            for name, value in after.items():
                if before[name] != value:
                    setattr(image, name, value)
        except Exception:
            for name, value in before.items():
                setattr(image, name, value)
            raise
        self._call(image, new, data)
        return image

    def _call(self, image: Any, layer: Layer, data: LabelledImage) -> None:
        """Show or hide the image, name it, and set its glyphs, by its layer."""
        if image.visible != layer.visible:
            image.visible = layer.visible
        if image.name != layer.name:
            image.name = layer.name
            self.workspace.slices.changed()
        self._glyphs.become(self.workspace.slices, image, data, layer.settings, layer.visible)

    def remove(self, image: Any) -> None:
        """Take an image away; with the last one the panes go, too."""
        stack = self.workspace.slices
        self._glyphs.remove(stack, image)
        stack.remove_layer(image)
        if all(one is self.painted for one in stack.layers):
            self.close()

    def add_painted(self, image: Any, opacity: float) -> None:
        """Show the painted regions above all images."""
        self.painted = self.workspace.slices.add(image, kind="labels", name="painted", opacity=opacity)

    def remove_painted(self) -> None:
        """Show it no more."""
        self.workspace.slices.remove_layer(self.painted)
        self.painted = None

    def put_in_order(self, images: Sequence[Any]) -> None:
        """Lay images over each other in an order, the lowest first."""
        if self.workspace is not None:
            self.workspace.slices.reorder(images)

    def close(self) -> None:
        """Take panes and slices away; the 3-D view fills the picture."""
        if self.workspace is not None:
            self._view = self.view
            self.workspace.remove()
            self.workspace = self.painted = None
            self._glyphs.forget()
            ready_views(self._plotter)

    def _smooth_alike(self) -> None:
        """Smooth edges in panes as in the 3-D view."""
        plotter = self._plotter
        value = plotter.picture.antialias
        for at in range(len(plotter.renderers)):
            if at != _THREE_D:
                plotter.renderers.set_active_renderer(*plotter.renderers.index_to_loc(at))
                plotter.picture.antialias = value
        to_3d_view(plotter)
