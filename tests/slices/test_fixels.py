"""Fixel directories of MRtrix, written here by NumPy: what is read of them, and what is drawn."""

from __future__ import annotations

import nibabel
import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets.slices.fixels import read_fixels
from pvfiblets.slices.image import as_slice_image

SHAPE = (4, 5, 3)
AFFINE = np.array([[2.0, 0, 0, -7], [0, 2.0, 0, 4], [0, 0, 2.5, 1], [0, 0, 0, 1]])


def write_mif(path, values, affine=None):
    """Write an image of MRtrix's, the first axis fastest."""
    kind = {"uint32": "UInt32LE", "float32": "Float32LE"}[values.dtype.name]
    lines = ["mrtrix image", "dim: " + ",".join(map(str, values.shape))]
    vox = [1.0] * values.ndim if affine is None else [*np.linalg.norm(affine[:3, :3], axis=0), 1.0][: values.ndim]
    lines += ["vox: " + ",".join(map(str, vox)), "layout: " + ",".join(f"+{k}" for k in range(values.ndim))]
    lines += [f"datatype: {kind}"]
    if affine is not None:
        lines += ["transform: " + ",".join(map(str, row)) for row in affine[:3] / [*vox[:3], 1.0]]
    head = "\n".join(lines)
    lines += [f"file: . {len(head) + 64}", "END"]
    data = ("\n".join(lines) + "\n").encode()
    path.write_bytes(data.ljust(len(head) + 64, b"\0") + values.astype(values.dtype).tobytes(order="F"))


def write_nifti(path, values, affine=None):
    nibabel.save(nibabel.Nifti2Image(values, np.eye(4) if affine is None else affine), path)


@pytest.fixture(params=["mif", "nii.gz"])
def folder(request, tmp_path):
    """A directory of fixels that lie in no order of the voxels, and what is in each voxel."""
    rng = np.random.default_rng(5)
    counts = rng.integers(0, 4, SHAPE).astype(np.uint32)
    counts[1, 1, 1] = 2
    n = int(counts.sum())
    voxels = rng.permutation(np.argwhere(counts > 0))
    first = np.zeros(SHAPE, np.uint32)
    at, inside = 0, {}
    for voxel in map(tuple, voxels):
        first[voxel] = at
        inside[voxel] = range(at, at + int(counts[voxel]))
        at += int(counts[voxel])
    directions = rng.normal(size=(n, 3)).astype(np.float32)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    fd = rng.uniform(0.1, 1.0, n).astype(np.float32)
    made = tmp_path / "fixels"
    made.mkdir()
    write = write_mif if request.param == "mif" else write_nifti
    write(made / f"index.{request.param}", np.stack([counts, first], axis=-1), AFFINE)
    write(made / f"directions.{request.param}", directions[:, :, None])
    write(made / f"fd.{request.param}", fd[:, None, None])
    write(made / f"t1.{request.param}", rng.random(SHAPE).astype(np.float32), AFFINE)
    return made, inside, directions, fd, request.param


def test_fixels_of_voxels_are_those_of_the_index(folder):
    made, inside, directions, fd, suffix = folder
    fixels, affine, name = read_fixels(made)
    assert (name, fixels.names) == ("fixels", ["fd", "t1"])
    np.testing.assert_allclose(affine, AFFINE, atol=1e-6)
    voxels = np.array([*inside, (0, 0, 0)])
    found, which = fixels.of_voxels(voxels)
    for k, voxel in enumerate(map(tuple, voxels)):
        assert found[which == k].tolist() == list(inside.get(voxel, ()))
    np.testing.assert_allclose(fixels.directions, directions, atol=1e-7)
    np.testing.assert_array_equal(fixels.numbers("fd"), fd)
    image = as_slice_image(made / f"fd.{suffix}")
    for voxel in np.ndindex(SHAPE):
        wanted = max((fd[one] for one in inside.get(voxel, ())), default=0.0)
        assert image.values[*voxel, 0] == wanted
    assert as_slice_image(made).values[1, 1, 1, 0] == 2
    assert as_slice_image(made / f"t1.{suffix}").fixels is None  # an image of voxels beside them
    for wrong, said in (("t1", "a number per fixel"), ("x", "there are: fd"), (np.zeros(3), r"shape \(3,\)")):
        with pytest.raises(ValueError, match=said):
            fixels.numbers(wrong)


def test_lines_lie_in_their_voxels_as_long_and_coloured_as_their_numbers(folder):
    made, inside, directions, fd, _ = folder
    plotter = pv.Plotter(off_screen=True, window_size=(60, 60))
    slices = plotter.add_slices(made, planes="axial")
    slices.voxel = (1, 1, 1)
    glyphs = slices.add_fixels(made, "fd", length="fd", cmap="gray", clim=(0, 1))
    plotter.show(auto_close=False)
    wanted = {one: voxel for voxel, ones in inside.items() if voxel[2] == 1 for one in ones}
    assert glyphs.n_glyphs == len(wanted)
    mesh, n = glyphs.mesh(slices.position, np.array([0.0, 0.0, 1.0]))
    ends = np.asarray(mesh.points).reshape(n, 2, 3)
    middles, along = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    longest = np.percentile(fd, 99)
    for one, voxel in wanted.items():
        centre = AFFINE[:3, :3] @ voxel + AFFINE[:3, 3]
        off = np.abs(along - directions[one] * 2.0 * fd[one] / longest).max(axis=1)
        off += np.abs(middles - centre).max(axis=1)
        (at,) = np.flatnonzero(off < 1e-4)
        grey = int(np.asarray(mesh["rgb"])[2 * at, 0])
        assert abs(grey - 255.0 * fd[one]) <= 1.5
    alike = slices.add_fixels(made)
    mesh, n = alike.mesh(slices.position, np.array([0.0, 0.0, 1.0]))
    ends = np.asarray(mesh.points).reshape(n, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), 2.0, rtol=1e-5)
    colours = np.asarray(mesh["rgb"])[::2]
    np.testing.assert_allclose(colours, 255.0 * np.abs(ends[:, 1] - ends[:, 0]) / 2.0, atol=0.51)
    plotter.close()


def test_what_is_no_directory_of_fixels_is_refused(folder, tmp_path):
    made, _, directions, _, suffix = folder
    write = write_mif if suffix == "mif" else write_nifti
    with pytest.raises(ValueError, match="no index and directions"):
        as_slice_image(tmp_path)
    plotter = pv.Plotter(off_screen=True)
    slices = plotter.add_slices(made / f"t1.{suffix}")
    with pytest.raises(ValueError, match="has no fixels"):
        slices.add_fixels(made / f"t1.{suffix}")
    with pytest.raises(ValueError, match="apply to fixels"):
        slices.add_glyphs((np.ones((3, 3, 3, 3)), np.eye(4)), scalars="fd")
    with pytest.raises(ValueError, match="clim is"):
        slices.add_fixels(made, "fd", clim=(1, 0))
    plotter.close()
    write(made / f"odd.{suffix}", np.zeros((7, 1, 1), np.float32))
    with pytest.raises(ValueError, match="a row for each fixel"):
        as_slice_image(made / f"odd.{suffix}")
    write(made / f"directions.{suffix}", directions[:-1, :, None])
    with pytest.raises(ValueError, match="not there"):
        as_slice_image(made)
    write(made / f"directions.{suffix}", directions[:, :2, None])
    with pytest.raises(ValueError, match=r"\(n, 3, 1\)"):
        as_slice_image(made)
