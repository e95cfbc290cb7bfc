"""The base of formats that must be read whole."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pvfiblets.formats.rows import finite
from pvfiblets.streamlines import Streamlines

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
