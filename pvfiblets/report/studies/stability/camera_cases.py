"""Lines drawn through extreme cameras, windows and places: right to a pixel, and culling changes none."""

from __future__ import annotations

import numpy as np

from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.engine import EngineError, FibletStyle, View
from pvfiblets.engine.gl.capabilities import pipelines
from pvfiblets.report.studies.codec.coded import compress
from pvfiblets.streamlines import Streamlines

from .case import Cases, Outcome, Setting, refused, worst
from .render_checks import EVERY_POINT, OFF_LINE, Array, camera, drawing, drawn, moved_camera, off_lines, read
from .synthetic_lines import lines_of, tracking, zigzag

__all__ = ["CASES"]

CASES = Cases("culling and camera", draws=True)
SIZE = (160, 120)
PIXELS, DIFFERENT = "pixels", "different pixels"
ON_LINES = f"the picture and the lines in float64 within {OFF_LINE:.2f} pixels of each other"
SLACK = 0.05  # pixels, of sampling and of decoding in float32


def fine(streamlines: Streamlines) -> FibletSet:
    """Compress so finely that no error of the codec shows."""
    return compress(streamlines, max_error=1e-3 * float(np.median(streamlines.lengths()) + 1e-30) / 60.0)


def compare(setting: Setting, streamlines: Streamlines, matrix: Array, size: tuple[int, int] = SIZE) -> Outcome:
    """Draw lines and compare the picture with them."""
    fiblets = fine(streamlines)
    shown = drawn(setting.gl, fiblets, View(size, matrix))
    lines = [np.asarray(line) for line in fiblets.decompress(dtype=np.float64).to_list()]
    off = off_lines(shown, lines, matrix, size) if shown.sound else np.inf
    return Outcome(off, OFF_LINE + SLACK, PIXELS, f"{int(shown.there.sum()):,} pixels drawn")


@CASES.add("offsets of ±1e7 mm", "tracking, camera and all, moved by 1e7 mm either way", ON_LINES)
def _far_away(setting: Setting) -> Outcome:
    base, matrix = tracking(6), camera(SIZE)
    return worst(
        [
            compare(setting, Streamlines(base.points + shift, base.offsets), moved_camera(matrix, 1.0, shift))
            for shift in (1e7, -1e7)
        ]
    )


@CASES.add("sizes of 1e-6 and 1e6", "tracking and camera scaled by a millionth and by a million", ON_LINES)
def _sizes(setting: Setting) -> Outcome:
    base, matrix = tracking(6), camera(SIZE)
    return worst(
        [
            compare(setting, Streamlines(base.points * scale, base.offsets), moved_camera(matrix, scale, 0.0))
            for scale in (1e-6, 1e6)
        ]
    )


@CASES.add("near plane at a millionth of the far", "near 0.001 mm, far 1000 mm; eye outside and inside", ON_LINES)
def _near(setting: Setting) -> Outcome:
    base = tracking(6)
    eyes = ((0.0, -260.0, 60.0), (3.0, -4.0, 2.0))
    return worst([compare(setting, base, camera(SIZE, eye=eye, near=1e-3, far=1e3)) for eye in eyes])


@CASES.add("eye on a line's point", "the eye exactly at a point of a line, looking along it", ON_LINES)
def _on_a_point(setting: Setting) -> Outcome:
    line = np.array(tracking(1).points)
    lines = lines_of(line, line + [1.0, 2.0, 3.0])
    at = np.asarray(fine(lines).decompress([0], dtype=np.float64).points)
    return compare(setting, lines, camera(SIZE, eye=at[40], target=at[60], near=0.01, far=300.0))


@CASES.add("windows of 1 × 1 and one pixel high or wide", "four sizes; parallel projection", ON_LINES)
def _small(setting: Setting) -> Outcome:
    fiblets = fine(tracking(12))
    lines = [np.asarray(line) for line in fiblets.decompress(dtype=np.float64).to_list()]
    found = []
    with drawing(setting.gl, fiblets) as renderer:
        for size in ((1, 1), (1, 90), (90, 1), (2, 3)):
            matrix = camera(size, height=60.0)
            shown = read(renderer.render(View(size, matrix), EVERY_POINT))
            off = off_lines(shown, lines, matrix, size) if shown.sound else np.inf
            found.append(Outcome(off, OFF_LINE + SLACK, PIXELS, f"{size[0]} × {size[1]}"))
    return worst(found)


