"""`HaloRenderer`: when it redraws, what it keeps, gives back, says and refuses, and 10^7 vertices."""

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletStyle, View
from pvfiblets.engine.gl import passes
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.queries import Timers
from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.report.studies.halos.reference import LINE

from .halos import EYES, PLAIN, SIZE, assert_same, buffers, draw_halos, look, read_halos, scattered, styled, wandering

STYLE = HaloDrawStyle(look=look())


@pytest.fixture(scope="module", params=["lines", "points"])
def drawn(request):
    return wandering() if request.param == "lines" else scattered()


@pytest.fixture(scope="module")
def view(camera):
    return View(SIZE, camera(SIZE, **EYES["perspective"]))


@pytest.fixture
def renderer(gl, drawn):
    made = HaloRenderer(gl, drawn)
    yield made
    made.release()


# ------------------------------------------------------------------------------------------------------- when it draws


def test_pictures_repeat_to_the_bit(renderer, drawn, view, camera):
    """Whatever was drawn between, and in a renderer of its own."""
    some = styled("number", filter_by="number", low=0.2)
    first = read_halos(renderer.render(view, some))
    assert first.shown.sum() > 300
    renderer.render(View((33, 77), camera((33, 77), **EYES["parallel"]), [[1.0, 0, 0, 0]]), styled("colour"))
    renderer.render(view, styled(n_tapered=5, t_tapered=0.4, width_cue=0.5))
    again = read_halos(renderer.render(view, some))
    assert_same(first, again)
    assert_same(first, draw_halos(renderer._ctx, drawn, view, some.look, values="number"))


def test_resizing(renderer, drawn, camera):
    for size in ((100, 50), (33, 77), (1, 1), (100, 50)):
        view = View(size, camera(size, **EYES["parallel"]))
        buffer = renderer.render(view, STYLE)
        assert buffer.size == size
        assert buffer.depth.size == buffer.owner.size == buffer.across.size == size
        assert_same(read_halos(buffer), draw_halos(renderer._ctx, drawn, view, STYLE.look))


def test_states_left_on_change_nothing(gl, renderer, view):
    first = read_halos(renderer.render(view, STYLE))
    target = gl.simple_framebuffer((20, 20))
    with renderer._gl.framebuffers_kept():
        target.use()
        gl.scissor = 3, 3, 4, 4
        gl.enable_direct(0x0B44)  # culling
        gl.enable_direct(0x0BE2)  # blending
        gl.depth_func = "!="
        gl.wireframe = True
        gl.provoking_vertex = 0x8E4D  # the first
        renderer._made = None
        again = read_halos(renderer.render(view, STYLE))
        gl.wireframe = False
        gl.disable_direct(0x0B44)
        gl.disable_direct(0x0BE2)
        gl.scissor = None
        gl.depth_func = "<="
    target.release()
    assert_same(first, again)


def test_clip_distances_do_not_stay_on(gl, renderer, view):
    before = read_halos(renderer.render(view, STYLE))
    renderer.render(View(SIZE, view.model_view_projection, [[0, 1.0, 0, 0], [0, -1.0, 0, 5.0]]), STYLE)
    assert_same(before, read_halos(renderer.render(view, STYLE)))


def test_no_framebuffer_of_its_own_stays_bound(gl, drawn, view):
    mine = gl.simple_framebuffer((8, 8))
    library = HaloRenderer(gl, HaloPoints(np.zeros((0, 3))))._gl
    with library.framebuffers_kept():
        mine.use()
        renderer = HaloRenderer(gl, drawn)
        for style in (styled(), styled("colour"), styled()):
            renderer.render(view, style)
            assert library.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == mine.glo
        renderer.release()
        mine.clear(0.5)
        assert mine.read(components=1)[0] in (127, 128)  # 127.5: drivers round it down or up
    mine.release()


# --------------------------------------------------------------------------------------- what it keeps, and gives back


def test_a_vertex_takes_few_bytes(renderer, drawn, view):
    n = drawn.n_points
    lines = isinstance(drawn, HaloLines)
    index = 4 * len(drawn.offsets) if lines else 0

    def of_vertices():
        held = buffers(renderer)
        return sum(held.get(name, 0) for name in ("places", "masks", "filters", "values", "colours", "offsets"))

    renderer.render(view, STYLE)
    assert of_vertices() == (14 if lines else 12) * n + index
    renderer.render(view, styled("number"))
    assert of_vertices() == (18 if lines else 16) * n + index
    renderer.render(view, styled("colour"))
    assert of_vertices() == (18 if lines else 16) * n + index
    renderer.render(view, styled("number", filter_by="number"))
    assert of_vertices() <= (22 if lines else 20) * n + index
    renderer.render(view, STYLE)
    assert of_vertices() == (14 if lines else 12) * n + index


