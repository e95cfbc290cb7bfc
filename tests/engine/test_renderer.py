"""Pictures: against OpenGL's own lines, and against a dense float64 sampling of the polylines."""

from __future__ import annotations

from itertools import pairwise

import moderngl
import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletRenderer, Style, View, passes, shaders

SIZE = (320, 240)
EMPTY = 0xFFFFFFFF


def read(gbuffer):
    """Depth keys (h, w), ids (h, w, 2), position (h, w, 2), owner (h, w)."""
    w, h = gbuffer.size
    get = lambda texture, dtype: np.frombuffer(texture.read(), dtype).reshape(h, w, -1)  # noqa: E731
    return (
        get(gbuffer.depth, "<u4")[..., 0],
        get(gbuffer.ids, "<u4"),
        get(gbuffer.position, "<f4"),
        get(gbuffer.owner, "<u4")[..., 0],
    )


def draw(gl, fiblets, matrix, *, size=SIZE, style=None, **limits):
    renderer = FibletRenderer(gl, fiblets, **limits)
    try:
        picture = read(renderer.render(View(size, matrix), style or Style()))
    finally:
        renderer.release()
    depth, ids, position, owner = picture
    drawn = depth != EMPTY
    assert (depth[drawn] <= 0xFFFFFEFF).all()
    assert (owner[drawn] != EMPTY).all(), "a pixel has a depth but no owner"
    assert (owner[~drawn] == EMPTY).all()
    assert np.isfinite(position[drawn]).all()
    return depth, ids, position


def gl_lines(gl, lines, matrix, size, *, points=False):
    """What OpenGL draws for GL_LINES of the same vertices: mask and depth, row 0 at the bottom."""
    program = gl.program(
        vertex_shader="""#version 330
        in vec3 p; uniform mat4 m; void main() { gl_Position = m * vec4(p, 1.0); }""",
        fragment_shader="#version 330\nout vec4 c; void main() { c = vec4(1.0); }",
    )
    if points:
        vertices = np.concatenate([line for line in lines if len(line) == 1])
    else:
        vertices = np.concatenate([np.repeat(line, 2, axis=0)[1:-1] for line in lines])
    program["m"].write(matrix.T.astype("<f4").tobytes())
    buffer = gl.buffer(vertices.astype("<f4").tobytes())
    array = gl.vertex_array(program, [(buffer, "3f", "p")])
    colour, depth = gl.renderbuffer(size), gl.depth_texture(size)
    target = gl.framebuffer([colour], depth)
    before = gl.detect_framebuffer()
    target.use()
    gl.enable_only(moderngl.DEPTH_TEST)
    target.clear(depth=1.0)
    array.render(moderngl.POINTS if points else moderngl.LINES)
    mask = np.frombuffer(target.read(components=1), np.uint8).reshape(size[1], size[0]) > 0
    z = np.frombuffer(depth.read(), "<f4").reshape(size[1], size[0])
    before.use()  # a released framebuffer must not stay bound
    for thing in (array, buffer, program, target, colour, depth):
        thing.release()
    return mask, z


def near(mask, radius=1):
    """Pixels at most that many pixels away from the mask."""
    grown = np.zeros_like(mask)
    padded = np.pad(mask, radius)
    for dy in range(2 * radius + 1):
        for dx in range(2 * radius + 1):
            grown |= padded[dy : dy + mask.shape[0], dx : dx + mask.shape[1]]
    return grown


def inside_part(a, b):
    """Range of t in which a + t (b - a) is inside the view volume: intersects the six half-lines of t."""
    low, high = 0.0, 1.0
    for axis in range(3):
        for sign in (-1.0, 1.0):
            da, db = a[3] + sign * a[axis], b[3] + sign * b[axis]
            if da < 0 and db < 0:
                return None
            if da * db < 0:
                low, high = (max(low, da / (da - db)), high) if da < 0 else (low, min(high, da / (da - db)))
    return (low, high) if low <= high else None