@CASES.add(
    "a window 16,384 pixels wide", "16,384 × 12 and 12 × 16,384 pixels, and lines that go all along it", ON_LINES
)
def _wide(setting: Setting) -> Outcome:
    t = np.linspace(-1.0, 1.0, 400)
    wave = np.stack([60.0 * t, 10.0 * t, 0.03 * np.sin(9.0 * t)], axis=1)
    return worst(
        [
            compare(setting, lines_of(wave[:, order]), camera(size, eye=(0.0, -260.0, 0.0), height=height), size)
            for size, height, order in (((16384, 12), 0.1, [0, 1, 2]), ((12, 16384), 120.0, [2, 1, 0]))
        ]
    )


@CASES.add("a window larger than OpenGL's largest texture", "a million pixels wide", "an error that names the limit")
def _too_wide(setting: Setting) -> Outcome:
    with drawing(setting.gl, compress(tracking(2))) as renderer:
        return refused(EngineError, "largest texture", lambda: renderer.render(View((10**6, 10), camera(SIZE))))


@CASES.add("no fiblets", "no streamlines, and only empty ones, by every pipeline there is", "an empty picture")
def _none(setting: Setting) -> Outcome:
    pixels, names = 0, []
    for pipeline in _pipelines(setting):
        for offsets in ([0], [0, 0, 0]):
            fiblets = compress(Streamlines(np.empty((0, 3)), offsets))
            shown = drawn(setting.gl, fiblets, View(SIZE, camera(SIZE)), pipeline=pipeline)
            pixels += int(shown.there.sum())
        names.append(pipeline)
    return Outcome(float(pixels), 0.0, "pixels drawn", ", ".join(names))


def _pipelines(setting: Setting) -> list[str]:
    return [found.name for found in pipelines(setting.gl) if found.available]


@CASES.add(
    "all fiblets culled", "looking away; beyond the far plane; cut off by a plane", "an empty picture, none counted"
)
def _culled(setting: Setting) -> Outcome:
    views = [
        View(SIZE, camera(SIZE, target=(0.0, -520.0, 120.0))),
        View(SIZE, camera(SIZE, near=1e-3, far=1e-2)),
        View(SIZE, camera(SIZE), [[0.0, 0.0, 1.0, -1e9]]),
    ]
    wrong = 0
    with drawing(setting.gl, compress(tracking())) as renderer:
        for view in views:
            shown = read(renderer.render(view, EVERY_POINT))
            wrong += int(shown.there.sum())
            counts = renderer.explain()["fiblets"]
            assert isinstance(counts, dict)
            wrong += int(counts["visible"] or 0)
    return Outcome(float(wrong), 0.0, "pixels and fiblets shown")


@CASES.add(
    "culling where it is hard",
    "near plane at a millionth of the far, eye among 400 lines, then a camera jump; two-phase beside none",
    "not one pixel differs",
)
def _culling(setting: Setting) -> Outcome:
    fiblets = compress(tracking(400, 200, seed=2))
    views = [
        View(SIZE, camera(SIZE, eye=eye, near=1e-3, far=1e3)) for eye in ((3.0, -4.0, 2.0), (0, -260, 60), (90, 2, 1))
    ]
    different = 0
    with drawing(setting.gl, fiblets) as one, drawing(setting.gl, fiblets, culling=None) as other:
        for view in (*views, views[0]):
            different += read(one.render(view, EVERY_POINT)).differs(read(other.render(view, EVERY_POINT)))
    return Outcome(float(different), 0.0, DIFFERENT)


@CASES.add("5,000 lines at one place", "copies of one line: a tie in every pixel", "the first wins, twice alike")
def _ties(setting: Setting) -> Outcome:
    line = np.asarray(tracking(1).points)
    fiblets = compress(lines_of(*[line] * 5000))
    view = View(SIZE, camera(SIZE))
    first, again = (drawn(setting.gl, fiblets, view) for _ in range(2))
    wrong = first.differs(again) + int((first.ids[first.there][:, 0] != 0).sum())
    return Outcome(float(wrong) if first.there.any() else np.inf, 0.0, DIFFERENT)


