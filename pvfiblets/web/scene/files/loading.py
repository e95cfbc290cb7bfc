"""From files and demonstrations to what layers draw, with progress, and confined to a folder.

Nothing here draws or knows a plotter: :meth:`Files.load` may run in a thread of its own.
"""

from __future__ import annotations

import contextlib
import itertools
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets import formats
from pvfiblets.codec.shards.manifest import MANIFEST
from pvfiblets.formats.gzipped import check_ratio
from pvfiblets.formats.registry import UnknownFormatError, is_trx_folder, suffix_of, suffixes
from pvfiblets.images.sources import as_image
from pvfiblets.support.file_notes import notes_of
from pvfiblets.support.vtk_space import unnamed_here
from pvfiblets.web.scene.files.file_kinds import (
    MESHES,
    SPACED,
    TABLES,
    VALUES,
    VOLUMES,
    VTK_SUFFIXES,
    is_tractogram_folder,
    kind_of,
    read_vtk,
)
from pvfiblets.web.scene.files.layer_readers import (
    read_colours,
    read_fixels,
    read_mesh,
    read_several,
    read_tubes,
    volume_facts,
)
from pvfiblets.web.session.document import LINES, Source
from pvfiblets.web.values import shown

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

MOST_REMEMBERED = 16  # exports whose points are not coded again

Progress = Callable[[str, float], None]  # called with the step's name and its finished share, from 0 to 1
Cancel = Callable[[], bool]  # whether to stop
Stamp = tuple[int, int]  # when a file was changed last, in nanoseconds, and its bytes


class Cancelled(Exception):  # noqa: N818 - not an error: somebody wanted it
    """A load was cancelled; nothing has changed."""


@dataclass(frozen=True, eq=False)
class Loaded:
    """Data of a layer, and their description."""

    kind: str  # of the layers that it is for
    source: Source
    name: str  # for people
    data: Any
    facts: dict[str, Any] = field(default_factory=dict)  # of the file, in JSON's types or nearly
    error: dict[str, Any] | None = None  # `error_mm` and `error_steps`, where compressing it here measured them
    kept: tuple[str, ...] = ()  # kept per-point arrays, for scripts
    # of the files that it was read from, as documents name them: time of the last change and size
    stamps: dict[str, Stamp] = field(default_factory=dict)


