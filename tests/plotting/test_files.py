"""Files of tractograms, values, volumes and meshes through PyVista, and coordinates that nobody draws on purpose."""

from __future__ import annotations

import re
from contextlib import nullcontext

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets as pf
from pvfiblets.errors import FormatError
from pvfiblets.other_libraries import streamlines_of
from pvfiblets.plotting.filtering.region_sources import as_region
from pvfiblets.plotting.meshes import read_mesh
from pvfiblets.support.vtk_space import unnamed_as


@pytest.mark.parametrize("suffix", [".tck", ".trk", ".trx", ".fiblets"])
def test_lines_go_out_and_come_back(three_lines, tmp_path, suffix):
    path = tmp_path / f"lines{suffix}"
    told = pytest.warns(UserWarning, match=r"cannot hold per_point \(.*height") if suffix == ".tck" else nullcontext()
    with told:
        pv.wrap(three_lines.to_polydata()).save(path)
    back = pv.read(path)
    assert isinstance(back, pv.PolyData)
    assert back.n_lines == 3
    np.testing.assert_allclose(back.points, three_lines.points, atol=0.06)


def test_nibabels_own_file_lands_where_nibabel_says(tmp_path):
    lines = [np.random.default_rng(i).normal(size=(5 + i, 3)).astype(np.float32) for i in range(4)]
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -20.0
    tractogram = nib.streamlines.Tractogram(lines, affine_to_rasmm=np.eye(4))
    header = {"voxel_sizes": (2, 2, 2), "dimensions": (20, 20, 20), "voxel_to_rasmm": affine, "voxel_order": "RAS"}
    nib.streamlines.save(nib.streamlines.TrkFile(tractogram, header), tmp_path / "a.trk")
    data = pv.read(tmp_path / "a.trk")
    np.testing.assert_allclose(data.points, np.concatenate(lines), atol=1e-4)
    assert data.n_lines == 4


def test_a_gzipped_file_is_read_by_its_double_suffix(shared_data):
    assert pv.read(shared_data / "nv_stroke.trk.gz").n_lines == 36763


def test_only_polydata_can_be_saved(tmp_path):
    with pytest.raises((TypeError, ValueError), match="PolyData"):
        pv.ImageData(dimensions=(2, 2, 2)).save(tmp_path / "image.trk")


def test_the_accessor_compresses_lines_with_their_data(three_lines):
    data = pv.wrap(three_lines.to_polydata())
    fiblets = data.fiblets.compress(per_point=["height"], max_error=0.01)
    back = fiblets.decompress()
    np.testing.assert_allclose(back.points, three_lines.points, atol=0.011)
    np.testing.assert_allclose(back.per_streamline["weight"], [1.0, 10.0, 100.0])
    np.testing.assert_allclose(back.per_point["height"], three_lines.per_point["height"], atol=0.003)
    assert len(data.fiblets.to_streamlines()) == 3


NAME = "nv_mni152.SLF1_R"


@pytest.fixture
def files(shared_data):
    return shared_data / "nv_tract.SLF1_R.tck", shared_data / f"{NAME}.tsf"


def numbers_of(path):
    """The values of a track scalar file, by its specification: after the offset, a number a point, NaN between."""
    raw = path.read_bytes()
    start = int(re.search(rb"\nfile: \. (\d+)", raw)[1])
    values = np.frombuffer(raw[start:], "<f4")
    return values[np.isfinite(values)]


@pytest.fixture
def plotter():
    made = pv.Plotter(off_screen=True, window_size=(200, 150))
    yield made
    made.close()


@pytest.mark.parametrize("compressed", [False, True])
def test_a_track_scalar_file_colours_its_tractogram(files, plotter, compressed):
    tractogram, scalars = files
    wanted = numbers_of(scalars)
    assert len(wanted) == len(nib.streamlines.load(tractogram).streamlines.get_data()) == 156
    source = pf.compress(pf.read(tractogram)) if compressed else tractogram
    actor = plotter.add_fiblets(source, scalars=str(scalars))
    values = actor.fiblets.decompress().per_point[NAME].ravel()
    np.testing.assert_allclose(values, wanted, atol=np.ptp(wanted) / 500)
    assert actor.scalars == NAME
    assert actor.clim == pytest.approx((wanted.min(), wanted.max()))
    actor.scalars = "length"
    actor.scalars = scalars  # again, of the actor that is there
    assert actor.scalars == NAME


def test_weights_of_streamlines_in_a_text_file(files, plotter, tmp_path):
    weights = np.linspace(0.5, 2.0, 13)
    (tmp_path / "sift2.txt").write_text(" ".join(map(str, weights)))
    actor = plotter.add_fiblets(files[0], scalars=tmp_path / "sift2.txt")
    np.testing.assert_allclose(actor.fiblets.per_streamline["sift2"], weights)
    assert actor.clim == pytest.approx((0.5, 2.0))


