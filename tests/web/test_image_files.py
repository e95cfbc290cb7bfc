"""Images and surfaces of every format on the page: listed, where nibabel says that they lie, and kept in sessions."""

from __future__ import annotations

import asyncio
import gzip

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from nibabel.gifti import GiftiDataArray, GiftiImage, GiftiLabel, GiftiLabelTable

from pvfiblets.errors import FormatError
from pvfiblets.plotting.gifti import read_surface, with_vertex_values
from pvfiblets.web import session
from pvfiblets.web.history import History
from pvfiblets.web.loading import Files
from pvfiblets.web.scene import Scene
from pvfiblets.web.script import as_script
from pvfiblets.web.slicing import ready_views
from tests.web.desk import Desk

TURN = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
SIDES = np.array([2.0, 3.0, 4.0])
AFFINE = np.eye(4)
AFFINE[:3, :3], AFFINE[:3, 3] = TURN * SIDES, (5.0, -7.0, 3.0)
RNG = np.random.default_rng(5)
VALUES = RNG.integers(1, 99, (5, 6, 7)).astype(np.int16)


@pytest.fixture
def scene(tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(240, 160), shape=(2, 2), border=False)
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    ready_views(plotter)
    scene = Scene(plotter, tmp_path)
    yield scene
    scene.close()
    plotter.close()


def written(folder, suffix, values=VALUES):
    """Write an image as its format lays it down."""
    path = folder / f"image{suffix}"
    lps = np.diag([-1.0, -1.0, 1.0]) @ AFFINE[:3]
    if suffix in (".nii", ".nii.gz"):
        nib.save(nib.Nifti1Image(values, AFFINE), path)
    elif suffix in (".mgh", ".mgz"):
        nib.save(nib.MGHImage(values.astype(np.float32), AFFINE), path)
    elif suffix.startswith(".mi"):
        rows = "\n".join(f"transform: {','.join(map(str, row))}" for row in np.column_stack([TURN, AFFINE[:3, 3]]))
        head = f"mrtrix image\ndim: {','.join(map(str, values.shape))}\nvox: 2,3,4,1\nlayout: "
        head += f"{','.join(f'+{k}' for k in range(values.ndim))}\ndatatype: Int16LE\n{rows}\nfile: . 512\nEND\n"
        whole = head.encode().ljust(512, b"\0") + values.astype("<i2").tobytes(order="F")
        path.write_bytes(gzip.compress(whole) if suffix.endswith(".gz") else whole)
    elif suffix == ".nrrd":
        columns = " ".join(f"({x},{y},{z})" for x, y, z in lps[:, :3].T)
        head = (
            f"NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 5 6 7\nendian: little\n"
            f"space directions: {columns}\nspace origin: ({','.join(map(str, lps[:, 3]))})\nencoding: raw\n\n"
        )
        path.write_bytes(head.encode() + values.astype("<i2").tobytes(order="F"))
    else:
        turn = " ".join(map(str, (lps[:, :3] / SIDES).T.ravel()))
        head = (
            f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
            f"TransformMatrix = {turn}\nOffset = {' '.join(map(str, lps[:, 3]))}\n"
            "ElementSpacing = 2 3 4\nDimSize = 5 6 7\nElementType = MET_SHORT\nElementDataFile = LOCAL\n"
        )
        path.write_bytes(head.encode() + values.astype("<i2").tobytes(order="F"))
    return path


@pytest.mark.parametrize("suffix", [".nii.gz", ".mgz", ".mif", ".mif.gz", ".nrrd", ".mha"])
def test_an_image_of_each_format_is_listed_and_lies_where_its_affine_says(scene, tmp_path, suffix):
    name = written(tmp_path, suffix).name
    desk = Desk(scene, tmp_path)
    for purpose in ("", "slices"):
        desk.files.browse("", purpose)
        assert [entry["name"] for entry in desk.page.entries] == [name]
    image = scene.open(name, "image")
    scene.set(image.id, "interpolation", "nearest")
    workspace = scene.slicing.workspace
    for voxel in ((0, 0, 0), (4, 5, 6), (1, 3, 2)):
        scene.set_slices(position=(nib.affines.apply_affine(AFFINE, voxel)).tolist())
        assert workspace.values().images[name] == VALUES[voxel]
    assert scene.open(name).kind == "volume"
    np.testing.assert_allclose(scene.data(scene.layers[-1]).data.affine, AFFINE, atol=1e-5)


@pytest.mark.parametrize("suffix", [".nii", ".mif"])
def test_an_image_of_several_numbers_a_voxel_opens_as_slices(scene, tmp_path, suffix):
    four = RNG.integers(1, 99, (5, 6, 7, 3)).astype(np.int16)
    layer = scene.open(written(tmp_path, suffix, four).name)
    assert layer.kind == "image"
    scene.set(layer.id, "index", 2)
    scene.set(layer.id, "interpolation", "nearest")
    scene.set_slices(position=nib.affines.apply_affine(AFFINE, (1, 2, 3)).tolist())
    assert scene.slicing.workspace.values().images[layer.name] == four[1, 2, 3, 2]


