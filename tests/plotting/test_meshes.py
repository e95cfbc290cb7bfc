"""Surfaces from files that name the space of their points."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.other_libraries import streamlines_of
from pvfiblets.plotting.meshes import read_mesh
from pvfiblets.plotting.region_sources import as_region

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


def test_a_region_is_where_the_mesh_says(ball):
    ball.field_data["SPACE"] = ["LPS"]
    np.testing.assert_allclose(as_region(ball).points.mean(axis=0), (30, 20, 0), atol=0.5)


def test_a_file_without_points_is_told(tmp_path):
    pv.PolyData().save(tmp_path / "a.vtp")
    with pytest.raises(ValueError, match=r"a\.vtp holds no points: there is nothing to draw"):
        read_mesh(tmp_path / "a.vtp")
