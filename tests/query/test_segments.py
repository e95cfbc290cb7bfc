"""Segments against regions: signed distances searched to the last bit, closed forms, and voxels one by one."""

from itertools import pairwise

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import regions
from pvfiblets.codec.layout import unpack
from pvfiblets.query.regions.region import AND, NOT
from pvfiblets.query.regions.segments import segment_flags
from pvfiblets.query.selection.passing import region_flags
from pvfiblets.streamlines import Streamlines


def signed_distance(region, p):
    """Of a position: below 0 inside, above 0 outside, and changing by no more than one goes; by textbook formulas."""
    stack = []
    for op in region.program:
        if op >= 0:
            stack.append(leaf_distance(region.leaves[op], p))
        elif op == NOT:
            stack.append(-stack.pop())
        else:
            b, a = stack.pop(), stack.pop()
            stack.append(max(a, b) if op == AND else min(a, b))
    return stack[0]


def leaf_distance(leaf, p):
    if isinstance(leaf, regions.Surface):
        return -float(leaf.signed_distance(p)[0])
    u = leaf.linear @ (p - leaf.centre)
    if isinstance(leaf, regions.Plane):
        return -u[2]
    if isinstance(leaf, regions.Slab):
        return (abs(u[2]) - 1.0) / np.linalg.norm(leaf.linear[2])
    if isinstance(leaf, regions.Box):
        return float(((np.abs(u) - 1.0) / np.linalg.norm(leaf.linear, axis=1)).max())
    # An ellipsoid's: |u| - 1 changes no faster than its matrix stretches.
    return (np.linalg.norm(u) - 1.0) / np.linalg.norm(leaf.linear, 2)


def some_place_below(f, a, b):
    """Whether ``f <= 0`` somewhere from a to b, by Piyavskii's search; None within 1e-7 mm of either answer."""
    length, parts, unsure = float(np.linalg.norm(b - a)), [(0.0, 1.0)], False
    while parts:
        low, high = parts.pop()
        middle = (low + high) / 2
        value, reach = f(a + middle * (b - a)), (high - low) / 2 * length
        if value < -1e-7:
            return True
        if value > reach + 1e-7:
            continue
        if reach < 1e-8:
            unsure = True
            continue
        parts += [(low, middle), (middle, high)]
    return None if unsure else False


def an_octahedron(size):
    points = size * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return regions.Surface(points, triangles)


def some_regions():
    box = regions.Box(center=(4.0, -3.0, 5.0), size=(40.0, 30.0, 50.0))
    ball, plane = regions.Sphere((10.0, 0.0, 0.0), 18.0), regions.Plane((1.0, 2.0, -0.5))
    slab = regions.Slab((0.0, 1.0, 1.0), (2.0, 2.0, 2.0), 3.0)
    matrix = np.array([[1.5, 0.4, 0, 3], [0, 0.7, 0, 1], [0, 0, 1, -4], [0, 0, 0, 1.0]])
    shell = regions.Sphere((0, 0, 0), 25.0) - regions.Sphere((0, 0, 0), 24.5)
    mesh = an_octahedron(22.0).moved(matrix)
    return {
        "plane": plane, "slab": slab, "box": box, "ball": ball, "speck": regions.Sphere((3.0, 3.0, 3.0), 0.8),
        "ellipsoid": regions.Sphere((0, 0, 0), 20.0).moved(matrix), "turned box": box.moved(matrix),
        "not slab": ~slab, "ball and slab": ball & slab, "box or ball": box | ball, "shell": shell,
        "box and ball without slab": (box & ball) - slab, "mesh": mesh, "mesh without box": mesh - box,
        "box in a hole": (shell & box) | (slab - mesh),
    }  # fmt: skip


