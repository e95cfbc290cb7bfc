"""Octrees hold what lies under their nodes: against brute force, of any shape, type and order of memory."""

from __future__ import annotations

import itertools

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.volumes import RaycastVolume, build_octree
from pvfiblets.volumes.octree import HOMOGENEOUS, LEAF, OVERSHOOT, SKIP, VISIT, flags, homogeneous
from pvfiblets.volumes.volume import SPAN

DTYPES = [np.uint8, np.uint16, np.int16, np.float32]


def made(shape, dtype=np.uint8, seed=0, order="C", share=1.0):
    """Noise in a part of the voxels, 0 elsewhere."""
    rng = np.random.default_rng(seed)
    if dtype == np.float32:
        values = rng.normal(size=shape).astype(np.float32)
    else:
        info = np.iinfo(dtype)
        values = rng.integers(info.min, info.max, shape, dtype, endpoint=True)
    return np.asarray(np.where(rng.random(shape) < share, values, 0), dtype, order=order)


def catmull_rom(before, first, last, after, t):
    """The cubic through `first` and `last` whose slopes are half the differences of their neighbours (Hermite form)."""
    one, two = (last - before) / 2, (after - first) / 2
    return (
        (2 * t**3 - 3 * t**2 + 1) * first + (t**3 - 2 * t**2 + t) * one + (3 * t**2 - 2 * t**3) * last
        + (t**3 - t**2) * two
    )  # fmt: skip


def field(values, points, tricubic):
    """The reconstruction at points in voxels, float64, one axis after the other."""
    padded = np.pad(values.astype(np.float64), 1, mode="edge")
    out = []
    for point in points:
        cell = np.minimum(point.astype(int), np.array(values.shape) - 2)
        block = padded[tuple(slice(c, c + 4) for c in cell)]
        for t in point - cell:
            block = catmull_rom(*block, t) if tricubic else block[1] + t * (block[2] - block[1])
        out.append(block)
    return np.array(out)


def leaf_of(octree, level, node, shape):
    """The first and one past the last cell of a node along each axis."""
    side = octree.leaf << level
    first = np.array(node) * side
    return first, np.minimum(first + side, np.array(shape) - 1)