BALL = pv.Icosphere(radius=10.0, nsub=2)
NUMBERS = np.arange(BALL.n_points) % 3


def saved(folder, name, *arrays, table=None):
    image = GiftiImage(darrays=list(arrays), labeltable=table)
    nib.save(image, folder / name)
    return name


def surface(folder, name="lh.pial.surf.gii"):
    points = GiftiDataArray(BALL.points.astype(np.float32), "NIFTI_INTENT_POINTSET")
    faces = GiftiDataArray(BALL.regular_faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE")
    return saved(folder, name, points, faces)


def labels(folder, name="lh.aparc.label.gii", numbers=NUMBERS):
    table = GiftiLabelTable()
    colours = {"none": (0.5, 0.5, 0.5), "insula": (1.0, 0.0, 0.0), "cuneus": (0.0, 0.0, 1.0)}
    for key, (word, colour) in enumerate(colours.items()):
        one = GiftiLabel(key, *colour, 1.0)
        one.label = word
        table.labels.append(one)
    return saved(folder, name, GiftiDataArray(numbers.astype(np.int32), "NIFTI_INTENT_LABEL"), table=table)


def test_a_gifti_surface_takes_labels_and_numbers_of_its_vertices(scene, tmp_path):
    surface(tmp_path)
    labels(tmp_path)
    saved(tmp_path, "lh.area.shape.gii", GiftiDataArray(NUMBERS.astype(np.float32), "NIFTI_INTENT_SHAPE"))
    desk = Desk(scene, tmp_path)

    async def opened(*names):
        for name in names:
            desk.files.browse("")
            assert name in {entry["name"] for entry in desk.page.entries}
            desk.files.take(name, False)
            await desk.done()

    history = History(scene)
    asyncio.run(opened("lh.pial.surf.gii", "lh.area.shape.gii", "lh.aparc.label.gii"))
    (mesh,) = scene.layers
    found = scene.actor(mesh.id).mapper.dataset
    np.testing.assert_allclose(found.points, BALL.points, atol=1e-5)
    np.testing.assert_array_equal(found.regular_faces, BALL.regular_faces)
    np.testing.assert_array_equal(found.point_data["lh.area"], NUMBERS)
    assert mesh.settings["scalars"] == "lh.aparc_rgb"
    wanted = np.array([[128, 128, 128], [255, 0, 0], [0, 0, 255]])[NUMBERS]
    np.testing.assert_allclose(found.point_data["lh.aparc_rgb"], wanted, atol=1)
    scene.set(mesh.id, "lighting", False)
    picture = scene.screenshot()
    seen = picture[(picture > 0).any(axis=2)].astype(int)
    assert (seen[:, 0] > 200).any()
    assert (seen[:, 2] > 200).any()
    text = as_script(scene, "found.png").replace('FOLDER = Path(".")', f"FOLDER = Path({str(tmp_path)!r})")
    exec(compile(text.replace("'found.png'", repr(str(tmp_path / "found.png"))), "script", "exec"), {})
    drawn = np.asarray(pv.read(tmp_path / "found.png").active_scalars).reshape(160, 240, -1)[::-1]
    assert (abs(drawn[..., :3].astype(int) - picture).max(axis=-1) > 8).mean() < 0.002
    kept = session.to_dict(scene)
    history.undo()
    history.undo()
    history.undo()
    assert scene.layer(mesh.id).source.values == ()
    session.from_dict(scene, kept)
    assert "lh.aparc_rgb" in scene.actor(mesh.id).mapper.dataset.point_data


def test_what_is_wrong_with_gifti_is_said(tmp_path):
    ball = read_surface(tmp_path / surface(tmp_path))
    assert ball.n_points == BALL.n_points
    labels(tmp_path, "few.label.gii", NUMBERS[:-2])
    with pytest.raises(FormatError, match="160 vertices.*162"):
        with_vertex_values(ball, tmp_path / "few.label.gii")
    with pytest.raises(FormatError, match="0 sets of points"):
        read_surface(tmp_path / "few.label.gii")
    with pytest.raises(FormatError, match="no numbers of vertices"):
        with_vertex_values(ball, tmp_path / "lh.pial.surf.gii")
    whole = (tmp_path / "lh.pial.surf.gii").read_bytes()
    (tmp_path / "half.gii").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "none.gii").write_bytes(b"<a/>")
    (tmp_path / "words.gii").write_bytes(b'<?xml version="1.0" encoding="eTF-8"?><GIFTI/>')
    points = GiftiDataArray(np.full((3, 3), np.nan, np.float32), "NIFTI_INTENT_POINTSET")
    faces = GiftiDataArray(np.array([[0, 1, 2]], np.int32), "NIFTI_INTENT_TRIANGLE")
    saved(tmp_path, "nan.gii", points, faces)
    with pytest.raises(FormatError, match="finite mm"):
        read_surface(tmp_path / "nan.gii")
    for name in ("half.gii", "none.gii", "words.gii"):
        with pytest.raises(FormatError, match="GIFTI"):
            read_surface(tmp_path / name)
        with pytest.raises((FormatError, ValueError)):
            Files(tmp_path).load(type("Named", (), {"demo": None, "path": name})())