class Files:
    """A scene's files, and the temporary files made from them."""

    def __init__(self, root: Path | None = None, allowed: Iterable[Path] = ()) -> None:
        # paths are relative to it, and lead out of it neither by `..` nor by links; any path is allowed without
        self.root = None if root is None else Path(root).resolve(strict=True)
        # files and folders outside of the root that may be opened all the same
        self.allowed = [Path(path).resolve() for path in allowed]
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._numbers = itertools.count(1)  # two threads may load at once
        self._coded: dict[Path, tuple[Stamp, Any]] = {}

    def resolve(self, path: Any, *, new: bool = False) -> Path:
        """Return the place of a file."""
        text = str(path) if isinstance(path, (str, Path)) else ""
        if not text or not text.isprintable() or len(text) > 4096:
            raise ValueError(f"path is {shown(path)}; give the name of a file")
        found = (Path(text) if self.root is None else self.root / text).resolve()
        inside = self.root is None or any(
            found == place or found.is_relative_to(place) for place in (self.root, *self.allowed)
        )
        if not inside:
            raise PermissionError(f"{text}: outside of the folder that is open to you; give a path in it")
        if not (found.parent.is_dir() if new else found.is_file() or is_tractogram_folder(found)):
            raise FileNotFoundError(f"{text}: there is no such {'folder' if new else 'file'}")
        if self.root is not None and not new:
            from pvfiblets.web.scene.files.references import check_references

            if not found.name.lower().endswith((*suffixes(), *VOLUMES, *MESHES, *VALUES, *TABLES, ".json")):
                # Some formats name files that cannot be known before their reader opens them.
                raise UnknownFormatError(f"{found.name}: such files are not opened here; convert it to .vtp or .nii")
            check_references(found, [self.root, *self.allowed])
        return found

    def name(self, place: Path) -> str:
        """Return a place as documents hold it: relative to the root where it lies in it."""
        if self.root is not None and place.is_relative_to(self.root):
            return place.relative_to(self.root).as_posix()
        return str(place)

    @staticmethod
    def stamp(place: Path) -> Stamp:
        """Return what tells whether a file has changed."""
        if place.is_dir():
            place = place / ("header.json" if is_trx_folder(place) else MANIFEST)
        found = place.stat()
        return found.st_mtime_ns, found.st_size

    def remember(self, place: Path, fiblets: FibletSet) -> None:
        """Take fiblets for a file that holds their points, so that opening it does not code those again."""
        self._coded[place] = self.stamp(place), fiblets
        while len(self._coded) > MOST_REMEMBERED:
            self._coded.pop(next(iter(self._coded)))

    def spooled(self, save: Callable[[Path], Any]) -> FibletSet:
        """Return the fiblets of a temporary file, which is removed when unused."""
        from pvfiblets.codec.fibletset import FibletSet

        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="pvfiblets-")
        target = Path(self._folder.name) / f"{next(self._numbers)}.fiblets"
        try:
            save(target)
            fiblets = FibletSet.open(target)
        finally:
            with contextlib.suppress(OSError):  # it stays mapped; Windows keeps the name until it is unused
                target.unlink(missing_ok=True)
        return fiblets

    def load(
        self, source: Source, kind: str | None = None, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> Loaded:
        """Read, and where it must be, compress a source; it may take minutes."""
        with unnamed_here(source.space):
            loaded = self._load(source, kind, progress, cancel)
        texts = () if source.path is None else notes_of(self.resolve(source.path))
        return replace(loaded, facts=loaded.facts | {"notes": list(texts)}) if texts else loaded

    def _load(self, source: Source, kind: str | None, progress: Progress | None, cancel: Cancel | None) -> Loaded:
        watch = Watch(progress, cancel)
        watch("reading", 0.0)
        if source.demo is not None:
            return _demo(source, kind)
        place = self.resolve(source.path)
        asked, kind = kind, kind_of(place) if kind is None else kind
        if asked is None and kind == "volume" and (fixels := read_fixels(place)) is not None:
            return Loaded("image", Source(self.name(place)), place.name, *fixels)
        name = place.name
        source = Source(self.name(place), space=source.space if name.lower().endswith(SPACED) else None)
        if kind in (*LINES, "tubes"):
            check_ratio(place)
        if kind in LINES:
            return self._lines(place, source, name, watch)
        if kind == "tubes":
            tubes, facts = read_tubes(place)
            watch("reading", 1.0)
            return Loaded(kind, source, name, tubes, facts)
        if kind == "volume":
            from pvfiblets.volumes import as_raycast_volume

            try:
                volume = as_raycast_volume(read_vtk(place) if name.lower().endswith(VTK_SUFFIXES) else place)
            except ValueError:
                if asked is not None or (several := read_several(place)) is None:
                    raise
                return Loaded("image", source, name, *several)
            watch("reading", 1.0)
            return Loaded(kind, source, name, volume, volume_facts(volume))
        if kind == "image":
            from pvfiblets.web.scene.slices.label_images import facts_of, read_image

            if not name.lower().endswith(VOLUMES):
                raise UnknownFormatError(f"{name}: slices are of images, which are in files of {', '.join(VOLUMES)}")
            image = read_image(place)
            watch("reading", 1.0)
            return Loaded(kind, source, name, image, facts_of(image))
        if kind == "labels":
            return Loaded(kind, source, name, as_image(place))  # and read where it is used
        if kind == "colours":
            return Loaded(kind, source, name, read_colours(place))
        mesh = read_mesh(place)
        watch("reading", 1.0)
        return Loaded("mesh", source, name, mesh, {"points": mesh.n_points, "faces": mesh.n_cells})

    def with_values(self, loaded: Loaded, paths: tuple[str, ...]) -> Loaded:
        """Return a tractogram or a mesh with the values of files more, or an image with names of labels."""
        add: Callable[[Any, Path], Any]
        if loaded.kind == "image":
            from pvfiblets.web.scene.slices.label_images import with_table as add
        elif loaded.kind == "mesh":
            from pvfiblets.plotting.gifti import with_vertex_values as add
        else:
            from pvfiblets.plotting.fiblets.along import with_table_of as add

        data, stamps = loaded.data, dict(loaded.stamps)
        for path in paths:
            place = self.resolve(path)
            stamps[path] = self.stamp(place)
            data = add(data, place)
        return replace(loaded, source=replace(loaded.source, values=paths), data=data, stamps=stamps)

    def _lines(self, place: Path, source: Source, name: str, watch: Watch) -> Loaded:
        from pvfiblets.codec.fibletset import FibletSet
        from pvfiblets.codec.files.convert import compress_file

        stamp = self.stamp(place)
        facts = formats.info(place)
        if suffix_of(place) == ".fiblets":
            fiblets = FibletSet.open(place)
            watch("reading", 1.0)
            return Loaded("tractogram", source, name, fiblets, facts)
        kept = tuple(facts.get("per_point") or ())
        before, coded = self._coded.get(place, (None, None))
        if coded is not None and before == stamp and kept == tuple(coded.per_point):
            watch("reading", 1.0)
            return Loaded("tractogram", source, name, coded, facts, None, kept, {source.path or "": stamp})
        result: dict[str, Any] = {}
        fiblets = self.spooled(
            lambda target: result.update(compress_file(place, target, per_point=kept, progress=watch))
        )
        error = {key: result[key] for key in ("error_mm", "error_steps")}
        facts = {**facts, "dropped": result["dropped"]}
        return Loaded("tractogram", source, name, fiblets, facts, error, kept, {source.path or "": stamp})

    def close(self) -> None:
        """Remove the temporary files; a second call has no effect."""
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


class Watch:
    """Passes progress on, and stops where that is wanted."""

    def __init__(self, progress: Progress | None, cancel: Cancel | None) -> None:
        self._progress, self._cancel = progress, cancel  # see `Files.load`

    def __call__(self, what: str, share: float) -> None:
        """Report progress; raise :class:`Cancelled` if it was cancelled."""
        if self._cancel is not None and self._cancel():
            raise Cancelled("stopped; all is as it was")
        if self._progress is not None:
            self._progress(what, min(max(share, 0.0), 1.0))


def _demo(source: Source, kind: str | None) -> Loaded:
    from pvfiblets import synthetic

    if source.demo == "tracts" and kind in (None, *LINES):
        from pvfiblets.codec.encoding.compress import compress
        from pvfiblets.codec.error import measure_error

        lines = synthetic.brain_streamlines(source.size, 0.5)
        fiblets = compress(lines)
        error = measure_error(lines, fiblets).summary()
        facts = {"streamlines": len(lines), "points": lines.n_points, "format": "made here"}
        return Loaded("tractogram", source, "demo tracts", fiblets, facts, error)
    if source.demo == "head" and kind in (None, "volume"):
        from pvfiblets.synthetic.vessels import brain_like

        volume = brain_like(source.size)
        return Loaded("volume", source, "demo head", volume, volume_facts(volume))
    if source.demo == "head" and kind == "image":
        from pvfiblets.synthetic.vessels import brain_like
        from pvfiblets.web.scene.slices.label_images import LabelledImage, facts_of

        volume = brain_like(source.size)
        image = LabelledImage(volume.values[..., None], volume.affine, "demo head")
        return Loaded(kind, source, "demo head", image, facts_of(image))
    if source.demo == "head" and kind == "colours":
        from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
        from pvfiblets.synthetic.vessels import brain_like

        volume = brain_like(source.size)
        return Loaded(kind, source, "demo head", VolumeSource(volume.values, volume.affine, name="demo head"))
    raise ValueError(f"there is no demonstration {source.demo!r} for a layer of kind {kind!r}; there are tracts, head")
