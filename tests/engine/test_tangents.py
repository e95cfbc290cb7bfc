"""Tangents are continuous along lines, in every pipeline: against float64 tangents of the decoded points."""

import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.codec import layout
from pvfiblets.engine import FibletRenderer, FibletStyle, View

from .emulated import emulated_renderer
from .line_tubes import entries, smoothed
from .pictures import draw, read, unpacked_tangent
from .polylines import feet, to_clip, to_window
from .tangents import tangents_at, tangents_at_ends, unit

SIZE = (200, 150)
PIPELINES = ["compute", "geometry", "tessellation", "mesh", "mesh-serial"]


def curve(n, turn=0.25, seed=0, step=1.0):
    """A line of n points that winds through space."""
    rng = np.random.default_rng(seed)
    d = unit(rng.normal(0, 1, 3))
    out = [np.zeros(3)]
    for axis in unit(rng.normal(0, 1, (n - 1, 3)) + rng.normal(0, 1, 3)):
        out.append(out[-1] + step * d)
        d = unit(d + turn * np.cross(axis, d))
    return np.array(out) - np.mean(out, axis=0)


LENGTHS = [2, 3, 59, 60, 61, 62, 120, 121, 150]
"""Points of lines; 61 and 121 leave a last fiblet of a single point."""


@pytest.fixture
def drawn(gl, monkeypatch):
    """Return a function that draws by a pipeline, or by what stands in for it where there are no mesh shaders."""

    def run(fiblets, view, style, pipeline):
        if not pipeline.startswith("mesh"):
            return draw(gl, fiblets, view, style, pipeline=pipeline, culling=None)
        renderer = emulated_renderer(monkeypatch, gl, fiblets, serial=pipeline == "mesh-serial", culling=None)
        try:
            return read(renderer.render(view, style))
        finally:
            renderer.release()

    return run


def assert_tangents(picture, lines, share=0.995, per_fiblet=60):
    """Each pixel's tangent is that at the place that it names."""
    rows, columns = np.nonzero(picture.drawn)
    rows, columns = rows[::3], columns[::3]
    place = picture.position[rows, columns, 0].astype(float)
    expected = tangents_at(lines, picture.ids[rows, columns, 0], place, per_fiblet)
    shown = unpacked_tangent(picture.ids[rows, columns, 1])
    assert (np.linalg.norm(shown - expected, axis=1) < 2e-3).mean() > share


@pytest.fixture(scope="module")
def directions():
    """Fiblets of direction codes, and the lines that they decode to."""
    fiblets = compress(Streamlines.from_list([curve(n, seed=n) for n in LENGTHS]))
    assert set(layout.unpack("kind", fiblets.decoding)) == {int(layout.Kind.DIRECTION)}
    return fiblets, [line.astype(float) for line in fiblets.decompress().to_list()]


@pytest.mark.few(2)
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("width", [1.0, 5.0])
def test_tangents_of_direction_codes(drawn, directions, camera, width, pipeline):
    fiblets, lines = directions
    view = View(SIZE, camera(SIZE, height=70.0))
    assert_tangents(drawn(fiblets, view, FibletStyle(width, tolerance=0.0), pipeline), lines)


@pytest.mark.few(9)
@pytest.mark.every("pair")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("kind", [1, 2, 3])
def test_tangents_of_lattice_codes(drawn, fabricate, camera, kind, pipeline):
    """Short fiblets: most points are next to a border."""
    per_fiblet = {1: 7, 2: 60, 3: 4}[kind]
    fiblets = fabricate([curve(n, seed=n) for n in LENGTHS], kind=kind, per_fiblet=per_fiblet)
    view = View(SIZE, camera(SIZE, height=70.0))
    picture = drawn(fiblets, view, FibletStyle(tolerance=0.0), pipeline)
    assert_tangents(picture, fiblets.lines, per_fiblet=per_fiblet)


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_points_that_coincide_have_the_direction_before_them(drawn, fabricate, camera, pipeline):
    """Segments of no length, at the start, in the middle, at the end, and a line that has no other."""
    line = curve(30)
    doubled = [np.repeat(line, count, axis=0) for count in (2, 3)]
    ends = np.concatenate([line[:1], line[:1], line, line[-1:]])
    fiblets = fabricate([*doubled, ends, np.zeros((3, 3))], kind=3, per_fiblet=12)
    picture = drawn(fiblets, View(SIZE, camera(SIZE, height=60.0)), FibletStyle(4.0, tolerance=0.0), pipeline)
    assert_tangents(picture, fiblets.lines, per_fiblet=12, share=0.98)


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_line_turns_evenly(drawn, directions, camera, pipeline):
    """From pixel to pixel along a line no tangent jumps by a whole turn, as it did with one tangent a segment."""
    fiblets, lines = directions
    view = View((600, 450), camera((600, 450), height=70.0))
    picture = drawn(fiblets, view, FibletStyle(tolerance=0.0), pipeline)
    for line, points in enumerate(lines):
        mine = picture.drawn & (picture.ids[..., 0] == line)
        place = picture.position[mine][:, 0].astype(float)
        order = np.argsort(place)
        tangents = unpacked_tangent(picture.ids[mine][:, 1])[order]
        jump = np.linalg.norm(np.diff(tangents, axis=0), axis=1)
        steps = np.diff(place[order])
        ends = tangents_at_ends(points)
        rate = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
        assert (jump <= rate * steps * 1.05 + 2e-3).all()


