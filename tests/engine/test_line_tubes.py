"""Tubes are exact bodies, in every pipeline and view; wide lines say where across them a pixel lies."""

import numpy as np
import pytest

from pvfiblets import Streamlines, compress, regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.pipelines import CONSTANTS, compute
from pvfiblets.engine.gbuffer import GBuffer
from pvfiblets.engine.gl.shaders import assemble

from .emulated import emulated_renderer
from .line_tubes import entries, smoothed
from .pictures import SIZE, assert_same, draw, near, read, unpacked_tangent
from .polylines import feet, to_clip, to_window
from .shader_programs import preprocessed

PIPELINES = ["compute", "geometry", "tessellation"]
SMALL = (160, 120)
TINY = (64, 48)
"""Of so few pixels that the compute pipeline draws any tube under software OpenGL within the loops it is given."""

VIEWS = {
    "perspective": {},
    "parallel": {"height": 130.0},
    "close": {"eye": (0, -60, 10), "near": 1.0, "far": 300.0},
    "from inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
    "cut by near and far": {"eye": (0, -60, 10), "near": 55.0, "far": 70.0},
}
CLOSER = {"perspective": {"angle": 14.0}, "parallel": {"height": 50.0}, "close": {}}
SLAB = [(0.2, 1, -0.1, 4), (0, -1, 0.3, 9), (1.0, 0, 0, 20)]


@pytest.fixture
def really(monkeypatch):
    """Have the compute pipeline draw tubes itself, which it leaves to another one under software OpenGL."""
    monkeypatch.setattr(compute, "TUBES_BY_RASTER", False)


@pytest.fixture(scope="module")
def knots(fabricate):
    """Six tangled lines with long segments, sharp bends, and a single point."""
    rng = np.random.default_rng(0)
    lines = [np.cumsum(rng.normal(0, 6, (14, 3)), axis=0) for _ in range(6)]
    return fabricate([*(line - line.mean(0) for line in lines), np.array([[12.0, -20.0, 15.0]])], kind=3)


@pytest.fixture(scope="module")
def few(fabricate):
    """Six lines of three segments around the origin."""
    rng = np.random.default_rng(7)
    return fabricate([np.cumsum(rng.normal(0, 9, (4, 3)), axis=0) - 5.0 for _ in range(6)], kind=3)


@pytest.fixture(scope="module")
def known():
    """Return :func:`entries`, kept by a key: it takes longer than all pipelines together."""
    kept = {}

    def find(key, *arguments):
        if key not in kept:
            kept[key] = smoothed(entries(*arguments), arguments[0])
        return kept[key]

    return find


def pictured(gl, fiblets, view, style, **options):
    """Return a picture, and what its texture `across` holds."""
    renderer = FibletRenderer(gl, fiblets, **options)
    try:
        target = renderer.render(view, style)
        relief = target.across.read()
        w, h = view.size
        return read(target), np.frombuffer(relief, "<u4" if style.radius else "<f2").reshape(h, w)
    finally:
        renderer.release()


