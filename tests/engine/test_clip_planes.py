"""Clip planes of a view, against polylines cut in NumPy and against OpenGL's own clip distances."""

import re

import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.shaders import assemble

from .gl_lines import gl_lines
from .pictures import EMPTY, EVERY_POINT, SIZE, assert_same, differences, draw, near, read
from .polylines import DEPTH_ROUNDING, assert_pixels_name_places, places, to_clip, to_window
from .shader_programs import preprocessed


def box(half, centre=(0.0, 0.0, 0.0)):
    """Six planes around a box of data coordinates."""
    planes = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            planes.append([*normal, half - normal @ centre])
    return planes


def cut(lines, planes):
    """(m, 2, 3) ends of the kept pieces of polylines, in float64."""
    planes = np.asarray(planes, float).reshape(-1, 4)
    a, b = np.concatenate([line[:-1] for line in lines]), np.concatenate([line[1:] for line in lines])
    ha, hb = (points @ planes[:, :3].T + planes[:, 3] for points in (a, b))
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = ha / (ha - hb)
    t0 = np.where((ha < 0) & (hb >= 0), crossing, 0.0).max(axis=1, keepdims=True)
    t1 = np.where((ha >= 0) & (hb < 0), crossing, 1.0).min(axis=1, keepdims=True)
    kept = ~((ha < 0) & (hb < 0)).any(axis=1) & (t0 <= t1)[:, 0]
    return np.stack([a + t0 * (b - a), a + t1 * (b - a)], axis=1)[kept]


def shown_points(picture, lines):
    """The data position that every drawn pixel says it shows, with pixel rows and columns."""
    rows, columns = np.nonzero(picture.drawn)
    points, _, _ = places(lines, picture.ids[rows, columns, 0], picture.position[rows, columns, 0].astype(float))
    return points, rows, columns


def heights(planes, points):
    planes = np.asarray(planes, float)
    return (points @ planes[:, :3].T + planes[:, 3]) / np.linalg.norm(planes[:, :3], axis=1)


CUTS = {
    "a box": box(25.0),
    "one, towards the viewer": [(0.2, 1, -0.1, 0)],
    "one, away from the viewer": [(0, -3, 0, 5)],
    "one, edge on": [(0, 0, 1, 0)],
    "two that face the viewer": [(1, 1, 0.1, 5), (-1, 1, 0.2, 5)],
    "a thin slab": [(0, 1, 0, 1), (0, -1, 0, 1)],
    "a slab within one step": [(0, 1, 0, 0.05), (0, -1, 0, 0.05)],
    "eight": [*box(25.0), (1, 1, 1, 10), (-1, 1, -1, 10)],
}


@pytest.mark.few(1)
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
@pytest.mark.parametrize("name", CUTS)
def test_planes_cut_as_opengl_and_numpy_cut(gl, fabricate, random_lines, camera, name, parallel):
    planes = CUTS[name]
    fiblets = fabricate([line for line in random_lines(400, seed=1) if len(line) > 1], kind=2)
    matrix = camera(SIZE, eye=(120, -200, 110), height=130 if parallel else None)
    picture = draw(gl, fiblets, View(SIZE, matrix, planes))
    drawn = picture.drawn
    # OpenGL's own clipping. Its lines leave out an end pixel, which is all there is of very short pieces.
    mask, z = gl_lines(gl, fiblets.lines, matrix, SIZE, planes)
    assert near(drawn)[mask].mean() >= 0.99
    # NumPy's, sampled densely: all that is drawn is there, and all that is there is drawn.
    touched = np.zeros_like(drawn)
    a, b = cut(fiblets.lines, planes).swapaxes(0, 1)
    for t in np.linspace(0, 1, 40):
        clip = to_clip(a + t * (b - a), matrix)
        clip = clip[(np.abs(clip[:, :3]) <= clip[:, 3:]).all(axis=1)]
        cells = to_window(clip, SIZE)[:, :2].astype(int).clip(0, np.array(SIZE) - 1)
        touched[cells[:, 1], cells[:, 0]] = True
    assert near(touched)[drawn].mean() >= 0.999
    assert near(drawn)[touched].mean() >= 0.999
    both = drawn & mask
    assert np.median(np.abs(picture.window_depth - z)[both]) < 2e-4  # a fraction of a pixel along
    # Nothing shown lies beyond a plane.
    points, _, _ = shown_points(picture, fiblets.lines)
    assert heights(planes, points).min() > -2e-3
    assert_pixels_name_places(picture, fiblets.lines, matrix, SIZE, cut=True)


