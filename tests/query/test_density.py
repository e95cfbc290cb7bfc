"""Density maps: against a clip in NumPy that cuts one segment at a time, and examples whose numbers are known."""

import gzip
import itertools

import nibabel as nib
import numba
import numpy as np
import pytest
import pyvista as pv
from hypothesis import assume, given
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.query.density import density_sources, voxel_grid
from pvfiblets.query.density import volume as room
from pvfiblets.query.density.density_map import DensityMap
from pvfiblets.query.density.voxel_grid import VoxelGrid, grid_about, grid_like
from pvfiblets.query.measures.measures import Distance, measure
from pvfiblets.streamlines import Streamlines
from tests.codec.test_restrict import every_kind

SHEARED = np.array([[3.4, 0.8, 0, -45.0], [-0.6, 4.2, 0.4, -35.0], [0.2, 1.0, -6.6, 30.0], [0, 0, 0, 1.0]])
SHAPE = (17, 19, 15)


def pieces(a, b):
    """Of a segment in voxels from the grid's corner: voxel, share, and where the middle lies, piece by piece."""
    cuts = [0.0, 1.0]
    for k in range(3):
        low, high = sorted((a[k], b[k]))
        if high > low:
            cuts += [(face - a[k]) / (b[k] - a[k]) for face in range(int(np.floor(low)), int(np.ceil(high)) + 1)]
    cuts = np.unique(np.clip(cuts, 0.0, 1.0))
    middles = (cuts[1:] + cuts[:-1]) / 2
    where = np.floor(a + middles[:, None] * (b - a)).astype(int)
    return [(tuple(v), share, m) for v, share, m in zip(where.tolist(), np.diff(cuts), middles, strict=True)]


def reference(
    lines,
    grid,
    weights=None,
    values=None,
):
    """Every contrast, from float64 points."""
    w = np.ones(len(lines)) if weights is None else weights
    found = {name: np.zeros(grid.shape) for name in ("count", "length", "sum", "known")}
    found["direction"] = np.zeros((*grid.shape, 3))
    to_voxels = np.linalg.inv(grid.affine)
    for s, line in enumerate(lines):
        u = line @ to_voxels[:3, :3].T + to_voxels[:3, 3] + 0.5
        visited = {tuple(v) for v in np.floor(u).astype(int).tolist()}
        for i in range(len(line) - 1):
            step = line[i + 1] - line[i]
            length = np.linalg.norm(step)
            for voxel, share, middle in pieces(u[i], u[i + 1]):
                if length > 0.0:
                    visited.add(voxel)
                if not all(0 <= v < n for v, n in zip(voxel, grid.shape, strict=True)):
                    continue
                found["length"][voxel] += w[s] * length * share
                found["direction"][voxel] += w[s] * share * np.abs(step)
                if values is not None:
                    value = values[s][i] + middle * (values[s][i + 1] - values[s][i])
                    if np.isfinite(value):
                        found["sum"][voxel] += w[s] * length * share * value
                        found["known"][voxel] += w[s] * length * share
        for voxel in visited:
            if all(0 <= v < n for v, n in zip(voxel, grid.shape, strict=True)):
                found["count"][voxel] += w[s]
    with np.errstate(invalid="ignore"):
        found["direction"] = np.nan_to_num(found["direction"] / found["length"][..., None])
        found["mean"] = np.nan_to_num(found["sum"] / found["known"])
    return found


def lines_with_values():
    lines = every_kind()
    rng = np.random.default_rng(3)
    fa = rng.random(lines.n_points)
    fa[40:60] = np.nan
    return Streamlines(
        lines.points, lines.offsets, {"fa": fa}, {"age": rng.random(len(lines)), "sift2": rng.random(len(lines))}
    )


LINES = lines_with_values()


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    monkeypatch.setattr(density_sources, "CHUNK", 2000)
    monkeypatch.setattr(room, "PIECES", 3000)


@pytest.fixture(scope="module", params=["input", "hilbert", "mapped"])
def whole(request, tmp_path_factory):
    order = "input" if request.param == "input" else "hilbert"
    made = pf.compress(LINES, per_point=["fa"], order=order)
    if request.param != "mapped":
        return made
    path = tmp_path_factory.mktemp("density") / "a.fiblets"
    made.save(path)
    return pf.FibletSet.open(path)