@pytest.mark.few(1)
@pytest.mark.every("pair")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("radius", [2.5, 6.0])
@pytest.mark.parametrize("name", VIEWS)
def test_every_pixel_shows_where_its_ray_enters(gl, knots, known, really, camera, name, radius, pipeline):
    """Depth, streamline, place and normal against rays and capsules in float64."""
    view = View(TINY, camera(TINY, **VIEWS[name]))
    style = FibletStyle(radius=radius, tolerance=0.0, across=True)
    picture, packed = pictured(gl, knots, view, style, pipeline=pipeline)
    expected = known(("every", name, radius), knots.lines, radius, view.model_view_projection, TINY)
    hit = np.isfinite(expected.depth)
    assert hit.sum() > 60
    both = hit & picture.drawn
    # half a pixel's brush around the axis may add to the thinner parts; the rays of silhouettes may round either way
    extra = picture.drawn & ~hit
    assert (hit & ~picture.drawn).sum() <= 2
    assert near(hit)[extra].all()
    assert extra.sum() <= 0.06 * hit.sum()
    error = np.abs(picture.window_depth - expected.depth)
    assert (error[both] <= 1e-5).mean() > 0.998
    agreed = both & (error <= 2e-5)
    assert agreed.sum() >= both.sum() - 2
    same = agreed & (picture.ids[..., 0] == expected.line)
    assert same.sum() >= agreed.sum() - 2
    placed = np.abs(picture.position[..., 0] - expected.place) < 1e-3
    assert placed[same].mean() > 0.998  # where two segments meet either may be nearer by a digit
    same &= placed
    normals = np.linalg.norm(unpacked_tangent(packed) - expected.normal, axis=-1)[same]
    steep = expected.margin[same] > 0.02  # at a silhouette the place on the tube is a root's root
    assert (normals[steep] < 1e-3).mean() > 0.998  # at joints the other segment may be the nearer one
    assert (normals < 0.1).all()


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["perspective", "parallel", "close"])
def test_planes_cut_tubes_as_solids(gl, few, known, really, camera, name):
    """A cut is closed by a flat disc with the plane's normal, and nothing of a tube shows beyond a plane."""
    matrix = camera(TINY, **{**VIEWS[name], **CLOSER[name]})
    pictures = {}
    for pipeline in PIPELINES:
        style = FibletStyle(radius=5.0, tolerance=0.0, across=True)
        pictures[pipeline], packed = pictured(gl, few, View(TINY, matrix, SLAB), style, pipeline=pipeline)
        expected = known(("planes", name), few.lines, 5.0, matrix, TINY, SLAB)
        hit = np.isfinite(expected.depth)
        assert (hit ^ pictures[pipeline].drawn).sum() <= 0.01 * hit.sum()
        both = hit & pictures[pipeline].drawn
        error = np.abs(pictures[pipeline].window_depth - expected.depth)[both]
        assert (error < 1e-5).mean() > 0.998
        normals = np.linalg.norm(unpacked_tangent(packed) - expected.normal, axis=-1)[both]
        assert (normals < 1e-2).mean() > 0.98
        planes = np.array(SLAB)[:, :3] / np.linalg.norm(np.array(SLAB)[:, :3], axis=1)[:, None]
        faces = (np.abs(expected.normal[both][:, None] + planes).max(-1) < 1e-9).any(-1)
        assert faces.sum() > 10
        assert (normals[faces] < 1e-3).mean() > 0.97


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("culling", ["two-phase", "coverage"])
def test_culling_loses_no_pixel(gl, really, fabricate, random_lines, camera, culling, pipeline):
    """A turning camera, and one inside: the pictures are those without culling."""
    fiblets = fabricate(random_lines(250, seed=2), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=culling)
    eyes = [(0, -160, 20), (10, -158, 20), (10, -158, 20), (120, 20, 0), (5, 5, 5)]
    for radius, tolerance in ((0.4, 0.0), (1.5, 0.5)):
        for k, eye in enumerate(eyes):
            view = View(TINY, camera(TINY, eye=eye, target=(0, 0, 0) if k < 4 else (30, 0, 0), near=8.0))
            style = FibletStyle(radius=radius, tolerance=tolerance)
            whole = draw(gl, fiblets, view, style, pipeline=pipeline, culling=None)
            target = renderer.render(view, style)
            if culling == "coverage":  # may lose some for a picture; of the same view none
                renderer._made = None
                target = renderer.render(view, style)
            assert_same(read(target), whole)
    renderer.release()


