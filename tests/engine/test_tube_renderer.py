"""`TubeRenderer`: when it redraws, what it keeps and gives back, what it says and refuses, and older OpenGL."""

import pickle

import numpy as np
import pytest

from pvfiblets.engine import EngineError, View
from pvfiblets.engine.culling.two_phase_items import LEAST_SEGMENTS
from pvfiblets.engine.gl import passes
from pvfiblets.engine.tubes import SILHOUETTES, SOLVERS, TubeRenderer, TubeStyle
from pvfiblets.engine.tubes.options import check_choices
from pvfiblets.tubes import NodeValues, SplineTubes

from .elsewhere import run_elsewhere
from .tubes import (
    EYE,
    TubeTarget,
    bundle,
    changed,
    degrees,
    draw_splines,
    many,
    pictures_of,
    read_splines,
    winding,
)

SIZE = (96, 72)


@pytest.fixture(scope="module")
def tubes():
    return bundle()


@pytest.fixture(scope="module")
def view(camera):
    return View(SIZE, camera(SIZE, **EYE))


@pytest.fixture
def renderer(gl, tubes):
    made = TubeRenderer(gl, tubes)
    yield made
    made.release()


def empty():
    return SplineTubes(np.zeros((0, 3)), np.zeros((0, 2), int), [], np.zeros((0, 3)), [], False, np.zeros(0, int), 2)


def buffers(renderer):
    return {buffer["name"]: buffer["bytes"] for buffer in renderer.explain()["buffers"]}


# ------------------------------------------------------------------------------------------------------- when it draws


def test_pictures_repeat_to_the_bit(renderer, view, camera):
    first = read_splines(renderer.render(view, TubeStyle(values="number")))
    renderer.render(View(SIZE, camera(SIZE, **{**EYE, "near": 59.0}), [[1.0, 0, 0, 0]]), TubeStyle(values="colour"))
    again = read_splines(renderer.render(view, TubeStyle(values="number")))
    drawn = first.drawn
    assert drawn.sum() > 600
    for name in ("drawn", "z", "owner"):
        assert (getattr(first, name) == getattr(again, name)).all()
    for name in ("tube", "t", "value", "tangent", "normal"):
        assert (getattr(first, name) == getattr(again, name))[drawn].all()


def test_resizing(gl, renderer, tubes, camera):
    for size in ((100, 50), (33, 77), (1, 1), (100, 50)):
        view = View(size, camera(size, **EYE))
        buffer = renderer.render(view)
        assert buffer.size == size
        assert buffer.depth.size == buffer.owner.size == buffer.across.size == size
        picture, alone = read_splines(buffer), draw_splines(gl, tubes, view)
        assert (picture.owner == alone.owner).all()
        assert (picture.z == alone.z).all()


def test_a_scissor_or_culling_left_on_changes_nothing(gl, renderer, view):
    first = read_splines(renderer.render(view))
    target = gl.simple_framebuffer((20, 20))
    with renderer._gl.framebuffers_kept():
        target.use()
        gl.scissor = 3, 3, 4, 4
        gl.enable_direct(0x0B44)  # culling
        gl.depth_func = "!="
        gl.wireframe = True
        renderer._made = None
        again = read_splines(renderer.render(view))
        gl.wireframe = False
        gl.disable_direct(0x0B44)
        gl.scissor = None
        gl.depth_func = "<="
    target.release()
    assert (first.z == again.z).all()


def test_no_framebuffer_of_its_own_stays_bound(gl, tubes, view):
    mine = gl.simple_framebuffer((8, 8))
    library = TubeRenderer(gl, empty())._gl
    with library.framebuffers_kept():
        mine.use()
        renderer = TubeRenderer(gl, tubes)
        for style in (TubeStyle(), TubeStyle(values="colour"), TubeStyle()):
            renderer.render(view, style)
            assert library.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == mine.glo
        renderer.release()
        mine.clear(0.5)
        assert mine.read(components=1)[0] in (127, 128)  # 127.5: drivers round it down or up
    mine.release()


# ----------------------------------------------------------------------------------------------------- what it keeps


