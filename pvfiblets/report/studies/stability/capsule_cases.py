"""Capsules that culling trusts, and tubes about lines: every point lies within, and rays hit the same as in float64."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.layout import unpack, unpack_ends
from pvfiblets.engine import FibletStyle, View
from pvfiblets.report.studies.codec.coded import compress

from .case import Cases, Outcome, Setting, refused, worst
from .codec_cases import EFFORTS
from .decode_cases import stiff
from .render_checks import Array, camera, drawn, pixel_rays
from .synthetic_lines import from_segments, lines_of, tracking, zigzag

CASES = Cases("capsules and tubes of lines")
SIZE = (48, 36)


@CASES.add(
    "capsules of stiff lines",
    "eight sets, with both encoders: decoded points and where their capsules end",
    "no point leaves its fiblet's capsule by more than rounding",
)
def _capsules(_: Setting) -> Outcome:
    found = []
    for name, lines in stiff().items():
        for effort in EFFORTS:
            fiblets = compress(lines, effort=effort)
            points = np.asarray(fiblets.decompress(dtype=np.float64).points) - fiblets.origin
            starts = np.append(fiblets.fiblet_points(), fiblets.n_points)
            ends = unpack("end", fiblets.anchors).astype(bool)
            ranks = np.cumsum(unpack("begin", fiblets.anchors)) - 1
            vectors = unpack_ends(np.asarray(fiblets.ends)) * fiblets.parameters.end_scale
            for f in range(fiblets.n_fiblets):
                own = points[starts[f] : starts[f + 1]]
                tip = own[0] + vectors[ranks[f]] if ends[f] else points[starts[f + 1]]
                radius = float(fiblets.reach[f]) * fiblets.parameters.reach_scale
                slack = 16.0 * float(np.spacing(np.abs(own).max() + np.abs(fiblets.origin).max()))
                farthest = float(from_segments(own, own[0], tip).max())
                found.append(Outcome(farthest / (radius + slack), 1.0, "of the radius", name))
    return worst(found)


def _entries(lines: list[npt.NDArray[Any]], radius: float, o: Array, d: Array) -> Array:
    """Return how far rays go until they enter one of the lines' capsules; inf where they meet none."""
    nearest = np.full(len(o), np.inf)
    for line in lines:
        for a, b in pairwise(line):
            first = np.minimum(_ball(o - a, d, radius), _ball(o - b, d, radius))
            run = b - a
            length = float(np.linalg.norm(run))
            if length > 0.0:
                u = run / length
                along, rise = (o - a) @ u, d @ u
                side, across = (o - a) - along[:, None] * u, d - rise[:, None] * u
                squares = np.maximum((across**2).sum(axis=1), 1e-300)
                middle = -(side * across).sum(axis=1) / squares
                room = radius**2 - (side**2).sum(axis=1) + middle**2 * squares
                t = np.where(room >= 0.0, middle - np.sqrt(np.maximum(room, 0.0) / squares), np.inf)
                with np.errstate(invalid="ignore"):
                    at = along + t * rise
                first = np.where((room >= 0.0) & (at >= 0.0) & (at <= length), np.minimum(first, t), first)
            nearest = np.minimum(nearest, np.where(first >= 0.0, first, np.inf))
    return nearest


def _ball(o: Array, d: Array, radius: float) -> Array:
    middle = -(o * d).sum(axis=1)
    room = radius**2 - (o**2).sum(axis=1) + middle**2
    return np.where(room >= 0.0, middle - np.sqrt(np.maximum(room, 0.0)), np.inf)


@CASES.add(
    "radii of 1e-6 to 100 mm about lines",
    "tracking, a line that turns back, points at one place; thinner than a pixel, and thicker than the scene",
    "all pixels but 1 in 100 as rays meet capsules in float64, where 2 % of the radius do not decide",
    draws=True,
)
def _tubes(setting: Setting) -> Outcome:
    lines = lines_of(*np.asarray(tracking(2, 40).points).reshape(2, 40, 3), 20.0 * zigzag(6), np.full((3, 3), 12.0))
    fiblets = compress(lines, max_error=1e-4)
    decoded = [np.asarray(line) for line in fiblets.decompress(dtype=np.float64).to_list()]
    found = []
    for radius, eye in ((0.5, 120.0), (5.0, 120.0), (100.0, 600.0)):
        matrix = camera(SIZE, eye=(0.0, -eye, 0.2 * eye), near=1.0, far=3.0 * eye)
        shown = drawn(setting.gl, fiblets, View(SIZE, matrix), FibletStyle(radius=radius, tolerance=0.0))
        o, d = pixel_rays(matrix, SIZE)
        there = [np.isfinite(_entries(decoded, radius * factor, o, d)) for factor in (1.0, 0.98, 1.02)]
        sure = (there[0] == there[1]) & (there[0] == there[2])
        wrong = sure & (shown.there.ravel() != there[0])
        if radius < 1.0:  # thinner than a pixel in places, and then drawn a pixel wide
            wrong &= ~shown.there.ravel()
        off = 100.0 * float(wrong.mean()) if shown.sound and shown.there.any() else np.inf
        found.append(Outcome(off, 1.0, "pixels in 100", f"radius {radius:g} mm"))
    thread = drawn(setting.gl, fiblets, View(SIZE, camera(SIZE)), FibletStyle(radius=1e-6, tolerance=0.0))
    found.append(Outcome(0.0 if thread.sound and thread.there.any() else np.inf, 1.0, "pixels in 100", "1e-6 mm"))
    return worst(found)


@CASES.add(
    "an eye within a tube",
    "in the axis, beside it, and of a radius of 1e6 mm",
    "finite, and the tube about the eye is open",
    draws=True,
)
def _inside(setting: Setting) -> Outcome:
    lines = lines_of([[-50.0, 0.0, 0.0], [50.0, 0.0, 0.0]], [[0.0, 30.0, -40.0], [0.0, 30.0, 40.0]])
    fiblets, wrong = compress(lines, max_error=1e-4), 0
    for radius, eye, target in (
        (2.0, (0.5, 0.2, 0.1), (0.0, 30.0, 0.0)),
        (2.0, (0.0, 0.0, 0.0), (40.0, 1.0, 0.0)),
        (1e6, (1.0, -20.0, 3.0), (0.0, 0.0, 0.0)),
    ):
        view = View(SIZE, camera(SIZE, eye=eye, target=target, near=0.01, far=300.0, angle=70.0))
        shown = drawn(setting.gl, fiblets, view, FibletStyle(radius=radius, tolerance=0.0, across=True))
        wrong += int((shown.ids[shown.there][:, 0] == 0).sum()) + (not shown.sound)
    return Outcome(float(wrong), 0.0, "pixels of the tube about the eye")


@CASES.add("invalid radii", "0, negative, NaN and infinite", "an error that names the expected values")
def _bad_radii(_: Setting) -> Outcome:
    values = (0.0, -1.0, np.nan, np.inf)
    return refused(
        ValueError, "radius is .*above 0", *(lambda radius=radius: FibletStyle(radius=radius) for radius in values)
    )