@pytest.mark.more
def test_culling_hides_what_tubes_hide(gl, really, fabricate, camera):
    """Behind a wall of thick tubes nothing is drawn in the second picture."""
    wall = [np.array([[x, 0.0, -60.0], [x, 0.0, 60.0]]) for x in np.arange(-60.0, 61.0, 2.0)]
    behind = [np.array([[x, 60.0, -20.0], [x, 60.0, 20.0]]) for x in np.arange(-20.0, 21.0, 1.0)]
    fiblets = fabricate([*wall, *behind], kind=3)
    renderer = FibletRenderer(gl, fiblets, pipeline="compute", culling="two-phase")
    counts = []
    for k in range(2):
        renderer.render(View(SMALL, camera(SMALL, eye=(k, -160, 0))), FibletStyle(radius=1.5))
        counts.append(renderer.explain()["fiblets"])
    renderer.release()
    assert counts[1]["drawn"] <= len(wall) + 2
    assert counts[1]["in_frustum"] == len(wall) + len(behind)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_far_tubes_are_lines_and_never_vanish(gl, really, fabricate, camera, tolerance, pipeline):
    """A tube of a hundredth of a pixel is the wide line of one pixel: unbroken, with the axis' depth."""
    rng = np.random.default_rng(4)
    line = np.cumsum(rng.normal(0, 1, (40, 3)) * [9, 1, 6], axis=0)
    fiblets = fabricate([line - line.mean(0)], kind=3)
    matrix = camera(SIZE)
    drawn = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(radius=0.005, tolerance=tolerance), pipeline=pipeline)
    nearest = feet(to_window(to_clip(fiblets.lines[0], matrix), SIZE)[:, :2], SIZE)[0]
    assert drawn.drawn[nearest < 0.49].all()
    assert not drawn.drawn[nearest > 0.52].any()
    for eye in (-400.0, -2000.0, -8000.0):
        view = View(SIZE, camera(SIZE, eye=(0, eye, 0), far=9000.0))
        shown = draw(gl, fiblets, view, FibletStyle(radius=0.3, tolerance=tolerance), pipeline=pipeline).drawn
        thin = draw(gl, fiblets, view, FibletStyle(tolerance=tolerance), pipeline=pipeline).drawn
        assert near(shown)[thin].all()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_camera_inside_a_tube_looks_through(gl, really, fabricate, camera, pipeline):
    """The tube that it is in is open: what lies beyond shows, and nothing is not a number."""
    fiblets = fabricate([np.array([[-50.0, 0, 0], [50.0, 0, 0]]), np.array([[0.0, 30, -40], [0.0, 30, 40]])], kind=3)
    for eye, target in (((0.5, 0.2, 0.1), (0, 30, 0)), ((0.0, 0, 0), (40, 1, 0)), ((-50.0, 0, 0), (0, 0, 0))):
        view = View(TINY, camera(TINY, eye=eye, target=target, near=0.01, far=300.0, angle=70.0))
        picture, packed = pictured(gl, fiblets, view, FibletStyle(radius=2.0, across=True), pipeline=pipeline)
        expected = entries(fiblets.lines, 2.0, view.model_view_projection, TINY)
        hit = np.isfinite(expected.depth)
        assert (hit ^ picture.drawn).sum() <= 2
        assert np.isfinite(unpacked_tangent(packed)[picture.drawn]).all()
        assert not (picture.ids[..., 0][picture.drawn] == 0).any()


@pytest.mark.few(1)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_any_scale_and_far_from_the_origin(gl, really, fabricate, camera, scale):
    """Tubes of nanometres and of kilometres, a million millimetres away: as exact as at the origin."""
    rng = np.random.default_rng(3)
    line = np.cumsum(rng.normal(0, 6, (12, 3)), axis=0)
    fiblets = fabricate([scale * (line - line.mean(0)) + 1e6], kind=3, low=True)
    place = np.eye(4)
    place[:3, :3] /= scale
    place[:3, 3] = -1e6 / scale
    matrix = camera(SMALL) @ place
    radius = 4.0 * scale
    picture = draw(gl, fiblets, View(SMALL, matrix), FibletStyle(radius=radius, tolerance=0.0))
    moved = camera(SMALL)
    expected = entries([(fiblets.lines[0] - 1e6) / scale], 4.0, moved, SMALL)
    hit = np.isfinite(expected.depth)
    if scale < 1.0:  # anchors of 32 bits are finer, but float64 itself has no nanometres a kilometre from the origin
        assert (hit ^ picture.drawn).mean() < 0.01
        return
    assert (hit ^ picture.drawn).sum() <= 0.01 * hit.sum()
    both = hit & picture.drawn
    assert (np.abs(picture.window_depth - expected.depth)[both] < 2e-5).mean() > 0.99


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("width", [2.0, 9.0])
def test_where_across_a_wide_line(gl, fabricate, camera, width, pipeline):
    """Signed distance from the axis over half the width, positive to the left of the tangent on the screen."""
    rng = np.random.default_rng(5)
    ends = rng.uniform(-45, 45, (12, 2, 3)) * [1, 0.1, 1]
    for line in ends:
        fiblets = fabricate([line], kind=3)
        view = View(SMALL, camera(SMALL))
        picture, across = pictured(gl, fiblets, view, FibletStyle(width, tolerance=0.0, across=True), pipeline=pipeline)
        a, b = to_window(to_clip(fiblets.lines[0], view.model_view_projection), SMALL)[:, :2]
        y, x = np.mgrid[: SMALL[1], : SMALL[0]] + 0.5
        run = (b - a) / np.linalg.norm(b - a)
        left = (-(x - a[0]) * run[1] + (y - a[1]) * run[0]) / (width / 2)
        assert np.abs(across[picture.drawn].astype(float) - left[picture.drawn]).max() < 2e-3


