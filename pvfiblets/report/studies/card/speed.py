"""The card's check of speed: pictures of synthetic brains of 1, 10 and 100 million segments, by one pipeline."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..culling.pictures import views
from .findings import EMPTY
from .scenes import TIMED, Judged, Scene

if TYPE_CHECKING:
    import moderngl

SEGMENTS = (1e6, 1e7, 1e8)
STEP = 0.1  # mm; Schertzer et al. 2022, section 4
SIZE = (1280, 720)
DEGREES = 1.14  # a frame: Schertzer et al. 2022, section 4.5
TOO_SLOW = 100.0  # ms a picture at a million segments
SLUGGISH = 1000.0  # ms a picture of whatever size
HOPELESS = 2000.0  # ms a picture, beyond which larger sets are left out


def named(segments: float) -> str:
    """Return the label of a number of segments."""
    return f"{segments / 1e6:g} M segments"


def make_brains(segments: tuple[float, ...], folder: Path) -> dict[float, Path]:
    """Make synthetic brains of so many segments, as files in a folder."""
    from pvfiblets.synthetic import brain, streamline_count

    made = {}
    for wanted in segments:
        made[wanted] = folder / f"{wanted:g}.fiblets"
        brain(streamline_count(wanted, STEP), STEP, path=made[wanted])
    return made


def speed_part(ctx: moderngl.Context, pipeline: str, folder: Path) -> Iterator[tuple[str, Callable[[], Scene]]]:
    """Yield the brains in a folder, the smallest first; larger ones are left out where one is far too slow."""
    for path in sorted(folder.glob("*.fiblets"), key=lambda path: float(path.stem)):
        taken: list[float] = []
        yield named(float(path.stem)), partial(_scene, ctx, pipeline, path, taken)
        if not taken or 1e3 * float(np.median(taken)) > HOPELESS:
            return


def _scene(ctx: moderngl.Context, pipeline: str, path: Path, taken: list[float]) -> Scene:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.renderer import FibletRenderer

    fiblets = FibletSet.open(path)
    flight = views(fiblets.bounds, "far", DEGREES, 1 + TIMED, SIZE)
    renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline)
    segments = fiblets.n_points - fiblets.n_ranks

    def draw(number: int) -> None:
        begin = time.perf_counter()
        renderer.render(flight[number])
        ctx.finish()
        if number > 0:  # the first compiles
            taken.append(time.perf_counter() - begin)

    def judge(_: Any) -> Judged:
        ms = 1e3 * float(np.median(taken))
        figures = {EMPTY: 0.0, "M segments a second": 1e-3 * segments / ms}
        return Judged(figures, {EMPTY: 0.0}, note=f"{figures['M segments a second']:,.0f} M segments a second")

    return Scene(draw, judge, renderer.release)
