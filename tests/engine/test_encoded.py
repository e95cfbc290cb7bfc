"""Sets made by the codec: what is drawn is what `decompress` gives, on made-up brains and on real tracking."""

import numpy as np
import pytest

from pvfiblets import Streamlines, compress, read
from pvfiblets.codec import layout
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.synthetic import brain_streamlines

from .gl_lines import gl_lines
from .pictures import EMPTY, draw, near
from .polylines import assert_pixels_name_places
from .tangents import borders_of

SIZE = (640, 480)


def fitted(camera, bounds):
    """A view of all of it."""
    box = np.reshape(bounds, (3, 2))
    middle, radius = box.mean(1), np.linalg.norm(np.diff(box, axis=1)) / 2
    eye = middle + [0, -3.9 * radius, 0]
    return camera(SIZE, eye=eye, target=middle, near=2.8 * radius, far=5.0 * radius, angle=30.0)


def assert_drawn_as_decompressed(gl, camera, fiblets, **limits):
    """Every point, against the decoded points; and as views show it by default, against that picture."""
    decoded = fiblets.decompress()
    lines = decoded.to_list()
    matrix = fitted(camera, fiblets.bounds)
    picture = draw(gl, fiblets, View(SIZE, matrix), **limits)
    assert picture.drawn.sum() > 500
    mask, _ = gl_lines(gl, [line for line in lines if len(line) > 1], matrix, SIZE)
    assert near(mask)[picture.drawn].mean() >= 0.99
    assert near(picture.drawn)[mask].mean() >= 0.99
    # fiblets of streamlines in their order; those of no point have none
    borders = dict(zip(np.flatnonzero([len(line) for line in lines]), borders_of(fiblets), strict=True))
    assert_pixels_name_places(picture, [line.astype(float) for line in lines], matrix, SIZE, per_fiblet=borders)
    far = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(), **limits)
    assert near(picture.drawn)[far.drawn].mean() >= 0.99
    assert near(far.drawn)[picture.drawn].mean() >= 0.99


@pytest.mark.more
@pytest.mark.parametrize(("effort", "kind"), [("fast", layout.DIRECTION), ("small", layout.SPLINE)])
def test_a_made_up_brain(gl, camera, effort, kind):
    fiblets = compress(brain_streamlines(1500, step=0.5), exact=False, effort=effort)
    assert (layout.coded_kind(fiblets.decoding) == kind).mean() > 0.3
    assert_drawn_as_decompressed(gl, camera, fiblets)


def test_steps_that_vary(gl, camera):
    rng = np.random.default_rng(0)
    lines = []
    for _ in range(300):
        n = int(rng.integers(1, 120))
        steps = rng.normal(0, 1, (n, 3)) * rng.uniform(0, 4, (n, 1)) + rng.normal(0, 1, 3)
        lines.append(rng.uniform(-40, 40, 3) + np.cumsum(steps, axis=0))
    fiblets = compress(Streamlines.from_list(lines))
    assert layout.unpack("kind", fiblets.decoding).max() > 0
    assert_drawn_as_decompressed(gl, camera, fiblets)


def test_a_tight_promise(gl, camera):
    brain = brain_streamlines(100, step=0.5)
    fiblets = compress(Streamlines(brain.points.astype(float) + 1e5, brain.offsets), max_error=1e-5)
    assert fiblets.anchors_low is not None
    assert_drawn_as_decompressed(gl, camera, fiblets)