def test_a_picture_pays_only_for_what_it_shows(gl, knots, camera):
    """No texture, block, feature or line of a shader without tubes and places across."""
    renderer = FibletRenderer(gl, knots)
    view = View(SMALL, camera(SMALL))

    def state(style):
        target = renderer.render(view, style)
        explained = renderer.explain(counts=False)
        sizes = {buffer["name"]: buffer["bytes"] for buffer in explained["buffers"]}
        return target, set(explained["features"]) & {"TUBES", "CROSS_LINE", "WIDE_LINES"}, sizes

    pixels = SMALL[0] * SMALL[1]
    for style, features, nbytes in (
        (FibletStyle(), set(), 24),
        (FibletStyle(across=True), set(), 24),
        (FibletStyle(3.0), {"WIDE_LINES"}, 24),
        (FibletStyle(3.0, across=True), {"WIDE_LINES", "CROSS_LINE"}, 26),
        (FibletStyle(radius=1.0), {"WIDE_LINES", "TUBES"}, 24),
        (FibletStyle(radius=1.0, across=True), {"WIDE_LINES", "TUBES", "CROSS_LINE"}, 28),
        (FibletStyle(), set(), 24),
    ):
        target, found, sizes = state(style)
        assert found == features
        assert sizes["gbuffer"] == nbytes * pixels
        assert ("tubes" in sizes) == (style.radius is not None)
        assert (target.across is not None) == (style.relief is not None)
    renderer.release()
    for name in (
        "fiblets/compute/cull.comp",
        "fiblets/compute/depth.comp",
        "fiblets/compute/resolve_owner.comp",
        "fiblets/hardware_raster/capsule.frag",
        "fiblets/hardware_raster/survivors.vert",
    ):
        for features in (set(), {"WIDE_LINES", "CLIPPING", "CLIPPING_DEPTH"}):
            left = "\n".join(preprocessed(assemble(name, features, CONSTANTS), features))
            assert "tube" not in left.lower()
            assert "across_" not in left.replace("store_across", "")


TUBES = ["WIDE_LINES", "TUBES"]


@pytest.mark.few(1)
@pytest.mark.parametrize("serial", [False, True], ids=["together", "serial"])
@pytest.mark.parametrize("planes", [[], SLAB], ids=["whole", "cut"])
@pytest.mark.parametrize("name", ["perspective", "close"])
def test_mesh_stages_draw_the_same_tubes(gl, monkeypatch, knots, camera, name, planes, serial):
    """Run as compute shaders, where there are no mesh shaders."""
    view, style = View(SMALL, camera(SMALL, **VIEWS[name]), planes), FibletStyle(radius=3.0, tolerance=0.0, across=True)
    expected, normals = pictured(gl, knots, view, style, pipeline="geometry", culling=None)
    renderer = emulated_renderer(monkeypatch, gl, knots, serial=serial, culling=None)
    target = renderer.render(view, style)
    picture, packed = read(target), np.frombuffer(target.across.read(), "<u4").reshape(expected.depth.shape)
    renderer.release()
    both = picture.drawn & expected.drawn
    assert (picture.drawn ^ expected.drawn).sum() <= 2
    assert (np.abs(picture.window_depth - expected.window_depth)[both] < 1e-5).mean() > 0.999
    assert (np.linalg.norm(unpacked_tangent(packed) - unpacked_tangent(normals), axis=-1)[both] < 1e-2).mean() > 0.99


def test_tubes_hand_over_no_more_than_wide_lines():
    """So that the geometry and mesh stages' shares hold for them."""
    from pvfiblets.engine.gl.shaders import read_shader

    def components(features):
        sizes = {"float": 1, "uint": 1, "vec2": 2, "uvec2": 2, "vec3": 3, "vec4": 4, "uvec4": 4}
        lines = preprocessed(read_shader("fiblets/hardware_raster/varyings.glsl"), features)
        return sum(sizes[line.split()[1]] for line in lines if line.startswith("VARYING "))

    for more in ([], ["CLIPPING"], ["CLIPPING", "CLIP_PLANES"]):
        for values in ([], ["VALUES_ARC_LENGTH"]):
            assert components([*TUBES, *more, *values]) <= components(["WIDE_LINES", *more, *values])


