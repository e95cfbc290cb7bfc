"""How the benchmark of ray-cast volumes times each method, and finds the step with which one is as wrong as another."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from volumes_data import make_data
from volumes_methods import EQUAL, METHODS, Method

from pvfiblets.report.cameras import Camera
from pvfiblets.report.studies.volumes.scene import Look, Truth, circle, look_of

STATIC_TOO = ("engine", "plotter", "vtk-gpu", EQUAL)
"""Methods that are also timed in the static view: the other one is the mapper of these once more."""

BYTES = 1.0 / (255.0 * math.sqrt(12.0))
"""What rounding colours to bytes costs: no picture of bytes need be nearer to what is right."""

NEAR = 1.03
"""So many times another error is as good as equal to it."""

CLOSE = 1.1
"""So many times another step is no longer looked for what lies between."""

COARSEST = 8.0  # voxels: no step is longer
WARM = "vessels-16"


class FrameTimes:
    """Milliseconds of frames, by the clock and of all of this process's threads."""

    def __init__(self) -> None:
        self.wall: list[float] = []
        self.cpu: list[float] = []

    def time(self, draw: Any, *arguments: Any) -> None:
        """Draw a frame."""
        wall, cpu = time.perf_counter(), time.process_time()
        draw(*arguments)
        self.wall.append(1e3 * (time.perf_counter() - wall))
        self.cpu.append(1e3 * (time.process_time() - cpu))

    def report(self) -> dict[str, Any]:
        """Return medians, and the 10th and 90th percentile."""
        low, median, high = (float(np.percentile(self.wall, q)) for q in (10, 50, 90))
        cpu_low, cpu, cpu_high = (float(np.percentile(self.cpu, q)) for q in (10, 50, 90))
        return {"ms": median, "ms_spread": [low, high], "cpu_ms": cpu, "cpu_spread": [cpu_low, cpu_high],
                "frames": len(self.wall)}  # fmt: skip


def timed(draw: Any, cameras: list[Camera], seconds: float) -> dict[str, Any]:
    """Return times of frames: of all cameras, or of as many as take so many seconds, and of one at least.

    What is nearly the first one is drawn once before; if that alone takes longer than that, it is what is measured.
    """
    warm = FrameTimes()
    warm.time(draw, nudged(cameras[0], 3)[2])
    if warm.wall[0] > 1500.0 * seconds:
        return warm.report()
    measured = FrameTimes()
    for camera in cameras:
        measured.time(draw, camera)
        if sum(measured.wall) > 1e3 * seconds:
            break
    return measured.report()


def nudged(camera: Camera, count: int) -> list[Camera]:
    """Return a camera so many times, each a little different: none may show the picture of the one before."""
    return [
        Camera(camera.size, camera.eye, camera.centre, camera.near, camera.far * (1.0 + 1e-7 * (1 + k % 3)))
        for k in range(count)
    ]


def run(
    name: str, data: str, truths: dict[str, Truth], targets: dict[str, float], options: Any
) -> Iterator[dict[str, Any]]:
    """Return a row for each mode of one method: its error, times and bytes, and how long it takes to be there.

    Of VTK's GPU mapper there is a second one where an error to reach is given.
    """
    kind = METHODS[name]
    volume = make_data(data, options.seed, options.data_folder)
    size, still = (options.size, options.size), (options.still, options.still)
    cameras, static = circle(volume, options.frames, size), nudged(circle(volume, 1, still)[0], options.frames)
    for mode, of in truths.items():
        small = make_data(WARM)
        first = kind(name, small, look_of(small, mode), options.step, size)  # imports, compilers
        first.draw(circle(small, 1, size)[0])
        first.close()
        look = look_of(volume, mode)
        build = FrameTimes()
        made: list[Method] = []

        def begin(look: Look = look, made: list[Method] = made) -> None:
            made.append(kind(name, volume, look, options.step, size))
            made[0].draw(cameras[0])

        build.time(begin)
        (method,) = made
        try:
            row = {"mode": mode, "method": name, "step": options.step, "error": method.error(of)}
            row["circle"] = timed(method.draw, cameras, options.seconds)
            if name in STATIC_TOO and affordable(row["circle"], options):
                row["static"] = timed(method.draw, static, options.seconds)
            row["gpu_bytes"] = method.bytes()
            report = build.report()
            # The first picture itself is no part of building.
            row["build_ms"] = max(report["ms"] - row["circle"]["ms"], 0.0)
            row["build_cpu_ms"] = max(report["cpu_ms"] - row["circle"]["cpu_ms"], 0.0)
            yield {**row, **method.facts()}
            if name == "vtk-gpu" and mode in targets:
                yield equal(method, mode, row, of, targets[mode], cameras, static, options)
        finally:
            method.close()


def affordable(circle: dict[str, Any], options: Any) -> bool:
    """Say whether a frame of the static view will not take too long, judged by one of the other view."""
    return 1e-3 * circle["ms"] * (options.still / options.size) ** 2 <= options.longest


def equal(
    method: Any, mode: str, same: dict[str, Any], of: Truth, target: float, cameras: list[Camera], static: list[Camera],
    options: Any,
) -> dict[str, Any]:  # fmt: skip
    """Return the row of VTK's GPU mapper at a step with which it is as wrong as another method."""
    target = max(target, BYTES)
    step, error, reached = search(method, of, target, (same["step"], same["error"]), options.search)
    row = {"mode": mode, "method": EQUAL, "step": step, "error": error, "target": target, "reached": reached}
    if step == same["step"]:
        return {**row, **{key: same[key] for key in ("circle", "static") if key in same}}
    method.step(step)
    row["circle"] = timed(method.draw, cameras, options.seconds)
    if reached and affordable(row["circle"], options):
        row["static"] = timed(method.draw, static, options.seconds)
    return row


def search(
    method: Any, of: Truth, target: float, start: tuple[float, float], seconds: float
) -> tuple[float, float, bool]:
    """Return the longest step found with which a method is as wrong as another, or the best one, its error, and which.

    Steps are halved or doubled until the error is on the other side, then what lies between is halved in turn.

    Parameters
    ----------
    method : Method
        With a method `step`.
    of : Truth
    target : float
        The error to keep to.
    start : tuple of float
        A step, and the error with it.
    seconds : float
        That pictures of one step may take: finer ones are not tried.
    """
    tried = [start]
    fine = start[1] <= target * NEAR
    took = 0.0
    while (tried[-1][1] <= target * NEAR) == fine:
        step = tried[-1][0] * (2.0 if fine else 0.5)
        if step > COARSEST or (not fine and 2.0 * took > seconds):
            break
        began = time.perf_counter()
        method.step(step)
        tried.append((step, method.error(of)))
        took = time.perf_counter() - began
    else:
        (a, error_a), (b, _) = sorted(tried[-2:])  # a keeps to it, b does not
        while b / a > CLOSE:
            step = math.sqrt(a * b)
            method.step(step)
            error = method.error(of)
            if error <= target * NEAR:
                a, error_a = step, error
            else:
                b = step
        return a, error_a, True
    if fine:
        return (*max(tried), True)
    return (*min(tried, key=lambda one: one[1]), False)