@pytest.fixture(scope="module")
def part_of():
    """A set, what a sheared grid that covers a part of it holds, and the length of all of it."""
    coded = pf.compress(LINES)
    lines = coded.decompress(dtype=np.float64)
    return coded, reference(lines.to_list(), VoxelGrid(SHAPE, SHEARED)), lines.lengths().sum()


def split(rows, lines):
    return np.split(rows, np.cumsum([len(line) for line in lines])[:-1])


@pytest.mark.more
def test_every_contrast_is_the_reference(whole):
    lines = whole.decompress(dtype=np.float64)
    low, high = np.reshape(whole.bounds, (3, 2)).T  # of the originals, which density maps keep to
    points = [np.clip(line, low, high) for line in lines.to_list()]
    per_point = np.asarray(lines.per_point["fa"], np.float64).ravel()
    for weights in (None, "sift2"):
        w = None if weights is None else LINES.per_streamline["sift2"]
        found = whole.density(14.0, weights=weights)
        exact = reference(points, found.grid, w, split(per_point, points))
        np.testing.assert_allclose(found.values, exact["count"], rtol=1e-12)
        assert found.values.dtype == (np.int32 if weights is None else np.float64)
        for contrast in ("length", "direction"):
            found = whole.density(14.0, contrast=contrast, weights=weights)
            np.testing.assert_allclose(found.values, exact[contrast], rtol=1e-9, atol=1e-12)
            assert found.share_outside < 1e-12
        for contrast in ("fa", per_point):
            found = whole.density(14.0, contrast=contrast, weights=weights)
            np.testing.assert_allclose(found.values, exact["mean"], rtol=1e-6, atol=1e-9)
            assert np.isfinite(found.values).all()


@pytest.mark.few(1)
def test_values_of_streamlines_are_their_means(whole):
    age = np.asarray(LINES.per_streamline["age"])
    points = whole.decompress(dtype=np.float64).to_list()
    found = whole.density((13.0, 12.0, 14.0), contrast="age")
    exact = reference(points, found.grid, None, [np.full(len(p), a) for p, a in zip(points, age, strict=True)])
    np.testing.assert_allclose(found.values, exact["mean"], rtol=1e-9, atol=1e-12)
    for contrast in (age, measure(whole, "age")):
        np.testing.assert_array_equal(whole.density((13.0, 12.0, 14.0), contrast=contrast).values, found.values)
    assert whole.density(15.0, contrast="curvature").unit == "1/mm"
    assert (whole.density(15.0, contrast=Distance((0.0, 0.0, 0.0), per="point")).values >= 0.0).all()


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", ["nibabel", "pyvista", "cells", "shape", "array", "map"])
def test_grids_of_images_may_be_sheared_and_cover_a_part(part_of, kind):
    coded, exact, everything = part_of
    like = {
        "nibabel": lambda: nib.Nifti1Image(np.zeros((*SHAPE, 2), np.float32), SHEARED),
        "pyvista": lambda: pyvista_image(SHAPE, SHEARED),
        "cells": lambda: pyvista_image(SHAPE, SHEARED, cells=True),
        "shape": lambda: (SHAPE, SHEARED),
        "array": lambda: (np.zeros(SHAPE), SHEARED),
        "map": lambda: DensityMap(np.zeros(SHAPE), VoxelGrid(SHAPE, SHEARED), "count", "", 0.0),
    }[kind]()
    found = coded.density(like=like, contrast="length")
    np.testing.assert_allclose(found.affine, SHEARED, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.values, exact["length"], rtol=1e-9, atol=1e-12)
    outside = 1.0 - exact["length"].sum() / everything
    assert 0.05 < outside < 0.95
    assert found.share_outside == pytest.approx(outside, rel=1e-7)  # points are held within the originals' bounds
    np.testing.assert_array_equal(coded.density(like=like).values, exact["count"])


def pyvista_image(shape, affine, cells=False):
    """An image that has these voxels, with an extent that does not begin at 0."""
    n = np.array(shape) + cells
    image = pv.ImageData()
    image.SetExtent(2, 1 + n[0], -3, n[1] - 4, 5, n[2] + 4)
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    image.spacing, image.direction_matrix = spacing, affine[:3, :3] / spacing
    first = np.array([2, -3, 5]) + 0.5 * cells
    image.origin = affine[:3, 3] - affine[:3, :3] @ first
    data = image.cell_data if cells else image.point_data
    data["labels"] = np.zeros(np.prod(shape))
    image.set_active_scalars("labels")
    return image


