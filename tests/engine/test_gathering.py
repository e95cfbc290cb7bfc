"""What all lines of a pixel add up to, against lines drawn by NumPy and blended one by one."""

from dataclasses import replace

import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.gather.gathering import SLICES, SliceDistances, slice_edges
from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.engine.gl import shaders
from tests.drivers import MESH

from .cells import clear_of, line_samples
from .pictures import EMPTY, EVERY_POINT, SIZE, read, unpacked_tangent

PIPELINES = ["compute", "tessellation", "geometry", *MESH]


def counted(lines, matrix, size):
    """(h, w) segments' pixels by the rule of thin lines, and where rounding may decide nothing."""
    samples, doubtful = line_samples(lines, matrix, size)
    rows = np.concatenate(samples)
    count = np.zeros((size[1], size[0]))
    np.add.at(count, (rows[:, 1].astype(int), rows[:, 0].astype(int)), 1)
    return count, clear_of(doubtful, size)


def one_by_one(renderer, fiblets, view, style):
    """Pictures of each streamline drawn alone."""
    pictures = []
    for s in range(fiblets.n_streamlines):
        renderer.filtering = Filter(streamlines=np.arange(fiblets.n_streamlines) == s)
        pictures.append(read(renderer.render(view, style)))
    renderer.filtering = None
    return pictures