@pytest.mark.parametrize("kind", ["path", "mesh", "fiblets"])
@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
def test_tubes_and_lines_with_halos_take_them_too(files, plotter, add, kind):
    tractogram, scalars = files
    source = {"path": str, "mesh": pv.read, "fiblets": lambda path: pf.compress(pf.read(path))}[kind](tractogram)
    actor = getattr(plotter, add)(source, scalars=scalars)
    assert actor.scalars == NAME
    wanted = numbers_of(scalars)
    assert actor.clim == pytest.approx((wanted.min(), wanted.max()))


def test_a_file_of_other_lines_is_refused(files, shared_data):
    with pytest.raises(FormatError, match="13 streamlines.*14 as the tractogram has"):
        pv.Plotter(off_screen=True).add_fiblets(shared_data / "nv_tract.IFOF_R.trk", scalars=files[1])


AFFINE = np.array([[-2.0, 0.3, 0, 20], [0, 2.5, 0, -30], [0.1, 0, 3.0, -25], [0, 0, 0, 1]])


@pytest.fixture
def saved(tmp_path):
    """A file whose axes are flipped, oblique and far from the origin."""
    values = np.arange(20 * 24 * 18, dtype=np.float32).reshape(20, 24, 18)
    path = tmp_path / "fa.nii.gz"
    nib.save(nib.Nifti1Image(values, AFFINE), path)
    return path, values


def test_read_volume_keeps_the_place(saved):
    path, values = saved
    image = pf.read_volume(path)
    assert image.active_scalars_name == "fa"
    for index in ((0, 0, 0), (19, 0, 0), (3, 23, 7), (5, 6, 17)):
        point = image.find_closest_point((AFFINE @ [*index, 1])[:3])
        np.testing.assert_allclose(image.points[point], (AFFINE @ [*index, 1])[:3], atol=1e-4)
        assert image["fa"][point] == values[index]


def test_a_volume_colours_the_same_by_image_and_by_path(saved, plotter, three_lines):
    pictures = []
    for source in (str(saved[0]), pf.read_volume(saved[0])):
        plotter.add_fiblets(three_lines, scalars=source, name="one", show_scalar_bar=False, lighting=False)
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        pictures.append(plotter.screenshot(None))
    np.testing.assert_array_equal(*pictures)
    assert len(np.unique(pictures[0].reshape(-1, 3), axis=0)) > 5


def test_a_volume_elsewhere_warns_with_both_bounds(plotter, three_lines):
    far = pv.ImageData(dimensions=(4, 4, 4), origin=(100, 0, 0))
    far["fa"] = np.arange(64.0)
    told = r"no streamline meets the image 'fa'.* x 99\.5 to 103\.5, .* x -10 to 10, .*read_volume"
    with pytest.warns(UserWarning, match=told):
        actor = plotter.add_fiblets(three_lines, scalars=far)
    near = far.copy()
    near.origin = (9.9, -10, 0)  # its outermost half voxel holds the end of one line
    actor.scalars = near
    with pytest.warns(UserWarning, match="no streamline meets"):
        actor.scalars = far


def test_what_is_no_volume_is_refused(tmp_path):
    (tmp_path / "a.jpg").touch()
    with pytest.raises(ValueError, match=r"a\.jpg is no image; give a file that ends in .*\.nii\.gz"):
        pf.read_volume(tmp_path / "a.jpg")
    with pytest.raises(FileNotFoundError, match=r"none\.nii"):
        pf.read_volume(tmp_path / "none.nii")


RIGHT, FRONT = 30.0, 20.0


@pytest.fixture
def ball():
    """A ball at RAS (30, 20, 0), in LPS+."""
    return pv.Sphere(radius=8, center=(-RIGHT, -FRONT, 0), theta_resolution=8, phi_resolution=8)


def write(ball, path, text):
    """Write what 3D Slicer writes."""
    from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    from vtkmodules.vtkIOPLY import vtkPLYWriter

    if path.suffix in (".vtp", ".vtu"):
        mesh = ball if path.suffix == ".vtp" else ball.cast_to_unstructured_grid()
        mesh.field_data["SPACE"] = [text.rpartition("=")[2]]
        mesh.save(path)
        return
    writers = {".stl": vtkSTLWriter, ".ply": vtkPLYWriter, ".obj": vtkOBJWriter, ".vtk": vtkPolyDataWriter}
    writer = writers[path.suffix]()
    writer.SetFileName(str(path))
    writer.SetInputData(ball)
    if path.suffix == ".ply":
        writer.AddComment(text)
    elif path.suffix == ".obj":
        pass
    else:
        writer.SetHeader(text)
    if "binary" in path.stem:
        writer.SetFileTypeToBinary()
    writer.Write()
    if path.suffix == ".obj":
        path.write_text(f"# {text}\n{path.read_text()}")