def test_values_take_memory_only_while_they_show(renderer, tubes, view):
    """A node takes 32 bytes, a segment 16, and values and colours what they are while they show."""
    renderer.render(view)
    plain = buffers(renderer)
    assert not {"values", "colours"} & set(plain)
    assert renderer.render(view).colours is None
    renderer.render(view, TubeStyle(values="number"))
    assert buffers(renderer) == plain | {"values": 8 * tubes.n_nodes}
    assert "TUBE_VALUES" in renderer.explain()["features"]
    shown = renderer.render(view, TubeStyle(values="colour"))
    assert shown.colours is not None
    pixels = SIZE[0] * SIZE[1]
    assert buffers(renderer) == plain | {"colours": 32 * tubes.n_nodes, "gbuffer": plain["gbuffer"] + 4 * pixels}
    assert "TUBE_COLOURS" in renderer.explain()["features"]
    renderer.render(view)
    assert buffers(renderer) == plain
    renderer.render(view)
    assert buffers(renderer)["nodes"] == 32 * tubes.n_nodes
    assert buffers(renderer)["segments"] == 16 * tubes.n_segments


def test_values_that_are_no_number_stay_so(gl, tubes, view):
    """They stand for no value, and what shows them has to know."""
    values = tubes.values["number"].values.copy()
    values[7] = np.nan
    tubes = changed(tubes, values={"some": NodeValues(values, tubes.values["number"].slopes)})
    picture = draw_splines(gl, tubes, view, "some")
    beside = (tubes.segments[np.maximum(picture.owner, 0)] == 7).any(axis=-1) & picture.drawn
    assert beside.sum() > 10
    assert np.isnan(picture.value[beside]).any()
    assert np.isfinite(picture.value[picture.drawn & ~beside]).all()


def test_explain(renderer, tubes, view, camera, monkeypatch):
    assert renderer.explain()["features"] == []
    renderer.render(view)
    said = renderer.explain()
    assert [p["name"] for p in said["passes"]] == ["clear", "tubes", "attributes"]
    assert all(0 <= p["ms"] < 1e5 for p in said["passes"])
    assert (said["tubes_total"], said["segments_total"]) == (tubes.n_tubes, tubes.n_segments)
    assert said["primitives"] == 2 * tubes.n_segments
    assert (said["solver"], said["iterations"]) == ("illinois", SOLVERS["illinois"].iterations)
    assert said["culling"] is None
    assert said["features"] == ["TUBES", "TUBE_ILLINOIS"]
    # Planes cost nothing where they touch nothing, and only what cutting needs where they do.
    renderer.render(View(SIZE, view.model_view_projection, [[0, 1.0, 0, 1000.0]]))
    assert renderer.explain()["features"] == ["TUBES", "TUBE_ILLINOIS"]
    renderer.render(View(SIZE, view.model_view_projection, [[0, 1.0, 0, 0.0]]))
    assert renderer.explain()["features"] == ["CLIP_PLANES", "TUBES", "TUBE_CHAIN", "TUBE_ILLINOIS"]
    assert "clip_planes" in buffers(renderer)
    renderer.render(View(SIZE, camera(SIZE, **{**EYE, "near": 59.0})))
    assert renderer.explain()["features"] == ["TUBES", "TUBE_CHAIN", "TUBE_HOLLOW", "TUBE_ILLINOIS"]
    assert "clip_planes" not in buffers(renderer)
    renderer.render(view)
    assert renderer.explain()["features"] == said["features"]
    assert renderer.explain()["buffers"] == said["buffers"]


@pytest.mark.parametrize("silhouettes", SILHOUETTES)
@pytest.mark.parametrize("solver", SOLVERS)
def test_choices_are_kept(gl, tubes, view, silhouettes, solver):
    renderer = TubeRenderer(gl, tubes, silhouettes=silhouettes, solver=solver, iterations=17)
    renderer.render(view)
    said = renderer.explain()
    assert (renderer.pipeline, renderer.solver, renderer.iterations) == (silhouettes, solver, 17)
    assert (said["solver"], said["iterations"]) == (solver, 17)
    assert said["primitives"] == (2 if silhouettes == "rectangles" else 24) * tubes.n_segments
    assert renderer.share == 1.0
    assert not renderer.needs_outside(view, TubeStyle())
    renderer.release()


