"""FreeSurfer's surfaces lie where the scanner's mm are, against nibabel's numbers and the rules of its volumes."""

from __future__ import annotations

import json
import re
import warnings

import nibabel as nib
import nibabel.freesurfer as fs
import numpy as np
import pytest
import pyvista as pv
from nibabel.affines import apply_affine
from nibabel.gifti import GiftiCoordSystem, GiftiDataArray, GiftiImage, GiftiMetaData
from PIL import Image

from pvfiblets.cli.command import main
from pvfiblets.errors import FormatError
from pvfiblets.plotting.filtering.region_sources import as_region
from pvfiblets.plotting.gifti import shown_array, with_vertex_values
from pvfiblets.plotting.meshes import read_mesh

BALL = pv.Icosphere(radius=10.0, nsub=2)
POINTS = np.asarray(BALL.points, "f4")
FACES = BALL.regular_faces.astype("i4")
C_RAS = (5.5, -17.0, 32.0)
STANDARD = ((-1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0))
SAID = r"{} has its points in FreeSurfer's surface space \(tkRAS\); they are moved by c_ras = \(5.5, -17, 32\) mm"


def gifti(path, c_ras=C_RAS, axes=STANDARD, dataspace=0, points=POINTS):
    said = {f"VolGeom{axis}_{way}": str(value) for axis, row in zip("XYZC", (*axes, c_ras), strict=True)
            for way, value in zip("RAS", row, strict=True)}  # fmt: skip
    said |= dict(zip(("VolGeomWidth", "VolGeomHeight", "VolGeomDepth"), ("256",) * 3, strict=True))
    system = GiftiCoordSystem(dataspace=dataspace, xformspace=dataspace, xform=np.eye(4))
    where = GiftiDataArray(
        points, "NIFTI_INTENT_POINTSET", "NIFTI_TYPE_FLOAT32", meta=GiftiMetaData(said), coordsys=system
    )
    nib.save(GiftiImage(darrays=[where, GiftiDataArray(FACES, "NIFTI_INTENT_TRIANGLE", "NIFTI_TYPE_INT32")]), path)
    return path


def binary(path, c_ras=C_RAS, axes=STANDARD, valid="1  # volume info valid"):
    said = {"head": np.array([2, 0, 20], ">i4"), "valid": valid, "filename": "filled.mgz", "volume": np.full(3, 256),
            "voxelsize": np.ones(3), "xras": np.array(axes[0]), "yras": np.array(axes[1]), "zras": np.array(axes[2]),
            "cras": np.array(c_ras)}  # fmt: skip
    fs.write_geometry(path, POINTS, FACES, volume_info=said)
    return path


def to_scanner(path):
    """Write what mris_convert --to-scanner does: the footer says that coordinates are the scanner's."""
    head = np.array([2, 0, 20], ">i4").tobytes()
    whole = binary(path).read_bytes()
    assert whole.count(head) == 1
    path.write_bytes(whole.replace(head, np.array([2, 1, 20], ">i4").tobytes()))
    return path


WRITERS = {"lh.pial.surf.gii": gifti, "lh.pial": binary, "rh.white": binary, "lh.inflated": binary}


@pytest.mark.parametrize("name", WRITERS)
def test_a_surface_is_moved_by_c_ras_and_says_so_once(tmp_path, name):
    path = WRITERS[name](tmp_path / name)
    with pytest.warns(UserWarning, match=SAID.format(re.escape(str(path)))):
        found = read_mesh(path)
    np.testing.assert_allclose(found.points, POINTS + np.array(C_RAS), atol=1e-5)
    np.testing.assert_array_equal(found.regular_faces, FACES)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_allclose(read_mesh(str(path)).points, found.points)
        np.testing.assert_allclose(read_mesh(path, tkras=True).points, POINTS)


@pytest.mark.filterwarnings("ignore:.*and turned as its volume is")
@pytest.mark.parametrize("writer", [gifti, binary])
def test_an_oblique_volume_turns_its_surface(tmp_path, writer):
    """Against FreeSurfer's matrices: voxels to scanner's mm, and voxels to tkRAS, as nibabel has them for MGH."""
    axes = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    header = nib.MGHImage(np.zeros((256,) * 3, "u1"), np.eye(4)).header
    header["Mdc"], header["Pxyz_c"] = axes, C_RAS
    matrix = header.get_affine() @ np.linalg.inv(header.get_vox2ras_tkr())
    found = read_mesh(writer(tmp_path / ("a.gii" if writer is gifti else "lh.pial"), axes=axes))
    np.testing.assert_allclose(found.points, apply_affine(matrix, POINTS), atol=1e-4)


