"""The made-up angiogram and head are what they say, at every size."""

import numpy as np
import pytest

from pvfiblets.synthetic.vessels import (
    LEAST_RADIUS,
    ROOT_RADIUS,
    VESSEL_SIDE,
    _grown,
    brain_like,
    vessel_lines,
    vessel_tree,
)


@pytest.fixture(scope="module")
def tree():
    """An angiogram and the vessels in it, which tests must not change."""
    return vessel_tree(96), _grown(0)


def distances(points, segments):
    """How deep points (n, 3) lie in the union of cones, mm, and the radius there (n,): float64, all against all."""
    a, b = segments[:, :3], segments[:, 4:7]
    along = b - a
    t = np.einsum("nsi,si->ns", points[:, None] - a, along) / (along**2).sum(1)
    t = np.clip(t, 0.0, 1.0)
    radius = segments[:, 3] + t * (segments[:, 7] - segments[:, 3])
    away = np.linalg.norm(points[:, None] - a - t[..., None] * along, axis=2)
    return radius - away, radius


@pytest.mark.more
def test_brightness_is_that_of_the_nearest_vessels(tree):
    volume, segments = tree
    rng = np.random.default_rng(0)
    bright = np.argwhere(volume.values > 0)
    voxels = np.concatenate([bright[rng.choice(len(bright), 150)], rng.integers(0, 96, (150, 3))])
    mm = voxels @ volume.affine[:3, :3].T + volume.affine[:3, 3]
    depth, radius = distances(mm, segments)
    edge = 1.2 * volume.spacing[0]
    share = np.clip(0.5 + depth / edge, 0.0, 1.0)
    value = (0.6 + 0.4 * np.minimum(radius / 2.0, 1.0)) * share**2 * (3.0 - 2.0 * share)
    np.testing.assert_allclose(volume.values[tuple(voxels.T)], 255.0 * value.max(axis=1), atol=0.51)


def test_vessels_fork_by_murrays_law(tree):
    _, segments = tree
    begins = {}
    for segment in segments[:-1]:
        begins.setdefault(segment[:3].tobytes(), []).append(segment)
    # A fork's children begin where the trunk ends; those that would be too fine are left out.
    forks = [
        (trunk, begins[trunk[4:7].tobytes()])
        for trunk in segments[:-1]
        if len(begins.get(trunk[4:7].tobytes(), ())) == 2
    ]
    assert len(forks) > 500
    cubes = np.array([[trunk[7] ** 3, sum(child[3] ** 3 for child in children)] for trunk, children in forks])
    np.testing.assert_allclose(cubes[:, 1], cubes[:, 0], rtol=1e-9)
    assert segments[:-1, 3].max() == ROOT_RADIUS
    assert segments[:, 3].min() >= LEAST_RADIUS
    assert abs(segments[1:, :3]).max() <= 0.52 * VESSEL_SIDE


def test_more_voxels_show_the_same(tree):
    coarse, fine = vessel_tree(25).values / 255.0, vessel_tree(97).values / 255.0
    # Voxels of the coarse one lie on every fourth of the fine one; where that is well inside, both are bright.
    blocks = fine[::4, ::4, ::4]
    assert np.corrcoef(coarse.ravel(), blocks.ravel())[0, 1] > 0.6
    head, finer = brain_like(25).values / 255.0, brain_like(97).values[::4, ::4, ::4] / 255.0
    assert np.corrcoef(head.ravel(), finer.ravel())[0, 1] > 0.9


