"""Streamlines as files: into the served folder, or for the browser to fetch.

What is only fetched lies in a folder of the session's own until newer exports or the session's end take it away. Names
that browsers fetch by are random and known to this session alone; the front server's checks stand before them.
"""

from __future__ import annotations

import re
import secrets
import tempfile
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from pvfiblets.web.actions import Actions
from pvfiblets.web.panels.files.writing import EXPORTS, write
from pvfiblets.web.scene.files.confined import check_name
from pvfiblets.web.scene.files.loading import Cancelled
from pvfiblets.web.scene.files.originals import Original, original_of
from pvfiblets.web.server.options import MEBIBYTE
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    from aiohttp import web

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.scene.files.loading import Cancel, Progress
    from pvfiblets.web.session.document import Layer

PLACES = ("folder", "computer")
KEPT = 4  # downloadable files; older ones are dropped, temporary ones removed
LARGEST = 2048 * MEBIBYTE  # largest size of a temporary file for download, bytes
BYTES_PER_POINT = 12  # at least, in all formats but `.fiblets`


@dataclass(frozen=True)
class _File:
    path: Path
    name: str
    temporary: bool


@dataclass(frozen=True, eq=False)
class _Held:
    """The exported streamlines, and their source, or the reason why it is not available."""

    fiblets: Any
    ids: Any
    original: Original | None
    why: str

    def told(self, error: float) -> str:
        """Return a sentence on how true the points are."""
        if error:
            because = f"{self.why}, so " if self.why else ""
            return f"{because}points are coded, within {error:.3g} mm of the source's"
        return "points are exactly the source's"