def info_of(path, *options, capsys):
    assert main(["info", str(path), "--json", *options]) == 0
    return json.loads(capsys.readouterr().out)


MOVED = "by c_ras = (5.5, -17, 32) mm"


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize(
    ("name", "write", "space", "moved"),
    [
        ("lh.pial", binary, "tkRAS", MOVED),
        ("a.surf.gii", gifti, "tkRAS", MOVED),
        ("lh.white", to_scanner, "RAS", None),
        ("b.gii", lambda path: gifti(path, dataspace=1), "RAS", None),
        ("c.gii", lambda path: gifti(path, c_ras=(0, 0, 0)), "RAS", None),
    ],
)
def test_info_says_where_a_surface_lies(tmp_path, capsys, name, write, space, moved):
    path = write(tmp_path / name)
    said = info_of(path, capsys=capsys)
    assert (said["points"], said["triangles"], said["bytes"]) == (len(POINTS), len(FACES), path.stat().st_size)
    assert (said["space"], said["moved"]) == (space, moved)
    box = np.stack([POINTS.min(axis=0), POINTS.max(axis=0)], axis=1)
    shift = np.array(C_RAS if moved else (0.0, 0.0, 0.0))[:, None]
    np.testing.assert_allclose(said["bounds_mm"], (box + shift).ravel(), atol=1e-4)
    kept = info_of(path, "--tkras", capsys=capsys)
    np.testing.assert_allclose(kept["bounds_mm"], box.ravel(), atol=1e-4)
    assert kept["moved"] is None
    assert (MOVED.removeprefix("by ") in kept["space_from"]) == (moved is not None)


@pytest.mark.parametrize("suffix", [".vtk", ".vtp", ".vtu", ".vtm", ".ply", ".stl", ".obj"])
def test_info_reads_surfaces_of_vtk(tmp_path, capsys, suffix):
    ball, path = BALL.translate((20.0, 5.0, 1.0)), tmp_path / f"ball{suffix}"
    whole = {".vtu": ball.cast_to_unstructured_grid(), ".vtm": pv.MultiBlock([ball])}.get(suffix, ball)
    whole.save(path)
    said = info_of(path, capsys=capsys)
    assert (said["format"], said["triangles"], said["space"]) == (suffix, len(FACES), "RAS")
    np.testing.assert_allclose(said["bounds_mm"], ball.bounds, atol=1e-4)
    assert said["space_from"].startswith("assumed")
    of_vtk = suffix in (".vtk", ".vtp", ".vtu", ".vtm")
    said = info_of(path, "--space", "lps", capsys=capsys)
    x_min, x_max = ball.bounds[:2]
    np.testing.assert_allclose(said["bounds_mm"][:2], (-x_max, -x_min) if of_vtk else (x_min, x_max), atol=1e-4)
    assert said["moved"] == ("x and y negated" if of_vtk else None)
    assert main(["info", str(path)]) == 0
    assert re.search(r"^triangles +320$", capsys.readouterr().out, re.MULTILINE)