def test_values_take_memory_only_while_they_show(renderer, drawn, view):
    renderer.render(view, STYLE)
    plain = buffers(renderer)
    assert not {"values", "colours", "filters"} & set(plain)
    assert renderer.render(view, STYLE).colours is None
    renderer.render(view, styled("number"))
    assert buffers(renderer) == plain | {"values": 4 * drawn.n_points}
    shown = renderer.render(view, styled("colour", filter_by="number", low=0.1))
    assert shown.colours is not None
    held = buffers(renderer)
    assert held["colours"] == held["filters"] == 4 * drawn.n_points
    assert held["gbuffer"] == plain["gbuffer"] + 4 * SIZE[0] * SIZE[1]
    renderer.render(view, STYLE)
    assert buffers(renderer) == plain
    renderer.render(View(SIZE, view.model_view_projection, [[0, 1.0, 0, 3]]), STYLE)
    assert set(buffers(renderer)) - set(plain) == {"clip_planes"}
    renderer.render(view, STYLE)
    assert buffers(renderer) == plain


def test_explain(renderer, drawn, view):
    assert renderer.explain()["features"] == []
    renderer.render(view, STYLE)
    said = renderer.explain()
    lines = isinstance(drawn, HaloLines)
    assert renderer.pipeline == ("strips" if lines else "discs")
    assert [p["name"] for p in said["passes"]] == ["clear", renderer.pipeline, "attributes"]
    assert all(0 <= p["ms"] < 1e5 for p in said["passes"])
    assert said["points_total"] == drawn.n_points
    assert said["lines_total"] == (drawn.n_lines if lines else 0)
    assert 2 * (drawn.n_segments if lines else drawn.n_points) <= said["primitives"] <= 2 * drawn.n_points
    assert said["features"] == (["HALO_TAPER"] if lines else ["HALO_POINTS"])
    assert renderer.share == 1.0
    assert not renderer.needs_outside(view, STYLE)


@pytest.mark.parametrize(
    ("more", "features"),
    [({}, set()), ({"n_tapered": 2}, {"HALO_TAPER"}), ({"width_cue": 0.1}, {"HALO_CUE"}),
     ({"filter_by": "number"}, {"HALO_FILTER"}), ({"filter_by": "number", "filter_taper": 2.0}, {"HALO_FILTER"}),
     ({"low": 0.2, "high": 0.4, "filter_taper": 2.0}, set()), ({"displacement": "square"}, {"HALO_BENT"}),
     ({"n_tapered": 9, "width_cue": 1.0, "filter_by": "number"}, {"HALO_TAPER", "HALO_CUE", "HALO_FILTER"})],
)  # fmt: skip
def test_a_picture_pays_for_what_its_look_uses(renderer, drawn, camera, view, more, features):
    """There is code for ends that narrow, depth cueing, filters and cuts only while something shows by them."""
    lines = isinstance(drawn, HaloLines)
    kind = set() if lines else {"HALO_POINTS"}
    renderer.render(view, styled(**PLAIN | more))
    assert set(renderer.explain()["features"]) == kind | (features if lines else features - {"HALO_TAPER"})
    cut = {"HALO_CUT"} if lines else set()
    near = camera(SIZE, **EYES["perspective"] | {"near": 55.0})
    for other, used in (
        (View(SIZE, view.model_view_projection, [[0, 1.0, 0, 1000.0]]), set()),
        (View(SIZE, view.model_view_projection, [[0, 1.0, 0, 0]]), {"CLIP_PLANES"} | cut),
        (View(SIZE, near), cut),
    ):
        renderer.render(other, styled("number", **PLAIN))
        assert set(renderer.explain()["features"]) == kind | {"HALO_VALUES"} | used