def test_gpu_bytes_per_point(gl):
    """Full fiblets cost at most 1.4 bytes per point on the GPU, counters and all (tables and pictures do not grow)."""
    line = np.stack([np.linspace(0, 600, 1201), np.zeros(1201), np.zeros(1201)], axis=1)[:1200]
    lines = [line + [0, 0.1 * i, 0.05 * i] for i in range(500)]
    fiblets = compress(Streamlines.from_list(lines))
    renderer = FibletRenderer(gl, fiblets)
    buffers = {b["name"]: b["bytes"] for b in renderer.explain()["buffers"]}
    renderer.release()
    assert (sum(buffers.values()) - buffers["rotations"]) / fiblets.n_points <= 1.4


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "name",
    ["dipy_hist_tractogram.trk", "nv_stroke.trk.gz", "gen_fibercup_det_0.25mm.tck", "vtk_Coastlines_Los_Alamos.vtp"],
)
def test_real_files(gl, camera, shared_data, name):
    if name.endswith("vtp"):
        pytest.importorskip("vtkmodules")
    assert_drawn_as_decompressed(gl, camera, compress(read(shared_data / name)))


def test_nothing_to_draw(gl, camera):
    fiblets = compress(Streamlines.from_list([]))
    renderer = FibletRenderer(gl, fiblets)
    for style in (FibletStyle(), FibletStyle(3.0, values="arc_length"), FibletStyle(1.0, values="curvature")):
        gbuffer = renderer.render(View(SIZE, camera(SIZE)), style)
        assert (np.frombuffer(gbuffer.depth.read(), "<u4") == EMPTY).all()
    assert renderer.value_range("curvature") == (0.0, 0.0)
    assert renderer.explain()["fiblets_total"] == 0
    renderer.release()


def test_streamlines_without_points(gl, camera):
    empty = np.zeros((0, 3))
    fiblets = compress(Streamlines.from_list([empty, np.array([[0.0, 0, 0], [30.0, 0, 0]]), empty, np.zeros((1, 3))]))
    renderer = FibletRenderer(gl, fiblets)
    gbuffer = renderer.render(View(SIZE, camera(SIZE)))
    drawn = np.frombuffer(gbuffer.depth.read(), "<u4") != EMPTY
    assert set(np.frombuffer(gbuffer.ids.read(), "<u4")[::2][drawn]) <= {1, 3}
    assert drawn.sum() > 20
    renderer.release()


@pytest.mark.more
def test_a_camera_on_a_point_looking_along_a_line(gl, camera):
    """Points in the centre of projection and in the plane through it (w = 0) neither stop nor spoil a picture."""
    line = np.stack([np.linspace(-50, 50, 101), np.zeros(101), np.zeros(101)], axis=1)
    across = line[:, [1, 0, 2]] + [30.0, 0.0, 0.0]
    fiblets = compress(Streamlines.from_list([line, across, line[::-1] * 0.5]), max_error=1e-3)
    renderer = FibletRenderer(gl, fiblets)
    for near_plane in (1e-6, 0.1, 5.0):
        matrix = camera(SIZE, eye=(0, 0, 0), target=(1, 0, 0), near=near_plane, far=100.0, angle=60.0)
        for style in (FibletStyle(), FibletStyle(5.0, values="curvature")):
            gbuffer = renderer.render(View(SIZE, matrix), style)
            drawn = np.frombuffer(gbuffer.depth.read(), "<u4") != EMPTY
            position = np.frombuffer(gbuffer.position.read(), "<f4").reshape(-1, 2)[drawn]
            assert drawn.sum() > SIZE[0] / 2  # the line across fills the picture's width
            assert np.isfinite(position).all()
    renderer.release()


def test_flat_sets(gl, camera):
    """All points in a plane, on a line, at one place."""
    t = np.linspace(-30, 30, 200)
    zero = 0 * t
    sets = {
        "plane": [np.stack([t, zero, 20 * np.sin(t / 7)], axis=1)],
        "line": [np.stack([t, zero, zero], axis=1)],
        "point": [np.zeros((5, 3))],
    }
    for name, lines in sets.items():
        fiblets = compress(Streamlines.from_list(lines))
        renderer = FibletRenderer(gl, fiblets)
        gbuffer = renderer.render(View(SIZE, camera(SIZE, eye=(0, -260, 1))))
        drawn = np.frombuffer(gbuffer.depth.read(), "<u4") != EMPTY
        renderer.release()
        assert drawn.sum() == 1 if name == "point" else drawn.sum() > 100, name