def sampled(lines, matrix, size, per_pixel=16):
    """Independent reference: points along all polylines in float64: window x, y, depth, streamline, place."""
    rows = []
    for streamline, line in enumerate(lines):
        clip = np.concatenate([line, np.ones((len(line), 1))], axis=1) @ matrix.T
        if len(line) == 1:
            rows.append(np.array([[*clip[0], streamline, 0.0]]))
        for i in range(len(line) - 1):
            a, b = clip[i], clip[i + 1]
            t = inside_part(a, b)
            if t is None:
                continue
            ends = [a + t[0] * (b - a), a + t[1] * (b - a)]
            span = np.abs((ends[0] / ends[0][3] - ends[1] / ends[1][3])[:2] * size).max() / 2
            s = np.linspace(0.0, 1.0, int(max(span, 1.0) * per_pixel) + 2)[:, None]
            w0, w1 = ends[0][3], ends[1][3]  # evenly in the window, not along the line
            t = t[0] + (t[1] - t[0]) * s * w0 / ((1 - s) * w1 + s * w0)
            c = a + t * (b - a)
            rows.append(np.concatenate([c, np.full_like(t, streamline), i + t], axis=1))
    rows = np.concatenate(rows)
    w = rows[:, 3]
    rows = rows[(np.abs(rows[:, :3]) <= w[:, None] * (1 + 1e-9)).all(1) & (w > 0)]
    window = (rows[:, :3] / rows[:, 3:4] + 1) / 2
    window[:, :2] *= size
    return np.concatenate([window, rows[:, 4:]], axis=1)


def unpacked_tangent(word):
    u, v = (word & 0xFFFF).astype(np.uint16).view(np.int16), (word >> 16).astype(np.uint16).view(np.int16)
    u, v = u / 32767.0, v / 32767.0
    x = 1 - abs(u) - abs(v)
    sign = lambda s: np.where(s < 0, -1.0, 1.0)  # noqa: E731
    y = np.where(x >= 0, u, (1 - abs(v)) * sign(u))
    z = np.where(x >= 0, v, (1 - abs(u)) * sign(v))
    d = np.stack([x, y, z], axis=-1)
    return d / np.linalg.norm(d, axis=-1, keepdims=True)


def assert_like_samples(picture, lines, matrix, size, *, radius=1.5, share=0.999):
    """Each pixel drawn shows a polyline point near it, and each polyline point has a pixel near it."""
    depth, ids, position = picture
    samples = sampled(lines, matrix, size)
    drawn = depth != EMPTY
    cells = samples[:, :2].astype(int).clip(0, np.array(size) - 1)
    touched = np.zeros(drawn.shape, bool)
    touched[cells[:, 1], cells[:, 0]] = True
    assert near(touched)[drawn].mean() >= share
    assert near(drawn)[touched].mean() >= share
    # what a pixel says it shows projects back to it, at its depth
    rows, columns = np.nonzero(drawn)
    pick = np.random.default_rng(0).permutation(len(rows))[:2000]
    rows, columns = rows[pick], columns[pick]
    streamline, place = ids[rows, columns, 0], position[rows, columns, 0].astype(float)
    points, tangents = [], []
    for s, p in zip(streamline, place, strict=True):
        line = lines[s]
        i = min(int(p), max(len(line) - 2, 0))
        j = min(i + 1, len(line) - 1)
        points.append(line[i] + (p - i) * (line[j] - line[i]))
        tangents.append(line[j] - line[i])
    clip = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ matrix.T
    window = (clip[:, :3] / clip[:, 3:] + 1) / 2
    away = np.linalg.norm(window[:, :2] * size - np.stack([columns, rows], axis=1) - 0.5, axis=1)
    assert away.max() <= radius
    assert np.abs(window[:, 2] - depth[rows, columns] / 4294967295.0).max() < 2e-4
    tangents = np.array(tangents)
    lengths = np.linalg.norm(tangents, axis=1)
    along = (unpacked_tangent(ids[rows, columns, 1]) * tangents).sum(1)[lengths > 0] / lengths[lengths > 0]
    # at a joint either neighbour's tangent is right
    assert np.mean(along > 1 - 1e-5) > 0.99