@pytest.mark.parametrize("software", [True, False], ids=["software", "card"])
def test_nothing_is_left_after_release(gl, drawn, view, monkeypatch, software):
    """Every buffer, texture, query and framebuffer that was made is gone: their names are free for others."""
    monkeypatch.setattr(passes, "is_software", lambda ctx: software)  # a card is asked by queries what passes take
    made = []
    for name in ("buffer", "texture", "depth_texture", "framebuffer", "vertex_array", "program"):
        make = getattr(gl, name)

        def recorded(*args, make=make, **kwargs):
            made.append(make(*args, **kwargs))
            return made[-1]

        monkeypatch.setattr(gl, name, recorded, raising=False)
    named = []
    for cls, name in ((GLExtras, "texture_buffer"), (Timers, "timed")):
        make = getattr(cls, name)

        def readable(*args, make=make):
            named.append(make(*args))
            return named[-1]

        monkeypatch.setattr(cls, name, readable)
    renderer = HaloRenderer(gl, drawn)
    renderer.render(view, styled("colour", filter_by="number"))
    renderer.render(View((50, 40), view.model_view_projection, [[0, 1.0, 0, 0]]), styled("number"))
    assert len(made) > 15
    renderer.release()
    left = [thing for thing in made if type(thing.mglo).__name__ != "InvalidObject"]
    assert not left
    assert {type(thing).__name__ for thing in named} == {"BufferTexture"} | (set() if software else {"Query"})
    assert not any(thing.glo for thing in named)


# ------------------------------------------------------------------------------------------------------ what it refuses


def test_what_is_refused_leaves_the_next_picture_as_it_was(renderer, view, gl, drawn):
    renderer.render(view, STYLE)
    for style in (styled("fa"), styled(filter_by="fa")):
        with pytest.raises(EngineError, match=r"no values 'fa' .* there are \['colour', 'number'\]"):
            renderer.render(view, style)
    with pytest.raises(EngineError, match="'colour' are colours, and cannot filter; give numbers"):
        renderer.render(view, styled(filter_by="colour"))
    assert read_halos(renderer.render(view, STYLE)).shown.any()
    first = renderer.render(view, STYLE).generation
    with pytest.raises(EngineError, match="wider or higher than this OpenGL's largest texture"):
        renderer.render(View((100_000, 4), view.model_view_projection), STYLE)
    assert renderer.render(view, STYLE).generation > first
    with pytest.raises(TypeError, match="a HaloDrawStyle"):
        renderer.render(view, FibletStyle())
    with pytest.raises(ValueError, match=r"culling is 'guess'; choose one of \('two-phase', None\)"):
        HaloRenderer(gl, drawn, culling="guess")


def test_coordinates_too_large_for_float32(gl):
    with pytest.raises(EngineError, match="float32"):
        HaloRenderer(gl, HaloPoints(np.array([[0, 0, 0], [1e39, 0, 0]])))


def test_thresholds_of_infinity_let_all_numbers_pass(gl, view):
    """Those too large for float32 count as its largest."""
    drawn = scattered()
    numbers = np.where(np.arange(drawn.n_points) % 2, 1e300, -1e300)
    some = HaloPoints(drawn.points, {"n": numbers, "m": np.sign(numbers) * 3.3e38})
    everything = draw_halos(gl, some, view, look())
    for name in some.values:
        assert_same(everything, draw_halos(gl, some, view, look(filter_by=name)))
        above = draw_halos(gl, some, view, look(filter_by=name, low=0.0))
        assert set(np.unique(above.owner[above.kind == LINE]) % 2) == {1}


# --------------------------------------------------------------------------------------------------- 10^7 vertices


@pytest.mark.parametrize("n", [1_000_000, pytest.param(10_000_000, marks=pytest.mark.exhaustive)])
def test_millions_of_vertices(gl, camera, n):
    """They are built and drawn, and take what few of them take each: with one number, no more than 20 bytes."""
    each = 1000
    steps = np.random.default_rng(0).standard_normal((n, 3), np.float32)
    points = np.cumsum(steps.reshape(-1, each, 3), axis=1, dtype=np.float32).reshape(-1, 3)
    points[:, 0] += np.repeat(np.linspace(-100, 100, n // each, dtype=np.float32), each)
    drawn = HaloLines(points, np.arange(0, n + 1, each), {"n": points[:, 2]})
    size = (320, 240)
    view = View(size, camera(size, eye=(0, -300, 60), near=50.0, far=800.0, angle=40.0))
    renderer = HaloRenderer(gl, drawn)
    style = HaloDrawStyle(look=look(line_width=0.4, strip_width=2.0, max_displacement=4.0), values="n")
    picture = read_halos(renderer.render(view, style))
    assert (picture.kind == LINE).sum() > 10_000
    line = picture.kind == LINE
    assert (picture.line[line] == picture.owner[line] // each).all()
    place = picture.place[line] - picture.owner[line] % each
    assert place.min() > -1e-3
    assert place.max() < 1.001
    a, b = points[picture.owner[line], 2], points[picture.owner[line] + 1, 2]
    assert np.abs(picture.value[line] - (a + place * (b - a))).max() < 1e-2
    held = buffers(renderer)
    held.pop("gbuffer")
    assert sum(held.values()) <= 20 * n
    renderer.release()