def test_software_opengl_draws_the_largest_tubes_whole(gl, fabricate, camera):
    """A tube as wide as the picture takes more pixels than a loop of software OpenGL goes round."""
    fiblets = fabricate([np.array([[-30.0, 0, 0], [30.0, 0, 0.5]])], kind=3)
    for more in ({"eye": (0, -60, 0), "near": 1.0}, {"height": 30.0}):
        view = View(SIZE, camera(SIZE, **more))
        picture = draw(gl, fiblets, view, FibletStyle(radius=18.0))
        expected = entries(fiblets.lines, 18.0, view.model_view_projection, SIZE)
        assert np.isfinite(expected.depth).sum() > 40_000
        assert (np.isfinite(expected.depth) ^ picture.drawn).sum() <= 2


@pytest.mark.more
def test_what_software_opengl_draws_otherwise(gl, fabricate, random_lines, camera):
    """Lines, tubes with values, lines again: pictures and counts are those of renderers of their own."""
    fiblets = fabricate(random_lines(60, seed=5), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline="compute", culling="two-phase")
    view = View(SIZE, camera(SIZE))
    styles = FibletStyle(radius=2.0, values="arc_length"), FibletStyle(radius=1.0, values="arc_length")
    for style in (FibletStyle(), *styles, FibletStyle(3.0)):
        picture = read(renderer.render(view, style))
        pipeline = "compute" if style.radius is None else "geometry"
        assert_same(picture, draw(gl, fiblets, view, style, pipeline=pipeline))
        counts = renderer.explain()["fiblets"]
        assert counts["visible"] == len(np.unique(picture.owner[picture.drawn]))
        assert (counts["drawn"] is None) == (style.radius is not None)
    renderer.release()
    renderer.release()


@pytest.mark.parametrize("radius", [0.0, -1.0, np.nan, np.inf])
def test_a_bad_radius_is_reported(radius):
    with pytest.raises(ValueError, match="give a finite number of millimetres above 0"):
        FibletStyle(radius=radius)


@pytest.mark.more
def test_matrices_without_depth_draw_nothing_and_no_nan(gl, really, knots):
    for matrix in (np.zeros((4, 4)), np.diag([0.01, 0.01, 0.0, 1.0]), np.diag([0.01, 0.0, 0.01, 1.0])):
        for pipeline in PIPELINES:
            picture = draw(gl, knots, View((32, 24), matrix), FibletStyle(radius=2.0), pipeline=pipeline)
            assert np.isfinite(picture.position[picture.drawn]).all()


def test_the_texture_is_made_and_given_back(gl):
    target = GBuffer(gl, (8, 4))
    for relief, nbytes in (("across", 26), ("normal", 28), (None, 24), ("across", 26)):
        target.want_relief(gl, relief)
        held = target.across
        target.want_relief(gl, relief)
        assert target.across is held
        assert target.nbytes == 32 * nbytes
    target.release()
    target.release()
    assert target.across is None


@pytest.mark.parametrize("pipeline", ["geometry", "compute"])
def test_a_region_keeps_the_side_of_a_tube_whose_axis_lies_outside(gl, camera, pipeline):
    """The axis lies half a millimetre outside of a box, the surface reaches 1.5 mm into it."""
    x = np.linspace(-20.0, 20.0, 200)
    fiblets = compress(Streamlines.from_list([np.c_[x, np.zeros_like(x), np.zeros_like(x)]]))
    size, box = (200, 150), regions.Box((-50.0, 50.0, 0.5, 60.0, -50.0, 50.0))
    matrix = camera(size, eye=(0, -20, 80), target=(0, 0, 0), near=10.0, far=200.0)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=None)
    pictures = [read(renderer.render(View(size, matrix, region=cut), FibletStyle(radius=2.0))) for cut in (None, box)]
    renderer.release()
    whole, kept = pictures
    rows, columns = np.nonzero(whole.drawn)
    window = np.c_[(columns + 0.5) / size[0], (rows + 0.5) / size[1], whole.window_depth[whole.drawn]]
    places = np.c_[2.0 * window - 1.0, np.ones(len(rows))] @ np.linalg.inv(matrix).T
    y = places[:, 1] / places[:, 3]
    sure = np.abs(y - 0.5) > 0.02
    assert (y[sure] > 0.5).sum() > 200
    np.testing.assert_array_equal(kept.drawn[whole.drawn][sure], y[sure] > 0.5)
    assert not kept.drawn[~whole.drawn].any()