def lone(*points):
    return Streamlines.from_list([np.array(points, np.float64)])


UNIT = ((4, 4, 4), np.eye(4))  # voxel (1, 2, 3) is [0.5, 1.5) x [1.5, 2.5) x [2.5, 3.5)


@pytest.mark.parametrize(
    ("line", "lengths"),
    [
        # Through corners of voxels there are no pieces beside the diagonal.
        (lone((0, 0, 0), (3, 3, 3)), {(0, 0, 0): 0.5, (1, 1, 1): 1.0, (2, 2, 2): 1.0, (3, 3, 3): 0.5}),
        (lone((3, 3, 3), (0, 0, 0)), {(0, 0, 0): 0.5, (1, 1, 1): 1.0, (2, 2, 2): 1.0, (3, 3, 3): 0.5}),
        (lone((0, 1, 0), (1, 0, 0)), {(0, 1, 0): 0.5, (1, 0, 0): 0.5}),
        # In a face and in an edge: of the voxel above.
        (lone((0.5, 0, 0), (0.5, 2, 0)), {(1, 0, 0): 0.5, (1, 1, 0): 1.0, (1, 2, 0): 0.5}),
        (lone((0.5, 0.5, 2), (0.5, 0.5, 0)), {(1, 1, 0): 0.5, (1, 1, 1): 1.0, (1, 1, 2): 0.5}),
        # From face to face, and beyond the grid on both sides.
        (lone((0.5, 1, 1), (1.5, 1, 1)), {(1, 1, 1): 1.0, (2, 1, 1): 0.0}),
        (lone((1.5, 1, 1), (0.5, 1, 1)), {(1, 1, 1): 1.0, (2, 1, 1): 0.0}),
        (lone((-9, 1, 1), (9, 1, 1)), {(i, 1, 1): 1.0 for i in range(4)}),
        (lone((1, 1, 3.5), (1, 1, 9)), {}),  # the grid's upper face is outside
        (lone((1, 1, -0.5), (1, 1, -9)), {(1, 1, 0): 0.0}),  # its lower one is inside
        (lone((3.5, 1, 1), (3.5, 2.5, 1)), {}),  # along the upper face
        (lone((1, 3.5, 3), (1, 3.5, 1)), {}),
        (lone((-0.5, 1, 1), (-0.5, 1.5, 1)), {(0, 1, 1): 0.5, (0, 2, 1): 0.0}),  # along the lower one
        # Without length: where the points are.
        (lone((2, 2, 2), (2, 2, 2)), {(2, 2, 2): 0.0}),
        (lone((2, 2, 2)), {(2, 2, 2): 0.0}),
        (lone((20, 2, 2)), {}),
        # There and back: twice the length, one visit.
        (lone((0, 0, 0), (1, 0, 0), (0, 0, 0)), {(0, 0, 0): 1.0, (1, 0, 0): 1.0}),
    ],
)  # fmt: skip
def test_points_on_faces_and_without_length(line, lengths):
    scale = np.linalg.norm(line.points[-1] - line.points[0]) if len(line.points) > 1 else 1.0
    along = np.abs(line.points[-1] - line.points[0]).max() if len(line.points) > 1 else 1.0
    expected, visits = np.zeros((4, 4, 4)), np.zeros((4, 4, 4))
    for voxel, length in lengths.items():
        expected[voxel] = length * (scale / along if along else 1.0)
        visits[voxel] = 1
    np.testing.assert_allclose(pf.density(line, like=UNIT, contrast="length").values, expected, atol=1e-15)
    np.testing.assert_array_equal(pf.density(line, like=UNIT).values, visits)
    for contrast in ("direction", np.full(len(line.points), 7.0) if len(line.points) > 1 else np.array([7.0])):
        found = pf.density(line, like=UNIT, contrast=contrast).values
        assert np.isfinite(found).all()
        assert ((found != 0).reshape(4, 4, 4, -1).any(axis=3) == (expected > 0)).all()