def test_the_first_tangent_of_a_fiblet_is_half_a_turn_from_the_mean_at_most(directions):
    """What is approximated: at borders between fiblets, one side stands for both."""
    _, lines = directions
    for line in lines:
        along = unit(np.diff(line, axis=0))
        for k in range(60, len(line) - 1, 60):
            mean = unit(along[k - 1] + along[k])
            shown = tangents_at_ends(line)[k][0]
            turn = np.arccos(np.clip(along[k - 1] @ along[k], -1, 1))
            assert np.arccos(np.clip(mean @ shown, -1, 1)) <= turn / 2 + 1e-6


@pytest.mark.parametrize("pipeline", ["compute", "geometry", "tessellation"])
def test_far_fiblets_turn_evenly_from_one_to_the_next(drawn, fabricate, camera, pipeline):
    """Each is one segment: tangents between those are the means of neighbours, too."""
    t = np.linspace(0.0, 6.0, 600)
    fiblets = fabricate([np.c_[30 * np.cos(t), 10 * np.sin(2 * t), 30 * np.sin(t)]], kind=2, per_fiblet=20)
    view = View(SIZE, camera(SIZE))
    picture = drawn(fiblets, view, FibletStyle(tolerance=2.0), pipeline)
    place = picture.position[picture.drawn][:, 0].astype(float)
    chords = fiblets.lines[0][[*range(0, 600, 20), 599]]
    expected = tangents_at([chords], np.zeros(len(place), int), place / 20.0, per_fiblet=1000)
    shown = unpacked_tangent(picture.ids[picture.drawn][:, 1])
    # the last one ends at its rounded end vector
    assert (np.linalg.norm(shown - expected, axis=1) < 1e-2).mean() > 0.95


# Wide lines and tubes


@pytest.mark.few(8)
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("slope", [-0.7, 0.0, 0.7])
def test_wide_lines_show_the_place_beside_each_pixel(drawn, fabricate, camera, slope, pipeline):
    """Towards the viewer, away, and across: not the round end of another segment that lies nearer."""
    t = np.linspace(0.0, 2.5, 130)
    line = np.c_[30 * np.cos(t), slope * 40 * t, 30 * np.sin(t) - 15]
    fiblets = fabricate([line - line.mean(0)], kind=3)
    view = View(SIZE, camera(SIZE, height=60.0))
    picture = drawn(fiblets, view, FibletStyle(16.0, tolerance=0.0), pipeline)
    window = to_window(to_clip(fiblets.lines[0], view.model_view_projection), SIZE)[:, :2]
    nearest, place = feet(window, SIZE)
    assert (picture.drawn == (nearest < 8.0))[np.abs(nearest - 8.0) > 0.02].all()
    error = np.abs(picture.position[..., 0] - place)[picture.drawn]
    assert (error < 0.05).mean() > 0.98  # inside a bend pixels lie beside several segments, and show the nearest


@pytest.mark.parametrize("pipeline", ["compute", "geometry", "tessellation"])
def test_tubes_have_no_rings(gl, fabricate, camera, monkeypatch, pipeline):
    """Normals are those of the capsules, turned to be perpendicular to the line's tangent, but for its ends."""
    from pvfiblets.engine.fiblets.pipelines import compute

    monkeypatch.setattr(compute, "TUBES_BY_RASTER", False)
    size = (64, 48)
    fiblets = fabricate([curve(14, step=6.0, turn=0.5)], kind=3, per_fiblet=5)
    matrix = camera(size, height=70.0)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=None)
    target = renderer.render(View(size, matrix), FibletStyle(radius=3.0, tolerance=0.0, across=True))
    normals = unpacked_tangent(np.frombuffer(target.across.read(), "<u4").reshape(size[::-1]))
    picture = read(target)
    renderer.release()
    flat = entries(fiblets.lines, 3.0, matrix, size)
    expected = smoothed(flat, fiblets.lines, per_fiblet=5)
    hit = picture.drawn & np.isfinite(expected.depth)
    error = np.linalg.norm(normals - expected.normal, axis=-1)[hit]
    assert hit.sum() > 150
    assert (hit & expected.side).sum() > 100
    assert (hit & ~expected.side).sum() > 5
    assert (error < 5e-3).mean() > 0.98
    assert np.linalg.norm(expected.normal - flat.normal, axis=-1)[hit].max() > 0.05
