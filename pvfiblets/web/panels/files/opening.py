"""Files: chosen in the file browser or uploaded, and opened with progress."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Callable, Coroutine, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.formats.registry import suffixes
from pvfiblets.support import memory
from pvfiblets.web.panels.files.session_actions import SESSION, SessionActions
from pvfiblets.web.scene.files.confined import ConfinedError, TakenError
from pvfiblets.web.scene.files.file_kinds import MESHES, OF_VERTICES, SPACED, TABLES, VALUES, VOLUMES
from pvfiblets.web.scene.files.loading import Cancelled
from pvfiblets.web.server.options import MEBIBYTE
from pvfiblets.web.server.rpc_allowlist import EXPECTED, sentence
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    from aiohttp import web

    from pvfiblets.support.vtk_space import Space
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Source

PIECE = MEBIBYTE  # bytes of an upload at a time
PURPOSES = {
    "": (*suffixes(), *VOLUMES, *MESHES, *VALUES, SESSION),
    "clip": MESHES,
    "region": (*MESHES, *VOLUMES),
    "slices": VOLUMES,
    "labels": TABLES,
    "painted": VOLUMES,
}
"""Purposes of choosing a file, and the suffixes shown for each."""
MOST_MARKED = 64  # files that are chosen at once


class FileActions(SessionActions):
    """The files of an application."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._for = ""  # what the file that is chosen next is for, of PURPOSES

    # Opening

    def open_given(self) -> None:
        """Open what the server was started with."""
        options = self._app.options
        given = [(path, "tractogram" if _is_lines(path) else None) for path in options.files]
        given += [(path, "volume") for path in options.volume] + [(path, "mesh") for path in options.mesh]
        self._starting = self._app.later(self._open_all(given))

    async def _open_all(self, given: list[tuple[str, str | None]]) -> None:
        for path, kind in given:
            try:
                await self._start(self.open(path, kind, self._app.options.space))
            except Exception as error:  # noqa: BLE001 - the others are opened all the same
                self._app.complain(str(error))
        if self._app.options.demo:
            await self._start(self._open_demo())
        self._app.stream.warm()

    async def _start(self, opening: Coroutine[Any, Any, bool]) -> None:
        """Open something that no user asked for: undo has no step for it, unless it came among a user's own."""
        history = self._app.history
        untouched = len(history) == 0
        if await opening and untouched and len(history) == 1:
            history.clear()
            self._app.refresh()

    def open_demo(self) -> None:
        """Open the made-up tractogram, which is made beside everything else."""
        self._app.later(self._open_demo())

    async def _open_demo(self) -> bool:
        scene = self._app.scene
        loaded = await self.run_in_background("demo", lambda *_: scene.load_demo(), "making it", cancellable=False)
        scene.add_loaded_demo(loaded)
        self._app.refresh()
        return True

    async def open(self, path: str, kind: str | None = None, space: Space | None = None) -> bool:
        """Open a file beside everything else; return whether it was, rather than cancelled."""
        # A file of values colours the chosen tractogram, or the chosen mesh.
        app = self._app
        name = Path(path).name
        if path.lower().endswith(VALUES):
            return await self._attach(path)
        try:
            loaded = await self.run_in_background(
                name, lambda progress, cancel: app.scene.load(path, kind, progress, cancel, space), "opening"
            )
            layer = memory.within(lambda: app.scene.add(loaded), reserve=0)
        except Cancelled:
            app.say(f"{name} was not opened: cancelled.")
            return False
        except EXPECTED as error:
            said = sentence(error).replace(f"{app.confined.root}{os.sep}", "")  # where it lies is the server's affair
            raise ValueError(f"{name} was not opened: {said}") from error
        lines = [one.id for one in app.scene.layers if one.kind in LINES]
        if layer.kind in LINES or app.page.chosen not in lines:  # the chosen tractogram stays chosen
            app.page.chosen = layer.id
        app.refresh()
        for text in loaded.facts.get("notes", ()):
            app.say(text.replace(f"{app.confined.root}{os.sep}", ""), "warning")
        return True

    async def _attach(self, path: str) -> bool:
        """Colour the chosen tractogram or mesh by a file of values, which is read beside everything else."""
        app = self._app
        name = Path(path).name
        kinds, of = (("mesh",), "the vertices of a surface") if _of_vertices(path) else (LINES, "a tractogram")
        lines = [layer.id for layer in app.scene.layers if layer.kind in kinds]
        if not lines:
            raise ValueError(f"{name} holds values for {of}; open that first")
        target = app.page.chosen if app.page.chosen in lines else lines[-1]
        try:
            loaded = await self.run_in_background(
                name, lambda *_: app.scene.load_values(target, path), "reading", cancellable=False
            )
            layer = app.scene.attach(target, loaded)
        except EXPECTED as error:
            said = sentence(error).replace(f"{app.confined.root}{os.sep}", "")
            raise ValueError(f"{name} was not opened: {said}") from error
        app.say(f"{layer.name} is coloured by {name}.", "success")
        app.refresh()
        return True

    # The file browser

    def browse(self, folder: str = "", purpose: str = "") -> None:
        """Show a folder of the root."""
        app = self._app
        self._for = purpose if purpose in PURPOSES else ("" if app.page.dialog != "open" else self._for)
        known = PURPOSES[self._for]
        entries = app.confined.listing(folder)
        app.page.folder = app.confined.relative(app.confined.resolve(folder)).removeprefix(".")
        app.page.file_search = ""
        app.page.several = not self._for
        if app.page.dialog != "open" or self._for:
            app.page.marked, app.page.open_space = [], "RAS"
        app.page.entries = [
            {"name": entry.name, "path": entry.path, "folder": entry.folder, "icon": _icon(entry),
             "spaced": entry.name.lower().endswith(SPACED),
             "bytes": entry.size, "time": entry.time, "detail": "" if entry.folder else _size(entry.size)}
            for entry in entries
            if entry.folder or entry.name.lower().endswith(tuple(known))
        ]  # fmt: skip
        app.page.dialog = "open"

    def take(self, path: str, folder: bool) -> None:
        """Open the file chosen in the file browser."""
        app = self._app
        if folder is True:
            self.browse(path, self._for)
            return
        app.confined.existing(path)
        app.page.dialog = ""
        purpose, self._for = self._for, ""
        space = self._space_chosen()
        place = {"path": path, "space": space} if space and path.lower().endswith(SPACED) else {"path": path}
        if purpose == "clip":
            app.cuts.add_file(place)
        elif purpose == "region":
            app.regions.add_file(place)
        elif purpose == "slices":
            app.later(self.open(path, "image"))
        elif purpose == "painted":
            app.painting.open_labels(path)
        elif purpose == "labels":
            app.slices.name_labels(path)
        elif path.lower().endswith(SESSION):
            self.open_session(path)
        else:
            app.later(self.open(path, space=space))

    def _space_chosen(self) -> Space | None:
        """Return the space that the dialog says files of VTK have which name none; None where it is the default."""
        return "LPS" if self._app.page.open_space == "LPS" else None

    def mark(self, path: str) -> None:
        """Choose a file in the file browser beside others, or no longer."""
        app = self._app
        app.confined.existing(path)
        marked = [other for other in app.page.marked if other != path]
        if len(marked) == len(app.page.marked):
            if len(marked) >= MOST_MARKED:
                raise ValueError(f"{MOST_MARKED} files are chosen, which is the most; open them first")
            marked.append(path)
        app.page.marked = marked

    def take_marked(self) -> None:
        """Open the chosen files, one after the other: values after their tractograms."""
        app = self._app
        marked, app.page.marked, app.page.dialog = app.page.marked, [], ""
        if len(marked) == 1:
            self.take(marked[0], False)
            return
        if sessions := [path for path in marked if path.lower().endswith(SESSION)]:
            raise ValueError(f"{Path(sessions[0]).name} is a session, which takes the place of all; open it alone")
        ordered = sorted(marked, key=lambda path: path.lower().endswith(VALUES))
        app.later(self._open_marked(ordered, self._space_chosen()))

    async def _open_marked(self, paths: list[str], space: Space | None) -> None:
        for path in paths:
            try:
                await self.open(path, space=space)
            except EXPECTED as error:  # the others are opened all the same
                self._app.complain(sentence(error))

    async def receive(self, request: web.Request) -> web.Response:
        """Take an upload into the root, and open it; a file of its name is never replaced."""
        from aiohttp import web

        app = self._app
        known = (*suffixes(), *VOLUMES, *MESHES, *VALUES)
        name = request.query.get("name", "")
        limit, size = app.options.upload, 0
        space = self._space_chosen() if app.page.dialog == "open" else None  # not of files that are dropped on the page
        try:
            target = app.confined.uploaded(name, tuple(known))
            with contextlib.ExitStack() as stack:
                hidden = stack.enter_context(app.notes.private(target.parent))
                part = hidden / target.name  # and so, if this process is killed before it is opened, it goes with that
                with part.open("xb") as file:
                    async for piece in request.content.iter_chunked(PIECE):
                        size += len(piece)
                        if size > limit:
                            raise web.HTTPRequestEntityTooLarge(max_size=limit, actual_size=size)
                        await asyncio.to_thread(file.write, piece)
                if request.content_length is not None and size != request.content_length:
                    raise web.HTTPBadRequest(text="the upload is incomplete")
                _place(part, target)
                held = stack.pop_all()
        except (TakenError, FileExistsError) as error:
            said = f"{name!r} exists already; choose another name"
            app.complain(said)
            raise web.HTTPConflict(text=said) from error
        except ConfinedError as error:
            app.complain(str(error))
            raise web.HTTPBadRequest(text=str(error)) from error
        except OSError as error:
            app.complain(f"{name} could not be stored: {error.strerror}")
            raise web.HTTPInsufficientStorage from error
        app.later(self._open_upload(target, held, space))
        return web.Response(text="stored")

    async def _open_upload(self, target: Path, held: contextlib.ExitStack, space: Space | None) -> None:
        """Open an upload; a file that cannot be opened, or ends this process, is removed."""
        with held:
            try:
                await self.open(self._app.confined.relative(target), space=space)
            except Exception:
                target.unlink(missing_ok=True)
                raise

    # For other parts of the page

    async def with_shape(self, shape: Mapping[str, Any], then: Callable[[], Any]) -> None:
        """Read what a region is made of, a mesh or labels, beside everything else; then do what needs it."""
        store = self._app.scene.store.fork()
        await self.run_in_background(
            Path(shape["path"]).name, lambda *_: store.shape(shape), "reading", cancellable=False
        )
        self._app.scene.store.take(store)
        then()

    async def with_volume(self, source: Source, then: Callable[[], Any]) -> None:
        """Read a volume that colours or filters lines beside everything else; then do what needs it."""
        scene = self._app.scene
        if ("colours", source) not in scene.store.loaded:
            loaded = await self.run_in_background(
                Path(source.path or "demo head").name,
                lambda progress, cancel: scene.files.load(source, "colours", progress, cancel),
                "reading",
                cancellable=False,
            )
            scene.store.put(loaded)
        then()

    def show_script(self) -> None:
        """Show the Python that makes the same picture."""
        from pvfiblets.web.session.script import as_script

        self._app.stream.settle()  # the script's picture has all pixels
        self._app.page.script = as_script(self._app.scene)
        self._app.page.dialog = "script"


def _place(part: Path, target: Path) -> None:
    """Give a whole file its name; never over another that came meanwhile."""
    try:
        os.link(part, target)
    except FileExistsError:
        raise
    except OSError:  # file systems without hard links
        with target.open("xb"):
            pass
        part.replace(target)


def _of_vertices(path: str) -> bool:
    return path.lower().endswith(OF_VERTICES)


def _is_lines(path: str) -> bool:
    return path.lower().endswith((".trk", ".trk.gz", ".tck", ".trx", ".tt.gz", ".fiblets"))


def _icon(entry: Any) -> str:
    name = entry.name.lower()
    if entry.folder:
        return "mdi-folder-outline"
    kinds = {
        "mdi-vector-polyline": tuple(suffixes()), "mdi-cube-outline": VOLUMES, "mdi-chart-line": VALUES,
        "mdi-triangle-outline": MESHES, "mdi-content-save-outline": (SESSION,),
    }  # fmt: skip
    return next((icon for icon, ends in kinds.items() if name.endswith(tuple(ends))), "mdi-file-outline")


def _size(size: int) -> str:
    return f"{size / MEBIBYTE:,.1f} MB" if size >= MEBIBYTE else f"{max(size, 1) / 1024:,.0f} kB"