class ExportActions(Actions):
    """The exports of an application."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._files: OrderedDict[str, _File] = OrderedDict()
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def export(self, suffix: str) -> None:
        """Write streamlines to a file, which and where the page says, and offer it."""
        app = self._app
        what, to = app.page.export_what, app.page.export_to
        if suffix not in EXPORTS:
            raise ValueError(f"{str(suffix)[:40]!r} is none of {', '.join(EXPORTS)}")
        if to not in PLACES:
            raise ValueError(f"{to[:40]!r} is none of {', '.join(PLACES)}")
        layer = self._owner(what)
        fiblets, ids = app.scene.selection.chosen(layer.id, what)
        self._begin(layer, fiblets, ids, self._stem(layer, what, suffix), suffix)

    def export_ids(self, layer_id: str, ids: Any, suffix: str, name: str) -> None:
        """Write some streamlines of a layer, called after something, to where the page says, and offer the file."""
        app = self._app
        if suffix not in EXPORTS or app.page.export_to not in PLACES:
            raise ValueError(f"{str(suffix)[:40]!r} is none of {', '.join(EXPORTS)}")
        layer = app.scene.layer(layer_id)
        stem = re.sub(r"[^\w-]+", "_", name).strip("_")[:80] or "bundle"
        self._begin(layer, app.scene.actor(layer_id).fiblets, ids, stem, suffix)

    def _begin(self, layer: Layer, fiblets: FibletSet, ids: Any, stem: str, suffix: str) -> None:
        app, to = self._app, self._app.page.export_to
        points = fiblets.n_points * len(ids) // max(fiblets.n_streamlines, 1)
        if to == "computer" and suffix != ".fiblets" and points * BYTES_PER_POINT > LARGEST:
            raise ValueError(f"about {points:,} points are too many to download; save the file in the served folder")
        original, why = original_of(app.scene, layer, ids)
        held = _Held(fiblets, ids, original, why)
        app.later(self._write(held, stem, suffix, temporary=to == "computer"))

    def _stem(self, layer: Layer, what: str, suffix: str) -> str:
        """Return what a file is called, without its suffix: as the page says, or else after the layer."""
        given = self._app.page.export_name.strip()
        ending = next((one for one in EXPORTS if given.lower().endswith(one)), "")
        if given := given.removesuffix(given[len(given) - len(ending) :]):
            return check_name(given + suffix).removesuffix(suffix)
        named = re.sub(r"[^\w-]+", "_", layer.name.partition(".")[0]).strip("_") or "streamlines"
        return f"{named[:80]}_{what}" if what != "all" else named[:80]

    async def _write(self, held: _Held, stem: str, suffix: str, *, temporary: bool) -> None:
        app = self._app
        target = self._temporary(suffix) if temporary else self._free(stem, suffix)
        name = stem + suffix if temporary else target.name
        with app.notes.private(target.parent) as home:
            part = home / target.name
            coded = None

            def work(progress: Progress, cancel: Cancel) -> dict[str, Any]:
                nonlocal coded
                done = write(held.fiblets, held.ids, part, progress, cancel, held.original)
                if done["error_mm"] and suffix != ".fiblets" and not temporary:
                    coded = app.scene.files.spooled(held.fiblets.extract(held.ids).save)
                return done

            try:
                done = await app.files.run_in_background(name, work, "writing")
            except Cancelled:
                app.say(f"{name} was not written: cancelled.")
                return
            if temporary and done["bytes"] > LARGEST:
                raise ValueError(f"{name} has {done['bytes']:,} bytes, too many to download; save it in the served "
                                 "folder")
            if target.exists():  # since its name was found to be free
                target = self._free(stem, suffix)
                name = target.name
            part.rename(target)
        if coded is not None:
            app.scene.files.remember(target, coded)
        number = secrets.token_urlsafe(24)
        self._offer(number, _File(target, name, temporary))
        lost = f"; {suffix} cannot hold: {', '.join(map(str, done['lost']))}" if done["lost"] else ""
        where = "ready for download" if temporary else "saved in the served folder"
        size = f"{done['bytes'] / 1024:,.0f} kB"
        app.page.download = {"url": f"/download/{number}", "file": name, "where": where}
        points = held.told(done["error_mm"])
        app.say(f"{done['streamlines']:,} streamlines {where} as {name} ({size}); {points}{lost}", "success")

    def _owner(self, what: str) -> Layer:
        """The layer that is exported: the chosen one, or of selections the first that has one."""
        scene, chosen = self._app.scene, self._app.page.chosen
        if what == "selected":
            having = [layer for layer in scene.layers if layer.selected is not None]
            if not having:
                raise ValueError("nothing is selected; pick streamlines first, or export the visible ones")
            return next((layer for layer in having if layer.id == chosen), having[0])
        if not chosen or scene.layer(chosen).kind not in LINES:
            raise ValueError("choose a tractogram first")
        return scene.layer(chosen)

    def _free(self, stem: str, suffix: str) -> Path:
        """Return a name in the served folder that is not taken."""
        confined = self._app.confined
        names = (f"{stem}{'' if k == 1 else f'_{k}'}{suffix}" for k in range(1, 10_000))
        found: Path = confined.writable(next(name for name in names if not (confined.root / name).exists()), EXPORTS)
        return found

    def _temporary(self, suffix: str) -> Path:
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="pvfiblets-")
        return Path(self._folder.name) / f"{secrets.token_hex(8)}{suffix}"

    @contextmanager
    def fresh(self, name: str) -> Iterator[tuple[Path, Callable[[], str]]]:
        """Give a place for a file that is only fetched, and what offers it under a name once it is whole."""
        place = self._temporary(Path(name).suffix)

        def offer() -> str:
            number = secrets.token_urlsafe(24)
            self._offer(number, _File(place, name, temporary=True))
            return f"/download/{number}"

        try:
            yield place, offer
        except BaseException:
            place.unlink(missing_ok=True)
            raise

    def _offer(self, number: str, file: _File) -> None:
        self._files[number] = file
        while len(self._files) > KEPT:
            _, old = self._files.popitem(last=False)
            if old.temporary:
                old.path.unlink(missing_ok=True)

    async def send(self, request: web.Request) -> web.FileResponse:
        """Answer a browser that fetches a file."""
        from aiohttp import web

        file = self._files.get(request.match_info["number"])
        if file is None or not file.path.is_file():
            raise web.HTTPNotFound
        return web.FileResponse(
            file.path,
            headers={
                "Content-Disposition": _disposition(file.name),
                "Content-Type": "application/octet-stream",
            },
        )

    def close(self) -> None:
        """Remove files that were for download only; a second call has no effect."""
        self._files.clear()
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


def _disposition(name: str) -> str:
    """Return the header that gives a file its name: of letters that all take, and whole where it has others."""
    plain = re.sub(r'[^ -~]|["\\\\%]', "_", name)
    whole = "" if plain == name else f"; filename*=UTF-8''{quote(name, safe='')}"
    return f'attachment; filename="{plain}"{whole}'
