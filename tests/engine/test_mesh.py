"""Mesh pipelines on a machine without mesh shaders: linked off-line, and run as compute shaders.

The drivers' own part is what remains: that they link what glslang links, and draw what the stages wrote.
"""

import re
import subprocess
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from pvfiblets import Streamlines, compress, synthetic
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.fiblets.pipelines.mesh import TASK_FIBLETS, MeshPipeline
from pvfiblets.engine.gl.mesh_program import MeshProgram
from pvfiblets.engine.gl.shaders import EXTENDED, assemble, read_shader
from tests.reference_compiler import glslang, link

from .cells import SHIFT_256
from .emulated import emulated_renderer
from .pictures import EVERY_POINT, SIZE, assert_same, differences, read
from .polylines import to_clip, to_window
from .test_two_phase import shells
from .visibility_bits import planned

DRAWN = {
    "whole": [],
    "cut": ["CLIPPING", "CLIPPING_DEPTH", "LEVEL_OF_DETAIL"],
    "planes": ["CLIPPING", "CLIPPING_DEPTH", "CLIP_PLANES"],
    "wide": ["WIDE_LINES", "LEVEL_OF_DETAIL"],
    "ends": ["WIDE_LINES", "LINE_ENDS", "LEVEL_OF_DETAIL"],
    "wide-planes": ["WIDE_LINES", "CLIPPING", "CLIPPING_DEPTH", "CLIP_PLANES", "LEVEL_OF_DETAIL"],
}


def stages(kind, features):
    """Sources by glslang's names of the stages."""
    wide = "WIDE_LINES" in features
    files = {
        "task": "fiblets/mesh/fiblets.task",
        "mesh": f"fiblets/mesh/{kind}.mesh",
        "frag": "fiblets/hardware_raster/capsule.frag" if wide else "fiblets/hardware_raster/line.frag",
    }
    every = {*features, "PER_PRIMITIVE"}
    return {stage: assemble(name, every, CONSTANTS, version=EXTENDED) for stage, name in files.items()}


def test_the_compiler_sees_every_stage(tmp_path):
    sources = stages("together", ["DIRECTION"])
    for stage in sources:
        broken = {**sources, stage: sources[stage].replace("void main() {", "void main() { nonsense();")}
        assert link(tmp_path, broken).returncode != 0


@pytest.mark.parametrize("kind", ["together", "serial"])
@pytest.mark.parametrize("drawn", DRAWN)
def test_outputs_are_within_what_opengl_promises(tmp_path, kind, drawn):
    """256 vertices, 512 primitives, 16 KiB of outputs and shared memory; as many as the shares need."""
    summed = ["GATHER", "GATHER_SLICES", "PAINTED", "VALUES_ARC_LENGTH"]
    features = ["DIRECTION", "LATTICE", "WIDE_LATTICE", "SPLINE", *summed, *DRAWN[drawn]]
    source = tmp_path / "stage.mesh"
    source.write_text(assemble(f"fiblets/mesh/{kind}.mesh", features, CONSTANTS))
    text = subprocess.run([glslang(), "-E", source], capture_output=True, text=True, check=True).stdout
    vertices, primitives = (int(re.search(rf"max_{what} = (\d+)", text)[1]) for what in ("vertices", "primitives"))
    share, shares = (int(n) for n in re.search(r"SHARE = (\d+)u, SHARES = (\d+)u", text).groups())
    sizes = {"float": 1, "uint": 1, "vec2": 2, "uvec2": 2, "vec3": 3, "vec4": 4, "uvec4": 4, "ivec3": 3}
    handed = sum(sizes[kind] for kind in re.findall(r"perprimitiveNV out (\w+) varying_", text))
    shared = sum(sizes[kind] for kind in re.findall(r"shared (\w+) \w+ *\[ *2u \* PREFIX_THREADS *\]", text))
    assert vertices <= 256
    assert primitives <= 512
    assert handed >= 11
    assert shared == (0 if kind == "serial" else 4 + 3 + 3 + 1)
    assert 16 * vertices + 4 * handed * primitives + 3 * primitives + 4 * 64 * shared <= 16384
    assert share * shares >= 60
    wide, cut = "WIDE_LINES" in features, "CLIPPING" in features
    assert vertices == (4 * share if wide else 2 * share if cut else share + 1)
    assert primitives == (2 * share if wide else share)