@pytest.mark.parametrize(("middle", "scale"), [(0.0, 1.0), (1e6, 1.0), (-1e6, 1e-2), (0.0, 1e-6), (1e9, 1e3)])
def test_far_and_tiny_coordinates_keep_their_lengths(middle, scale):
    rng = np.random.default_rng(1)
    steps = rng.normal(size=(20, 30, 3)) * scale
    lines = Streamlines.from_list(list(np.cumsum(steps, axis=1) + middle))
    found = pf.density(lines, 2.0 * scale, contrast="length")
    exact = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines)
    assert found.values.sum() == pytest.approx(exact, rel=1e-12)
    centred = Streamlines.from_list([line - middle for line in lines])
    affine = found.affine.copy()
    affine[:3, 3] -= middle
    moved = pf.density(centred, like=(found.values, affine), contrast="length")
    np.testing.assert_allclose(moved.values, found.values, rtol=0, atol=1e-9 * max(abs(middle), scale))


@given(st.lists(st.tuples(*[st.floats(-1e3, 1e3, width=32)] * 3), min_size=1, max_size=12), st.floats(0.5, 500.0))
def test_no_length_is_lost(points, size):
    line = lone(*points)
    # Voxels, of which more would take a machine's whole memory.
    assume(np.prod(np.ptp(line.points.astype(float), axis=0) / size + 1.0) < 5e6)
    exact = np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()
    found = pf.density(line, size, contrast="length")
    assert found.values.sum() == pytest.approx(exact, rel=1e-12, abs=1e-300)
    assert (found.values >= 0.0).all()
    half = pf.density(line, like=((3, 3, 3), np.diag([size, size, size, 1.0])), contrast="length")
    assert half.share_outside == pytest.approx(1.0 - half.values.sum() / exact if exact else 0.0, abs=1e-9)


def test_a_long_segment_through_many_voxels_is_cut_exactly():
    """Each of ten thousand pieces is computed by itself: errors do not add up."""
    line = lone((0.1, 0.2, 0.3), (9999.7, 3.9, 2.6))
    found = pf.density(line, like=((10_001, 5, 4), np.eye(4)), contrast="length").values
    length = np.linalg.norm(line.points[1] - line.points[0])
    columns = found.sum(axis=(1, 2))
    np.testing.assert_allclose(columns[1:-1], length / 9999.6, rtol=1e-10)
    assert found.sum() == pytest.approx(length, rel=1e-14)


def test_visits_are_those_of_dipy():
    """dipy counts the voxels that points lie in: with a point every hundredth of a voxel the same but for grazes."""
    from dipy.tracking.utils import density_map

    rng = np.random.default_rng(5)
    lines = []
    for _ in range(60):
        ends = rng.uniform(-30.0, 30.0, (2, 3))
        t = np.linspace(0.0, 1.0, 4000)[:, None]
        lines.append(ends[0] + t * (ends[1] - ends[0]) + 6.0 * np.sin(3.0 * t) * rng.normal(size=3))
    affine = np.array([[4.0, 0.3, 0.0, -40.0], [-0.3, 4.0, 0.0, -38.0], [0.0, 0.0, 3.0, -35.0], [0.0, 0.0, 0.0, 1.0]])
    shape = (20, 20, 24)
    ours = pf.density(Streamlines.from_list(lines), like=(shape, affine)).values
    theirs = density_map(lines, affine, shape)
    assert theirs.sum() > 500
    assert (ours >= theirs).all()
    assert (ours - theirs).sum() <= 0.01 * theirs.sum()


def test_sums_do_not_depend_on_threads(whole):
    threads = numba.get_num_threads()
    try:
        found = []
        for n in {1, threads}:
            numba.set_num_threads(n)
            found.append(whole.density(12.0, contrast="direction", weights="sift2").values)
    finally:
        numba.set_num_threads(threads)
    np.testing.assert_array_equal(found[0], found[-1])


@pytest.mark.few(1)
def test_end_points_alone(whole):
    points = whole.decompress(dtype=np.float64).to_list()
    ends = [line[[0, -1]] if len(line) > 1 else line for line in points]
    found = whole.density(16.0, ends_only=True)
    edges = [np.arange(n + 1) * 16.0 + c for n, c in zip(found.grid.shape, found.grid.corner, strict=True)]
    exact = np.histogramdd(np.concatenate(ends), edges)[0]
    np.testing.assert_array_equal(found.values, exact)
    assert found.share_outside == 0.0
    of = np.concatenate([np.full(len(e), i) for i, e in enumerate(ends)])
    weighted = whole.density(16.0, ends_only=True, weights="sift2").values
    heavy = np.histogramdd(np.concatenate(ends), edges, weights=LINES.per_streamline["sift2"][of])[0]
    np.testing.assert_allclose(weighted, heavy, rtol=1e-12)
    means = whole.density(16.0, ends_only=True, contrast="age").values
    ages = np.histogramdd(np.concatenate(ends), edges, weights=LINES.per_streamline["age"][of])[0]
    np.testing.assert_allclose(means[exact > 0], (ages / np.maximum(exact, 1))[exact > 0], rtol=1e-12)
    tangents = whole.density(16.0, ends_only=True, contrast="direction").values
    norms = np.linalg.norm(tangents, axis=3)
    assert ((norms == 0) | ((norms > 0.5) & (norms <= 1.0 + 1e-12))).all()
    part = whole.density(like=(SHAPE, SHEARED), ends_only=True)
    assert part.share_outside == pytest.approx(1.0 - part.values.sum() / len(of))