@hypothesis.given(
    shape=st.tuples(*[st.integers(2, 21)] * 3), dtype=st.sampled_from(DTYPES), order=st.sampled_from("CF"),
    margin=st.sampled_from([1, 2]), seed=st.integers(0, 99), share=st.sampled_from([0.05, 1.0]),
)  # fmt: skip
def test_every_value_of_every_cell_is_within_its_nodes_bounds(shape, dtype, order, margin, seed, share):
    values = made(shape, dtype, seed, order, share)
    octree = build_octree(RaycastVolume(values), margin)
    rng = np.random.default_rng(seed)
    points = rng.random((40, 3)) * (np.array(shape) - 1)
    points[::4] = np.floor(points[::4])  # on voxels and faces of cells too
    points[1::4, rng.integers(3)] = 0.0
    points[2::4] = np.floor(points[2::4]) + 0.5
    points = np.minimum(points, np.array(shape) - 1)
    found = field(values, points, tricubic=margin == 2)
    nearest = values[tuple(np.floor(points + 0.5).astype(int).T)]
    slack = 1e-12 * np.ptp(values.astype(float))
    for level, nodes in enumerate(octree.levels):
        at = tuple((np.minimum(points.astype(int), np.array(shape) - 2) // (octree.leaf << level)).T)
        for of in (found, nearest):
            assert (nodes.least[at] <= of + slack).all()
            assert (of - slack <= nodes.greatest[at]).all()


@hypothesis.given(
    shape=st.tuples(*[st.integers(2, 37)] * 3), dtype=st.sampled_from(DTYPES), order=st.sampled_from("CF"),
    seed=st.integers(0, 99),
)  # fmt: skip
def test_nodes_are_what_brute_force_finds(shape, dtype, order, seed):
    values = made(shape, dtype, seed, order)
    octree = build_octree(RaycastVolume(values))
    # The mean of a trilinear cell is that of its corners.
    corners = [values[i : shape[0] - 1 + i, j : shape[1] - 1 + j, k : shape[2] - 1 + k].astype(np.float64)
               for i, j, k in itertools.product((0, 1), repeat=3)]  # fmt: skip
    means = sum(corners) / 8
    scale = np.abs(values.astype(float)).max()
    for level, nodes in enumerate(octree.levels):
        assert nodes.shape == tuple(-(-(n - 1) // (LEAF << level)) for n in shape)
        assert nodes.least.dtype == nodes.greatest.dtype == values.dtype
        assert nodes.mean.dtype == np.float32
        for node in itertools.product(*map(range, nodes.shape)):
            first, last = leaf_of(octree, level, node, shape)
            voxels = values[tuple(slice(a, b + 1) for a, b in zip(first, last, strict=True))]
            cells = means[tuple(slice(a, b) for a, b in zip(first, last, strict=True))]
            assert nodes.least[node] == voxels.min()
            assert nodes.greatest[node] == voxels.max()
            assert nodes.mean[node] == pytest.approx(cells.mean(), abs=2e-6 * scale)
    assert octree.levels[-1].shape == (1, 1, 1)


def test_the_bound_on_overshoot_is_reached():
    # The field at a cell's middle is greatest where voxels are 1 under positive weights and 0 under negative ones.
    weights = np.array([-1, 9, 9, -1]) / 16
    values = (np.einsum("i,j,k", weights, weights, weights) > 0).astype(np.uint8)
    middle = field(values, np.array([[1.5, 1.5, 1.5]]), tricubic=True)[0]
    assert middle == pytest.approx(1.0 + OVERSHOOT)
    octree = build_octree(RaycastVolume(values * np.uint8(128)), margin=2)
    assert octree.levels[0].greatest[0, 0, 0] == 128 + 61
    assert octree.levels[0].least[0, 0, 0] == -61
    floats = build_octree(RaycastVolume(values.astype(np.float32)), margin=2)
    assert 0.0 <= floats.levels[0].greatest[0, 0, 0] - (1.0 + OVERSHOOT) < 1e-6


@pytest.mark.parametrize(("dtype", "wide"), [(np.uint8, np.int16), (np.uint16, np.int32), (np.int16, np.int32)])
def test_bounds_of_the_cubic_go_beyond_the_type(dtype, wide):
    info = np.iinfo(dtype)
    values = np.where(np.indices((9, 9, 9)).sum(axis=0) % 2, info.max, info.min).astype(dtype)
    nodes = build_octree(RaycastVolume(values), margin=2).levels[0]
    assert nodes.least.dtype == nodes.greatest.dtype == wide
    assert nodes.least.min() < info.min
    assert nodes.greatest.max() > info.max


def test_constant_and_greatest_floats():
    octree = build_octree(RaycastVolume(np.full((11, 12, 13), 0.1, np.float32)), margin=2)
    assert all(
        (level.least == np.float32(0.1)).all() and (level.greatest == level.least).all() for level in octree.levels
    )
    limit = np.float32(0.499 * SPAN[1])  # the widest range that volumes have
    values = np.where(np.indices((9, 9, 9)).sum(axis=0) % 2, limit, -limit)
    nodes = build_octree(RaycastVolume(values), margin=2).levels[0]
    assert np.isfinite(nodes.least).all()
    assert np.isfinite(nodes.greatest).all()


@pytest.mark.parametrize(
    ("dtype", "margin", "part"),
    [(np.uint8, 1, 0.05), (np.uint8, 2, 0.06), (np.uint16, 1, 0.04), (np.int16, 2, 0.05), (np.float32, 1, 0.03),
     (np.float32, 2, 0.03)],
)  # fmt: skip
def test_memory(dtype, margin, part):
    for shape in [(11, 11, 11), (18, 11, 18), (18, 18, 18), (26, 26, 26), (34, 18, 40), (65, 64, 66)]:
        volume = RaycastVolume(np.zeros(shape, dtype))
        octree = build_octree(volume, margin)
        nodes = sum(a.nbytes for level in octree.levels for a in (level.least, level.greatest, level.mean))
        assert octree.nbytes == nodes
        assert octree.nbytes <= part * volume.nbytes, shape
    large = np.lib.stride_tricks.as_strided(np.zeros(1, dtype), (129, 129, 129), (0, 0, 0))
    volume = RaycastVolume(large)
    assert build_octree(volume, margin).nbytes <= 0.02 * volume.n_points * volume.values.itemsize
    assert build_octree(volume, margin).n_nodes == 16**3 + 8**3 + 4**3 + 2**3 + 1


def test_homogeneous_nodes_are_visible_ones_of_little_difference():
    values = np.zeros((33, 33, 33), np.uint8)
    values[17:] = 100
    values[:9, :9, :9] += np.indices((9, 9, 9)).sum(axis=0).astype(np.uint8) % 3
    octree = build_octree(RaycastVolume(values))
    seen = flags(octree, lambda least, greatest: greatest > 0)
    even = homogeneous(octree, 2, seen)
    for level, nodes in enumerate(octree.levels):
        difference = nodes.greatest.astype(int) - nodes.least
        np.testing.assert_array_equal(even[level] == SKIP, nodes.greatest == 0)
        np.testing.assert_array_equal(even[level] == HOMOGENEOUS, (difference <= 2) & (nodes.greatest > 0))
    assert even[0][0, 0, 0] == HOMOGENEOUS
    assert even[0][2, 0, 0] == VISIT
    assert even[0][3, 3, 3] == HOMOGENEOUS
    assert homogeneous(octree, 0)[0][0, 3, 3] == HOMOGENEOUS
    assert homogeneous(octree, 0)[0][0, 0, 0] == VISIT
    assert homogeneous(octree, 255)[-1][0, 0, 0] == HOMOGENEOUS
    assert [level.dtype for level in even] == [np.uint8] * len(even)


def test_differences_do_not_wrap_around():
    values = np.zeros((9, 9, 9), np.int16)
    values[0], values[-1] = -32768, 32767
    assert homogeneous(build_octree(RaycastVolume(values)), 10)[0][0, 0, 0] == VISIT


def test_bad_arguments():
    volume = RaycastVolume(made((9, 9, 9)))
    with pytest.raises(ValueError, match=r"margin=3; expected 1 \(nearest, trilinear\) or 2 \(tricubic\)"):
        build_octree(volume, margin=3)
    for threshold in (-1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="the threshold of homogeneous nodes is"):
            homogeneous(build_octree(volume), threshold)