@CASES.add("stiff lines", "turns of 180°, steps of no length and of 1e-6 to 1e3 mm", ON_LINES)
def _stiff(setting: Setting) -> Outcome:
    rng = np.random.default_rng(8)
    steps = 10.0 ** rng.uniform(-6.0, 3.0, (200, 1)) * rng.normal(size=(200, 3))
    mixed = np.cumsum(steps, axis=0)
    mixed *= 60.0 / np.ptp(mixed, axis=0).max()
    still = np.repeat(rng.uniform(-20.0, 20.0, (8, 3)), 3, axis=0)
    return compare(setting, lines_of(30.0 * zigzag(40) - [15.0, 0, 0], mixed - mixed.mean(axis=0), still), camera(SIZE))


@CASES.add("lines through the eye's plane", "lines of 1e6 mm that pass behind the eye", ON_LINES)
def _through(setting: Setting) -> Outcome:
    directions = np.random.default_rng(9).normal(size=(5, 3))
    lines = [np.linspace(-5e5, 5e5, 30)[:, None] * d / np.linalg.norm(d) + d for d in directions]
    return compare(setting, lines_of(*lines), camera(SIZE, eye=(3.0, -20.0, 2.0), near=0.01, far=1e4))


@CASES.add("lines wider than the window", "100 pixels wide in 64 × 48", "every pixel shows it, by finite numbers")
def _broad(setting: Setting) -> Outcome:
    view = View((64, 48), camera((64, 48), angle=10.0))
    line = np.linspace(-40.0, 40.0, 100)[:, None] * [1.0, 0.2, 0.1]
    shown = drawn(setting.gl, compress(lines_of(line)), view, FibletStyle(line_width=100.0))
    return Outcome(float((~shown.there).sum()) if shown.sound else np.inf, 0.0, "empty pixels")


@CASES.add(
    "a tolerance of 1e9 pixels", "level of detail taken to its end", "pixels still on the lines' chords or nothing"
)
def _coarse(setting: Setting) -> Outcome:
    fiblets = compress(lines_of(np.linspace(-40.0, 40.0, 300)[:, None] * [1.0, 0.1, 0.2]))
    matrix = camera(SIZE)
    shown = drawn(setting.gl, fiblets, View(SIZE, matrix), FibletStyle(tolerance=1e9))
    ends = [np.array([[-40.0, -4.0, -8.0], [40.0, 4.0, 8.0]])]
    off = off_lines(shown, ends, matrix, SIZE) if shown.sound else np.inf
    return Outcome(off, OFF_LINE + SLACK, PIXELS)


@CASES.add("clip planes that are hardly any", "normals of 1e-30 and of 1e30, beside one of 1", "the same picture")
def _planes(setting: Setting) -> Outcome:
    fiblets, matrix = compress(tracking()), camera(SIZE)
    plane = np.array([0.3, 1.0, -0.2, 4.0])
    shown = [drawn(setting.gl, fiblets, View(SIZE, matrix, plane[None] * scale)) for scale in (1.0, 1e-30, 1e30)]
    missing = np.inf if not shown[0].there.any() else 0.0
    return Outcome(missing + sum(shown[0].differs(other) for other in shown[1:]), 0.0, DIFFERENT)


@CASES.add(
    "cameras and planes that are none", "NaN in the matrix, no pixels, NaN in a plane, nine planes", "an error each"
)
def _no_camera(_: Setting) -> Outcome:
    matrix = camera(SIZE)
    broken = matrix.copy()
    broken[1, 1] = np.nan
    return refused(
        ValueError,
        r"finite \(4, 4\) matrix|at least one pixel|finite rows|more than 8|line_width|tolerance|radius",
        lambda: View(SIZE, broken),
        lambda: View((0, 5), matrix),
        lambda: View(SIZE, matrix, [[1.0, 0.0, np.nan, 0.0]]),
        lambda: View(SIZE, matrix, np.ones((9, 4))),
        lambda: FibletStyle(line_width=0.0),
        lambda: FibletStyle(tolerance=np.inf),
        lambda: FibletStyle(radius=0.0),
    )
