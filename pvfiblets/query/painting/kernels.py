"""Compiles the kernels that tell streamlines of painted regions, which takes a quarter of a minute, once."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...codec.kernel_cache import is_filled, mark_filled
from ...streamlines import Streamlines

_WORK, _HOME = "painting", Path(__file__).resolve().parent


def are_compiled() -> bool:
    """Whether this was done before, by these sources."""
    return is_filled(_WORK, _HOME)


def compile_all() -> None:
    """Compile or load all kernels."""
    from ...codec.encoding.compress import compress
    from .live import LiveRegions
    from .painter import RegionPainter

    i = np.arange(130.0)
    line = np.stack([20.0 * np.cos(0.02 * i), 20.0 * np.sin(0.02 * i), 0.3 * i], axis=1)
    fiblets = compress(Streamlines.from_list([line, line + 5.0]), exact=False)
    place = np.eye(4)
    place[:3, 3] = -30.0
    painter = RegionPainter(((80, 80, 80), place))
    painter.add("a")
    painter.add("b")
    live = LiveRegions(fiblets, painter)
    live.region("a")
    live.region("b")
    painter.paint("a", line[40], 3.0)
    painter.erase(line[40], 2.0)
    painter.paint("b", line[80], 3.0)
    live.select(ends_in="a", stays_in="b")
    live.select(in_order=["a", "b"])
    painter.paint("a", line[60], 2.0)
    painter.fill("b", line[100])
    mark_filled(_WORK, _HOME)
