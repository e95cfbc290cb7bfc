"""Pieces of a tractogram put together on disk, so that a writer that wants the whole gets it without the memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.streamlines import Streamlines
from pvfiblets.support.unfinished import scratch_folder_for

Array = NDArray[Any]


@contextmanager
def gathered(chunks: Iterable[Streamlines], folder: str | PathLike[str]) -> Iterator[Streamlines]:
    """Join consecutive pieces into one object whose points and columns are maps of temporary files."""
    with scratch_folder_for(Path(folder) / "lines") as scratch, ExitStack() as files_open:
        points = _Column(Path(scratch) / "points", files_open)
        columns: dict[str, dict[str, _Column]] = {}
        counts: list[Array] = []
        groups: dict[str, list[Array]] = {}
        dropped: dict[str, int] = {}
        per_group: Mapping[str, Mapping[str, Array]] = {}
        first: Streamlines | None = None
        n = 0
        for chunk in chunks:
            if first is None:
                first, per_group = chunk, chunk.per_group
                for part in ("per_point", "per_streamline"):
                    names = enumerate(getattr(chunk, part))
                    columns[part] = {name: _Column(Path(scratch) / f"{part}{i}", files_open) for i, name in names}
            points.add(chunk.points)
            for part, files in columns.items():
                arrays = getattr(chunk, part)
                if list(arrays) != list(files):
                    raise ValueError(f"{part} is {list(arrays)} from streamline {n} on, {list(files)} before")
                for name, values in arrays.items():
                    files[name].add(values)
            counts.append(chunk.counts)
            for name, members in chunk.groups.items():
                groups.setdefault(name, []).append(members + n)
            for reason, count in chunk.dropped.items():
                dropped[reason] = dropped.get(reason, 0) + count
            n += len(chunk)
        if first is None:
            raise ValueError("no pieces to join; a file without streamlines gives one empty piece")
        yield Streamlines(
            points.whole(),
            np.concatenate([[0], np.cumsum(np.concatenate(counts))]),
            per_point={name: column.whole() for name, column in columns["per_point"].items()},
            per_streamline={name: column.whole() for name, column in columns["per_streamline"].items()},
            groups={name: np.concatenate(parts) for name, parts in groups.items()},
            per_group=per_group,
            affine=first.affine,
            space=first.space,
            dropped=dropped,
        )


class _Column:
    """Rows appended to a file."""

    def __init__(self, path: Path, files_open: ExitStack) -> None:
        self._path = path
        self._file = files_open.enter_context(path.open("wb"))
        self._like: Array | None = None
        self._rows = 0

    def add(self, rows: Array) -> None:
        if self._like is None:
            self._like = rows[:0]
        self._file.write(np.ascontiguousarray(rows, self._like.dtype).data)
        self._rows += len(rows)

    def whole(self) -> Array:
        assert self._like is not None
        self._file.close()
        shape = (self._rows, *self._like.shape[1:])
        if 0 in shape:
            return np.zeros(shape, self._like.dtype)
        return np.memmap(self._path, self._like.dtype, "r", shape=shape)