@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_agrees_with_opengl_lines(gl, fabricate, random_lines, camera, parallel):
    size = (640, 480)
    fiblets = fabricate([line for line in random_lines(120) if len(line) > 1], kind=2)
    matrix = camera(size, height=120 if parallel else None)
    depth, *_ = draw(gl, fiblets, matrix, size=size)
    mask, z = gl_lines(gl, fiblets.lines, matrix, size)
    drawn = depth != EMPTY
    assert drawn.sum() > 5000
    assert near(mask)[drawn].mean() >= 0.99
    assert near(drawn)[mask].mean() >= 0.99
    both = drawn & mask
    assert both.sum() > 0.7 * drawn.sum()
    assert np.median(np.abs(depth[both] / 4294967295.0 - z[both])) < 1e-4  # a fraction of a pixel along
    # thin lines are thin: not more pixels than OpenGL's own, but for joints
    assert drawn.sum() < 1.1 * mask.sum()


@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
@pytest.mark.parametrize("kind", [1, 2, 3])
def test_pixels_say_what_they_show(gl, fabricate, random_lines, camera, kind, parallel):
    fiblets = fabricate(random_lines(60, seed=kind), kind=kind)
    matrix = camera(SIZE, height=150 if parallel else None)
    assert_like_samples(draw(gl, fiblets, matrix), fiblets.lines, matrix, SIZE)


def test_camera_inside_the_data(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(150, seed=5), kind=2)
    matrix = camera(SIZE, eye=(3, -2, 1), target=(30, 10, 0), near=0.05, far=200.0, angle=80.0)
    picture = draw(gl, fiblets, matrix)
    assert (picture[0] != EMPTY).sum() > 1000
    assert_like_samples(picture, fiblets.lines, matrix, SIZE, share=0.99)


def test_lines_far_longer_than_the_screen(gl, fabricate, camera):
    lines = [np.array([[-3e4, -5.0, 3.0], [4e4, 12.0, -8.0]]), np.array([[0.0, -900.0, 0.0], [1.0, 4e4, 1.0]])]
    fiblets = fabricate(lines, kind=3, low=True)
    matrix = camera(SIZE)
    assert_like_samples(draw(gl, fiblets, matrix), fiblets.lines, matrix, SIZE)


def test_a_million_millimetres_away(gl, fabricate, random_lines, camera):
    offset = np.array([1e6, -2e6, 3e6])
    lines = random_lines(40, seed=7)
    here = fabricate(lines, kind=2)
    there = fabricate([line + offset for line in lines], kind=2)
    matrix = camera(SIZE)
    shift = np.eye(4)
    shift[:3, 3] = -(there.origin - here.origin)
    a, b = draw(gl, here, matrix), draw(gl, there, matrix @ shift)
    same = (a[0] == EMPTY) == (b[0] == EMPTY)
    assert same.mean() > 0.999
    assert_like_samples(b, there.lines, matrix @ shift, SIZE)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scales(gl, fabricate, random_lines, camera, scale):
    lines = random_lines(40, seed=8)
    fiblets = fabricate([line * scale for line in lines], kind=2)
    matrix = camera(SIZE) @ np.diag([1 / scale, 1 / scale, 1 / scale, 1.0])
    assert_like_samples(draw(gl, fiblets, matrix), fiblets.lines, matrix, SIZE)