@pytest.mark.few(1)
@pytest.mark.parametrize("height", [None, 120.0])
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_lines_are_counted_as_numpy_counts_them(gl, fabricate, random_lines, camera, pipeline, height):
    fiblets = fabricate(random_lines(120, seed=3), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    matrix = camera(SIZE, height=height)
    found = renderer.gather(View(SIZE, matrix), EVERY_POINT).read()[0, ..., 3]
    assert renderer.most_lines() == found.max()
    renderer.release()
    expected, clear = counted(fiblets.lines, matrix, SIZE)
    assert clear.mean() > 0.6
    assert expected[clear].max() >= 3
    assert (found[clear] == expected[clear]).all()
    assert abs(found.sum() - expected.sum()) < 0.002 * expected.sum()


@pytest.mark.more
def test_all_pipelines_add_up_the_same(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(200, seed=4), kind=2, per_fiblet=20)
    view = View(SIZE, camera(SIZE, eye=(30, -120, 40)))
    for paint in (Paint(), Paint("orientation", light=(-0.6, 0.0, 0.8))):
        sums = []
        for pipeline in PIPELINES:
            renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
            sums.append([renderer.gather(view, FibletStyle(), paint, sliced=sliced).read() for sliced in (False, True)])
            renderer.release()
        for whole, sliced in sums[1:]:
            for found, expected in ((whole, sums[0][0]), (sliced, sums[0][1])):
                wrong = (found[..., 3] != expected[..., 3]) | (np.abs(found - expected).max(-1) > found[..., 3])
                assert wrong.mean() < 1e-4  # tangents are handed on in 32 bits: colours may be rounded the other way


STYLES = {
    "thin": FibletStyle(),
    "wide": FibletStyle(7.0, tolerance=0.5),
    "tube": FibletStyle(radius=1.5, tolerance=0.5),
}


@pytest.mark.few(1)
@pytest.mark.parametrize(("name", "reciprocals"), [("thin", 0), ("wide", 0), ("tube", 0), ("tube", 1)])
@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_sums_are_those_of_streamlines_drawn_alone(gl, fabricate, camera, pipeline, name, reciprocals, monkeypatch):
    """Gentle lines that do not cross themselves: each adds once to every pixel that it takes."""
    style, read_shader = STYLES[name], shaders.read_shader
    if reciprocals:  # by which cards divide: of the whole axis a tube's end may be a bit less than all
        whole, by = "y / t.size", "y * (1.0 / t.size)"
        assert whole in read_shader("fiblets/segments/line_tube.glsl")
        monkeypatch.setattr(shaders, "read_shader", lambda name: read_shader(name).replace(whole, by))
    rng = np.random.default_rng(5)
    t = np.linspace(-40, 40, 90)[:, None]
    a, b, c = rng.normal(size=(3, 20, 3))
    lines = [t * x / np.linalg.norm(x) + 0.003 * t**2 * y + 6 * z for x, y, z in zip(a, b, c, strict=True)]
    fiblets = fabricate(lines, kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    view = View(SIZE, camera(SIZE, eye=(0, -200, 60)))
    alone = one_by_one(renderer, fiblets, view, style)
    count = np.sum([p.drawn for p in alone], 0)
    found = renderer.gather(view, style, Paint("orientation")).read()[0]
    assert (count > (1 if style.half_width == 0 else 3)).sum() > 50
    wrong = found[..., 3] != count
    assert wrong.mean() < (0.0002 if style.half_width == 0 else 0.01)
    assert np.abs(found[..., 3] - count).max() <= 2
    # Mean colours: of segments, where the picture has tangents that are continuous along a line.
    colour = np.sum([np.where(p.drawn[..., None], np.abs(unpacked_tangent(p.ids[..., 1])), 0.0) for p in alone], 0)
    both = (count > 0) & ~wrong
    error = np.abs(found[..., :3] / 255.0 - colour)[both] / count[both][:, None]
    assert error.mean() < 0.02
    assert np.quantile(error, 0.99) < 0.1
    # In slices: all but the nearest, by distance.
    near = renderer.render(view, style)
    nearest = read(near)
    parts = renderer.gather(view, style, sliced=True).read()[..., 3]
    ok = both & (nearest.depth != EMPTY)
    assert (parts.sum(0)[ok] == count[ok] - 1).mean() > 0.995
    expected = np.zeros((SLICES, *count.shape))
    distances = SliceDistances.from_box(view, fiblets.origin, fiblets.origin + 65535 * fiblets.anchor_scale)
    first = distance(distances, nearest.depth)
    for s, picture in enumerate(alone):
        u = (distance(distances, picture.depth) - first) / (distances.far - first)
        other = picture.drawn & (nearest.ids[..., 0] != s)
        for k in range(SLICES):
            low, high = (0.0, *slice_edges(), 2.0)[k : k + 2]
            expected[k] += other & (u > low if k else u >= 0) & (u <= high)
    assert (expected > 0).any((1, 2)).all()
    assert (parts == expected).all(0)[ok].mean() > 0.99
    renderer.release()


def distance(distances, key):
    p, q, r, s = distances.terms
    c = 1.0 - key / 4294967295.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return (p + q * c) / (r + s * c)


@pytest.mark.parametrize("height", [None, 120.0])
def test_distances_are_those_of_the_camera(camera, height):
    eye = np.array([10.0, -200.0, 60.0])
    view = View(SIZE, camera(SIZE, eye=tuple(eye), height=height))
    found = SliceDistances.from_box(view, (-50, -40, -30), (50, 40, 30))
    points = np.random.default_rng(0).uniform(-30, 30, (50, 3))
    clip = np.c_[points, np.ones(50)] @ np.asarray(view.model_view_projection).T
    depth = (clip[:, 2] / clip[:, 3] + 1) / 2
    along = (points - eye) @ (-eye / np.linalg.norm(eye))
    d = distance(found, depth * 4294967295.0)
    slope, offset = np.polyfit(along, d, 1)
    assert slope > 0
    assert np.abs(d - slope * along - offset).max() < 1e-6 * np.ptp(d) + 1e-9
    corners = np.array([[x, y, z] for x in (-50, 50) for y in (-40, 40) for z in (-30, 30)])
    far = ((corners - eye) @ (-eye / np.linalg.norm(eye))).max()
    assert found.far == pytest.approx(slope * far + offset, rel=1e-6)


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_filters_planes_and_others_leave_lines_out(gl, fabricate, random_lines, camera, pipeline):
    lines = random_lines(80, seed=6)
    fiblets = fabricate(lines, kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    matrix = camera(SIZE)
    view = View(SIZE, matrix)
    shown = np.arange(80) % 3 == 0
    renderer.filtering = Filter(streamlines=shown)
    found = renderer.gather(view, EVERY_POINT).read()[0, ..., 3]
    expected, clear = counted([line for line, on in zip(fiblets.lines, shown, strict=True) if on], matrix, SIZE)
    assert (found[clear] == expected[clear]).all()
    renderer.filtering = None
    whole = renderer.gather(view, EVERY_POINT).read()[0, ..., 3]
    cut = [View(SIZE, matrix, [(side, 0.0, 0.0, 0.0)]) for side in (1.0, -1.0)]
    halves = [renderer.gather(half, EVERY_POINT).read()[0, ..., 3] for half in cut]
    assert 0.98 * whole.sum() < sum(half.sum() for half in halves) < 1.05 * whole.sum()
    # Behind something at one depth: what is left is what is in front of it.
    key = np.uint32(np.median(read(renderer.render(view, EVERY_POINT)).depth[whole > 0]))
    wall = gl.texture(SIZE, 1, np.full((SIZE[1], SIZE[0]), key, np.uint32), dtype="u4")
    front = renderer.gather(view, EVERY_POINT, outside=lambda: wall, state="wall").read()[0, ..., 3]
    samples = np.concatenate(line_samples(fiblets.lines, matrix, SIZE)[0])
    left = (samples[:, 2] * 4294967295.0 <= key).mean()
    assert front.sum() / whole.sum() == pytest.approx(left, abs=0.003)
    wall.release()
    renderer.release()


def test_colours_of_streamlines_and_tables(gl, fabricate, camera):
    t = np.linspace(-40, 40, 60)
    lines = [np.stack([t, 0 * t + 6 * i, 0 * t], 1) for i in range(3)]
    fiblets = fabricate(lines, kind=2)
    colours = np.array([[255, 0, 0, 255], [0, 128, 0, 128], [0, 0, 64, 0]], np.uint8)
    texture = gl.texture((3, 1), 4, colours.tobytes(), alignment=1)
    renderer = FibletRenderer(gl, fiblets)
    view = View(SIZE, camera(SIZE, eye=(0, 0, 200), up=(0, 1, 0)))
    picture = read(renderer.render(view, EVERY_POINT))
    paint = Paint("streamline_rgba", {"colour_list": texture})
    plain = renderer.gather(view, EVERY_POINT, paint).read()[0]
    weighed = renderer.gather(view, EVERY_POINT, replace(paint, opacity=0.5)).read()[0]
    for s, colour in enumerate(colours.astype(float)):
        here = picture.drawn & (picture.ids[..., 0] == s)
        assert here.sum() > 40
        assert (plain[here] == [*colour[:3], 1]).all()
        unit = -np.log(0.5) / 255
        weight = np.round(-np.log(1 - 0.5 * colour[3] / 255) / unit)
        assert (weighed[here] == [*(colour[:3] * weight), weight]).all()
    # A value through a table: arc length from 0 to 80 mm in four colours.
    table = np.array([*([red, 0, 0, 255] for red in (10, 20, 30, 40)), [0] * 4, [0] * 4, [0] * 4], np.uint8)
    mapped = gl.texture((7, 1), 4, table.tobytes(), alignment=1)
    style = FibletStyle(values="arc_length", tolerance=0.0)
    value = read(renderer.render(view, style)).position[..., 1]
    paint = Paint(
        "point_scalar", {"colour_table": mapped}, {"colour_entries": 4, "colour_range": (0.0, 80.0, 4 / 80.0)}
    )
    found = renderer.gather(view, style, paint).read()[0]
    drawn = picture.drawn
    expected = np.where(value > 80, 0, 10 * (1 + np.minimum(value // 20, 3)))
    assert (np.abs(found[..., 0] - expected)[drawn] == 0).mean() > 0.98
    for thing in (texture, mapped):
        thing.release()
    renderer.release()


def test_it_is_done_once_for_a_picture(gl, fabricate, random_lines, camera):
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    view = View(SIZE, camera(SIZE))
    renderer.render(view)
    before = {b["name"] for b in renderer.explain()["buffers"]}
    renderer.gather(view)
    first = sum(p["name"] == "gather" for p in renderer.explain()["passes"])
    renderer.gather(view)
    assert first == 1 == sum(p["name"] == "gather" for p in renderer.explain()["passes"])
    assert {"GATHER"} <= {*renderer.explain()["features"], "GATHER"}
    renderer.drop_gathered()
    assert {b["name"] for b in renderer.explain()["buffers"]} == before
    renderer.release()