@pytest.fixture(scope="module")
def lines(random_lines):
    return random_lines(60, seed=4)


def pictures(gl, monkeypatch, fiblets, view, style, *, serial, other="compute", **options):
    emulated = emulated_renderer(monkeypatch, gl, fiblets, serial=serial, **options)
    real = FibletRenderer(gl, fiblets, pipeline=other, **options)
    try:
        return read(emulated.render(view, style)), read(real.render(view, style))
    finally:
        emulated.release()
        real.release()


def assert_alike(picture, expected):
    """As near as float32 decoded in another order brings two pictures."""
    both = picture.drawn & expected.drawn
    assert both.sum() > 500
    assert (picture.drawn ^ expected.drawn).sum() <= 2e-3 * both.sum()
    same = (picture.ids[..., 0] == expected.ids[..., 0]) & both
    assert same.sum() >= 0.995 * both.sum()
    depth = np.abs(picture.window_depth - expected.window_depth)[same]
    assert (depth < 1e-5).mean() > 0.999
    place = np.abs(picture.position[..., 0] - expected.position[..., 0])[same]
    assert (place < 1e-2).mean() > 0.995


# Every two of kind, camera and width meet; all three would take twice as long.
@pytest.mark.more
@pytest.mark.parametrize(
    ("kind", "where", "width"),
    [
        pytest.param(
            kind,
            where,
            (1.0, 3.0)[(kind + i) % 2],
            id=f"{name}-{where}-{('thin', 'wide')[(kind + i) % 2]}",
            marks=[] if (kind + i) % 3 == 0 else [pytest.mark.exhaustive],
        )
        for kind, name in ((1, "lattice8"), (2, "lattice16"), (3, "wide-lattice"), (4, "plain"))
        for i, where in enumerate(("outside", "inside", "parallel", "planes", "far"))
    ],
)
def test_pictures_of_lattices(gl, monkeypatch, fabricate, lines, camera, kind, where, width):
    fiblets = fabricate(lines, kind=kind, low=kind == 2)
    cameras = {
        "inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
        "parallel": {"height": 120.0},
        "far": {"eye": (0, -2500, 60), "near": 1000.0, "far": 4000.0, "angle": 4.0},
    }
    matrix = camera(SIZE, **cameras.get(where, {}))
    planes = [[0.6, 0.5, -0.3, 10.0], [-1.0, 0.0, 0.0, 30.0]] if where == "planes" else []
    view, style = View(SIZE, matrix, planes), FibletStyle(width, tolerance=0.5 if where == "far" else 0.0)
    serial, expected = pictures(gl, monkeypatch, fiblets, view, style, serial=True, other="geometry")
    different = differences(serial, expected)
    assert not {"depth", "owner"} & set(different)
    if width > 1.0:
        assert not different
    else:  # where a line folds back, its segments are drawn in another order
        assert different.get("ids", 0) <= 1e-3 * serial.drawn.sum()
    together, expected = pictures(gl, monkeypatch, fiblets, view, style, serial=False)
    assert_alike(together, expected)


@pytest.fixture(scope="module", params=["fast", "small"])
def brain(request):
    return compress(synthetic.brain_streamlines(300, 0.5, seed=5, fa=True), per_point=("fa",), effort=request.param)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("serial", [False, True], ids=["together", "serial"])
