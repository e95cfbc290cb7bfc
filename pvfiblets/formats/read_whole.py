"""The base of formats that must be read whole."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from os import PathLike
from typing import Any

from pvfiblets.formats.rows import finite
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.vtk_space import Space

TEXT_ARRAYS = "text arrays"  # the reason under which `dropped` counts arrays of strings


def only_finite(streamlines: Streamlines, more: dict[str, int] | None = None) -> Streamlines:
    """Streamlines less their non-finite points, with `more` reasons added to `dropped`."""
    dropped = {**streamlines.dropped, **{k: v for k, v in (more or {}).items() if v}}
    return finite(
        streamlines.points,
        streamlines.counts,
        streamlines.per_point,
        dropped,
        per_streamline=streamlines.per_streamline,
        groups=streamlines.groups,
        per_group=streamlines.per_group,
        affine=streamlines.affine,
        space=streamlines.space,
    )


def pieces(streamlines: Streamlines, max_points: int) -> Iterator[Streamlines]:
    """Cut streamlines into consecutive pieces; the first alone carries `dropped`."""
    for start, stop in list(streamlines.blocks(max_points)) or [(0, 0)]:
        piece = streamlines[start:stop]
        if start:
            piece.dropped = {}
        yield piece


def whole_file(read_with_facts: Callable[..., tuple[Streamlines, dict[str, str]]]) -> tuple[Any, Any, Any]:
    """Return ``read``, ``iter_chunks`` and ``info`` of a format, from a function of path and space."""

    def read(path: str | PathLike[str], *, progress: bool = False, space: Space | None = None) -> Streamlines:  # noqa: ARG001
        return read_with_facts(path, space)[0]

    def iter_chunks(path: str | PathLike[str], max_points: int, *, space: Space | None = None) -> Iterator[Streamlines]:
        return pieces(read(path, space=space), max_points)

    def info(path: str | PathLike[str], *, space: Space | None = None) -> dict[str, Any]:
        streamlines, of_space = read_with_facts(path, space)
        return {**facts(streamlines), **of_space}

    return read, iter_chunks, info


def facts(streamlines: Streamlines) -> dict[str, Any]:
    """Facts for ``info`` of a format whose header alone does not tell them."""
    return {
        "streamlines": len(streamlines),
        "points": streamlines.n_points,
        "dtype": streamlines.points.dtype.name,
        "per_point": list(streamlines.per_point),
        "per_streamline": list(streamlines.per_streamline),
        "groups": list(streamlines.groups),
        "affine": streamlines.affine,
        "dropped": streamlines.dropped,
        **streamlines.space,
    }