@pytest.mark.parametrize("name", some_regions())
def test_segments_are_where_their_places_are(name):
    region = some_regions()[name]
    rng = np.random.default_rng(len(name))
    n = 8 if "mesh" in name or "hole" in name else 30
    a = rng.uniform(-40, 40, (3 * n, 3))
    away = [rng.normal(0, 2, (n, 3)), rng.normal(0, 40, (n, 3)), rng.normal(0, 3, (n, 3)) + 5 * (3.0 - a[2 * n :])]
    b = a + np.concatenate(away)
    b[:3] = a[:3]  # without length
    found = segment_flags(region, a, b)
    answers = set()
    for k, (p, q) in enumerate(zip(a, b, strict=True)):
        some_in = some_place_below(lambda x: signed_distance(region, x), p, q)
        some_out = some_place_below(lambda x: -signed_distance(region, x), p, q)
        assert some_in is None or some_in == bool(found[k] & 1), k
        assert some_out is None or some_out == bool(found[k] & 2), k
        answers.add((some_in, some_out))
    assert len(answers) > 1


def test_what_touches_passes():
    a, b = np.array([[-8.0, 5, 0]]), np.array([[8.0, 5, 0]])
    ball, up = regions.Sphere((0, 0, 0), 5.0), np.array([0, 1e-9, 0])
    assert segment_flags(ball, a, b) == 3
    assert segment_flags(ball, a + up, b + up) == 2
    box = regions.Box((-1, 1, -5, 5, -1, 1))
    assert segment_flags(box, a, b) == 3  # in a face
    assert segment_flags(box, a + up, b + up) == 2
    assert segment_flags(regions.Box((8, 9, 4, 6, 0, 1)), a, b + [0.5, 0, 0]) == 3  # in an edge
    assert segment_flags(regions.Plane((0, 1, 0), (0, 5, 0)), a, b) == 1


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_shapes_that_share_a_face(shift):
    """Rounding puts the two crossings of a face side by side: neither a gap nor a sliver comes of that."""
    rng = np.random.default_rng(8)
    middle = np.array([shift, -shift, 0.1])
    low, high = middle - (0.1, 0.3, 0.7), middle + (0.9, 0.7, 0.3)
    left = regions.Box(np.stack([low, high], axis=1).ravel())
    beside = regions.Box(np.stack([[high[0], *low[1:]], [high[0] + 2.3, *high[1:]]], axis=1).ravel())
    larger = regions.Box(np.stack([low, [high[0] + 5.1, *high[1:]]], axis=1).ravel())
    inner = middle + rng.uniform(-0.05, 0.05, (500, 3))
    other = inner + [2.0, 0, 0]
    assert (segment_flags(left | beside, inner, other) == 1).all()
    assert (segment_flags(left - larger, inner - [3.0, 0, 0], other) == 2).all()
    assert (segment_flags(left & beside, inner, other) == 3).all()  # the face is in both
    volume = np.ones((2, 1, 1), int)
    volume[1] = 2
    affine = np.diag([0.7, 3.0, 3.0, 1.0])
    affine[:3, 3] = middle
    one, two = (regions.Labels(volume, affine, n) for n in (1, 2))
    end = inner + [0.7, 0, 0]
    assert (segment_flags(one & two, inner, end) == 2).all()  # a voxel holds its lower faces only
    assert (segment_flags(one | two, inner, end) == 1).all()


def lines_of_all_steps(seed):
    """Streamlines with steps from 0 to hundreds of mm; some of one point, some long enough for many fiblets."""
    rng = np.random.default_rng(seed)
    lines = [rng.uniform(-40, 40, (1, 3)) + np.cumsum(rng.normal(0, size, (n, 3)), axis=0)
             for size in (0.3, 4.0, 60.0) for n in (1, 2, 40, 90)]  # fmt: skip
    across = [np.array([[-397.0, y + 0.1, z], [403.0, y - 0.1, z]]) for y, z in ((3, 3), (6, 8))]
    return [*lines, np.repeat(lines[3][:5], 2, axis=0), np.zeros((0, 3)), *across]