@pytest.mark.parametrize("values", [None, "fa", "arc_length", "curvature"])
@pytest.mark.parametrize("tolerance", [0.0, 3.0], ids=["near", "far"])
def test_pictures_of_directions_and_their_values(gl, monkeypatch, brain, camera, serial, values, tolerance):
    matrix = camera(SIZE, eye=(-250, 120, 90), target=(0, -18, 8), angle=35.0)
    style = FibletStyle(1.0, values=values, tolerance=tolerance)
    picture, expected = pictures(gl, monkeypatch, brain, View(SIZE, matrix), style, serial=serial)
    assert_alike(picture, expected)
    same = (picture.owner == expected.owner) & picture.drawn & expected.drawn
    same &= np.abs(picture.position[..., 0] - expected.position[..., 0]) < 1e-3
    ours, theirs = picture.position[same][:, 1], expected.position[same][:, 1]
    scale = {None: 1.0, "fa": 1.0, "arc_length": 100.0, "curvature": 1.0}[values]
    assert np.array_equal(np.isnan(ours), np.isnan(theirs))
    assert np.nanmax(np.abs(ours - theirs)) < 2e-3 * scale


@pytest.mark.few(1)
@pytest.mark.parametrize("serial", [False, True], ids=["together", "serial"])
def test_meshes_against_float64(gl, monkeypatch, fabricate, lines, camera, serial):
    """A vertex a point, in the middle of its pixel, and a line a segment, in their order; nothing more."""
    fiblets = fabricate(lines, kind=2)
    matrix = camera(SIZE, eye=(0, -1200, 60), far=3000.0, angle=45.0)
    renderer = emulated_renderer(monkeypatch, gl, fiblets, serial=serial, culling=None)
    renderer.render(View(SIZE, matrix), EVERY_POINT)
    (meshes,), (tasks,) = renderer._pipeline.meshes, renderer._pipeline.tasks
    renderer.release()
    assert tasks[:, 0].sum() == fiblets.n_fiblets, "the whole set is in this view"
    drawn, lasts = 0, np.cumsum([len(line) for line in fiblets.lines])
    for f in range(fiblets.n_fiblets):
        group, within = divmod(f, TASK_FIBLETS)
        mesh = meshes[group, within]
        rank = int(np.searchsorted(lasts, points_before(fiblets, f), "right"))
        line, start = fiblets.lines[rank], fiblets.starts[f]
        points = line[start : start + 61] if start + 60 < len(line) else line[start:]
        ends = start + 60 >= len(line)
        if len(points) == 1:
            points = np.repeat(points, 2, axis=0)
        count = len(points) - 1
        assert mesh[2100] == count
        assert mesh[480 : 480 + 2 * count].tolist() == [v for s in reversed(range(count)) for v in (s, s + 1)]
        vertices = mesh[: 4 * (count + 1)].view("<f4").reshape(-1, 4)
        window = to_window(to_clip(points, matrix), SIZE)
        at = (vertices[:, :2] + 1.0) / 2.0 * SIZE - SHIFT_256 / 256.0 - 0.5
        inner = slice(0, len(points) - 1 if ends else None)  # the last one of a streamline goes on for part of a pixel
        sure = np.abs(window[:, :2] - np.rint(window[:, :2])).min(axis=1) > 1e-3
        assert np.abs(at - np.floor(window[:, :2]))[inner][sure[inner]].max(initial=0.0) < 1e-3
        if ends:
            assert np.abs(at[-1] - np.floor(window[-1, :2])).max() < 0.7
        assert (vertices[:, 2:] == [0.0, 1.0]).all()
        handed = mesh[660 : 660 + 24 * count].reshape(count, 24)[::-1]
        assert (handed[:, 0] == f).all()
        assert (handed[:, 1] & 255).tolist() == list(range(count))
        depths = handed[:, 6:8].copy().view("<f4")
        assert np.abs(depths[:, 1] - window[1:, 2]).max() < 1e-5
        drawn += count
    assert drawn > 1000


def points_before(fiblets, f):
    """Points of all earlier fiblets."""
    from pvfiblets.codec import layout

    return int(np.sum(layout.unpack("last", fiblets.decoding[:f]) + 1))