@pytest.mark.parametrize("name", ["a.stl", "binary.stl", "a.ply", "a.obj", "a.vtk", "a.vtp", "a.vtu"])
@pytest.mark.parametrize("space", ["LPS", "RAS"])
def test_meshes_that_slicer_saved(name, space, ball, tmp_path):
    write(ball, tmp_path / name, f"3D Slicer output. SPACE={space}")
    found, sign = read_mesh(tmp_path / name), 1 if space == "LPS" else -1
    np.testing.assert_allclose(found.center, (sign * RIGHT, sign * FRONT, 0), atol=1e-4)
    surface = found.extract_surface(algorithm=None).compute_normals(cell_normals=True)
    outwards = surface.cell_centers().points - np.array(found.center)
    assert (np.einsum("ij,ij->i", outwards, surface["Normals"]) > 0).all()


@pytest.mark.parametrize("named_by", ["block", "whole"])
def test_blocks_are_where_they_or_the_whole_say(named_by, ball, tmp_path):
    lines = pv.Line(ball.center, ball.center)
    blocks = pv.MultiBlock([ball.copy(), None, pv.MultiBlock([lines])])
    for one in [blocks] if named_by == "whole" else [blocks[0], blocks[2][0]]:
        one.field_data["SPACE"] = ["LPS"]
    np.testing.assert_allclose(streamlines_of(blocks).points, 2 * [[30, 20, 0]], atol=1e-4)
    blocks.save(tmp_path / "blocks.vtm")
    found = read_mesh(tmp_path / "blocks.vtm")
    for mesh in (found[0], found[2][0]):
        np.testing.assert_allclose(mesh.center, (30, 20, 0), atol=1e-4)
    np.testing.assert_allclose(streamlines_of(found).points, 2 * [[30, 20, 0]], atol=1e-4)


@pytest.mark.parametrize("name", ["a.vtk", "a.vtp", "a.vtu"])
def test_a_mesh_of_vtk_that_names_no_space_is_where_the_caller_says(name, ball, tmp_path):
    (ball.cast_to_unstructured_grid() if name == "a.vtu" else ball).save(tmp_path / name)
    np.testing.assert_allclose(read_mesh(tmp_path / name).center, (-RIGHT, -FRONT, 0), atol=1e-4)
    np.testing.assert_allclose(read_mesh(tmp_path / name, space="lps").center, (RIGHT, FRONT, 0), atol=1e-4)
    with unnamed_as("LPS"):  # as --space of the commands
        np.testing.assert_allclose(read_mesh(tmp_path / name).center, (RIGHT, FRONT, 0), atol=1e-4)
        np.testing.assert_allclose(read_mesh(tmp_path / name, space="RAS").center, (-RIGHT, -FRONT, 0), atol=1e-4)
    with pytest.raises(ValueError, match="unknown space 'x'; choose 'RAS' or 'LPS'"):
        read_mesh(tmp_path / name, space="x")


def test_a_region_is_where_the_mesh_says(ball):
    ball.field_data["SPACE"] = ["LPS"]
    np.testing.assert_allclose(as_region(ball).points.mean(axis=0), (30, 20, 0), atol=0.5)


def test_a_file_without_points_is_reported(tmp_path):
    pv.PolyData().save(tmp_path / "a.vtp")
    with pytest.raises(ValueError, match=r"a\.vtp has no points to draw; check the program that wrote it"):
        read_mesh(tmp_path / "a.vtp")


ADDS = ("add_fiblets", "add_spline_tubes", "add_halo_lines")


def brain(scale=1.0):
    random = np.random.default_rng(0)
    return [np.cumsum(random.normal(size=(20, 3)), axis=0) * scale for _ in range(5)]


def with_outlier(value):
    lines = brain()
    lines[3][5] = value
    return lines


@pytest.mark.few(5)
@pytest.mark.filterwarnings("ignore:most points lie within")  # which an outlier moves
@pytest.mark.parametrize("add", ADDS)
@pytest.mark.parametrize("lines", [brain(1e30), with_outlier(-1e30), brain(1e18)], ids=["1e30", "outlier", "1e18"])
def test_coordinates_beyond_the_cameras_reach_are_named_once(plotter, add, lines):
    reach = np.abs(np.concatenate(lines)).max()
    with pytest.warns(UserWarning, match="check the units, leave outliers out, or scale the points") as said:
        getattr(plotter, add)(lines)
    plotter.screenshot()  # warns of nothing more
    (beyond,) = [warning for warning in said if "most points lie within" not in str(warning.message)]
    assert beyond.filename == __file__
    named = float(str(beyond.message).split()[2])
    assert reach * 0.99 <= named <= reach * 1.05  # tubes and lines have a width


@pytest.mark.parametrize("add", ADDS)
def test_coordinates_that_float32_cannot_hold_are_refused(plotter, add):
    with pytest.raises(ValueError, match=r"a coordinate of 1e\+300 mm is beyond 1e\+35 mm.*check the units"):
        getattr(plotter, add)(with_outlier(1e300))
