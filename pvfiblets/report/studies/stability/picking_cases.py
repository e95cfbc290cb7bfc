"""Picking and regions at their limits: lines under an area, or in a shape, equal a search through all points."""

from __future__ import annotations

import numpy as np

from pvfiblets import regions
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.engine import View
from pvfiblets.query.selection.screen import under_polygon
from pvfiblets.report.studies.codec.coded import compress
from pvfiblets.streamlines import Streamlines

from .case import Cases, Outcome, Setting, refused, worst
from .render_checks import Array, camera, drawn, moved_camera, samples
from .synthetic_lines import lines_of, tracking, zigzag

CASES = Cases("picking and regions")
SIZE = (160, 120)
ALL = [[0.0, 0.0], [160.0, 0.0], [160.0, 120.0], [0.0, 120.0]]
BOX = np.array([[74.0, 54.0], [86.0, 54.0], [86.0, 66.0], [74.0, 66.0]])
SAME = "the streamlines found by a float64 search through their points, but for those at the area's edge"
WRONG = "wrong streamlines"


def _clearances(fiblets: FibletSet, matrix: Array, box: Array) -> Array:
    """Return of each streamline how far from a rectangle it passes, pixels: below 0 inside, inf if unseen."""
    low, high = box.min(axis=0), box.max(axis=0)
    found = np.full(fiblets.n_streamlines, np.inf)
    for i, line in enumerate(fiblets.decompress(dtype=np.float64).to_list()):
        pixels = samples([line], matrix, SIZE)
        if len(pixels):
            found[i] = np.maximum(low - pixels, pixels - high).max(axis=1).min()
    return found


def _same(streamlines: Streamlines, matrix: Array, box: Array = BOX, edge: float = 0.5) -> Outcome:
    """Compare a pick with the search; those whose nearest place is `edge` pixels from the edge may go either way."""
    fiblets = compress(streamlines)
    under = under_polygon(fiblets, matrix, SIZE, box)
    inside = np.zeros(fiblets.n_streamlines, bool)
    inside[under.ids] = True
    away = _clearances(fiblets, matrix, box)
    wrong = (inside & (away > edge)) | (~inside & (away < -edge))
    sound = np.isfinite(under.places).all() and (np.diff(under.depths) >= 0.0).all() and len(under.ids) > 0
    return Outcome(
        float(wrong.sum()) if sound else np.inf, 0.0, WRONG, f"{len(under.ids)} of {len(streamlines)} picked"
    )


@CASES.add("offsets of ±1e7 mm, sizes of 1e-6 and 1e6", "200 lines and the camera, moved or scaled", SAME)
def _places(_: Setting) -> Outcome:
    base, matrix, found = tracking(200, 60), camera(SIZE), []
    for scale, shift in ((1.0, 1e7), (1.0, -1e7), (1e-6, 0.0), (1e6, 0.0)):
        moved = Streamlines(base.points * scale + shift, base.offsets)
        found.append(_same(moved, moved_camera(matrix, scale, shift)))
    return worst(found)


@CASES.add("near plane at a millionth of the far", "the eye outside and among the lines", SAME)
def _near(_: Setting) -> Outcome:
    base = tracking(200, 60)
    eyes = ((0.0, -260.0, 60.0), (3.0, -4.0, 2.0))
    return worst([_same(base, camera(SIZE, eye=eye, near=1e-3, far=1e3)) for eye in eyes])


@CASES.add("steps of 1e6 mm through the eye's plane", "lines that begin behind the eye and end far in front", SAME)
def _through(_: Setting) -> Outcome:
    rng = np.random.default_rng(1)
    ends = rng.uniform(-40.0, 40.0, (60, 2, 3)) + [[[0.0, -1e6, 0.0], [0.0, 1e6, 0.0]]]
    middle = 0.5 * (ends[:, :1] + ends[:, 1:])
    lines = lines_of(*np.concatenate([ends[:, :1], middle, ends[:, 1:]], axis=1))
    return _same(lines, camera(SIZE, eye=(0.0, -260.0, 10.0), near=1.0, far=900.0), BOX - [40.0, 30.0])


@CASES.add(
    "areas that are hardly any",
    "one corner, two, a polygon of no area, one that crosses itself; without streamlines, too",
    "finite answers; nothing of an empty set",
)
def _areas(_: Setting) -> Outcome:
    fiblets, none = compress(tracking(50)), compress(Streamlines(np.empty((0, 3)), [0]))
    areas = ([[80.0, 60.0]], [[10.0, 60.0], [150.0, 60.0]], [[80.0, 60.0]] * 5, [ALL[0], ALL[2], ALL[1], ALL[3]])
    wrong = 0
    for area in areas:
        under = under_polygon(fiblets, camera(SIZE), SIZE, area, 1.0)
        wrong += not (np.isfinite(under.places).all() and np.isfinite(under.depths).all())
        wrong += len(under_polygon(none, camera(SIZE), SIZE, area, 1.0).ids)
    return Outcome(float(wrong), 0.0, "wrong answers")