def survivors(tasks):
    """Indices of fiblets that a round of task stages let through."""
    found = []
    for count, first, *words in tasks:
        bits = np.unpackbits(np.array(words, "<u4").view(np.uint8), bitorder="little")
        assert count == bits.sum()
        found.append(first + np.flatnonzero(bits))
    return np.concatenate(found)


@pytest.mark.more
def test_tasks_keep_what_the_compute_pipeline_plans(gl, monkeypatch, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(400, seed=9), kind=2, per_fiblet=12)
    view = View(SIZE, camera(SIZE, eye=(20, -40, 10), target=(0, 30, 0), near=5.0, far=70.0))
    renderer = emulated_renderer(monkeypatch, gl, fiblets, culling=None)
    real = FibletRenderer(gl, fiblets, culling=None)
    renderer.render(view, EVERY_POINT)
    real.render(view, EVERY_POINT)
    (tasks,), wanted = renderer._pipeline.tasks, planned(real)
    renderer.release()
    real.release()
    kept = np.zeros(fiblets.n_fiblets, bool)
    kept[survivors(tasks)] = True
    assert len(tasks) > 4
    assert 0.05 < kept.mean() < 0.9
    assert np.array_equal(kept, wanted)


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("serial", [False, True], ids=["together", "serial"])
@pytest.mark.parametrize("culling", ["two-phase", "coverage"])
def test_culling_in_the_task_stage(gl, monkeypatch, camera, serial, culling):
    """Two-phase culling changes no bit after any jump; the coverage buffer none as long as the camera rests."""
    fiblets = compress(synthetic.brain_streamlines(1500, 0.5, seed=2))
    culled = emulated_renderer(monkeypatch, gl, fiblets, serial=serial, culling=culling)
    whole = emulated_renderer(monkeypatch, gl, fiblets, serial=serial, culling=None)
    places = [(-220, 60, 40), (-220, 60, 40), (-200, 90, 50), (200, -120, 30), (10, -20, 5)]
    drawn = []
    for i, eye in enumerate(places[: 2 if culling == "coverage" else None]):
        matrix = camera((160, 120), eye=np.array(eye) + 1e-9 * i, target=(0, -18, 9), near=1.0, far=500.0, angle=30.0)
        view = View((160, 120), matrix)
        assert_same(read(culled.render(view)), read(whole.render(view)))
        drawn.append(sum(int(tasks[:, 0].sum()) for tasks in culled._pipeline.tasks) / fiblets.n_fiblets)
        rounds = [set(survivors(tasks).tolist()) for tasks in culled._pipeline.tasks]
        assert len(rounds) == (2 if culling == "two-phase" else 1)
        assert not set.intersection(*rounds) or len(rounds) == 1
    culled.release()
    whole.release()
    assert drawn[1] < 0.98 or culling == "coverage"  # of which so small a picture has few texels


