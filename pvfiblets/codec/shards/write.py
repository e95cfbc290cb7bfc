"""Write a set in shards, in the memory that one shard takes and some bytes a streamline."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from tqdm import tqdm

from ...support.unfinished import locked, remove_unfinished, scratch_folder_for, unfinished
from ...support.whole_files import naming_target
from ..editing.extract import extract
from ..editing.restrict import even_share
from ..progress import Progress
from .manifest import MANIFEST, Manifest, Shard, StoredFile
from .places import shards_of

if TYPE_CHECKING:
    from ..fibletset import FibletSet

THINNED = 1 / 16
"""Share of the streamlines that stands in a file of its own for first pictures; no more bytes than a shard has."""

Ints = npt.NDArray[np.int64]


def compress_file_in_shards(
    source: str | PathLike[str],
    target: str | PathLike[str],
    size: int,
    *,
    small: bool = False,
    progress: Progress = False,
    **options: Any,
) -> dict[str, Any]:
    """Compress a tractogram file into a folder of shards."""
    from ..fibletset import FibletSet
    from ..files.convert import compress_file, compressed_source

    target = Path(target).expanduser()
    _refuse(target, size)
    remove_unfinished(target.resolve().parent)
    if Path(source).suffix.lower() == ".fiblets":
        whole = compressed_source(source, options)
        manifest = write_shards(whole, target, size, small=small, progress=progress)
        result: dict[str, Any] = {"exact": whole.exact is not None, "per_point": list(whole.per_point)}
        result |= {"promise_mm": whole.points_promise, "dropped": dict(whole.dropped)}
    else:
        with (
            naming_target(target),
            scratch_folder_for(target) as made,
        ):
            aside = made / "whole.fiblets"
            result = compress_file(source, aside, progress=progress, **options)
            manifest = write_shards(FibletSet.open(aside), target, size, small=small, progress=progress)
    total = sum(file.stat().st_size for file in target.iterdir())
    return {
        **result,
        "streamlines": manifest.streamlines,
        "points": manifest.points,
        "fiblets": manifest.n_fiblets,
        "bytes": total,
        "bytes_per_point": total / max(manifest.points, 1),
        "shards": len(manifest.shards),
    }


def write_shards(
    fiblets: FibletSet, target: str | PathLike[str], size: int, *, small: bool = False, progress: Progress = False
) -> Manifest:
    """Write a set as a folder of shards; every point decodes to the same bits."""
    target = Path(target).expanduser()
    _refuse(target, size)
    places = shards_of(fiblets, size)
    with naming_target(target, fiblets.nbytes), _appearing(target) as folder:
        shards = []
        for number, ids in enumerate(_counted(places, progress)):
            part = extract(fiblets, ids)
            if number:  # said once, as sums are taken of what all shards say
                part = replace(part, dropped={})
            shards.append(_saved(part, ids, folder / f"{number:06}.fiblets", small))
        thinned = None
        if len(shards) > 1:
            share = min(THINNED, size / max(fiblets.nbytes, 1))
            ids = np.sort(even_share(fiblets, share))
            thinned = _saved(replace(extract(fiblets, ids), dropped={}), ids, folder / "thinned.level", small)
        manifest = Manifest(
            streamlines=fiblets.n_streamlines,
            points=fiblets.n_points,
            n_fiblets=fiblets.n_fiblets,
            promise_mm=fiblets.points_promise,
            bounds=fiblets.bounds,
            groups={k: len(v) for k, v in fiblets.groups.items()},
            dropped={k: int(v) for k, v in fiblets.dropped.items()},
            shards=tuple(shards),
            thinned=thinned,
        )
        (folder / MANIFEST).write_text(manifest.to_json(), encoding="utf-8")
    return manifest


def _saved(part: FibletSet, ids: Ints, path: Path, small: bool) -> Shard:
    made = path.with_suffix(".fiblets")
    part.save(made, small=small)
    made.rename(path)
    numbers = path.with_suffix(".ids.npy")
    np.save(numbers, ids)
    lengths = part.lengths()
    return Shard(
        fiblets=_described(path),
        ids=_described(numbers),
        streamlines=len(part),
        points=part.n_points,
        n_fiblets=part.n_fiblets,
        bounds=part.bounds,
        length_mm={
            "mean": float(lengths.mean()) if len(lengths) else 0.0,
            "max": float(lengths.max(initial=0.0)),
        },
        unpacked=part.nbytes if small else 0,
    )


def _counted(places: list[Ints], progress: Progress) -> Iterator[Ints]:
    """Yield the shards' streamlines, and show how far they have come."""
    if callable(progress):
        for number, ids in enumerate(places):
            progress("writing shards", number / len(places))
            yield ids
        return
    yield from tqdm(places, desc="writing shards", unit="shards", disable=not progress)


def _described(path: Path) -> StoredFile:
    with path.open("rb") as stream:
        return StoredFile(path.name, path.stat().st_size, hashlib.file_digest(stream, "sha256").hexdigest())


def _refuse(target: Path, size: int) -> None:
    """Refuse shards of no size, names of other formats, and to take the place of anything but a sharded set."""
    if size < 1:
        raise ValueError(f"shards of {size} bytes cannot hold anything; give a size such as 2 GB")
    if target.suffix.lower() != ".fiblets":
        raise ValueError(f"{target}: a set in shards is a folder whose name ends in .fiblets; name it so")
    if target.exists() and not (target / MANIFEST).is_file():
        kind = "folder without shards" if target.is_dir() else "file"
        raise FileExistsError(f"{target} is a {kind}, which shards would replace; remove it, or give another name")


@contextmanager
def _appearing(target: Path) -> Iterator[Path]:
    """Make a folder that takes its name when all went well, in the place of an older set."""
    folder, old = unfinished(target), unfinished(target, "old")
    folder.mkdir()
    try:
        with locked(folder):
            yield folder
        if target.exists():
            target.rename(old)
        folder.rename(target)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)