def test_what_lies_in_the_scanners_space_stays(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for path in (
            gifti(tmp_path / "scanner.gii", dataspace=1), gifti(tmp_path / "fmriprep.gii", c_ras=(0, 0, 0)),
            binary(tmp_path / "lh.white", c_ras=(0.0, 0, 0)), binary(tmp_path / "lh.pial", valid="0  # invalid"),
            to_scanner(tmp_path / "rh.pial"),
        ):  # fmt: skip
            np.testing.assert_allclose(read_mesh(path).points, POINTS)
        fs.write_geometry(tmp_path / "lh.orig", POINTS, FACES)  # without a footer
        np.testing.assert_allclose(read_mesh(tmp_path / "lh.orig").points, POINTS)
        assert as_region(tmp_path / "lh.orig").contains([[0.0, 0.0, 0.0], [11.0, 0.0, 0.0]]).tolist() == [True, False]


NAMES = ["unknown", "insula", "cuneus"]
TABLE = np.array([[25, 5, 25, 0], [255, 0, 0, 0], [0, 0, 255, 0]])


def values(folder):
    labels = np.arange(len(POINTS)) % 3
    labels[5] = -1
    fs.write_annot(folder / "lh.aparc.annot", labels, TABLE, NAMES, fill_ctab=True)
    fs.write_morph_data(folder / "lh.thickness", np.linspace(1.0, 4.0, len(POINTS)))
    return labels


def test_annotations_and_numbers_are_nibabels(tmp_path):
    values(tmp_path)
    fs.write_geometry(tmp_path / "lh.pial", POINTS, FACES)
    mesh = with_vertex_values(read_mesh(tmp_path / "lh.pial"), tmp_path / "lh.aparc.annot")
    labels, table, _ = fs.read_annot(tmp_path / "lh.aparc.annot")
    np.testing.assert_array_equal(mesh.point_data["lh.aparc"], labels)
    colours = np.where(labels[:, None] < 0, 128, table[labels, :3])
    np.testing.assert_array_equal(mesh.point_data["lh.aparc_rgb"], colours)
    assert shown_array(mesh, "lh.aparc.annot") == "lh.aparc_rgb"
    mesh = with_vertex_values(mesh, tmp_path / "lh.thickness")
    np.testing.assert_allclose(mesh.point_data["lh.thickness"], fs.read_morph_data(tmp_path / "lh.thickness"))
    assert shown_array(mesh, "lh.thickness") == "lh.thickness"


def test_damaged_files_are_refused_in_a_sentence(tmp_path):
    values(tmp_path)
    fs.write_geometry(tmp_path / "lh.pial", POINTS, FACES)
    ball = read_mesh(tmp_path / "lh.pial")
    for name, read in (("lh.pial", read_mesh), ("lh.aparc.annot", lambda p: with_vertex_values(ball, p)),
                       ("lh.thickness", lambda p: with_vertex_values(ball, p))):  # fmt: skip
        whole = (tmp_path / name).read_bytes()
        for cut in (0, 3, 40, len(whole) // 2, len(whole) - 1):
            (tmp_path / name).write_bytes(whole[:cut])
            with pytest.raises(FormatError, match=re.escape(name)):
                read(tmp_path / name)
        (tmp_path / name).write_bytes(whole)
    huge = bytearray((tmp_path / "lh.aparc.annot").read_bytes())
    at = 4 + 8 * len(POINTS) + 8
    huge[at : at + 4] = (1 << 30).to_bytes(4, "big")
    (tmp_path / "lh.aparc.annot").write_bytes(huge)
    with pytest.raises(FormatError, match="1,073,741,824 labels, expected 1 to 32,768"):
        with_vertex_values(ball, tmp_path / "lh.aparc.annot")
    with pytest.raises(FormatError, match=r"numbers for 162 vertices, expected one for each of the mesh's 42"):
        with_vertex_values(pv.Icosphere(nsub=1), tmp_path / "lh.thickness")
    gifti(tmp_path / "x.gii", c_ras=("a", 1, 2))
    with pytest.raises(FormatError, match=r"VolGeomC_R 'a', VolGeomC_A '1'.*expected three finite mm"):
        read_mesh(tmp_path / "x.gii")


def shot(tmp_path, *words):
    assert main(["screenshot", *map(str, words), "-o", str(tmp_path / "a.png"), "--size", "120x90"]) == 0
    picture = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).astype(int)
    return picture[(picture > 0).any(axis=2)]


@pytest.mark.filterwarnings("always")
def test_the_command_draws_surfaces_with_their_values(tmp_path, capsys):
    values(tmp_path)
    path = binary(tmp_path / "lh.pial")
    grey = shot(tmp_path, path)
    assert len(grey) > 500
    assert np.median(np.ptp(grey, axis=1)) < 15
    assert re.search(SAID.format(re.escape(str(path))), capsys.readouterr().err)
    seen = shot(tmp_path, path, tmp_path / "lh.thickness", tmp_path / "lh.aparc.annot")
    assert ((seen[:, 0] > 120) & (seen[:, 2] < 60)).any()
    assert ((seen[:, 2] > 120) & (seen[:, 0] < 60)).any()
    shot(tmp_path, path, "--tkras")
    assert capsys.readouterr().err == ""
    assert main(["screenshot", str(tmp_path / "lh.aparc.annot"), "-o", str(tmp_path / "a.png")]) == 1
    assert "holds values for the vertices of a surface, and follows none" in capsys.readouterr().err


@pytest.mark.parametrize("suffix", [".vtk", ".vtp", ".vtu", ".vtm"])
def test_a_file_of_vtk_that_holds_a_surface_alone_is_drawn(tmp_path, suffix):
    data = {".vtu": BALL.cast_to_unstructured_grid(), ".vtm": pv.MultiBlock([BALL])}.get(suffix, BALL)
    data.save(tmp_path / f"ball{suffix}")
    assert len(shot(tmp_path, tmp_path / f"ball{suffix}")) > 500


def test_an_empty_file_of_vtk_is_refused(tmp_path, capsys):
    pv.PolyData().save(tmp_path / "none.vtk")
    assert main(["screenshot", str(tmp_path / "none.vtk"), "-o", str(tmp_path / "a.png")]) == 1
    assert "none.vtk has no points to draw; check the program that wrote it" in capsys.readouterr().err
