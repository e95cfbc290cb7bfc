"""Limits of 2^31 bytes, 2^32 points and 65,535 work groups: crossed in numbers, or in pictures with smaller limits."""

import itertools

import numpy as np
import pytest

from pvfiblets.codec import layout
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import upload
from pvfiblets.engine.fiblets.data.chunks import CHUNK_BLOCK, plan_chunks, storage_buffer
from pvfiblets.engine.fiblets.pipelines import CONSTANTS, compute, limits
from pvfiblets.engine.fiblets.pipelines.compute import ARGUMENT_BYTES, CLASSES, ROUNDS
from pvfiblets.engine.gl import passes, shaders
from pvfiblets.engine.gl.bindings import BLOCKS
from pvfiblets.engine.gl.shaders import assemble
from pvfiblets.engine.gl.work_limits import WorkLimits
from tests.drivers import MESH

from .imagined import imagined
from .pictures import SIZE, assert_same, draw, read

ONE_PAGE = 12 * layout.PAGE + 4
"""Bytes of the largest buffer of a chunk of one page of short fiblets."""


@pytest.mark.few(5)
@pytest.mark.parametrize("buffer_bytes", [limits.LARGEST, 2**27, 2**21])
@pytest.mark.parametrize("codes_and_points", [(58, 60), (0, 1), (0, 2), (256, 60)])
def test_chunks_of_sets_beyond_32_bits(buffer_bytes, codes_and_points):
    """2^33 points, or as many bytes: every chunk within the limit, what shaders count within 32 bits, none left out."""
    codes, points = codes_and_points
    n = 2**33 // max(codes_and_points) + 12345
    if codes_and_points[0] == 0:
        n = 2**29 + 12345  # small fiblets: more bytes of records than 2^32
    whole = imagined(n, codes, points)
    if buffer_bytes == 2**21 and codes == 256:
        with pytest.raises(EngineError, match=r"page 0 of the fiblets needs a buffer of 4194312 bytes; .* to 2097152"):
            plan_chunks(whole, buffer_bytes)
        return
    plans = plan_chunks(whole, buffer_bytes)
    assert sum(plan.nbytes for plan in plans) > 2**32
    for column, total in (("fiblets", n), ("codes", codes * n), ("points", points * n)):
        stretches = [getattr(plan, column) for plan in plans]
        assert stretches[0][0] == 0
        assert stretches[-1][1] == total
        assert all(a[1] == b[0] for a, b in itertools.pairwise(stretches))
        assert all(b - a < 2**32 for a, b in stretches)
    assert all(max(plan.values, *plan.sizes.values()) <= buffer_bytes for plan in plans)
    middle = plans[len(plans) // 2]
    table = next(iter(upload._pages(whole, middle, (0, 0))))
    expected = whole.pages[slice(*middle.pages)].astype(object)
    assert table.dtype == np.uint32
    assert (table[:, 1].astype(object) == expected[:, 1] - middle.codes[0]).all()
    assert (table[:, 2].astype(object) == expected[:, 2] - middle.points[0]).all()
    assert (table[:, 0] == expected[:, 0]).all()


def test_no_buffer_is_so_large_that_shaders_could_miscount(gl, monkeypatch):
    """Whatever a driver allows: beyond 2^31 bytes of codes a chunk might have more than 2^32 points."""
    monkeypatch.setattr(limits.GLExtras, "get_integer", lambda self, name: 2**32 - 1)
    for pipeline in ("compute", "mesh", "tessellation", "geometry"):
        asked = limits.Limits.from_context(gl, limits.GLExtras(gl), pipeline, None, None)
        assert asked.buffer_bytes == limits.LARGEST < 2**31
    # Of N points a fiblet has N - 2 bytes of codes or more, and 12 of its record: two points without codes are worst.
    for points in range(1, 61):
        fiblets = min(limits.LARGEST // 12, limits.LARGEST // max(points - 2, 1))
        assert fiblets * points < 2**32


def test_a_streamline_may_begin_long_before_its_chunk(gl):
    """Points before a chunk are counted over the whole set; shaders get 32 bits of them, or an error says so."""
    n = 80_000_000
    whole = imagined(n, 58, 60, streamlines=1)
    plans = plan_chunks(whole, 2**31 - 4)
    assert upload._points_before(whole, plans[1].fiblets[0]) == plans[1].points[0] > 2**30
    late = next(p for p in plan_chunks(whole, 2**27) if p.points[0] >= 2**32)
    with pytest.raises(EngineError, match=rf"fiblet {late.fiblets[0]} is {late.points[0]} points into its streamline"):
        upload.upload_chunk(gl, whole, late)


@pytest.mark.parametrize("bits", [8, 16])
def test_codes_of_values_are_found_beyond_as_many_bits_as_a_number_has(gl, monkeypatch, bits):
    """The word and the place in it of point 2^32 / bits and of others, in a chunk of 2^31 points."""
    stub = "uint asked;\nuint value_word(uint index) { asked = index; return 0x76543210u; }\n"
    honest = shaders.read_shader
    monkeypatch.setattr(
        shaders, "read_shader", lambda name: stub if name == "fiblets/data/values.glsl" else honest(name)
    )
    source = """
    #version 430
    layout(local_size_x = 1) in;
    #include "fiblets/decode/sequential.glsl"
    #include "fiblets/attributes/streamline_index.glsl"
    #include "fiblets/attributes/values.glsl"
    layout(std430, binding = 5) buffer Out { uint found[]; };
    uniform uint first;
    void main() {
        values_first = first + gl_WorkGroupID.x;
        values_last = 60u;
        found[2u * gl_WorkGroupID.x + 1u] = value_code(3u);
        found[2u * gl_WorkGroupID.x] = asked;
    }
    """.replace("\n    ", "\n")
    program = gl.compute_shader(assemble("values", ["DIRECTION", "VALUES_STORED"], CONSTANTS, source=source))
    chunk, out = gl.buffer(bytes(CHUNK_BLOCK.nbytes)), storage_buffer(gl, np.zeros(16, np.uint32), "out")
    CHUNK_BLOCK.write(chunk, value_bits=bits)
    chunk.bind_to_uniform_block(BLOCKS["Chunk"])
    out.bind_to_storage_buffer(5)
    digits = 0x76543210
    for first in (0, 2**27 - 3, 2**28 - 5, 2**29 - 5, 2**31 - 8):
        program["first"] = first
        program.run(8)
        gl.memory_barrier()
        found = np.frombuffer(out.read(64), np.uint32).reshape(8, 2)
        points = first + 3 + np.arange(8)
        per = 32 // bits
        assert found[:, 0].tolist() == (points // per).tolist()
        assert found[:, 1].tolist() == [digits >> int(p % per) * bits & (1 << bits) - 1 for p in points]
    for thing in (program, chunk, out):
        thing.release()


# ----------------------------------------------------------------------------------------------------- work groups


def test_more_groups_than_an_axis_has_are_folded(gl):
    """More than 65,535 groups, of which every number comes once."""
    source = """
    #version 430
    layout(local_size_x = 1) in;
    #include "frame/groups.glsl"
    layout(std430, binding = 5) buffer Out { uint found[]; };
    void main() { atomicAdd(found[group_index()], 1u); }
    """.replace("\n    ", "\n")
    program = gl.compute_shader(assemble("groups", (), {}, source=source))
    for groups, most in ((65_536, 65_535), (65_535, 65_535), (200_001, 65_535), (77, 10), (1, 1)):
        out = storage_buffer(gl, np.zeros(4 * groups + 4 * 65_536, np.uint32), "out")
        out.bind_to_storage_buffer(5)
        passes.dispatch(program, groups, most)
        gl.memory_barrier()
        found = np.frombuffer(out.read(), np.uint32)
        assert (found[:groups] == 1).all()
        assert found.sum() < groups + most
        out.release()
    program.release()
    with pytest.raises(EngineError, match="101 work groups are more than 10 x 10"):
        passes.dispatch(program, 101, 10)


def indirect(made):
    """Of each chunk, (rounds * classes, slots, 4) arguments of indirect dispatches: groups along x, y and z, and 0."""
    buffer, found = made._pipeline.buffers["visibility_bits"], []
    for marks in made._pipeline._marks:
        size = ROUNDS * CLASSES * marks.slots * ARGUMENT_BYTES
        words = np.frombuffer(buffer.read(size, offset=marks.arguments_at(0, 0)), "<u4")
        found.append(words.reshape(-1, marks.slots, 4))
    return found


@pytest.fixture(scope="module")
def several_pages(fabricate, random_lines):
    """Short fiblets in four pages; streamlines of up to 600 fiblets run across their borders."""
    lines = [*random_lines(700, seed=12, longest=230), *random_lines(12, seed=3, longest=1200)]
    fiblets = fabricate(lines, kind=2, per_fiblet=2)
    assert len(fiblets.pages) >= 4
    begins = layout.unpack("begin", fiblets.anchors[layout.PAGE :: layout.PAGE])
    assert not begins.all(), "a streamline runs across a page's border"
    return fiblets


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("name", ["compute", "tessellation", "geometry", *MESH])
@pytest.mark.parametrize("culling", ["two-phase", None])
def test_pictures_do_not_depend_on_limits(gl, several_pages, camera, name, culling):
    """A chunk for every page, few work groups an axis: every byte of the pictures, camera turning, is the same."""
    whole = FibletRenderer(gl, several_pages, pipeline=name, culling=culling)
    pieces = FibletRenderer(
        gl, several_pages, pipeline=name, culling=culling, max_buffer_bytes=ONE_PAGE + 12, max_groups=16
    )
    assert (len(whole._chunks), len(pieces._chunks)) == (1, len(several_pages.pages) - 1)
    for eye, style in (
        ((0, -260, 60), FibletStyle()),
        ((40, -250, 60), FibletStyle()),
        ((0, -60, 10), FibletStyle(tolerance=0.0)),
        ((0, -60, 10), FibletStyle(3.0)),
        ((0, 160, 10), FibletStyle(3.0)),
    ):
        view = View(SIZE, camera(SIZE, eye=eye))
        assert_same(read(pieces.render(view, style)), read(whole.render(view, style)))
    if name == "compute":
        assert any((slots[:, 1, 0] > 0).any() for slots in indirect(pieces)), "lists too should be cut"
        assert all(slots[..., 0].max() <= 16 for slots in indirect(pieces))
        assert [slots.shape[1] for slots in indirect(whole)] == [1]
    whole.release()
    pieces.release()


def test_lists_are_cut_into_calls_of_few_fiblets(gl, several_pages, camera, monkeypatch):
    """One chunk, drawn by many calls: no picture shows it, and no call has more fiblets than it may have."""
    pictures = []
    for most in (1 << 31, 1000):
        few = WorkLimits(1 << 20, 1 << 62, most)
        monkeypatch.setattr(WorkLimits, "from_context", classmethod(lambda cls, ctx, few=few: few))
        made = FibletRenderer(gl, several_pages)
        views = [View(SIZE, camera(SIZE, eye=eye)) for eye in ((0, -260, 60), (40, -250, 60), (0, -60, 10))]
        pictures.append([read(made.render(view, FibletStyle())) for view in views])
        slots = indirect(made)[0]
        assert len(made._chunks) == 1
        assert slots.shape[1] == (1 if most > 1000 else -(-made._fiblets.n_fiblets // 768))
        made.release()
    assert slots[..., 0].max() == 1000 // 256
    for one, other in zip(*pictures, strict=True):
        assert_same(one, other)


@pytest.mark.parametrize("share", [8, 100_000])
def test_pictures_do_not_depend_on_the_room_of_lists(gl, several_pages, camera, monkeypatch, share):
    """Where fiblets do not fit into a list, groups go through the bits."""
    view, style = View(SIZE, camera(SIZE, eye=(0, -260, 60))), FibletStyle()
    expected = draw(gl, several_pages, view, style, culling=None)
    monkeypatch.setitem(CONSTANTS, "list_share", share)
    monkeypatch.setattr(compute, "LIST_SHARE", share)
    made = FibletRenderer(gl, several_pages)
    made.render(View(SIZE, camera(SIZE, eye=(40, -250, 60))), style)
    assert_same(read(made.render(view, style)), expected)
    made.release()


def test_one_work_group_an_axis_less_is_an_error(gl, several_pages, camera):
    made = FibletRenderer(gl, several_pages, max_groups=15)
    with pytest.raises(EngineError, match="240 work groups are more than 15 x 15"):
        made.render(View(SIZE, camera(SIZE)))
    made.release()


@pytest.mark.more
def test_streamlines_through_many_chunks_keep_their_places(gl, fabricate, camera):
    """One streamline of 49,000 points in three chunks: a pixel's place is that of the point nearest to it."""
    s = np.linspace(0.0, 1.0, 49_152)
    line = 60.0 * np.stack(
        [np.cos(40 * s) * (0.3 + 0.7 * s), np.zeros_like(s), np.sin(40 * s) * (0.3 + 0.7 * s)], axis=1
    )
    fiblets = fabricate([line], kind=2, per_fiblet=1)
    assert len(fiblets.pages) == 4
    view = View(SIZE, camera(SIZE))
    picture = draw(gl, fiblets, view, FibletStyle(values="arc_length", tolerance=0.0), max_buffer_bytes=ONE_PAGE + 12)
    rows, columns = np.nonzero(picture.drawn)
    assert len(rows) > 1000
    clip = np.concatenate([fiblets.lines[0], np.ones((len(s), 1))], axis=1) @ view.model_view_projection.T
    pixels = (clip[:, :2] / clip[:, 3:] + 1.0) / 2.0 * SIZE
    place = picture.position[rows, columns, 0]
    off = np.linalg.norm(pixels[np.rint(place).astype(int)] - np.stack([columns, rows], axis=1) - 0.5, axis=1)
    assert off.max() < 1.5
    assert place.max() > 48_000
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fiblets.lines[0], axis=0), axis=1))])
    assert np.abs(np.interp(place, np.arange(len(s)), lengths) - picture.position[rows, columns, 1]).max() < 0.01