def test_timer_queries_are_read_where_opengl_is_hardware(gl, tubes, view, monkeypatch):
    monkeypatch.setattr(passes, "is_software", lambda ctx: False)
    renderer = TubeRenderer(gl, tubes)
    renderer.render(view)
    times = renderer.explain()["passes"]
    assert [p["name"] for p in times] == ["clear", "tubes", "attributes"]
    assert all(p["ms"] >= 0 for p in times)  # of compute work llvmpipe answers with its clock
    renderer.release()


def test_discarding_shows_nothing_and_takes_silhouettes_alone(gl, tubes, view):
    assert not draw_splines(gl, tubes, view, discard=True).drawn.any()


# -------------------------------------------------------------------------------------------------------- culling


@pytest.fixture
def few_are_many(monkeypatch):
    """Have culling begin where tests do not take long."""
    monkeypatch.setattr("pvfiblets.engine.hit_drawable.LEAST_SEGMENTS", 3000)


@pytest.mark.usefixtures("few_are_many")
def test_culling_changes_no_pixel(gl, camera):
    """Hidden segments are left out, and the picture is the same, turn by turn, cut, and from inside."""
    tubes = many()
    assert 3000 <= tubes.n_segments < LEAST_SEGMENTS
    culled, whole = TubeRenderer(gl, tubes), TubeRenderer(gl, tubes, culling=None)
    plane = [[0.4, 1.0, 0.1, 2.0]]
    views = [
        View(SIZE, camera(SIZE, **{**EYE, "eye": (30 * np.sin(a), -62 * np.cos(a), 10)}), planes)
        for a, planes in ((0.0, ()), (0.1, ()), (1.5, ()), (1.5, plane), (1.6, plane))
    ]
    views += [View(SIZE, camera(SIZE, **{**EYE, "near": near})) for near in (58.0, 62.0)]
    views += [View((70, 90), camera((70, 90), **EYE))]
    for view in views:
        a, b = read_splines(culled.render(view)), read_splines(whole.render(view))
        assert a.drawn.sum() > 300
        assert (a.drawn == b.drawn).all()
        assert np.abs(a.z - b.z)[a.drawn].max() < 1e-6
        # Where two are as deep as each other, as where a plane cuts both, either may own a pixel.
        assert (a.owner != b.owner).sum() < (5 if not len(view.clip_planes) else 0.05 * a.drawn.sum())
    said = culled.explain()
    assert said["culling"] == "two-phase"
    assert "culling" in buffers(culled)
    assert "culling" not in buffers(whole)
    assert [p["name"] for p in said["passes"]] == [
        "last picture", "clear", "seen before", "pyramid", "others", "attributes",
    ]  # fmt: skip
    culled.release()
    whole.release()


@pytest.mark.usefixtures("few_are_many")
def test_culling_is_for_rectangles_of_many_segments(gl, tubes):
    for options, some in (({}, tubes), ({"silhouettes": "boxes"}, many()), ({"culling": None}, many())):
        renderer = TubeRenderer(gl, some, **options)
        assert renderer.explain()["culling"] is None
        renderer.release()


# ------------------------------------------------------------------------------------------------ what it refuses


