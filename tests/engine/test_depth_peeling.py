"""Layers of a picture against streamlines drawn one by one and sorted by NumPy."""

import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.gather.depth_peeling import MOST_LAYERS, _Stage

from .pictures import EMPTY, SIZE, near, read, unpacked_tangent


def bent_lines(n, seed=0, points=90):
    """Lines across a box of 80 mm, gently bent: none crosses itself, most pixels in the middle hold several."""
    rng = np.random.default_rng(seed)
    t = np.linspace(-1, 1, points)[:, None]
    lines = []
    for _ in range(n):
        a, b, c = rng.normal(size=(3, 3))
        a /= np.linalg.norm(a)
        lines.append(40 * t * a + 8 * (t**2) * b / np.linalg.norm(b) + 6 * c)
    return lines


def read_layers(buffer):
    """(layer, h, w) depth; (layer, h, w, 2) ids and position."""
    w, h = buffer.size
    get = lambda array, dtype: np.frombuffer(array.read(), dtype).reshape(buffer.count, h, w, -1)  # noqa: E731
    return get(buffer.depth, "<u4")[..., 0], get(buffer.ids, "<u4"), get(buffer.position, "<f4")


def one_by_one(renderer, fiblets, view, style):
    """(streamline, h, w) depth, and place, of each streamline drawn alone."""
    depths, places = [], []
    for s in range(fiblets.n_streamlines):
        renderer.filtering = Filter(streamlines=np.arange(fiblets.n_streamlines) == s)
        picture = read(renderer.render(view, style))
        depths.append(picture.depth)
        places.append(picture.position[..., 0])
    renderer.filtering = None
    return np.array(depths), np.array(places)


def sorted_layers(depths, count):
    """(layer, h, w) depth and streamline of the nearest; EMPTY behind the last."""
    order = np.argsort(depths, axis=0, kind="stable")[:count]
    return np.take_along_axis(depths, order, 0), order