@pytest.mark.more
def test_files_and_memory_give_the_same(tmp_path):
    trx, fiblets = tmp_path / "a.trx", tmp_path / "a.fiblets"
    formats.write(trx, LINES)
    lines = formats.read(trx)
    pf.compress(LINES, per_point=["fa"]).save(fiblets)
    weights = LINES.per_streamline["sift2"]
    for like in (None, (SHAPE, SHEARED)):
        for contrast in ("count", "length", "direction", "fa", "age", np.arange(lines.n_points)):
            grid = {"voxel_size": 14.0} if like is None else {"like": like}
            found = pf.density(trx, **grid, contrast=contrast, weights="sift2")
            same = pf.density(lines, **grid, contrast=contrast, weights=weights)
            np.testing.assert_array_equal(found.values, same.values)
            if not isinstance(contrast, str):
                continue
            coded = pf.density(fiblets, like=found, contrast=contrast, weights="sift2")
            scale = np.abs(found.values).max()
            assert np.abs(coded.values - found.values).mean() < 0.05 * scale
            np.testing.assert_array_equal(
                coded.values, pf.FibletSet.open(fiblets).density(like=found, contrast=contrast, weights=weights).values
            )
    through_pyvista = lines.to_polydata().fiblets.density(14.0, contrast="fa", weights="sift2")
    np.testing.assert_allclose(through_pyvista.values, pf.density(trx, 14.0, contrast="fa", weights="sift2").values)


def test_nothing_gives_an_empty_map():
    empty = Streamlines.from_list([])
    for source in (empty, pf.compress(empty)):
        found = pf.density(source, 2.0)
        assert found.values.shape == (1, 1, 1)
        assert not found.values.any()
        assert found.share_outside == 0.0


def test_images_of_pyvista_lie_where_the_voxels_are():
    """Sampled at the middles of voxels, an image has their numbers, however it is sheared and flipped."""
    lines = pf.compress(LINES).decompress()
    for contrast in ("length", "direction"):
        found = pf.density(lines, like=(SHAPE, SHEARED), contrast=contrast)
        image = found.to_image()
        assert isinstance(image, pv.ImageData)
        assert image.active_scalars_name == contrast
        at = np.argwhere(found.values.reshape(*SHAPE, -1)[..., 0] > 0)[:40]
        where = at @ SHEARED[:3, :3].T + SHEARED[:3, 3]
        rows = np.ravel_multi_index(at.T, SHAPE, order="F")
        np.testing.assert_allclose(image.points[rows], where, atol=1e-5)
        np.testing.assert_array_equal(image[contrast][rows], found.values[tuple(at.T)])
        assert np.shares_memory(image[contrast], found.values) or contrast == "direction"


@pytest.mark.parametrize("contrast", ["count", "length", "direction"])
@pytest.mark.parametrize("suffix", [".mif", ".mif.gz"])
def test_a_mif_is_what_its_format_says(tmp_path, suffix, contrast):
    """Read by the words of MRtrix's page on the format: fields of text, then numbers where ``file`` says."""
    found = pf.density(LINES, like=(SHAPE, SHEARED), contrast=contrast)
    found.save(tmp_path / f"a{suffix}")
    raw = (tmp_path / f"a{suffix}").read_bytes()
    raw = gzip.decompress(raw) if suffix.endswith(".gz") else raw
    lines = raw[: raw.index(b"\nEND\n")].decode().split("\n")
    assert lines[0] == "mrtrix image"
    fields = dict(line.split(": ") for line in lines[1:] if not line.startswith(("transform", "comments")))
    shape = tuple(map(int, fields["dim"].split(",")))
    assert shape == found.values.shape
    assert fields["layout"] == ",".join(f"+{axis}" for axis in range(len(shape)))
    kind = {"Int32LE": "<i4", "Float32LE": "<f4"}[fields["datatype"]]
    assert (kind == "<i4") == (contrast == "count")
    data = np.frombuffer(raw, kind, offset=int(fields["file"].split()[1])).reshape(shape, order="F")
    np.testing.assert_allclose(data, found.values, rtol=1e-6)
    rows = np.array([line.split(": ")[1].split(",") for line in lines if line.startswith("transform")], float)
    np.testing.assert_allclose(np.linalg.norm(rows[:, :3], axis=0), 1.0)
    affine = rows * [*np.array(fields["vox"].split(",")[:3], float), 1.0]
    np.testing.assert_allclose(affine, SHEARED[:3])
    with pytest.raises(ValueError, match="MIF has no float16; give dtype='float32'"):
        found.save(tmp_path / f"a{suffix}", dtype=np.float16)


