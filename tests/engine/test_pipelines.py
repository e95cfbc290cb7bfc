"""The pipelines that OpenGL's rasteriser draws for: their pictures are those of the compute pipeline."""

from dataclasses import replace
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from pvfiblets import compress, regions
from pvfiblets.codec.point_values import PointValues, linear_table
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import measures
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.pipelines.hardware_raster import RasterTarget, SeenTexture
from pvfiblets.engine.fiblets.pipelines.limits import Limits
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .likeness import assert_like
from .pictures import EMPTY, SIZE, assert_same, differences, draw, read

RASTER = ["tessellation", "geometry", *MESH]
BOX = [(1.0, 0, 0, 25), (-1.0, 0, 0, 25), (0, 1.0, 0, 25), (0, -1.0, 0, 25), (0, 0, 1.0, 25), (0, 0, -1.0, 25)]
VIEWS = {
    "perspective": {},
    "parallel": {"height": 150.0},
    "from inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
    "cut by near and far": {"eye": (0, -60, 10), "near": 55.0, "far": 70.0},
    "far": {"eye": (0, -900, 10), "far": 2000.0},
}
STYLES = {
    "every point": FibletStyle(tolerance=0.0),
    "far detail": FibletStyle(tolerance=0.5),
    "3 pixels": FibletStyle(3.0),
    "12 pixels": FibletStyle(12.0),
}


def compared(gl, fiblets, view, style, pipeline, **options):
    reference = draw(gl, fiblets, view, style, pipeline="compute", culling=None)
    picture = draw(gl, fiblets, view, style, pipeline=pipeline, culling=None, **options)
    assert_like(picture, reference)
    return picture


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("name", VIEWS)
def test_pictures_are_those_of_compute(gl, fabricate, random_lines, camera, name, pipeline):
    fiblets = fabricate(random_lines(80, seed=3), kind=2)
    view = View(SIZE, camera(SIZE, **VIEWS[name]))
    for style in STYLES.values():
        compared(gl, fiblets, view, style, pipeline)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
@pytest.mark.parametrize("low", [False, True])
def test_lattice_kinds_and_fine_anchors(gl, fabricate, random_lines, camera, kind, low, pipeline):
    ids = np.arange(40) * 3 + 5
    fiblets = fabricate(random_lines(40, seed=kind), kind=kind, low=low, rank_to_id=ids, per_fiblet=7 * kind)
    picture = compared(gl, fiblets, View(SIZE, camera(SIZE)), FibletStyle(), pipeline)
    assert set(picture.ids[picture.drawn][:, 0].tolist()) <= set(ids.tolist())


@pytest.mark.more
@pytest.mark.parametrize("pipeline", RASTER)
def test_a_made_up_brain(gl, camera, pipeline):
    """Direction codes, and more of them than Mesa's evaluation stage can number in one call."""
    fiblets = compress(brain_streamlines(600, step=0.5, seed=4))
    assert fiblets.n_points > 1 << 16
    size = (640, 480)
    for eye in ((0, -260, 60), (150, 150, 30)):
        for style in (FibletStyle(), FibletStyle(tolerance=0.0), FibletStyle(3.0)):
            compared(gl, fiblets, View(size, camera(size, eye=eye)), style, pipeline)


