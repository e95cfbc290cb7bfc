"""Label volumes and their distance fields: against NumPy look-ups and brute force over voxels."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.query.regions import fields
from pvfiblets.query.regions.classify import classify_ball, pack

from .test_shapes import SHEAR, place, placement, rotation

RNG = np.random.default_rng(5)
VOLUME = np.zeros((11, 9, 13), np.int16)
VOLUME[2:6, 3:8, 1:9] = 3
VOLUME[7, 1, 11] = 5
VOLUME[4, 5, 5] = 0
VOLUME[0, 0, 0] = 5

AFFINES = {
    "plain": np.eye(4),
    "turned": placement(rotation() * (1.0, 2.5, 0.7), (-10.0, 4.0, 1e3)),
    "flipped": placement(np.diag([-2.0, -2.0, 2.0]), (90.0, 126.0, -72.0)),
    "sheared": SHEAR,
}


@pytest.fixture(params=list(AFFINES))
def affine(request):
    return AFFINES[request.param]


def scattered(affine, n=20_000):
    """Positions in and around the volume, mm."""
    return place(affine, RNG.uniform(-4.0, np.array(VOLUME.shape) + 3.0, (n, 3)))


def looked_up(mask, affine, points):
    voxels = np.floor(place(np.linalg.inv(affine), points) + 0.5).astype(int)
    inside = ((voxels >= 0) & (voxels < mask.shape)).all(axis=1)
    found = np.zeros(len(points), bool)
    found[inside] = mask[tuple(voxels[inside].T)]
    return found


def box_distances(points, voxels, sizes):
    """Distances (n,) of points (n, 3), voxel coordinates, from the nearest of voxels' boxes; axes at right angles."""
    gaps = np.maximum(np.abs(points[:, None] - voxels[None]) - 0.5, 0.0) * sizes
    return np.linalg.norm(gaps, axis=2).min(axis=1)


@pytest.mark.parametrize("labels", [None, 3, [5], (3, 5)])
def test_a_position_has_the_label_of_its_nearest_voxel(affine, labels):
    region = regions.Labels(VOLUME, affine, labels)
    mask = VOLUME != 0 if labels is None else np.isin(VOLUME, labels)
    assert (region.mask == mask).all()
    points = scattered(affine)
    assert (region.contains(points) == looked_up(mask, affine, points)).all()
    centres = place(affine, np.argwhere(np.ones(VOLUME.shape)).astype(float))
    assert (region.contains(centres) == mask.ravel()).all()
    low, high = region.bounds[::2], region.bounds[1::2]
    held = points[region.contains(points)]
    assert ((held >= low - 1e-9) & (held <= high + 1e-9)).all()


def test_single_positions_are_settled_exactly(affine):
    region = regions.Labels(VOLUME, affine)
    points = scattered(affine)
    sides = regions.classify(region, points, 0.0)
    assert (sides != 0).all()
    assert ((sides > 0) == region.contains(points)).all()
    # On the faces between voxels rounding decides, which is left to the exact look-up.
    faces = place(affine, np.array([[5.5, 5.0, 5.0], [2.0, 2.5, 5.0]]))
    assert (regions.classify(region, faces, 0.0) == 0).all()


def test_balls_are_never_misjudged(affine):
    region = regions.Labels(VOLUME, affine)
    centres, radii = scattered(affine, 3000), RNG.exponential(1.0, 3000)
    sides = regions.classify(region, centres, radii)
    towards = RNG.normal(size=(3000, 60, 3))
    towards *= (RNG.choice([0.4, 0.8, 1.0], (3000, 60)) / np.linalg.norm(towards, axis=2))[..., None]
    within = region.contains((centres[:, None] + radii[:, None, None] * towards).reshape(-1, 3)).reshape(3000, 60)
    assert within[sides > 0].all()
    assert not within[sides < 0].any()
    assert (sides == -1).sum() > 500
    assert (sides == 1).sum() >= 4


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["plain", "turned", "flipped"])
@pytest.mark.parametrize("most", [10**9, 60])
def test_the_field_bounds_the_distance_to_the_nearest_change(name, most, monkeypatch):
    monkeypatch.setattr(fields, "MOST_VALUES", most)
    region = regions.Labels(VOLUME, AFFINES[name])
    field = region.field
    sizes = np.linalg.norm(AFFINES[name][:3, :3], axis=0)
    assert field.whole == (most > 1000)
    assert field.values.size <= most
    nz, ny, nx = field.values.shape
    nodes = field.origin + field.spacing * np.argwhere(np.ones((nx, ny, nz)))
    assert field.steps == pytest.approx(field.spacing * sizes)
    padded = np.pad(VOLUME != 0, 8)
    values = field.values.transpose(2, 1, 0).ravel().astype(float)
    to_in, to_out = (box_distances(nodes, np.argwhere(padded == state) - 8.0, sizes) for state in (True, False))
    sure = values != 0
    held = region.contains(place(AFFINES[name], nodes))
    assert (held == (values > 0))[sure].all()
    exact = np.where(values > 0, to_out, to_in)
    assert (np.abs(values) <= exact)[sure].all()
    if field.whole:
        assert sure.all()
        assert (np.abs(values) >= exact - np.linalg.norm(sizes) / 2).all()
        edge = exact == sizes.min() / 2
        assert edge.any()
        assert np.abs(values[edge]) == pytest.approx(exact[edge], rel=1e-5), "half a voxel at a boundary voxel"


