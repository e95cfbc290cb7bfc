"""`explain()["features"]` is what the text of the programs says that ran, whoever asks for them, and nothing else."""

import functools
import re

import numpy as np
import pytest

from pvfiblets import compress, regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.shaders import Programs, switched_on
from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
from pvfiblets.engine.tubes import TubeRenderer
from pvfiblets.halos import HaloStyle
from pvfiblets.halos.build import as_halo_lines
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.tubes import as_spline_tubes

SIZE = (160, 120)
ON = re.compile(r"^#define FEATURE_(\w+) 1$", re.MULTILINE)


@pytest.fixture
def ran(gl, monkeypatch):
    """Switches that are on in the programs that run, as seen between the engine and OpenGL."""
    import moderngl

    switches, seen = {}, set()

    def watch(owner, name, note):
        function = getattr(owner, name)

        @functools.wraps(function)
        def watched(*arguments, **keywords):
            made = function(*arguments, **keywords)
            note(made, *arguments, **keywords)
            return made

        monkeypatch.setattr(owner, name, watched)

    def linked(made, _, *sources, **stages):
        texts = [*sources, *(text for text in stages.values() if isinstance(text, str))]
        switches[made.glo] = {feature for text in texts for feature in ON.findall(text)}

    watch(moderngl.Context, "compute_shader", linked)
    watch(moderngl.Context, "program", linked)
    for name in ("run", "run_indirect"):
        watch(moderngl.ComputeShader, name, lambda _, program, *__, **___: seen.update(switches[program.glo]))
    for name in ("render", "render_indirect", "transform"):
        watch(moderngl.VertexArray, name, lambda _, array, *__, **___: seen.update(switches[array.program.glo]))
    return seen


@pytest.fixture(scope="module")
def fiblets():
    made = brain_streamlines(60, seed=1)
    made.per_point = {"height": made.points[:, 2].copy()}
    return compress(made, per_point=("height",))


def told(renderer, ran, draw):
    """What is told of a picture, which is drawn twice so that it has one before it."""
    draw(0)
    ran.clear()
    draw(1)
    seen = set(ran)
    assert renderer.explain(counts=False)["features"] == sorted(seen)
    assert renderer.explain()["features"] == sorted(seen), "counting is no part of the picture"
    return seen


BOX = regions.Box((-30.0, 30.0, -30.0, 30.0, -30.0, 30.0))
CULLED = {"culling": "two-phase"}
CASES = {
    "plain": ({}, FibletStyle(), {}, set()),
    "detail": (CULLED, FibletStyle(tolerance=0.5), {}, {"ONE_SEGMENT", "LEVEL_OF_DETAIL", "CULL_PYRAMID"}),
    "two-phase": (CULLED, FibletStyle(), {}, {"CULL_PYRAMID"}),
    "detail, no culling": ({"culling": None}, FibletStyle(tolerance=0.5), {}, {"ONE_SEGMENT"}),
    "planes": ({}, FibletStyle(3.0), {"clip_planes": [(1.0, 0.0, 0.0, 0.0)]}, {"CLIP_PLANES", "WIDE_LINES"}),
    "region": ({}, FibletStyle(), {"region": BOX}, {"CLIP_REGION"}),
    "values": ({}, FibletStyle(values="height"), {}, {"VALUES_STORED"}),
    "geometry": ({"pipeline": "geometry", **CULLED}, FibletStyle(), {}, {"TEXTURE_DATA", "SECOND_ROUND"}),
    "geometry, no culling": ({"pipeline": "geometry", "culling": None}, FibletStyle(), {}, {"TEXTURE_DATA"}),
    "tessellation": ({"pipeline": "tessellation", **CULLED}, FibletStyle(), {}, {"TEXTURE_DATA", "SECOND_ROUND"}),
    "tubes": ({}, FibletStyle(radius=1.0), {}, {"TUBES", "WIDE_LINES"}),
}