@pytest.mark.parametrize("pipeline", ["tessellation", "geometry"])
@pytest.mark.parametrize(
    "style",
    [FibletStyle(), FibletStyle(3.0, across=True, edges=True), FibletStyle(radius=0.4, across=True, edges=True)],
    ids=["thin", "wide", "tubes"],
)
def test_pixels_show_what_compute_finds(gl, camera, style, pipeline):
    """To the bit, edges and places across the line included: they are found once a pixel, as there."""
    fiblets, view = compress(brain_streamlines(150, step=0.5, seed=4)), View(SIZE, camera(SIZE))
    found = []
    for name in (pipeline, "compute"):
        renderer = FibletRenderer(gl, fiblets, pipeline=name)
        buffer = renderer.render(view, replace(style, values="arc_length"))
        picture = read(buffer)
        more = [texture for texture in (buffer.across, buffer.edges) if texture is not None]
        words = [np.frombuffer(texture.read(), f"u{texture.dtype[1]}") for texture in more]
        found.append((picture, [word.reshape(SIZE[::-1])[picture.drawn] for word in words]))
        renderer.release()
    (picture, words), (expected, their_words) = found
    assert set(differences(picture, expected)) <= {"position"}
    places, values = np.moveaxis(picture.position[picture.drawn] - expected.position[picture.drawn], -1, 0)
    assert not places.any()
    assert np.abs(values).max() < 1e-4, "mm; compilers sum lengths in orders of their own"
    assert len(words) == (0 if style == FibletStyle() else 2)
    for ours, theirs in zip(words, their_words, strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.more
@pytest.mark.parametrize("seed", range(4))
def test_chosen_at_random(gl, camera, seed):
    """Views, brushes, planes, regions, filters and values together, ten scenes a seed."""
    rng = np.random.default_rng(seed)
    lines = brain_streamlines(200, step=float(rng.choice([0.5, 2.0])), seed=seed)
    fiblets = compress(lines, effort=("fast", "small")[seed % 2])
    brushes = [{}, {"line_width": 3.0}, {"radius": 0.3}, {"radius": 1.5}, {"line_width": 6.0, "ends": True}]
    cuts = [None, regions.Sphere((0, 0, 0), 40), regions.Box([-30, 30, -50, 20, -40, 40])]
    for _ in range(10):
        eye = [(0, -260, 60), (150, 150, 30), (20, -30, 10)][rng.integers(3)]
        planes, region = [(0.2, 1, -0.1, 0)][: rng.integers(2)], cuts[rng.integers(3)]
        view = View(SIZE, camera(SIZE, eye=eye, near=1.0), planes, region=region)
        values = [None, "arc_length"][rng.integers(2)]
        style = FibletStyle(tolerance=float(rng.integers(2)) / 2, values=values, **brushes[rng.integers(5)])
        words = np.bitwise_or.reduce(rng.integers(0, 1 << 32, (4, fiblets.n_points // 32 + 1), np.uint32))
        shown = rng.random(fiblets.n_streamlines) < 0.5
        filtering = [None, Filter(points=words), Filter(streamlines=shown)][rng.integers(3)]
        pictures = []
        for name in ("compute", "tessellation", "geometry"):
            renderer = FibletRenderer(gl, fiblets, pipeline=name, culling=["two-phase", None][rng.integers(2)])
            renderer.filtering = filtering
            pictures.append(read(renderer.render(view, style)))
            renderer.release()
        for picture in pictures[1:]:
            if picture.drawn.any() or pictures[0].drawn.any():
                assert_like(picture, pictures[0])


def test_wide_lines_join_alike_where_points_are_hidden(gl, camera):
    """Of compute, fiblets with all their points have a program that knows no mask: joints are the same."""
    fiblets, view = compress(brain_streamlines(300, step=0.5, seed=4)), View(SIZE, camera(SIZE))
    words = np.random.default_rng(0).integers(0, 1 << 32, (4, fiblets.n_points // 32 + 1), np.uint32)
    pictures = []
    for name in ("compute", "geometry"):
        renderer = FibletRenderer(gl, fiblets, pipeline=name)
        renderer.filtering = Filter(points=np.bitwise_or.reduce(words))
        pictures.append(read(renderer.render(view, FibletStyle(3.0))))
        renderer.release()
    assert pictures[0].drawn.sum() > 5000
    assert_same(*pictures)


@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("width", [1.0, 5.0])
@pytest.mark.parametrize(
    "planes",
    [[(0.2, 1, -0.1, 0)], [(0, 1, 0, 1), (0, -1, 0, 1)], [(0, 1, 0, 0.05), (0, -1, 0, 0.05)], BOX],
    ids=["one", "slab", "slab within a step", "box"],
)
def test_clip_planes(gl, fabricate, random_lines, camera, planes, width, pipeline):
    fiblets = fabricate(random_lines(150, seed=3), kind=2)
    for more in ({}, {"height": 130.0}):
        compared(gl, fiblets, View(SIZE, camera(SIZE, **more), planes), FibletStyle(width), pipeline)


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("values", ["arc_length", "bytes", "words"])
def test_per_point_values(gl, fabricate, random_lines, camera, values, pipeline):
    fiblets = fabricate(random_lines(60, seed=5), kind=2, per_fiblet=20)
    rng = np.random.default_rng(1)
    for name, dtype in (("bytes", np.uint8), ("words", np.uint16)):
        codes = rng.integers(0, np.iinfo(dtype).max, fiblets.n_points, dtype, endpoint=True)
        fiblets.per_point[name] = PointValues(codes, -2.0, 3.0, 0.0, table=linear_table(-2.0, 3.0, 8 * codes.itemsize))
    views = View(SIZE, camera(SIZE)), View(SIZE, camera(SIZE, **VIEWS["far"])), View(SIZE, camera(SIZE), BOX)
    for view, width in zip((*views, views[0]), (1.0, 5.0, 1.0, 5.0), strict=True):
        compared(gl, fiblets, view, FibletStyle(width, values=values), pipeline)


@pytest.mark.parametrize("pipeline", RASTER)
def test_value_ranges(gl, fabricate, random_lines, pipeline, monkeypatch):
    """Measured by transform feedback as by compute, in several batches."""
    monkeypatch.setattr(measures, "BATCH", 500)
    fiblets = fabricate(random_lines(60, seed=5), kind=2, per_fiblet=3)
    assert fiblets.n_fiblets > 1500
    renderers = [FibletRenderer(gl, fiblets, pipeline=name) for name in ("compute", pipeline)]
    expected, found = (renderer.value_range("arc_length") for renderer in renderers)
    np.testing.assert_allclose(found, expected, rtol=1e-5)
    for renderer in renderers:
        renderer.release()


@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("width", [1.0, 2.0, 7.0])
def test_one_point_streamlines_are_dots(gl, fabricate, camera, width, pipeline):
    points = np.random.default_rng(2).uniform(-40, 40, (300, 1, 3))
    fiblets = fabricate(list(points), kind=1)
    view = View(SIZE, camera(SIZE))
    picture = compared(gl, fiblets, view, FibletStyle(width), pipeline)
    clip = np.concatenate([np.concatenate(fiblets.lines), np.ones((300, 1))], axis=1) @ view.model_view_projection.T
    cells = ((clip[:, :2] / clip[:, 3:] + 1) / 2 * SIZE).astype(int)
    assert picture.drawn[cells[:, 1], cells[:, 0]].mean() > (0.99 if width < 2 or width > 4 else 0.6)
    if width == 1.0:
        assert picture.drawn.sum() == len(np.unique(cells, axis=0))


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", RASTER)
def test_segments_longer_than_the_picture(gl, fabricate, camera, pipeline):
    rng = np.random.default_rng(8)
    fiblets = fabricate(rng.uniform(-300, 300, (60, 3, 3)), kind=3)
    for more in ({}, {"height": 60.0}, {"eye": (0, 0, 0), "target": (1, 1, 0), "near": 0.1}):
        for style in (FibletStyle(), FibletStyle(6.0)):
            compared(gl, fiblets, View(SIZE, camera(SIZE, **more)), style, pipeline)


@pytest.mark.more
@pytest.mark.parametrize("pipeline", RASTER)
def test_paging_changes_nothing(gl, fabricate, random_lines, camera, pipeline):
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2)
    view, few = View(SIZE, camera(SIZE)), {"max_buffer_bytes": 12 * (16384 + 1), "pipeline": pipeline}
    renderer = FibletRenderer(gl, fiblets, **few)
    assert len(renderer._chunks) == 3
    renderer.release()
    for style in (FibletStyle(), FibletStyle(2.5, values="arc_length"), FibletStyle(tolerance=0.0)):
        for culling in (None, "two-phase"):
            whole = draw(gl, fiblets, view, style, pipeline=pipeline, culling=culling)
            pieces = draw(gl, fiblets, view, style, culling=culling, **few)
            assert not set(differences(pieces, whole)) - {"position"}
            assert np.abs(pieces.position[whole.drawn] - whole.position[whole.drawn]).max() < 1e-3


def jumps(camera):
    """Views of a camera that turns, dollies through, is teleported, and changes range, size and projection."""
    around = [(0, -260, 60), (3, -260, 60), (225, -130, 60), (225, 130, 60), (-220, 150, 60)]
    views = [View(SIZE, camera(SIZE, eye=eye)) for eye in around]
    views += [View(SIZE, camera(SIZE, eye=(0, y, 2), target=(0, y + 10, 2), near=1.0)) for y in range(-120, 80, 40)]
    views += [View(SIZE, camera(SIZE, eye=(0, 0, 300), up=(0, 1, 0))), View(SIZE, camera(SIZE, eye=(-260, 1, 0)))]
    views += [
        View(SIZE, camera(SIZE, near=near, far=far)) for near, far in ((20, 600), (255, 600), (255, 270), (1, 9e3))
    ]
    views += [View(size, camera(size)) for size in ((150, 200), (321, 77), SIZE)]
    views += [View(SIZE, camera(SIZE, height=h)) for h in (150.0, 40.0)]
    return [*views, View(SIZE, camera(SIZE), BOX), View(SIZE, camera(SIZE), BOX[:1]), View(SIZE, camera(SIZE))]


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", RASTER)
@pytest.mark.parametrize("width", [1.0, 4.0])
def test_two_phase_culling_changes_no_bit(gl, fabricate, random_lines, camera, width, pipeline):
    """Of any jump; with every line three times over, so that there are ties in every pixel."""
    lines = random_lines(150, seed=21)
    order = np.random.default_rng(3).permutation(450) % 150
    fiblets = fabricate([lines[i] for i in order], kind=2, per_fiblet=17)
    culled, whole = (FibletRenderer(gl, fiblets, pipeline=pipeline, culling=c) for c in ("two-phase", None))
    style = FibletStyle(width)
    for number, view in enumerate(jumps(camera)):
        picture, expected = read(culled.render(view, style)), read(whole.render(view, style))
        assert not differences(picture, expected), f"picture {number}"
    assert [p["name"] for p in culled.explain()["passes"]][-6:] == [
        "clear",
        "visible",
        "pyramid",
        "draw",
        "resolve",
        "visibility_bits",
    ]
    assert [p["name"] for p in whole.explain()["passes"]] == ["clear", "draw", "resolve"]
    held = [{b["name"]: b["bytes"] for b in renderer.explain()["buffers"]} for renderer in (culled, whole)]
    pixels = SIZE[0] * SIZE[1]
    assert held[0]["depth"] == 17 * pixels
    assert held[0]["visibility_bits"] == 1024 * -(-fiblets.n_fiblets // 1024)
    assert held[1]["depth"] == 5 * pixels
    assert "visibility_bits" not in held[1]
    for renderer in (culled, whole):
        renderer.release()


@pytest.mark.parametrize("pipeline", RASTER)
def test_ties_go_to_the_first_whatever_was_seen(gl, fabricate, random_lines, camera, pipeline):
    """A copy seen from where the first of the lines is not in the picture does not win when it comes back."""
    lines = random_lines(40, seed=11)
    fiblets = fabricate([*lines, *lines], kind=2)
    n = fiblets.n_fiblets // 2
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    view = View(SIZE, camera(SIZE))
    first = read(renderer.render(view))
    assert (first.owner[first.drawn] < n).all()
    seen = renderer._pipeline._seen
    marks = np.zeros(seen.size[0] * seen.size[1], np.uint8)
    marks[n : 2 * n] = 1  # as if the copies had been seen and the lines not
    seen.texture.write(marks.tobytes())
    renderer._made = None
    assert_same(read(renderer.render(view)), first)
    renderer.release()


@pytest.mark.parametrize("pipeline", RASTER)
def test_only_owners_are_seen(gl, fabricate, random_lines, camera, pipeline):
    fiblets = fabricate(random_lines(300, seed=22), kind=2)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    for eye in ((0, -260, 60), (260, 0, 60)):
        picture = read(renderer.render(View(SIZE, camera(SIZE, eye=eye))))
        marks = np.frombuffer(renderer._pipeline._seen.texture.read(alignment=1), np.uint8)
        assert set(np.flatnonzero(marks)) == set(np.unique(picture.owner[picture.drawn]))
    renderer.release()


@pytest.mark.more
@pytest.mark.parametrize("pipeline", RASTER)
def test_coverage_culling_keeps_a_still_picture(gl, camera, pipeline):
    fiblets = compress(brain_streamlines(1000, step=0.5, seed=4))
    size = (640, 480)
    views = [View(size, camera(size)), View(size, camera(size, far=601.0)), View(size, camera(size, far=602.0))]
    culled, whole = (FibletRenderer(gl, fiblets, pipeline=pipeline, culling=c) for c in ("coverage", None))
    for view in views:
        picture, expected = read(culled.render(view)), read(whole.render(view))
        lost = (picture.depth != expected.depth).sum()
        assert lost <= 1e-3 * expected.drawn.sum()
    for renderer in (culled, whole):
        renderer.release()


@pytest.mark.parametrize("pipeline", RASTER)
def test_the_number_of_draws_does_not_follow_the_data(gl, fabricate, random_lines, camera, pipeline, monkeypatch):
    calls, render = [], moderngl.VertexArray.render
    monkeypatch.setattr(moderngl.VertexArray, "render", lambda *a, **k: (calls.append(k), render(*a, **k)))
    monkeypatch.setattr("pvfiblets.engine.fiblets.pipelines.textured.is_software", lambda ctx: False)
    counts = []
    for n in (3, 90):
        calls.clear()
        draw(gl, fabricate(random_lines(n), kind=2), View(SIZE, camera(SIZE)), pipeline=pipeline)
        counts.append(len(calls))
    assert counts[0] == counts[1] < 20


@pytest.mark.parametrize("pipeline", RASTER)
def test_bindings_are_left_as_they_were(gl, fabricate, random_lines, camera, pipeline):
    functions, mine = GLExtras(gl), gl.simple_framebuffer((4, 4))
    renderer = FibletRenderer(gl, fabricate(random_lines(10), kind=2), pipeline=pipeline)
    with functions.framebuffers_kept():
        mine.use()
        for near in (10.0, 20.0):
            renderer.render(View(SIZE, camera(SIZE, near=near)), FibletStyle(values="arc_length"))
            assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == mine.glo
            assert gl.fbo is mine
    renderer.release()
    renderer.release()
    mine.release()
    with pytest.raises(EngineError, match="released"):
        renderer.render(View(SIZE, camera(SIZE)))


def test_what_vtk_leaves_on_does_not_matter(gl, fabricate, random_lines, camera):
    """Blending, culling of faces, another depth test, wide lines' wireframes and a scissor."""
    fiblets, view = fabricate(random_lines(30), kind=2), View(SIZE, camera(SIZE))
    for pipeline in RASTER:
        for style in (FibletStyle(), FibletStyle(4.0)):
            expected = draw(gl, fiblets, view, style, pipeline=pipeline)
            mine = gl.simple_framebuffer((400, 400))
            mine.scissor = 10, 10, 20, 20
            mine.depth_mask = False
            with gl.scope(mine, moderngl.BLEND | moderngl.CULL_FACE):
                gl.depth_func, gl.cull_face, gl.wireframe = ">", "front_and_back", True
                gl.provoking_vertex = moderngl.FIRST_VERTEX_CONVENTION
                found = draw(gl, fiblets, view, style, pipeline=pipeline)
                gl.depth_func, gl.cull_face, gl.wireframe = "<=", "back", False
                gl.provoking_vertex = moderngl.LAST_VERTEX_CONVENTION
            mine.release()
            assert_same(found, expected)


def test_marks_fit_textures_of_any_limit(gl):
    """A texel for each fiblet, in rows of a power of two, as few as the driver allows."""
    programs, functions = SimpleNamespace(), GLExtras(gl)
    limited = SimpleNamespace(info={"GL_MAX_TEXTURE_SIZE": 2048}, texture=gl.texture, framebuffer=gl.framebuffer)
    for n, size in ((0, (1024, 1)), (1024, (1024, 1)), (1025, (1024, 2)), (2048 * 1024 + 1, (2048, 1025))):
        seen = SeenTexture(limited, functions, programs, n)
        assert seen.size == size
        assert not np.frombuffer(seen.texture.read(), np.uint8).any()
        assert seen.nbytes == size[0] * size[1]
        seen.release()
    with pytest.raises(EngineError, match="4194305 fiblets are more than the 4194304"):
        SeenTexture(limited, functions, programs, 2048 * 2048 + 1)


@pytest.mark.parametrize("pipeline", RASTER)
def test_limits_are_those_of_textures(gl, fabricate, random_lines, pipeline, monkeypatch):
    functions = GLExtras(gl)
    limits = Limits.from_context(gl, functions, pipeline, None, None)
    assert limits.buffer_bytes <= 4 * functions.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE")
    assert Limits.from_context(gl, functions, pipeline, 1000, None).buffer_bytes == 1000
    fiblets = fabricate(random_lines(20), kind=2)
    monkeypatch.setattr(GLExtras, "get_integer", lambda self, name: 4 if name == "GL_MAX_TEXTURE_SIZE" else 65536)
    with pytest.raises(EngineError, match=r"\d+ fiblets are more than the 16 .* largest texture"):
        FibletRenderer(gl, fiblets, pipeline=pipeline)


def test_no_memory_for_a_picture_is_told(gl):
    blank = dict.fromkeys(("depth", "owner", "ids", "position", "across", "relief", "edges"))
    target = SimpleNamespace(size=SIZE, **blank)

    def refuse(*_, **__):
        raise moderngl.Error("out of memory")

    short = SimpleNamespace(depth_texture=refuse, texture=refuse)
    with pytest.raises(EngineError, match="no memory for a picture of 320 x 240 pixels: out of memory"):
        RasterTarget(short, GLExtras(gl), target, True)


def test_empty_pixels_are_empty(gl, fabricate, random_lines, camera):
    """Nothing in view: every texel that means something says so, whatever was there before."""
    fiblets = fabricate(random_lines(30), kind=2)
    for pipeline in RASTER:
        renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
        assert read(renderer.render(View(SIZE, camera(SIZE)))).drawn.any()
        away = View(SIZE, camera(SIZE, eye=(0, -260, 60), target=(0, -500, 60)))
        for style in (FibletStyle(), FibletStyle(5.0)):
            picture = read(renderer.render(away, style))
            assert (picture.depth == EMPTY).all()
            assert (picture.owner == EMPTY).all()
        renderer.release()