def test_blocks_of_voxels_still_never_misjudge(monkeypatch):
    monkeypatch.setattr(fields, "MOST_VALUES", 60)
    region = regions.Labels(VOLUME, AFFINES["turned"])
    points = scattered(AFFINES["turned"])
    sides = regions.classify(region, points, RNG.choice([0.0, 0.3], len(points)))
    assert (region.contains(points) == (sides > 0))[sides != 0].all()
    assert (sides != 0).mean() > 0.5


@pytest.mark.parametrize("sizes", [(1.0, 1.0, 1.0), (0.3, 2.0, 5.0), (1e-6, 1e-6, 3e-6), (1e6, 1e6, 1e6)])
def test_the_distance_transform_is_exact(sizes):
    targets = RNG.random((12, 15, 17)) < 0.01
    found = fields.squared_distances(targets, np.array(sizes))
    all_places, chosen = np.argwhere(np.ones(targets.shape))[:, ::-1] * sizes, np.argwhere(targets)[:, ::-1] * sizes
    expected = ((all_places[:, None] - chosen[None]) ** 2).sum(axis=2).min(axis=1)
    assert found.ravel() == pytest.approx(expected, rel=1e-6)
    assert (fields.squared_distances(np.zeros((3, 3, 3), bool), np.ones(3)) > 1e36).all()


@pytest.mark.parametrize("name", ["plain", "turned", "flipped"])
def test_distances_are_to_the_nearest_voxels_box(name):
    affine = AFFINES[name]
    region = regions.Labels(VOLUME, affine)
    points = scattered(affine, 2000)
    own = place(np.linalg.inv(affine), points)
    expected = box_distances(own, np.argwhere(VOLUME).astype(float), np.linalg.norm(affine[:3, :3], axis=0))
    assert region.distance(points) == pytest.approx(expected, abs=1e-9)


def test_distances_in_a_sheared_volume():
    region = regions.Labels(VOLUME, SHEAR, 3)
    points = scattered(SHEAR, 500)
    boxes = [regions.Box(center=voxel, size=1.0).moved(SHEAR) for voxel in np.argwhere(VOLUME == 3).astype(float)]
    assert region.distance(points) == pytest.approx(np.min([box.distance(points) for box in boxes], axis=0), abs=1e-9)


def test_a_moved_volume_shares_its_field_and_asks_like_a_new_affine():
    region = regions.Labels(VOLUME, AFFINES["turned"])
    moved, made = region.moved(SHEAR), regions.Labels(VOLUME, SHEAR @ AFFINES["turned"])
    points = scattered(SHEAR @ AFFINES["turned"], 5000)
    clear = regions.classify(made, points, 1e-9) != 0
    assert (moved.contains(points) == made.contains(points))[clear].all()
    assert moved.field is region.field
    sides = regions.classify(moved, points, 0.5)
    assert (moved.contains(points) == (sides > 0))[sides != 0].all()
    assert moved.matrix @ np.append(place(SHEAR @ AFFINES["turned"], np.array([[1.0, 2.0, 3.0]]))[0], 1.0) == (
        pytest.approx([1.0, 2.0, 3.0, 1.0])
    )


def test_full_and_single_voxel_volumes():
    full = regions.Labels(np.ones((4, 4, 4), bool), np.eye(4))
    assert regions.classify(full, (1.5, 1.5, 1.5), 0.6).tolist() == [1]
    assert regions.classify(full, (1.5, 1.5, 1.5), 2.1).tolist() == [0]
    assert regions.classify(full, (9.0, 1.5, 1.5), 5.0).tolist() == [-1]
    single = regions.Labels(np.ones((1, 1, 1), np.uint8), np.diag([1e-6, 1e-6, 1e-6, 1.0]))
    assert single.contains(np.array([[4e-7, 0, 0], [6e-7, 0, 0]])).tolist() == [True, False]
    assert regions.classify(single, (0, 0, 0), [4e-7]).tolist() == [1]


def test_volumes_of_floats_and_what_is_none():
    values = np.where(VOLUME == 5, np.nan, VOLUME)
    assert (regions.Labels(values, np.eye(4)).mask == (VOLUME == 3)).all()
    with pytest.raises(ValueError, match=r"shape \(3, 3\).*give \(i, j, k\) integers"):
        regions.Labels(np.ones((3, 3)), np.eye(4))
    with pytest.raises(ValueError, match=r"shape \(2, 2, 2, 4\).*one time step"):
        regions.Labels(np.ones((2, 2, 2, 4)), np.eye(4))
    with pytest.raises(ValueError, match=r"no voxel has a label of \[7\]; there are 0, 3, 5"):
        regions.Labels(VOLUME, np.eye(4), 7)
    with pytest.raises(ValueError, match="all are 0"):
        regions.Labels(np.zeros((2, 2, 2)), np.eye(4))
    with pytest.raises(ValueError, match="flattens space"):
        regions.Labels(VOLUME, np.diag([1.0, 1.0, 0.0, 1.0]))
    with pytest.raises(ValueError, match="labels are"):
        regions.Labels(VOLUME, np.eye(4), [])


def test_kernels_get_each_field_once():
    labels = regions.Labels(VOLUME, np.eye(4))
    region = (labels - labels.moved(SHEAR)) | regions.Sphere((0, 0, 0), 2)
    packed = pack(region)
    assert packed.rows.shape == (3, 20)
    assert packed.rows[:, 17].tolist() == [0, 0, -1]
    assert len(packed.fields) == 1 == len(packed.grids)
    assert packed.values.size >= labels.field.values.size
    points = RNG.uniform(-2, 8, (50, 3))
    each = [classify_ball(*packed.arrays, *point, 0.25) for point in points]
    assert each == regions.classify(region, points, 0.25).tolist()
    assert pack(region) is packed