@pytest.mark.parametrize("name", ["ball", "mesh", "box and ball without slab", "speck"])
def test_streamlines_are_their_points_and_segments(name):
    region = some_regions()[name]
    whole = pf.compress(Streamlines.from_list(lines_of_all_steps(3)), exact=name == "ball")
    found, by_points = region_flags(whole, region), region_flags(whole, region, "points")
    assert (found & 12 == by_points & 12).all(), "ends are points"
    assert (found & 1 >= by_points & 1).all()
    assert (found & 1 > by_points & 1).any()
    for line, flags in zip(whole.decompress(dtype=np.float64), found, strict=True):
        inside, outside = region.contains(line).any(), not region.contains(line).all()
        for p, q in pairwise(line):
            inside = inside or some_place_below(lambda x: signed_distance(region, x), p, q)
            outside = outside or some_place_below(lambda x: -signed_distance(region, x), p, q)
        assert inside is None or bool(flags & 1) == inside
        assert outside is None or bool(flags & 2) == (len(line) > 0 and not outside)


def test_labels_are_passed_where_density_maps_have_some():
    """And where the slabs of one voxel after the other have some length of a segment."""
    rng = np.random.default_rng(5)
    affine = np.array([[3.0, 0.4, 0, -30], [0, -2.5, 0, 40], [0.3, 0, 4, -40], [0, 0, 0, 1]])
    volume = (rng.random((20, 30, 19)) > 0.995).astype(int)
    whole = pf.compress(Streamlines.from_list(lines_of_all_steps(4)))
    labels = regions.Labels(volume, affine)
    found = region_flags(whole, labels)
    chosen = np.argwhere(volume)
    inverse = np.linalg.inv(affine)
    for line, flags in zip(whole.decompress(dtype=np.float64), found, strict=True):
        one = Streamlines(line, [0, len(line)])
        counted = pf.density(one, like=(volume, affine)).values if len(line) else np.zeros(volume.shape)
        assert bool(flags & 1) == bool(counted[volume > 0].any())
        v, passed = line @ inverse[:3, :3].T + inverse[:3, 3], bool(labels.contains(line).any())
        for p, q in pairwise(v):
            with np.errstate(divide="ignore", invalid="ignore"):
                s, t = (chosen - 0.5 - p) / (q - p), (chosen + 0.5 - p) / (q - p)
            enter, leave = np.minimum(s, t).max(axis=1), np.maximum(s, t).min(axis=1)
            passed |= bool((np.maximum(enter, 0.0) < np.minimum(leave, 1.0)).any())
        assert bool(flags & 1) == passed
    assert (found & 1 > region_flags(whole, labels, "points") & 1).any()
    assert not region_flags(whole, labels & ~labels).any()
    empty = np.diff(whole.offsets()) == 0
    np.testing.assert_array_equal(region_flags(whole, ~labels) & 2 == 0, (found & 1 > 0) | empty)


def test_a_line_of_two_points_passes_what_lies_between_them():
    """Also between the last point of a fiblet and the first of the next."""
    line = np.stack([np.arange(200) * 10.0, np.zeros(200), np.zeros(200)], axis=1)
    whole = pf.compress(Streamlines.from_list([line, line + [0, 5, 0], line[[0, -1]]]))
    points = np.cumsum(unpack("last", whole.decoding) + 1)
    joints = points[points < 200] - 0.5
    assert len(joints) > 1
    for x in (*joints * 10.0, 5.0, 1985.0):
        speck = regions.Sphere((x, 0.0, 0.0), 1.0)
        assert whole.select(regions.passes(speck)).tolist() == [True, False, True]
        assert not whole.select(regions.passes(speck, sampling="points")).any()
        assert not whole.select(regions.stays_in(~speck))[[0, 2]].any()
    assert whole.select(regions.stays_in(~speck, sampling="points")).all()