BAD = {
    "solver": ({"solver": "secant"}, r"solver is 'secant'; use one of \['auto', 'illinois'"),
    "silhouettes": ({"silhouettes": "spheres"}, r"silhouettes is 'spheres'; use one of \['auto', 'rectangles'"),
    "no iterations": ({"iterations": 0}, "iterations is 0; give a whole number above 0"),
    "half iterations": ({"iterations": 2.5}, "iterations is 2.5; give a whole number"),
    "true iterations": ({"iterations": True}, "iterations is True"),
    "negative width": ({"min_width": -1.0}, r"min_width is -1.0; give pixels from 0"),
    "wide": ({"min_width": 65.0}, "min_width is 65.0"),
    "no width": ({"min_width": float("nan")}, "min_width is nan"),
    "culling": ({"culling": "guess"}, "culling is 'guess'"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_choices_name_what_there_is(gl, tubes, name):
    options, message = BAD[name]
    with pytest.raises(ValueError, match=message):
        check_choices(**options)
    if "min_width" not in options:
        with pytest.raises(ValueError, match=message):
            TubeRenderer(gl, tubes, **options)


@pytest.mark.parametrize("width", [-1.0, np.nan, np.inf])
def test_a_style_needs_a_width(width):
    with pytest.raises(ValueError, match=f"min_width is {width}; give a finite number of pixels, 0 or more"):
        TubeStyle(min_width=width)


def test_what_is_refused_leaves_the_next_picture_as_it_was(renderer, view, camera):
    renderer.render(view)
    with pytest.raises(EngineError, match=r"no values 'fa' .* there are \['colour', 'number'\]"):
        renderer.render(view, TubeStyle(values="fa"))
    assert read_splines(renderer.render(view)).drawn.any()
    first = renderer.render(view).generation
    with pytest.raises(EngineError, match="wider or higher than this OpenGL's largest texture"):
        renderer.render(View((100_000, 4), camera(SIZE, **EYE)))
    assert renderer.render(view).generation > first


LARGE = {
    "radius": {"radius": 1e39}, "tangents": {"tangents": 1e39}, "radius_slopes": {"radius_slopes": -1e39},
    "nodes of spline tubes extend over": {"points": 1e39},
}  # fmt: skip


@pytest.mark.parametrize("message", LARGE)
def test_numbers_too_large_for_float32(gl, message):
    (name, value), *_ = LARGE[message].items()
    tubes = winding()
    array = getattr(tubes, name).copy()
    array[2] = value
    with pytest.raises(EngineError, match=f"{message}.*more than float32 holds; scale"):
        TubeRenderer(gl, changed(tubes, **{name: array}))


def test_a_set_without_segments_shows_nothing(gl, tubes, view):
    nodes_only = changed(tubes, segments=np.zeros((0, 2), int), tubes=np.zeros(0, int))
    for some in (empty(), nodes_only):
        for silhouettes in SILHOUETTES:
            renderer = TubeRenderer(gl, some, silhouettes=silhouettes)
            for style in (None, *(TubeStyle(values=name) for name in some.values)):
                for planes in ((), [[0, 1.0, 0, 0]]):
                    picture = read_splines(renderer.render(View(SIZE, view.model_view_projection, planes), style))
                    assert not picture.drawn.any()
            assert renderer.explain()["segments_total"] == 0
            renderer.release()


@pytest.mark.parametrize("silhouettes", SILHOUETTES)
def test_views_without_depth_or_size_are_harmless(gl, tubes, silhouettes):
    """Nothing or something, but neither an error nor a number that is none."""
    flat = np.diag([0.02, 0.02, 0.0, 1.0])
    for matrix in (np.zeros((4, 4)), flat, np.diag([1e-30, 1e-30, 1e-30, 1.0]), np.diag([1e30, 1e30, 1e30, 1.0])):
        draw_splines(gl, tubes, View(SIZE, matrix), silhouettes=silhouettes)


# ------------------------------------------------------------------------------------------------ older OpenGL


DRAW = """
from tests.engine import tubes
found = {s: [tuple(p) for p in tubes.pictures_of(ctx, camera, s)] for s in tubes.SILHOUETTES}
Path(arguments[0]).write_bytes(pickle.dumps(found))
"""


@pytest.mark.more
@pytest.mark.parametrize("version", ["3.3", pytest.param("4.1", marks=pytest.mark.exhaustive)])
def test_older_opengl_draws_the_same(gl, camera, older_opengl, tmp_path, version):
    """In a process whose OpenGL has nothing newer: storage buffers, images and compute do not even compile there."""
    file = tmp_path / "pictures"
    run_elsewhere(older_opengl, version, DRAW, file)
    found = pickle.loads(file.read_bytes())
    for silhouettes, pictures in found.items():
        expected = pictures_of(gl, camera, silhouettes, culling=None)  # which older OpenGL has not
        assert len(pictures) == len(expected) == 6
        for arrays, wanted in zip(pictures, expected, strict=True):
            picture = TubeTarget(*arrays)
            assert wanted.drawn.sum() > 300
            assert (picture.drawn != wanted.drawn).sum() <= 2
            both = picture.drawn & wanted.drawn
            other = both & (picture.owner != wanted.owner)  # where a plane cuts two, the last bit of depth decides
            assert (np.abs(picture.z - wanted.z)[other] < 1e-6).all()
            assert other.sum() < 0.1 * both.sum()
            assert np.quantile(np.abs(picture.z - wanted.z)[both], 0.99) < 1e-6
            assert np.quantile(degrees(picture.normal, wanted.normal)[both], 0.99) < 0.1
            assert (picture.colour is None) == (wanted.colour is None)