def test_lines_run_through_the_vessels_of_the_volume(tree):
    volume, segments = tree
    lines = vessel_lines()
    branches = [lines.get_cell(index).point_ids for index in range(lines.n_cells)]
    assert sum(len(branch) - 1 for branch in branches) == len(segments) - 1  # without the aneurysm
    assert lines["radius"].max() == ROOT_RADIUS
    # Each branch is as wide as its vessel, but begins at a point of another: all of them hang on three roots.
    nodes = {}
    for branch in branches:
        assert np.ptp(lines["radius"][branch[1:]]) == 0.0
        for node in branch[1:]:
            nodes[node] = nodes.get(node, 0) + 1
    assert set(nodes.values()) == {1}
    assert len({branch[0] for branch in branches} - nodes.keys()) == 3
    thick = lines.points[lines["radius"] > 1.5 * volume.spacing[0]]
    voxels = np.rint((thick - volume.affine[:3, 3]) / volume.spacing).astype(int)
    voxels = voxels[(voxels >= 0).all(axis=1) & (voxels < 96).all(axis=1)]
    assert (volume.values[tuple(voxels.T)] > 100).all()


@pytest.mark.parametrize("make", [vessel_tree, brain_like])
def test_seeds_types_and_noise(make):
    first, again, other = make(32, 5), make(32, 5), make(32, 6)
    np.testing.assert_array_equal(first.values, again.values)
    assert (first.values != other.values).any()
    floats = make(32, 5, "float32").values
    assert floats.max() <= 1.0
    for dtype, peak in (("uint8", 255), ("uint16", 4095), ("int16", 4095)):
        values = make(32, 5, dtype).values
        assert values.dtype == dtype
        np.testing.assert_allclose(values, peak * floats.astype(float), atol=0.51)
    noisy = make(32, 5, "float32", noise=0.05).values
    added = noisy - floats
    assert added.min() >= -1e-7
    assert added.max() <= 0.05 + 1e-6
    assert added[floats == 0.0].mean() == pytest.approx(0.025, rel=0.02)
    neighbours = added[floats == 0.0]
    assert abs(np.corrcoef(neighbours[1:], neighbours[:-1])[0, 1]) < 0.03


def test_shells_follow_each_other_from_the_middle_outwards():
    values = brain_like(161, dtype="float32").values
    shells = np.array([0.7, 0.45, 0.2, 0.1, 0.9, 0.0])  # white matter, cortex, fluid, skull, scalp, air
    outwards = np.arange(20, 80)  # from beyond the ventricles
    seen = set()
    for way in [
        (1, 0, 0),
        (-1, 0, 0),
        (1, 1, 0),
        (-1, 1, 0),
        (1, -1, 0),
        (-1, -1, 0),
        (1, 0, 1),
        (-1, 0, 1),
        (1, 1, 1),
    ]:
        ray = values[tuple(80 + np.outer(way, outwards))]
        within = abs(ray[:, None] - shells) < 0.005
        order = np.argmax(within, axis=1)[within.any(axis=1)]
        assert (np.diff(order) >= 0).all(), way
        assert {0, 1, 3, 4, 5} <= set(order.tolist()), way
        seen.update(order.tolist())
    assert seen == set(range(6))


def test_the_cortex_is_folded():
    volume = brain_like(101, dtype="float32")
    # Along rays from the middle in one plane, how far out the cortex begins to give way to fluid.
    angles = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    radii = np.linspace(20.0, 85.0, 260)
    x, y = radii * np.cos(angles)[:, None], radii * np.sin(angles)[:, None]
    values = volume.values[np.rint(x / 2 + 50).astype(int), np.rint(y / 2 + 50).astype(int), 62]
    outermost = radii[values.shape[1] - 1 - np.argmax((abs(values - 0.45) < 0.1)[:, ::-1], axis=1)]
    depth = np.abs(np.diff(outermost))
    assert (depth > 4.0).sum() > 10  # walls of sulci: the surface jumps inwards


@pytest.mark.parametrize("make", [vessel_tree, brain_like])
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"n": 1}, "n=1; expected 2 voxels or more"),
        ({"n": 8, "dtype": "float64"}, "dtype='float64'; choose one of 'uint8', 'uint16', 'int16', 'float32'"),
        ({"n": 8, "noise": 1.5}, "noise=1.5; expected a part of the full brightness, 0 to 1"),
    ],
)
def test_bad_arguments(make, arguments, message):
    with pytest.raises(ValueError, match=message):
        make(**arguments)