@pytest.mark.few(1)
@pytest.mark.every("pair")
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
@pytest.mark.parametrize("width", [1.0, 5.0])
@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_layers_are_the_streamlines_in_order(gl, fabricate, camera, pipeline, width, tolerance):
    fiblets = fabricate(bent_lines(25), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    view, style = View(SIZE, camera(SIZE, eye=(0, -200, 60))), FibletStyle(width, values=None, tolerance=tolerance)
    depths, _ = one_by_one(renderer, fiblets, view, style)
    expected, streamline = sorted_layers(depths, 6)
    depth, ids, position = read_layers(renderer.render_layers(view, style, 6))
    renderer.release()
    drawn = expected != EMPTY
    assert drawn[5 if width > 1.0 else 2].sum() > 20, "too few pixels have several layers"
    # At the same key only one of several is there; lines drawn alone may take another pixel at a joint.
    wrong = (depth != expected) | (drawn & (ids[..., 0] != streamline))
    assert wrong.mean(axis=(1, 2)).max() < 2e-3 * drawn.mean()
    assert (np.diff(depth.astype(np.int64), axis=0)[drawn[1:] & (depth[1:] != EMPTY)] > 0).all()
    assert np.isfinite(position[depth != EMPTY][:, 0]).all()


def test_the_first_layer_is_the_picture(gl, fabricate, camera):
    fiblets = fabricate(bent_lines(25), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets)
    view, style = View(SIZE, camera(SIZE)), FibletStyle(3.0, values="arc_length")
    picture = read(renderer.render(view, style))
    depth, ids, position = read_layers(renderer.render_layers(view, style, 3))
    renderer.release()
    drawn = picture.drawn
    assert (depth[0] == picture.depth).all()
    assert (ids[0][drawn] == picture.ids[drawn]).all()
    assert (position[0][drawn] == picture.position[drawn]).all()
    # Values of further layers are those of their own places: 1 mm a point here, nearly.
    behind = depth[1] != EMPTY
    steps = [np.linalg.norm(np.diff(line, axis=0), axis=1) for line in fiblets.lines]
    for s in range(fiblets.n_streamlines):
        here = behind & (ids[1][..., 0] == s)
        arc = np.concatenate([[0.0], np.cumsum(steps[s])])
        place = position[1][here][:, 0]
        assert np.abs(np.interp(place, np.arange(len(arc)), arc) - position[1][here][:, 1]).max(initial=0.0) < 0.5


@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_a_wide_line_is_one_surface(gl, fabricate, camera, pipeline):
    """Segments shorter than the line is wide cover each pixel many times, at depths of their own."""
    t = np.linspace(-40, 40, 161)
    aslant = np.stack([t, 0.6 * t, 0.2 * t], 1)
    away = np.stack([0 * t + 30, t, 0 * t - 12], 1)  # nearly end on
    fiblets = fabricate([aslant, away], kind=2)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    view = View(SIZE, camera(SIZE, eye=(0, -150, 20)))
    depth, ids, _ = read_layers(renderer.render_layers(view, FibletStyle(12.0, tolerance=0.0), 4))
    renderer.release()
    assert (depth[0] != EMPTY).sum() > 2000
    second = depth[1] != EMPTY
    # Only where both lines are.
    assert (ids[1][second][:, 0] != ids[0][second][:, 0]).all()
    assert (depth[2] == EMPTY).all()


def test_a_line_that_comes_back_is_two_layers(gl, fabricate, camera):
    t = np.linspace(0, 2 * np.pi, 400)
    coil = np.stack([25 * np.cos(t), 25 * np.sin(t), 0.5 * t], 1)  # a ring, seen from its edge
    fiblets = fabricate([coil], kind=2)
    renderer = FibletRenderer(gl, fiblets)
    view = View(SIZE, camera(SIZE, eye=(0, -150, 3)))
    depth, _, position = read_layers(renderer.render_layers(view, FibletStyle(8.0, tolerance=0.0), 3))
    renderer.release()
    middle = depth[:, :, 120:200]
    both = middle[1] != EMPTY
    assert both.sum() > 0.5 * (middle[0] != EMPTY).sum()
    apart = np.abs(position[0][..., 0] - position[1][..., 0])[:, 120:200][both]
    assert apart.min() > 60, "front and back of the ring"
    assert (middle[2] == EMPTY).all()


def test_the_order_of_streamlines_does_not_matter(gl, fabricate, camera):
    lines = bent_lines(30, seed=3)
    order = np.random.default_rng(1).permutation(30)
    view, found = View(SIZE, camera(SIZE)), []
    for chosen in (np.arange(30), order):
        # The same scale and lattice either way
        fiblets = fabricate([lines[i] for i in chosen], kind=2, per_fiblet=20)
        renderer = FibletRenderer(gl, fiblets)
        depth, ids, _ = read_layers(renderer.render_layers(view, FibletStyle(3.0), 4))
        renderer.release()
        found.append((depth, np.where(depth != EMPTY, chosen[np.where(depth != EMPTY, ids[..., 0], 0)], -1)))
    (depth_a, ids_a), (depth_b, ids_b) = found
    ties = 1e-3
    assert (depth_a != depth_b).mean() < ties
    assert (ids_a != ids_b).mean() < ties


def test_planes_cut_every_layer(gl, fabricate, camera):
    fiblets = fabricate(bent_lines(25), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets)
    matrix, style = camera(SIZE), FibletStyle(1.0)
    planes = [(1.0, 0.0, 0.0, 0.0)]
    cut = View(SIZE, matrix, planes)
    depths, _ = one_by_one(renderer, fiblets, cut, style)
    expected, _ = sorted_layers(depths, 3)
    depth, _, _ = read_layers(renderer.render_layers(cut, style, 3))
    whole, _, _ = read_layers(renderer.render_layers(View(SIZE, matrix), style, 3))
    renderer.release()
    assert (depth != expected).mean() < 1e-4
    assert (whole[2] != EMPTY).sum() > (depth[2] != EMPTY).sum() > 0


def test_nothing_is_done_twice_and_the_next_picture_is_unharmed(gl, fabricate, camera, monkeypatch):
    fiblets = fabricate(bent_lines(25), kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets)
    view, style = View(SIZE, camera(SIZE)), FibletStyle(3.0)
    first = renderer.render_layers(view, style, 3)
    before = read_layers(first)
    calls = []
    draw = _Stage.draw

    def counted(self, job, peel, *rest):
        calls.append(peel.drawn)
        return draw(self, job, peel, *rest)

    monkeypatch.setattr(_Stage, "draw", counted)
    assert renderer.render_layers(view, style, 3) is first
    assert not calls
    renderer.render_layers(view, style, 4)
    assert calls == [1, 2, 3]
    turned = View(SIZE, camera(SIZE, eye=(200, -100, 60)))
    renderer.render_layers(turned, style, 4)
    fresh = FibletRenderer(gl, fiblets)
    expected = read(fresh.render(turned, style))
    fresh.release()
    assert (read(renderer.render(turned, style)).depth == expected.depth).all()
    renderer.filtering = Filter(streamlines=np.arange(25) < 20)
    some = read_layers(renderer.render_layers(view, style, 3))
    assert (some[1][some[0] != EMPTY][:, 0] < 20).all()
    renderer.filtering = None
    for a, b in zip(read_layers(renderer.render_layers(view, style, 3)), before, strict=True):
        assert (a[before[0] != EMPTY] == b[before[0] != EMPTY]).all()
    assert "layers" in {entry["name"] for entry in renderer.explain(counts=False)["buffers"]}
    renderer.drop_layers()
    renderer.drop_layers()
    assert "layers" not in {entry["name"] for entry in renderer.explain(counts=False)["buffers"]}
    renderer.release()


@pytest.mark.parametrize("count", [0, 1, MOST_LAYERS + 1])
def test_a_number_of_layers_that_makes_no_sense(gl, fabricate, camera, count):
    renderer = FibletRenderer(gl, fabricate(bent_lines(2), kind=2))
    with pytest.raises(ValueError, match=f"{count} layers"):
        renderer.render_layers(View(SIZE, camera(SIZE)), FibletStyle(), count)
    renderer.release()


def test_a_picture_of_another_size(gl, fabricate, camera):
    renderer = FibletRenderer(gl, fabricate(bent_lines(12), kind=2))
    for size in (SIZE, (64, 48), SIZE):
        buffer = renderer.render_layers(View(size, camera(size)), FibletStyle(), 3)
        depth = read_layers(buffer)[0]
        assert buffer.size == size
        assert (near(depth[0] != EMPTY, 0) | (depth[1] == EMPTY)).all(), "a layer where the first has none"
    renderer.release()


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_tubes_are_one_surface_each(gl, fabricate, camera, pipeline):
    lines = bent_lines(5, seed=5, points=40)
    fiblets = fabricate(lines, kind=2, per_fiblet=20)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    size = (100, 80)
    view, style = View(size, camera(size, eye=(0, -200, 60))), FibletStyle(radius=4.0, across=True, tolerance=0.0)
    depths, _ = one_by_one(renderer, fiblets, view, style)
    expected, streamline = sorted_layers(depths, 4)
    buffer = renderer.render_layers(view, style, 4)
    depth, ids, _ = read_layers(buffer)
    normals = np.frombuffer(buffer.across.read(), "<u4").reshape(4, *size[::-1])
    renderer.release()
    drawn = expected != EMPTY
    assert drawn[2].sum() > 30
    # At the edge of one tube another segment of it may show behind, a hand's breadth along: few pixels.
    wrong = (depth != expected) | (drawn & (ids[..., 0] != streamline))
    assert wrong.mean(axis=(1, 2)).max() < 0.02 * drawn.mean()
    facing = unpacked_tangent(normals[depth != EMPTY]) @ np.array([0, -200, 60]) / np.hypot(200, 60)
    assert (facing > -0.3).all()
    assert np.median(facing) > 0.55