@pytest.mark.parametrize("contrast", ["count", "direction"])
def test_pyvista_reads_a_vti(tmp_path, contrast):
    straight = SHEARED.copy()
    straight[:3, :3] = np.linalg.qr(SHEARED[:3, :3])[0] * [2.0, 3.0, 4.0]
    found = pf.density(LINES, like=(SHAPE, straight), contrast=contrast)
    found.save(tmp_path / "a.vti")
    image = pv.read(tmp_path / "a.vti")
    np.testing.assert_allclose(image.index_to_physical_matrix, straight, atol=1e-12)
    values = image.active_scalars.reshape(*SHAPE, *found.values.shape[3:], order="F")
    assert image.active_scalars_name == found.name
    np.testing.assert_allclose(values, found.values, rtol=1e-6)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.vti"]


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz"])
def test_nibabel_reads_what_is_written(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    reference_image = nib.Nifti1Image(np.zeros(SHAPE, np.float32), SHEARED)
    reference_image.set_sform(SHEARED, 4)
    for contrast, kind in (("count", np.int32), ("length", np.float32), ("direction", np.float32)):
        found = pf.density(LINES, like=reference_image, contrast=contrast)
        found.save(path)
        image = nib.load(path)
        assert image.get_data_dtype() == kind
        np.testing.assert_allclose(image.affine, SHEARED, atol=1e-5)
        assert int(image.header["sform_code"]) == 4
        assert int(image.header["qform_code"]) == 0  # it could not hold the shear
        np.testing.assert_array_equal(np.asarray(image.dataobj), found.values.astype(kind))
        assert image.header.get_xyzt_units()[0] == "mm"
        assert [p.name for p in tmp_path.iterdir()] == [path.name]
    found.save(path, dtype=np.float64)
    np.testing.assert_array_equal(nib.load(path).get_fdata(), found.values)
    straight = pf.density(LINES, 15.0)
    straight.save(path)
    np.testing.assert_allclose(nib.load(path).get_qform(), straight.affine, atol=1e-5)
    with pytest.raises(ValueError, match=r"a\.png is no name of an image"):
        straight.save(tmp_path / "a.png")


def test_grids_of_one_size_fit_each_other():
    a, b = grid_about((0.2, -3.1, 5.0), (7.0, 2.0, 5.0), 1.5), grid_about((2.0, 2.0, 2.0), (9.0, 9.0, 9.0), 1.5)
    for grid in (a, b):
        np.testing.assert_allclose(grid.corner / 1.5, np.rint(grid.corner / 1.5), atol=1e-12)
    assert (a.corner <= (0.2, -3.1, 5.0)).all()
    assert (a.corner + 1.5 * np.array(a.shape) > (7.0, 2.0, 5.0)).all()
    assert a.shape == (5, 5, 1)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({}, ValueError, "give either voxel_size"),
        ({"voxel_size": 1.0, "like": UNIT}, ValueError, "give either voxel_size"),
        ({"voxel_size": 0.0}, ValueError, "voxel_size is 0.0; give a finite number of mm above 0"),
        ({"voxel_size": (1.0, 2.0)}, ValueError, "voxel_size is"),
        ({"voxel_size": 1e-13}, ValueError, "too small .* give a larger voxel_size"),
        ({"voxel_size": 0.2}, ValueError, "takes .* GB of the .* give a larger voxel_size"),
        ({"like": 3}, TypeError, "like is a int; give the path of an image"),
        ({"like": (np.zeros((3, 3)), np.eye(4))}, ValueError, "three axes"),
        ({"like": ((3, 3, 3), np.zeros((4, 4)))}, ValueError, "affine"),
        ({"like": ((3, 0, 3), np.eye(4))}, ValueError, "three whole numbers above 0"),
        ({"like": __file__}, ValueError, "is no image; give a file that ends in .nii"),
        ({"like": "none.nii"}, FileNotFoundError, "none.nii"),
        ({"voxel_size": 90.0, "weights": "none"}, KeyError, "no array per streamline is named 'none'; there are: age"),
        ({"voxel_size": 90.0, "weights": np.ones(3)}, ValueError, r"weights are float64\(3,\); one number for each of"),
        ({"voxel_size": 90.0, "weights": np.full(73, -1.0)}, ValueError, "weight of streamline 0 is -1.0"),
        ({"voxel_size": 90.0, "weights": np.full(73, np.nan)}, ValueError, "weight of streamline 0 is nan"),
        ({"voxel_size": 90.0, "contrast": "none"}, KeyError, "none"),
        ({"voxel_size": 90.0, "contrast": np.ones(3)}, ValueError, "one number for each of"),
        ({"voxel_size": 90.0, "contrast": "length", "ends_only": True}, ValueError, "end points have none"),
    ],
)  # fmt: skip
def test_errors_name_the_value_and_the_remedy(arguments, error, message):
    for source in (LINES, pf.compress(LINES)):
        with pytest.raises(error, match=message):
            pf.density(source, **arguments)