def lying_open(renderer):
    """Whether each fiblet's cluster may show, by round."""
    rounds = []
    for chunk in renderer._chunks:
        n = chunk.n_fiblets
        words = np.frombuffer(renderer._pipeline._open[chunk.plan.fiblets[0]].read(), "<u4")[: 2 * -(-n // 32)]
        rounds.append(np.unpackbits(words.reshape(2, -1).view(np.uint8), axis=1, bitorder="little")[:, :n] != 0)
    return np.concatenate(rounds, axis=1)


@pytest.mark.more
def test_clusters_before_the_task_stage(gl, monkeypatch, camera):
    """They change no pixel, of lines at one depth neither; what is drawn in the second round lies open."""
    monkeypatch.setattr(chunks, "CLUSTERED", 0)
    lines = shells(4.0).decompress()
    offsets = np.concatenate([lines.offsets, lines.offsets[1:] + lines.offsets[-1]])
    fiblets = compress(Streamlines(np.concatenate([lines.points] * 2), offsets), max_error=1e-3)
    culled = emulated_renderer(monkeypatch, gl, fiblets, culling="two-phase")
    whole = emulated_renderer(monkeypatch, gl, fiblets, culling=None)
    size, cut = (24, 18), {"clip_planes": [(0.0, 1.0, 0.2, 10.0)]}
    for eye, kept in ((110, 0, 30), {}), ((110, 2, 30), {}), ((-90, 60, 5), cut):
        view = View(size, camera(size, eye=eye, target=(0, 0, 0), near=1.0, far=300.0, angle=40.0), **kept)
        assert_same(read(culled.render(view)), read(whole.render(view)))
        likely, left = lying_open(culled)
        assert likely.any() == (eye != (110, 0, 30))
        assert 0.0 < left.mean() < (0.95 if likely.any() else 1.01)
        assert left[survivors(culled._pipeline.tasks[1])].all()
    culled.release()
    whole.release()


@pytest.mark.more
def test_clusters_of_chunks_before_the_task_stage(gl, monkeypatch, fabricate, random_lines, camera):
    monkeypatch.setattr(chunks, "CLUSTERED", 0)
    fiblets = fabricate(random_lines(900, seed=3), kind=1, per_fiblet=3)
    culled = emulated_renderer(monkeypatch, gl, fiblets, culling="two-phase", max_buffer_bytes=250_000)
    assert len(culled._chunks) > 1
    whole = FibletRenderer(gl, fiblets, pipeline="compute", culling=None)
    for eye in ((0, -200, 0), (1, -200, 0)):
        view = View((40, 30), camera((40, 30), eye=eye))
        assert_alike(read(culled.render(view, EVERY_POINT)), read(whole.render(view, EVERY_POINT)))
    assert lying_open(culled).any(axis=1).all()
    culled.release()
    whole.release()


@pytest.mark.more
def test_chunks_and_calls_of_limited_length(gl, monkeypatch, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(900, seed=3), kind=1, per_fiblet=3)
    assert fiblets.n_fiblets > 20_000
    view = View(SIZE, camera(SIZE))
    renderer = emulated_renderer(monkeypatch, gl, fiblets, culling=None, max_buffer_bytes=250_000)
    assert len(renderer._chunks) > 1
    renderer._pipeline._max_tasks = 7
    picture = read(renderer.render(view, EVERY_POINT))
    renderer.release()
    expected = FibletRenderer(gl, fiblets, pipeline="compute", culling=None)
    assert_alike(picture, read(expected.render(view, EVERY_POINT)))
    expected.release()


class Driver(SimpleNamespace):
    """What a MeshPipeline asks of OpenGL when it is made."""

    def get_integer(self, name):
        return self.numbers[name]


def made(extensions=(), **numbers):
    ctx = SimpleNamespace(extensions=set(extensions), version_code=460)
    known = {f"GL_SUBGROUP_{name}_KHR": value for name, value in numbers.items()}
    return MeshPipeline(ctx, Driver(numbers=known), None, 10)


def test_ballots_are_used_where_they_cover_a_work_group():
    khr = ["GL_KHR_shader_subgroup"]
    assert "SUBGROUPS" not in made().features
    assert "SUBGROUPS" in made(khr, SIZE=32, SUPPORTED_STAGES=0xFF, SUPPORTED_FEATURES=0xFF).features
    assert "SUBGROUPS" not in made(khr, SIZE=64, SUPPORTED_STAGES=0xFF, SUPPORTED_FEATURES=0xFF).features
    assert "SUBGROUPS" not in made(khr, SIZE=32, SUPPORTED_STAGES=0x20, SUPPORTED_FEATURES=0xFF).features
    assert "SUBGROUPS" not in made(khr, SIZE=32, SUPPORTED_STAGES=0xFF, SUPPORTED_FEATURES=0x1).features


def test_calls_are_as_long_as_the_extensions_promise():
    pipeline = made()
    calls = []

    class Program(dict):
        def draw_mesh_tasks(self, count):
            calls.append((self["first_group"], count))

    chunk = SimpleNamespace(n_fiblets=90_000_000, bind_storage=lambda: None)
    pipeline._draw(None, Program(), chunk, SimpleNamespace(clustered=False))
    groups = -(-90_000_000 // TASK_FIBLETS)
    assert [first for first, _ in calls] == list(range(0, groups, 65535))
    assert sum(count for _, count in calls) == groups
    assert len(calls) == 6
    assert pipeline.name == "mesh"


def test_emulation_replaces_one_page_only():
    """What the tests above do not run is this: assignments, without a decision."""
    source = read_shader("fiblets/mesh/outputs.glsl")
    for word in ("if", "for", "?"):
        assert not re.search(rf"(?m)^[^/\n]*(?<!\w){re.escape(word)}(?!\w)", source.replace("#if", ""))


FORMS = {"nv": "GL_NV_mesh_shader", "ext": "GL_EXT_mesh_shader"}


@pytest.mark.parametrize("form", FORMS)
def test_fragments_declare_primitives_in_the_form_that_the_driver_takes(monkeypatch, form):
    """Khronos' compiler wants `flat`, which Mesa refuses. OpenGL programs on NVIDIA name no extension there either."""
    sources = stages("together", ["DIRECTION", *(["MESH_EXT"] if form == "ext" else [])])
    sources = {f"{'fragment' if name == 'frag' else name}_shader": text for name, text in sources.items()}
    linked, calls = [], []

    def made(refuses):
        linked.clear()

        def link(self, given):
            linked.append(dict(given))
            if refuses(given["fragment_shader"]):
                raise moderngl.Error(f"refused {len(linked)}")

        monkeypatch.setattr(MeshProgram, "_link", link)
        monkeypatch.setattr(MeshProgram, "_active", lambda self: {})
        monkeypatch.setattr(MeshProgram, "_call", lambda self, *call: calls.append(call))
        return MeshProgram(SimpleNamespace(extensions=set()), sources, {}, nvidia=form == "nv")

    program = made(lambda text: False)
    assert linked == [sources]
    calls.clear()
    program.draw_mesh_tasks(7)
    assert calls[-1] == (("glDrawMeshTasksNV", 0, 7) if form == "nv" else ("glDrawMeshTasksEXT", 7, 1, 1))
    made(lambda text: "flat perprimitive" in text or "GL_NV_mesh_shader : enable" in text)
    strict, lax = (given.pop("fragment_shader") for given in linked)
    assert linked[0] == linked[1]
    assert strict == sources["fragment_shader"]
    word = f"#define VARYING {{}}perprimitive{form.upper()} in"
    assert word.format("flat ") in strict
    assert word.format("") in lax
    assert "#extension GL_EXT_mesh_shader : require" in lax, "Mesa wants it"
    with pytest.raises(moderngl.Error, match="refused 2"):
        made(lambda text: True)


@pytest.mark.parametrize(
    ("has", "compiles", "taken"),
    [
        (["nv"], ["nv"], ["nv"]),
        (["ext"], ["ext"], ["ext"]),
        (["nv", "ext"], ["nv", "ext"], ["ext"]),
        (["nv", "ext"], ["nv"], ["ext", "nv"]),
        (["nv", "ext"], [], ["ext", "nv"]),
        (["ext"], [], ["ext"]),
    ],
)
def test_the_form_of_stages_is_one_that_the_driver_has_and_compiles(has, compiles, taken):
    tried = []

    class Driven:
        def render(self, files, features):
            form = "ext" if "MESH_EXT" in features else "nv"
            tried.append(form)
            if form not in compiles:
                raise EngineError(f"{form} does not link")
            return form

    pipeline = made([FORMS[form] for form in has])
    pipeline._programs = Driven()
    pipeline._features = lambda request: [*pipeline.features]
    request = SimpleNamespace(wide=())
    if compiles:
        assert pipeline._program(request, ()) == taken[-1]
        assert tried == taken
        assert pipeline._program(request, ()) == taken[-1]
        assert tried == [*taken, taken[-1]], "what was refused is not tried again"
    else:
        with pytest.raises(EngineError, match=f"{taken[-1]} does not link"):
            pipeline._program(request, ())
        assert tried == taken