@pytest.mark.few(3)
@pytest.mark.parametrize("name", CASES)
def test_of_fiblets(gl, fiblets, camera, ran, name):
    options, style, of_view, some = CASES[name]
    renderer = FibletRenderer(gl, fiblets, **options)

    def draw(turn):
        renderer.render(View(SIZE, camera(SIZE, eye=(3.0 * turn, -260, 60)), **of_view), style)

    try:
        seen = told(renderer, ran, draw)
    finally:
        renderer.release()
    assert some <= seen
    assert "PEEL" not in seen


def test_of_layers_and_filters(gl, fiblets, camera, ran):
    renderer = FibletRenderer(gl, fiblets)
    mask = np.ones(fiblets.n_streamlines, bool)
    mask[::3] = False
    renderer.filtering = Filter(mask, None)
    views = [View(SIZE, camera(SIZE, eye=(x, -260, 60))) for x in (0.0, 3.0)]
    try:
        seen = told(renderer, ran, lambda turn: renderer.render_layers(views[turn], FibletStyle(), 3))
        assert {"PEEL", "STREAMLINE_MASK"} <= seen
        renderer.drop_layers()
        assert set(renderer.explain()["features"]) == seen - {"PEEL"}, "layers that are gone are not told"
        assert "PEEL" not in told(renderer, ran, lambda turn: renderer.render(views[1 - turn], FibletStyle()))
    finally:
        renderer.release()


@pytest.mark.parametrize("count", [20, 300], ids=["whole", "listed"])
@pytest.mark.parametrize("planes", [(), [(1.0, 0.0, 0.0, 0.0)]], ids=["uncut", "cut"])
def test_of_spline_tubes(gl, camera, ran, count, planes):
    renderer = TubeRenderer(gl, as_spline_tubes(brain_streamlines(count, step=1.0, seed=2), radius=0.8))

    def draw(turn):
        renderer.render(View(SIZE, camera(SIZE, eye=(3.0 * turn, -260, 60)), planes))

    try:
        seen = told(renderer, ran, draw)
    finally:
        renderer.release()
    assert {"TUBES", "TUBE_ILLINOIS"} <= seen
    assert ("TUBE_LISTED" in seen) == (count == 300)
    assert ("CLIP_PLANES" in seen) == bool(planes)


@pytest.mark.parametrize("cue", [0.0, 0.7])
def test_of_lines_with_halos(gl, camera, ran, cue):
    """A list of what shows narrows halos only where they are: without a cue the switch is off there, too."""
    lines, _ = as_halo_lines(brain_streamlines(300, step=1.0, seed=2))
    renderer = HaloRenderer(gl, lines)
    style = HaloDrawStyle(look=HaloStyle(line_width=0.4, strip_width=2.0, max_displacement=4.0, width_cue=cue))

    def draw(turn):
        renderer.render(View(SIZE, camera(SIZE, eye=(3.0 * turn, -260, 60))), style)

    try:
        seen = told(renderer, ran, draw)
    finally:
        renderer.release()
    assert "HALO_LISTED" in seen
    assert ("HALO_CUE" in seen) == (cue > 0.0)


def test_programs_note_what_their_text_says(gl):
    programs = Programs(gl, CONSTANTS)
    try:
        with programs.noting() as outer:
            programs.compute("fiblets/compute/clear.comp", ["TUBES"])  # no stage of which looks at it
            with programs.noting() as inner:
                programs.compute("fiblets/compute/cull.comp", ["CLIP_PLANES", "DIRECTION"])
            programs.note(["PEEL"])
        programs.compute("fiblets/compute/cull.comp", ["TUBES"])
        with programs.noting() as again:
            programs.compute("fiblets/compute/cull.comp", ["CLIP_PLANES", "DIRECTION"])
    finally:
        programs.release()
    assert inner == {"CLIP_PLANES"}, "to cull, nothing is decoded"
    assert again == inner
    assert outer == inner | {"PEEL", "TUBES"}
    assert switched_on("#define FEATURE_A 1\n#define FEATURE_B 0\n") == {"A"}