def test_fine_anchors_keep_their_digits_in_a_close_view(gl, fabricate, camera):
    """Ten micrometres of a 2 km data set, seen from close by: float32 alone would be 100 um off."""
    t = np.linspace(0, 1e-2, 30)
    close = np.stack([t, 0.003 * np.sin(t * 1500), 0 * t], axis=1) + 1000.0
    fiblets = fabricate([np.zeros((1, 3)), close, np.full((1, 3), 2000.0)], kind=2, low=True, lattice=2e-5)
    size, target = (200, 200), np.array([1000.005, 1000.0, 1000.0])
    matrix = camera(
        size, eye=target + np.array([0, 0, 0.03]), target=target, up=(0, 1, 0), near=1e-3, far=1.0, angle=20.0
    )
    picture = draw(gl, fiblets, matrix, size=size)
    assert (picture[0] != EMPTY).sum() > 150
    assert_like_samples(picture, fiblets.lines, matrix, size)


def test_one_point_streamlines_are_dots(gl, fabricate, camera):
    points = np.random.default_rng(3).uniform(-40, 40, (50, 3))
    fiblets = fabricate(points[:, None, :], kind=1)
    matrix = camera(SIZE)
    depth, _, position = draw(gl, fiblets, matrix)
    clip = np.concatenate([np.concatenate(fiblets.lines), np.ones((50, 1))], axis=1) @ matrix.T
    cells = ((clip[:, :2] / clip[:, 3:] + 1) / 2 * SIZE).astype(int)
    assert (depth[cells[:, 1], cells[:, 0]] != EMPTY).all()
    assert (depth != EMPTY).sum() == len(np.unique(cells, axis=0))
    assert (position[depth != EMPTY][:, 0] == 0).all()
    wide, *_ = draw(gl, fiblets, matrix, style=Style(line_width=7.0))
    area = (wide != EMPTY).sum() / (depth != EMPTY).sum()
    assert 0.8 * np.pi * 3.5**2 < area < 1.1 * np.pi * 3.5**2


