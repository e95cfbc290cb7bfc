"""Surfaces from files that name the space of their points."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.plotting.meshes import read_mesh

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


def test_a_file_without_points_is_told(tmp_path):
    pv.PolyData().save(tmp_path / "a.vtp")
    with pytest.raises(ValueError, match=r"a\.vtp holds no points: there is nothing to draw"):
        read_mesh(tmp_path / "a.vtp")
