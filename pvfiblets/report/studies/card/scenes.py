"""Scenes of the check of a graphics card: drawing, comparison, and their parts."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .findings import DIFFERS, Finding, verdict_of

if TYPE_CHECKING:
    import moderngl

SIZE, SMALL = (320, 240), (160, 120)  # the latter where a reference takes its time
TIMED = 3  # pictures

Mask = npt.NDArray[np.bool_]
Pixels = npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Judged:
    """A picture, compared with the right one."""

    # As in `Finding`
    figures: Mapping[str, float]
    limits: Mapping[str, float]
    # By name, `(height, width)` bool or `(height, width, 3)` uint8, row 0 at the bottom: what to look at where it
    # differs
    pictures: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""
    compared: bool = True  # Whether it was held against anything; else it only had to be drawn


@dataclass(frozen=True, eq=False)
class Scene:
    """Something to be drawn and judged."""

    draw: Callable[[int], Any]  # Draws picture number so and so, each from another place, and returns it
    judge: Callable[[Any], Judged]  # Judges the last picture
    release: Callable[[], object] = lambda: None


def tried(
    ctx: moderngl.Context, part: str, feature: str, make: Callable[[], Scene]
) -> tuple[Finding, Mapping[str, Any]]:
    """Draw a scene some times, judge the last picture, and give all back.

    What OpenGL complains of makes it differ, whatever the picture looks like.
    """
    while ctx.error != "GL_NO_ERROR":  # of what came before
        pass
    begin = time.perf_counter()
    scene = make()
    try:
        scene.draw(0)
        ctx.finish()
        first = 1e3 * (time.perf_counter() - begin)
        taken = []
        for number in range(1, 1 + TIMED):
            begin = time.perf_counter()
            drawn = scene.draw(number)
            ctx.finish()
            taken.append(1e3 * (time.perf_counter() - begin))
        judged = scene.judge(drawn)
        complaint = ctx.error
    finally:
        scene.release()
    figures = {name: float(value) for name, value in judged.figures.items()}
    found = Finding(
        part, feature, verdict_of(figures, judged.limits, judged.compared), judged.note, figures, dict(judged.limits),
        float(np.median(taken)), first,
    )  # fmt: skip
    if complaint != "GL_NO_ERROR":
        found = replace(found, verdict=DIFFERS, note=f"OpenGL complained: {complaint}")
    return found, judged.pictures if found.bad else {}


def share(mask: Mask, of: Mask) -> float:
    """Return how many of the pixels of `of` are in a mask, as a share."""
    return float(mask.sum()) / max(int(of.sum()), 1)