def test_polylines_have_no_gaps(gl, fabricate, camera):
    """Whatever the step: a circle drawn with steps from a fraction of a pixel to many is one closed curve."""
    for n in (7, 100, 900, 5000):
        a = np.linspace(0, 2 * np.pi, n + 1)
        fiblets = fabricate([np.stack([60 * np.cos(a), 0 * a, 60 * np.sin(a)], axis=1)], kind=3)
        depth, *_ = draw(gl, fiblets, camera(SIZE, eye=(0, -260, 0)))
        drawn = depth != EMPTY
        # flooding the outside must not reach the middle
        outside = np.zeros_like(drawn)
        outside[0, 0] = True
        while True:
            grown = outside | np.roll(outside, 1, 0) | np.roll(outside, -1, 0)
            grown |= np.roll(outside, 1, 1) | np.roll(outside, -1, 1)
            grown &= ~drawn
            if (grown == outside).all():
                break
            outside = grown
        assert not outside[SIZE[1] // 2, SIZE[0] // 2], f"{n} steps leave a gap"


@pytest.mark.parametrize("width", [1.5, 3.0, 8.0])
def test_wide_lines(gl, fabricate, camera, width):
    """All pixels whose centre is at most half the width away, and no others."""
    rng = np.random.default_rng(4)
    line = np.cumsum(rng.normal(0, 1, (40, 3)) * [9, 1, 6], axis=0)
    fiblets = fabricate([line - line.mean(0)], kind=3)
    matrix = camera(SIZE)
    depth, *_ = draw(gl, fiblets, matrix, style=Style(line_width=width))
    clip = np.concatenate([fiblets.lines[0], np.ones((40, 1))], axis=1) @ matrix.T
    window = (clip[:, :2] / clip[:, 3:] + 1) / 2 * SIZE
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    nearest = np.full(x.shape, np.inf)
    for a, b in pairwise(window):
        run = b - a
        t = np.clip(((x - a[0]) * run[0] + (y - a[1]) * run[1]) / (run @ run), 0, 1)
        nearest = np.minimum(nearest, np.hypot(x - a[0] - t * run[0], y - a[1] - t * run[1]))
    drawn = depth != EMPTY
    assert drawn[nearest < width / 2 - 0.01].all()
    assert not drawn[nearest > width / 2 + 0.01].any()


@pytest.mark.parametrize("width", [2.0, 12.0, 25.0, 60.0])
def test_no_width_loses_pieces(gl, fabricate, random_lines, camera, width):
    """Software OpenGL leaves loops that run long: what a thin line shows, a wide one must."""
    fiblets = fabricate(random_lines(150, seed=6), kind=2)
    matrix = camera(SIZE)
    thin = draw(gl, fiblets, matrix)[0] != EMPTY
    wide = draw(gl, fiblets, matrix, style=Style(width))
    assert near(wide[0] != EMPTY)[thin].all()
    again = draw(gl, fiblets, matrix, style=Style(width))
    drawn = wide[0] != EMPTY
    assert (again[0] == wide[0]).all()
    assert (again[1] == wide[1])[drawn].all()
    assert (again[2] == wide[2])[drawn].all()


def test_wide_lines_in_a_close_view(gl, fabricate, camera):
    """Segments of a hundred pixels, in all fiblets of one group."""
    rng = np.random.default_rng(2)
    lines = [np.cumsum(rng.normal(0, 1, (60, 3)), axis=0) for _ in range(200)]
    fiblets = fabricate([line - line.mean(0) for line in lines], kind=2)
    matrix = camera(SIZE, eye=(0, -8, 0), near=0.5, far=60.0)
    thin = draw(gl, fiblets, matrix)[0] != EMPTY
    assert near(draw(gl, fiblets, matrix, style=Style(9.0))[0] != EMPTY)[thin].all()


def test_a_width_beyond_software_opengl_is_told(gl, fabricate, random_lines, camera):
    if "llvmpipe" not in gl.info["GL_RENDERER"]:
        pytest.skip("hardware draws any width")
    with pytest.raises(EngineError, match="at most 100"):
        draw(gl, fabricate(random_lines(5), kind=2), camera(SIZE), style=Style(400.0))


def test_wide_lines_reach_in_from_outside(gl, fabricate, camera):
    """A wide line just off the screen shows its edge."""
    size, matrix = (200, 100), camera((200, 100), height=100.0)
    x = 102.2  # window x = 202.2, and the last pixel's centre is at 199.5
    fiblets = fabricate([np.array([[x, 0.0, -30.0], [x, 0.0, 30.0]])], kind=3)
    assert (draw(gl, fiblets, matrix, size=size)[0] == EMPTY).all()
    drawn = draw(gl, fiblets, matrix, size=size, style=Style(line_width=6.0))[0] != EMPTY
    assert drawn[50].tolist() == [False] * 199 + [True]


def test_the_nearest_line_wins(gl, fabricate, camera):
    lines = [np.array([[-50.0, y, 1e-3 * i], [50.0, y, 1e-3 * i]]) for i, y in enumerate((5.0, -20.0, 30.0))]
    fiblets = fabricate(lines, kind=3)
    depth, ids, _ = draw(gl, fiblets, camera(SIZE, eye=(0, -260, 0)), style=Style(line_width=3.0))
    middle = np.nonzero(depth[:, SIZE[0] // 2] != EMPTY)[0]
    assert (ids[middle[1:-1], SIZE[0] // 2, 0] == 1).all()  # at the edges another may stand out


def test_ties_go_to_the_first_and_pictures_repeat(gl, fabricate, random_lines, camera):
    """Every line four times over: ties in every pixel, and still the same bytes every time."""
    lines = random_lines(60, seed=11)
    fiblets = fabricate(lines * 4, kind=2)
    matrix = camera(SIZE)
    first = draw(gl, fiblets, matrix)
    drawn = first[0] != EMPTY
    assert (first[1][drawn][:, 0] < 60).all()
    for _ in range(5):
        again = draw(gl, fiblets, matrix)
        assert (again[0] == first[0]).all()
        for a, b in zip(again[1:], first[1:], strict=True):
            assert (a[drawn] == b[drawn]).all()


def test_paging_changes_nothing(gl, fabricate, random_lines, camera):
    """40,000 short fiblets in three pages: one chunk, three chunks, and dispatches folded into rows."""
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2)
    assert fiblets.n_fiblets > 2 * 16384
    matrix = camera(SIZE)
    for style in (Style(), Style(2.5, "arc_length")):
        whole = draw(gl, fiblets, matrix, style=style)
        drawn = whole[0] != EMPTY
        renderer = FibletRenderer(gl, fiblets, max_buffer_bytes=12 * (16384 + 1), max_groups=9)
        assert len(renderer._chunks) == 3
        renderer.release()
        pieces = draw(gl, fiblets, matrix, style=style, max_buffer_bytes=12 * (16384 + 1), max_groups=16)
        assert (pieces[0] == whole[0]).all()
        assert (pieces[1][drawn] == whole[1][drawn]).all()
        assert np.abs(pieces[2] - whole[2])[drawn].max() < 1e-3


def test_culling_never_shows(gl, fabricate, random_lines, camera, monkeypatch):
    """A picture drawn by a cull pass that lets everything through is the same, byte for byte."""
    fiblets = fabricate(random_lines(300, seed=13), kind=2, per_fiblet=10)
    rng = np.random.default_rng(14)
    cases = []
    for i in range(12):
        eye = rng.uniform(-60, 60, 3)
        height = 40.0 if i % 3 == 0 else None
        matrix = camera(SIZE, eye=eye, target=eye + rng.normal(0, 1, 3), near=0.5, far=60.0, height=height)
        cases.append((View(SIZE, matrix), Style(line_width=1.0 if i % 2 else 9.0)))

    def pictures():
        renderer = FibletRenderer(gl, fiblets)
        for view, style in cases:
            picture = read(renderer.render(view, style))
            marks = np.frombuffer(renderer._pipeline.buffers["marks"].read(), np.uint32)
            plan = np.ascontiguousarray(marks[: len(marks) // 8 * 8].reshape(-1, 8)[:, :6]).view(np.uint8)
            yield picture, np.unpackbits(plan).sum() / fiblets.n_fiblets
        renderer.release()

    culled = list(pictures())
    test = "if (min(edges, depths) >= -radius) shown"
    assert test in shaders.read_shader("compute/cull.comp")
    honest = shaders.read_shader
    monkeypatch.setattr(shaders, "read_shader", lambda name: honest(name).replace(test, "shown"))
    for (a, share), (b, everything) in zip(culled, pictures(), strict=True):
        assert everything == 1.0
        assert share < 1.0
        assert (a[0] == b[0]).all()
        assert (a[1] == b[1])[a[0] != EMPTY].all()
    assert np.mean([share for _, share in culled]) < 0.5, "culling should spare work too"


def test_redraws_only_when_something_changed(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(20), kind=2)
    renderer = FibletRenderer(gl, fiblets)
    view = View(SIZE, camera(SIZE))
    first = renderer.render(view, Style())
    assert first.generation == 1
    assert renderer.render(View(SIZE, camera(SIZE)), Style()) is first
    assert first.generation == 1
    assert renderer.render(view, Style(line_width=2.0)).generation == 2
    assert renderer.render(View(SIZE, camera(SIZE, near=25.0)), Style(line_width=2.0)).generation == 3
    resized = renderer.render(View((100, 50), camera((100, 50))))
    assert resized.generation == 4
    assert resized.depth.size == (100, 50)
    renderer.release()


def test_explain_lists_only_what_is_used(gl, fabricate, random_lines, camera):
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    renderer.render(View(SIZE, camera(SIZE)))
    plain = renderer.explain()
    assert plain["features"] == ["LATTICE", "CLIPPING", "CLIPPING_DEPTH"]  # some lines leave the screen
    assert [p["name"] for p in plain["passes"]] == ["clear", "cull", "depth", "own", "attributes"]
    assert all(p["ms"] >= 0 for p in plain["passes"])
    names = {b["name"] for b in plain["buffers"]}
    assert not names & {"values", "starts", "anchors_low", "rank_to_id"}
    renderer.render(View(SIZE, camera(SIZE)), Style(2.0, "curvature"))
    rich = renderer.explain()
    assert rich["features"] == ["LATTICE", "WIDE_LINES", "CLIPPING", "CLIPPING_DEPTH", "VALUES_CURVATURE"]
    assert "starts" in {b["name"] for b in rich["buffers"]}
    renderer.render(View(SIZE, camera(SIZE)))
    assert renderer.explain()["features"] == plain["features"]
    assert renderer.explain()["buffers"] == plain["buffers"]
    renderer.release()


def test_timer_queries_are_read_where_opengl_is_hardware(gl, fabricate, random_lines, camera, monkeypatch):
    monkeypatch.setattr(passes, "is_software", lambda ctx: False)
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    for near_plane in (10.0, 20.0):
        renderer.render(View(SIZE, camera(SIZE, near=near_plane)))
        times = renderer.explain()["passes"]
        assert len(times) == 5
        assert all(0 <= p["ms"] < 1e5 for p in times)
    renderer.release()


def test_release_twice_and_use_after(gl, fabricate, random_lines, camera):
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    renderer.render(View(SIZE, camera(SIZE)))
    renderer.release()
    renderer.release()
    with pytest.raises(EngineError, match="released"):
        renderer.render(View(SIZE, camera(SIZE)))


def test_streamlines_without_points_keep_their_numbers(gl, fabricate, random_lines, camera):
    lines = random_lines(30, seed=15)
    ids = np.arange(30) * 2 + 5
    plain, numbered = fabricate(lines, kind=2), fabricate(lines, kind=2, rank_to_id=ids)
    a, b = draw(gl, plain, camera(SIZE)), draw(gl, numbered, camera(SIZE))
    drawn = a[0] != EMPTY
    assert (b[1][drawn][:, 0] == ids[a[1][drawn][:, 0]]).all()


def test_all_optional_buffers_at_once(gl, fabricate, random_lines, camera):
    """Fine anchors, numbered streamlines and a per-point value, in several chunks."""
    lines = random_lines(700, seed=12, longest=230)
    ids = np.arange(700) * 3 + 1
    plain = fabricate(lines, kind=2, per_fiblet=2)
    rich = fabricate(lines, kind=2, per_fiblet=2, low=True, rank_to_id=ids)
    style = Style(1.0, "arc_length")
    a = draw(gl, plain, camera(SIZE), style=style)
    b = draw(gl, rich, camera(SIZE), style=style, max_buffer_bytes=12 * (16384 + 1))
    same = (a[0] != EMPTY) & (b[0] != EMPTY)
    assert same.sum() > 0.95 * (a[0] != EMPTY).sum()
    agree = (b[1][..., 0] == ids[np.where(same, a[1][..., 0], 0)])[same]  # anchors differ by their rounding
    assert agree.mean() > 0.9
    assert (np.unique(b[1][same][:, 0]) % 3 == 1).all()


def test_limits_are_told(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(20), kind=2)
    with pytest.raises(EngineError, match="buffers are limited to 100"):
        FibletRenderer(gl, fiblets, max_buffer_bytes=100)
    with pytest.raises(EngineError, match="MB are available"):
        FibletRenderer(gl, fiblets, max_total_bytes=100)
    renderer = FibletRenderer(gl, fiblets)
    with pytest.raises(EngineError, match="largest texture"):
        renderer.render(View((10**6, 10), camera(SIZE)))
    with pytest.raises(EngineError, match="no per-point array 'fa'"):
        renderer.render(View(SIZE, camera(SIZE)), Style(values="fa"))
    renderer.render(View(SIZE, camera(SIZE)))  # and works after all of these
    renderer.release()