def test_other_sources_are_refused():
    with pytest.raises(TypeError, match="source is a list; give a FibletSet, Streamlines, or the path"):
        pf.density([np.zeros((3, 3))], 1.0)
    with pytest.raises(TypeError, match="a Distance, which is for compressed sets"):
        pf.density(LINES, 1.0, contrast=Distance((0, 0, 0)))


def test_a_line_is_not_joined_across_a_point_that_is_no_number():
    with pytest.warns(UserWarning, match="the streamlines: .*non-finite points: 1; streamlines added"):
        found = pf.density(lone((0, 0, 0), (1, 0, 0), (np.nan, 0, 0), (3, 0, 0)), like=UNIT, contrast="length")
    wanted = pf.density(lone((0, 0, 0), (1, 0, 0)), like=UNIT, contrast="length")
    np.testing.assert_array_equal(found.values, wanted.values)


def test_an_image_has_its_mean_in_voxels_as_an_array_of_its_values_has():
    image = (np.random.default_rng(6).random((9, 9, 9)), np.diag([9.0, 9.0, 9.0, 1.0]))
    values = pf.sample(LINES, image)
    assert np.isnan(values).any()
    wanted = pf.density(LINES, 14.0, contrast=values)
    for source in (LINES, pf.compress(LINES, exact=True)):
        np.testing.assert_allclose(pf.density(source, 14.0, contrast=image).values, wanted.values, atol=1e-5)


def test_damaged_images_are_reported(tmp_path):
    path = tmp_path / "a.nii"
    path.write_bytes(b"no image")
    with pytest.raises(pf.FormatError, match="a whole NIfTI or MGH image"):
        pf.density(LINES, like=path)


def test_progress_is_told():
    told = []
    pf.density(LINES, 14.0, progress=lambda what, share: told.append((what, share)))
    assert list(dict.fromkeys(what for what, _ in told)) == ["surveying", "adding up"]
    shares = [share for what, share in told if what == "adding up"]
    assert all(a <= b for a, b in itertools.pairwise(shares))
    assert shares[-1] > 0.5


def test_real_streamlines_keep_their_length(shared_data):
    """A file of another program, on the grid of its image's size; and its counts are at least those of its points."""
    lines = formats.read(shared_data / "dipy_hist_tractogram.trk")
    found = pf.density(lines, 1.0, contrast="length")
    assert found.values.sum() == pytest.approx(lines.lengths().sum(), rel=1e-9)
    counts = pf.density(lines, 1.0)
    edges = [np.arange(n + 1) + c for n, c in zip(counts.grid.shape, counts.grid.corner, strict=True)]
    of_points = np.zeros(counts.grid.shape)
    for line in lines:
        of_points += np.histogramdd(line.astype(np.float64), edges)[0] > 0  # what dipy's density_map counts
    assert (counts.values >= of_points).all()
    assert of_points.sum() > 0.7 * counts.values.sum()
    assert voxel_grid.grid_like(counts).shape == grid_like(counts).shape