@CASES.add("100,000 streamlines of 2 points", "all under an area, none far from it", "all, and none")
def _many(_: Setting) -> Outcome:
    rng = np.random.default_rng(6)
    first = rng.uniform(-20.0, 20.0, (100_000, 1, 3))
    points = np.concatenate([first, first + rng.normal(0.0, 0.3, first.shape)], axis=1).reshape(-1, 3)
    fiblets = compress(Streamlines(points, 2 * np.arange(100_001)))
    seen = len(under_polygon(fiblets, camera(SIZE), SIZE, ALL).ids)
    missed = len(under_polygon(fiblets, camera(SIZE), SIZE, np.array(ALL) + 1e4).ids)
    return Outcome(float(100_000 - seen + missed), 0.0, WRONG)


@CASES.add(
    "ids of pixels",
    "ids in a picture of stiff lines, and the lines under each such pixel",
    "the id is among those picked there",
    draws=True,
)
def _pixels(setting: Setting) -> Outcome:
    rng = np.random.default_rng(8)
    mixed = np.cumsum(10.0 ** rng.uniform(-4.0, 0.8, (300, 1)) * rng.normal(size=(300, 3)), axis=0)
    fiblets = compress(Streamlines.concatenate([lines_of(30.0 * zigzag(40) - [15.0, 0.0, 0.0], mixed), tracking(20)]))
    matrix = camera(SIZE)
    shown = drawn(setting.gl, fiblets, View(SIZE, matrix))
    rows, columns = np.nonzero(shown.there)
    wrong = 0
    for y, x in list(zip(rows, columns, strict=True))[:: max(len(rows) // 60, 1)]:
        wrong += shown.ids[y, x, 0] not in under_polygon(fiblets, matrix, SIZE, [[x + 0.5, y + 0.5]], 1.3).ids
    return Outcome(float(wrong) if len(rows) else np.inf, 0.0, "pixels that name another")


@CASES.add("cameras and areas that are none", "no corners, NaN, no pixels, a tolerance below 0", "an error each")
def _bad(_: Setting) -> Outcome:
    fiblets, matrix = compress(tracking(2)), camera(SIZE)
    return refused(
        ValueError,
        "polygon is|finite|above 0|0 or more",
        lambda: under_polygon(fiblets, matrix, SIZE, []),
        lambda: under_polygon(fiblets, matrix, SIZE, [[np.nan, 0.0]]),
        lambda: under_polygon(fiblets, np.full((4, 4), np.nan), SIZE, ALL),
        lambda: under_polygon(fiblets, matrix, (0, 5), ALL),
        lambda: under_polygon(fiblets, matrix, SIZE, ALL, -1.0),
    )


@CASES.add(
    "shapes of 1e-6 to 1e6 mm, 1e7 mm away",
    "spheres and boxes at three sizes and two places, joined, intersected and turned inside out",
    "of each of 2,000 places the answer of a formula in float64, where a millionth of the size does not decide",
)
def _shapes(_: Setting) -> Outcome:
    rng, wrong = np.random.default_rng(2), 0
    for centre in (0.0, 1e7):
        for size in (1e-6, 1.0, 1e6):
            if size < 1e-12 * centre * 1e3:  # float64 itself has no such places there
                continue
            places = centre + 2.0 * size * rng.uniform(-1.0, 1.0, (2000, 3))
            ball = np.linalg.norm(places - centre, axis=1) / size - 1.0
            box = np.abs(places - centre).max(axis=1) / (0.7 * size) - 1.0
            sphere = regions.Sphere((centre,) * 3, size)
            cube = regions.Box(tuple(side for _ in range(3) for side in (centre - 0.7 * size, centre + 0.7 * size)))
            sure = (np.abs(ball) > 1e-5) & (np.abs(box) > 1e-5)
            for region, wanted in (
                (sphere, ball < 0.0),
                (cube, box < 0.0),
                (sphere | cube, (ball < 0.0) | (box < 0.0)),
                (sphere & ~cube, (ball < 0.0) & (box >= 0.0)),
            ):
                wrong += int((np.asarray(region.contains(places)) != wanted)[sure].sum())
    return Outcome(float(wrong), 0.0, "wrong places")