def test_what_is_behind_a_cut_shows_to_the_last_pixel(gl, fabricate, camera):
    """A curtain of lines behind another: where a box's corner cuts the first away, the second has no hole."""
    x = np.linspace(-60, 60, 400)
    lines = [np.c_[np.full(30, a), np.full(30, y), np.linspace(-60, 60, 30)] for y in (-10.0, 20.0) for a in x]
    fiblets = fabricate(lines, kind=3)
    matrix = camera(SIZE, eye=(0, -260, 0), height=100)
    planes = [(1, 1, 0, 0), (-1, 1, 0, 0)]  # a wedge that opens away from the viewer
    depth, ids, *_ = draw(gl, fiblets, View(SIZE, matrix, planes))
    columns = (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * 100 / SIZE[1]
    inside = np.abs(columns) < 19.5
    assert (depth[:, inside] != EMPTY).all()
    assert (ids[:, inside, 0] >= 400).all()
    assert (depth[:, np.abs(columns) > 20.6] == EMPTY).all()


def test_a_million_millimetres_away(gl, fabricate, random_lines, camera):
    offset = np.array([1e6, -2e6, 3e6])
    lines = [line for line in random_lines(60, seed=7) if len(line) > 1]
    here, there = fabricate(lines, kind=2), fabricate([line + offset for line in lines], kind=2)
    shift = np.eye(4)
    shift[:3, 3] = -(there.origin - here.origin)
    planes = np.array(box(25.0))
    a = draw(gl, here, View(SIZE, camera(SIZE), planes))
    b = draw(gl, there, View(SIZE, camera(SIZE) @ shift, planes @ shift))
    assert (a.drawn == b.drawn).mean() > 0.999
    assert heights(planes @ shift, shown_points(b, there.lines)[0]).min() > -2e-3


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scales(gl, fabricate, random_lines, camera, scale):
    fiblets = fabricate([line * scale for line in random_lines(60, seed=8) if len(line) > 1], kind=2)
    matrix = camera(SIZE) @ np.diag([1 / scale, 1 / scale, 1 / scale, 1.0])
    planes = np.array([(1.0, 1.0, 0.1, 5.0 * scale), (-1e-3, 1e-3, 0.0, 5e-3 * scale)])
    picture = draw(gl, fiblets, View(SIZE, matrix, planes))
    assert picture.drawn.sum() > 500
    mask, _ = gl_lines(gl, fiblets.lines, matrix, SIZE, planes)
    assert near(mask)[picture.drawn].mean() > 0.98
    assert heights(planes, shown_points(picture, fiblets.lines)[0]).min() > -2e-3 * scale


@pytest.mark.few(1)
@pytest.mark.parametrize("normal", [(0.0, 1.0, 0.0), (1.0, 0.2, 0.0)], ids=["across", "along the view"])
def test_plane_through_the_camera_inside_the_data(gl, fabricate, random_lines, camera, normal):
    eye = np.array([3.0, -2.0, 1.0])
    matrix = camera(SIZE, eye=eye, target=(3, 10, 1), near=0.05, far=200.0, angle=80.0)
    planes = [(*normal, -float(np.dot(normal, eye)))]
    fiblets = fabricate([line for line in random_lines(150, seed=5) if len(line) > 1], kind=2)
    for style in (EVERY_POINT, FibletStyle(4.0, tolerance=0.0)):
        picture = draw(gl, fiblets, View(SIZE, matrix, planes), style)
        whole = draw(gl, fiblets, View(SIZE, matrix), style)
        if normal[0] == 0.0:  # all that is in front of the camera is kept; what crosses the plane is clipped once more
            assert (picture.owner == whole.owner).all()
            assert np.abs(picture.window_depth - whole.window_depth).max() < DEPTH_ROUNDING
        else:
            assert 0.2 < picture.drawn.sum() / whole.drawn.sum() < 0.95
            assert heights(planes, shown_points(picture, fiblets.lines)[0]).min() > -2e-3


@pytest.mark.parametrize("planes", [[(0, 0, 1, -500)], [(0, 0, 0, -1)], [(1, 0, 0, -0.5), (-1, 0, 0, 0.4)]])
@pytest.mark.parametrize("width", [1.0, 5.0])
def test_planes_that_leave_nothing(gl, fabricate, random_lines, camera, planes, width):
    fiblets = fabricate(random_lines(40), kind=2)
    assert not draw(gl, fiblets, View(SIZE, camera(SIZE), planes), FibletStyle(width)).drawn.any()


def test_one_point_streamlines_are_cut_too(gl, fabricate, camera):
    points = np.random.default_rng(3).uniform(-40, 40, (80, 3))
    fiblets = fabricate(points[:, None, :], kind=1)
    _, ids, *_ = picture = draw(gl, fiblets, View(SIZE, camera(SIZE), [(1, 0, 0, 0)]))
    kept = {i for i, line in enumerate(fiblets.lines) if line[0, 0] >= 0}
    shown = set(ids[picture.drawn][:, 0].tolist())
    assert shown <= kept
    assert len(shown) > 0.9 * len(kept)


def test_planes_moved_live(gl, fabricate, random_lines, camera):
    """A renderer that a plane is dragged through shows what a fresh one shows."""
    fiblets = fabricate(random_lines(120, seed=9), kind=2)
    matrix = camera(SIZE)
    renderer = FibletRenderer(gl, fiblets)
    seen = []
    for step, height in enumerate([-20.0, -5.0, 0.0, 30.0, 0.0], 1):
        view = View(SIZE, matrix, [(0, 1, 0, height)])
        target = renderer.render(view)
        assert target.generation == step
        assert renderer.render(View(SIZE, matrix, [(0, 1, 0, height)])).generation == step
        fresh = draw(gl, fiblets, view, FibletStyle())
        assert_same(read(target), fresh)
        seen.append(fresh)
    assert differences(seen[0], seen[1])
    assert_same(read(renderer.render(View(SIZE, matrix))), draw(gl, fiblets, View(SIZE, matrix), FibletStyle()))
    renderer.release()


@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
@pytest.mark.parametrize("width", [3.0, 12.0])
def test_wide_lines_show_nothing_beyond_a_plane(gl, fabricate, random_lines, camera, width, parallel):
    """Against the position that a pixel and its depth stand for."""
    planes = np.array(CUTS["two that face the viewer"] + [(0, 0, 1, 4)], float)
    fiblets = fabricate(random_lines(150, seed=6), kind=2)
    matrix = camera(SIZE, height=130 if parallel else None)
    depth, *_ = wide = draw(gl, fiblets, View(SIZE, matrix, planes), FibletStyle(width, tolerance=0.0))
    thin = draw(gl, fiblets, View(SIZE, matrix, planes))
    assert near(wide.drawn)[thin.drawn].all()
    rows, columns = np.nonzero(depth != EMPTY)
    ndc = np.c_[(columns + 0.5) / SIZE[0], (rows + 0.5) / SIZE[1], depth[rows, columns] / 4294967295.0] * 2 - 1
    places = np.c_[ndc, np.ones(len(ndc))] @ np.linalg.inv(matrix).T
    found = heights(planes, places[:, :3] / places[:, 3:])
    assert found.min() > -5e-3
    assert (np.abs(found) < 0.5).sum() > 50, "brushes reach up to the planes"


def test_wide_lines_at_a_cut(gl, fabricate, camera):
    """A cut across a line is a straight edge; a line cut head-on shows its whole brush, however thin the slice."""
    across = fabricate([np.array([[-40.0, 0, 0.1], [40.0, 0, 0.1]])], kind=3)
    matrix = camera((200, 100), eye=(0, -260, 0), height=100.0)
    drawn = draw(gl, across, View((200, 100), matrix, [(-1, 0, 0, 20)]), FibletStyle(9.0)).drawn
    ends = [np.flatnonzero(row)[-1] for row in drawn if row.any()]
    assert len(ends) == 9
    assert set(ends) == {119}
    towards = fabricate([np.array([[0.1, -40.0, 0.1], [0.1, 40.0, 0.1]])], kind=3)
    disc = draw(gl, towards, View((200, 100), matrix, [(0, 1, 0, 0.1), (0, -1, 0, 0.1)]), FibletStyle(9.0)).drawn
    assert disc.sum() == pytest.approx(np.pi * 4.5**2, rel=0.1)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "style",
    [FibletStyle(), FibletStyle(6.0), FibletStyle(values="arc_length"), FibletStyle(2.0, values="curvature")],
)
def test_fiblets_apart_from_the_planes_are_drawn_as_ever(gl, fabricate, random_lines, camera, style):
    """Planes far away change no bit; a plane that keeps a part changes nothing in that part's own streamlines."""
    fiblets = fabricate(random_lines(150, seed=3), kind=2, per_fiblet=12)
    view = View(SIZE, camera(SIZE))
    renderer = FibletRenderer(gl, fiblets)
    renderer.render(View(SIZE, camera(SIZE, near=10.0)), style)  # the first picture has none before it to cull by
    plain = read(renderer.render(view, style))
    features = renderer.explain()["features"]
    away = read(renderer.render(View(SIZE, camera(SIZE), [(1, 0, 0, 1e4), (0, 0, 0, 1)]), style))
    assert renderer.explain()["features"] == features
    assert "clip_planes" not in {b["name"] for b in renderer.explain()["buffers"]}
    touching = read(renderer.render(View(SIZE, camera(SIZE), [(1, 0, 0, 0)]), style))
    assert "CLIP_PLANES" in renderer.explain()["features"]
    assert "clip_planes" in {b["name"] for b in renderer.explain()["buffers"]}
    again = read(renderer.render(view, style))
    assert "clip_planes" not in {b["name"] for b in renderer.explain()["buffers"]}
    renderer.release()
    for other in (away, again):
        assert_same(other, plain)
    points, rows, columns = shown_points(plain, fiblets.lines)
    kept = points[:, 0] > 6.0 + style.line_width  # clear of the plane, brush included
    assert kept.sum() > 200
    rows, columns = rows[kept], columns[kept]
    assert (touching.depth[rows, columns] == plain.depth[rows, columns]).all()
    assert (touching.ids[rows, columns] == plain.ids[rows, columns]).all()
    place, value = (touching.position[rows, columns] - plain.position[rows, columns]).T
    assert (place == 0.0).all()
    # values are summed up in another program
    assert np.abs(value).max() <= 4.0 * np.finfo(np.float32).eps * np.abs(plain.position[rows, columns, 1]).max()


@pytest.mark.parametrize("stage", ["clear", "cull", "depth", "resolve_owner", "resolve_ties", "occlude", "refine"])
def test_without_planes_no_word_of_them_is_compiled(stage):
    words = re.compile(r"clip_planes|ClipPlanes|clip_height|clip_tilts|clip_rounding")
    for features in (["DIRECTION"], ["WIDE_LINES"], ["CLIPPING", "CLIPPING_DEPTH"]):
        body = "\n".join(preprocessed(assemble(f"fiblets/compute/{stage}.comp", features, CONSTANTS), features))
        assert "void main()" in body
        assert not words.search(body)
    features = ["CLIPPING", "CLIPPING_DEPTH", "CLIP_PLANES"]
    body = "\n".join(preprocessed(assemble(f"fiblets/compute/{stage}.comp", features, CONSTANTS), features))
    assert bool(words.search(body)) == (stage in ("cull", "depth", "resolve_owner", "resolve_ties"))
