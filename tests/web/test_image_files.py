"""Images and surfaces of every format on the page: listed, where nibabel says that they lie, and kept in sessions."""

import asyncio
import gzip
import json
import math

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from nibabel.gifti import GiftiDataArray, GiftiImage, GiftiLabel, GiftiLabelTable

import pvfiblets
from pvfiblets.errors import FormatError
from pvfiblets.plotting.gifti import placed_surface, with_vertex_values
from pvfiblets.slices.image import as_slice_image
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.volumes import RaycastVolume
from pvfiblets.web.scene import layers
from pvfiblets.web.scene.files.loading import Files
from pvfiblets.web.session import files as session
from pvfiblets.web.session.document import Ids, Source
from pvfiblets.web.session.history import History
from tests.web.desk import Desk, assert_script_draws, scene_of_views

TURN = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
SIDES = np.array([2.0, 3.0, 4.0])
AFFINE = np.eye(4)
AFFINE[:3, :3], AFFINE[:3, 3] = TURN * SIDES, (5.0, -7.0, 3.0)
RNG = np.random.default_rng(5)
VALUES = RNG.integers(1, 99, (5, 6, 7)).astype(np.int16)


@pytest.fixture
def views(tmp_path):
    with scene_of_views(tmp_path) as scene:
        yield scene


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
def test_an_image_of_each_format_is_listed_and_lies_where_its_affine_says(views, tmp_path, suffix):
    name = written(tmp_path, suffix).name
    desk = Desk(views, tmp_path)
    for purpose in ("", "slices"):
        desk.files.browse("", purpose)
        assert [entry["name"] for entry in desk.page.entries] == [name]
    image = views.open(name, "image")
    views.set(image.id, "interpolation", "nearest")
    workspace = views.slicing.workspace
    for voxel in ((0, 0, 0), (4, 5, 6), (1, 3, 2)):
        views.images.set_slices(position=(nib.affines.apply_affine(AFFINE, voxel)).tolist())
        assert workspace.values().images[name] == VALUES[voxel]
    assert views.open(name).kind == "volume"
    np.testing.assert_allclose(views.data(views.layers[-1]).data.affine, AFFINE, atol=1e-5)


@pytest.mark.parametrize("suffix", [".nii", ".mif"])
def test_an_image_of_several_numbers_a_voxel_opens_as_slices(views, tmp_path, suffix):
    four = RNG.integers(1, 99, (5, 6, 7, 3)).astype(np.int16)
    layer = views.open(written(tmp_path, suffix, four).name)
    assert layer.kind == "image"
    views.set(layer.id, "index", 2)
    views.set(layer.id, "interpolation", "nearest")
    views.images.set_slices(position=nib.affines.apply_affine(AFFINE, (1, 2, 3)).tolist())
    assert views.slicing.workspace.values().images[layer.name] == four[1, 2, 3, 2]


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


def test_a_gifti_surface_takes_labels_and_numbers_of_its_vertices(views, tmp_path):
    surface(tmp_path)
    labels(tmp_path)
    saved(tmp_path, "lh.area.shape.gii", GiftiDataArray(NUMBERS.astype(np.float32), "NIFTI_INTENT_SHAPE"))
    desk = Desk(views, tmp_path)

    async def opened(*names):
        for name in names:
            desk.files.browse("")
            assert name in {entry["name"] for entry in desk.page.entries}
            desk.files.take(name, False)
            await desk.done()

    history = History(views)
    asyncio.run(opened("lh.pial.surf.gii", "lh.area.shape.gii", "lh.aparc.label.gii"))
    (mesh,) = views.layers
    found = views.actor(mesh.id).mapper.dataset
    np.testing.assert_allclose(found.points, BALL.points, atol=1e-5)
    np.testing.assert_array_equal(found.regular_faces, BALL.regular_faces)
    np.testing.assert_array_equal(found.point_data["lh.area"], NUMBERS)
    assert mesh.settings["scalars"] == "lh.aparc_rgb"
    wanted = np.array([[128, 128, 128], [255, 0, 0], [0, 0, 255]])[NUMBERS]
    np.testing.assert_allclose(found.point_data["lh.aparc_rgb"], wanted, atol=1)
    views.set(mesh.id, "lighting", False)
    picture = views.cameras.screenshot()
    seen = picture[(picture > 0).any(axis=2)].astype(int)
    assert (seen[:, 0] > 200).any()
    assert (seen[:, 2] > 200).any()
    assert_script_draws(views, tmp_path, picture)
    kept = session.to_dict(views)
    history.undo()
    history.undo()
    history.undo()
    assert views.layer(mesh.id).source.values == ()
    session.from_dict(views, kept)
    assert "lh.aparc_rgb" in views.actor(mesh.id).mapper.dataset.point_data


@pytest.mark.filterwarnings("ignore:.*moved by c_ras")
def test_a_surface_of_freesurfer_opens_with_its_annotation(views, tmp_path):
    labels = NUMBERS.copy()
    volume = {"head": np.array([2, 0, 20]), "valid": "1", "filename": "a", "volume": [256] * 3, "voxelsize": [1.0] * 3,
              "xras": [-1, 0, 0], "yras": [0, 0, -1], "zras": [0, 1, 0], "cras": [5.5, -17, 32]}  # fmt: skip
    nib.freesurfer.write_geometry(tmp_path / "lh.pial", BALL.points, BALL.regular_faces, volume_info=volume)
    table = np.array([[25, 5, 25, 0], [255, 0, 0, 0], [0, 0, 255, 0]])
    nib.freesurfer.write_annot(tmp_path / "lh.aparc.annot", labels, table, ["none", "a", "b"], fill_ctab=True)
    desk = Desk(views, tmp_path)

    async def opened(*names):
        for name in names:
            desk.files.browse("")
            assert name in {entry["name"] for entry in desk.page.entries}
            desk.files.take(name, False)
            await desk.done()

    asyncio.run(opened("lh.pial", "lh.aparc.annot"))
    (mesh,) = views.layers
    found = views.actor(mesh.id).mapper.dataset
    np.testing.assert_allclose(found.points, BALL.points + [5.5, -17, 32], atol=1e-4)
    assert mesh.settings["scalars"] == "lh.aparc_rgb"
    np.testing.assert_array_equal(found.point_data["lh.aparc_rgb"], table[labels, :3])
    (text,) = views.data(mesh).facts["notes"]
    assert "moved by c_ras = (5.5, -17, 32) mm" in text
    assert_script_draws(views, tmp_path, views.cameras.screenshot())


def test_what_is_wrong_with_gifti_is_said(tmp_path):
    ball = placed_surface(tmp_path / surface(tmp_path))[0]
    assert ball.n_points == BALL.n_points
    labels(tmp_path, "few.label.gii", NUMBERS[:-2])
    with pytest.raises(FormatError, match="160 vertices.*162"):
        with_vertex_values(ball, tmp_path / "few.label.gii")
    with pytest.raises(FormatError, match="0 sets of points"):
        placed_surface(tmp_path / "few.label.gii")
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
        placed_surface(tmp_path / "nan.gii")
    for name in ("half.gii", "none.gii", "words.gii"):
        with pytest.raises(FormatError, match="GIFTI"):
            placed_surface(tmp_path / name)
        with pytest.raises((FormatError, ValueError)):
            Files(tmp_path).load(Source(name))


@pytest.fixture(scope="module")
def data(lines):
    """Something that each kind of layer draws."""
    mesh = pv.Sphere()
    mesh["height"] = mesh.points[:, 2]
    return {
        "tractogram": pvfiblets.compress(lines, per_point=["fa"]),
        "selection": pvfiblets.compress(lines[:5]),
        "tubes": as_spline_tubes([np.array([(0, 0, 0), (5, 1, 0), (10, 0, 0)], float)], radius=1.0),
        "volume": RaycastVolume(np.arange(64.0).reshape(4, 4, 4)),
        "mesh": mesh,
        "image": as_slice_image(np.arange(64.0).reshape(4, 4, 4)),
    }


EVERY = [(kind, prop) for kind, table in layers.TABLES.items() for prop in table]


@pytest.mark.parametrize(("kind", "prop"), EVERY, ids=[f"{kind}-{prop.name}" for kind, prop in EVERY])
def test_defaults_are_accepted_and_nonsense_is_not(kind, prop, data):
    if not prop.read_only:
        assert layers.check(kind, prop.name, prop.default, data[kind]) == prop.default
    for nonsense in ({"a": 1}, [[1]], "\x00", object(), math.nan, 10**400):
        with pytest.raises(ValueError, match=prop.name):
            layers.check(kind, prop.name, nonsense, data[kind])


@pytest.mark.parametrize("kind", layers.KINDS)
def test_names_are_unique_and_described(kind):
    names = [prop.name for prop in layers.TABLES[kind]]
    assert len(names) == len(set(names))
    assert all(prop.label and prop.help and prop.type in layers.TYPES for prop in layers.TABLES[kind])


@pytest.mark.parametrize(
    ("kind", "name", "value", "says"),
    [
        ("tractogram", "opacity", 1.5, "from 0 to 1"),
        ("tractogram", "opacity", True, "True"),
        ("tractogram", "opacity", "1", "'1'"),
        ("tractogram", "no_such", 1, "no_such"),
        ("tractogram", "promise", "0", "only be read"),
        ("tractogram", "scalars", "height", "'height'"),
        ("tractogram", "clim", [2.0, 1.0], "low end first"),
        ("tractogram", "clim", [0.0], "2 numbers"),
        ("tractogram", "color", "no colour", "'no colour'"),
        ("tractogram", "lighting", 1, "true or false"),
        ("tractogram", "tube_radius", 1e9, "from"),
        ("tractogram", "__class__", 1, "__class__"),
        ("volume", "mode", "fog", "isosurface"),
        ("volume", "values", list(range(20)), "1 to 8"),
        ("mesh", "scalars", 0, "0"),
    ],
)
def test_errors_name_value_and_remedy(kind, name, value, says, data):
    with pytest.raises(ValueError, match=says):
        layers.check(kind, name, value, data[kind])


def test_choices_follow_the_data(data, lines):
    def choices(kind, thing):
        (prop,) = (prop for prop in layers.TABLES[kind] if prop.name == "scalars")
        return {value for value, _ in prop.choices_for(thing)}

    assert {"orientation", None, "length", "fa", "weight", "group"} <= choices("tractogram", data["tractogram"])
    plain = pvfiblets.compress(pvfiblets.Streamlines(lines.points, lines.offsets))
    assert not {"fa", "weight", "group"} & choices("tractogram", plain)
    assert "height" in choices("mesh", data["mesh"])
    assert {"radius", "arc_length"} <= choices("tubes", data["tubes"])


def test_layers_have_colours_in_one_form_and_ranges_of_their_own(data):
    assert layers.check("mesh", "color", "red", data["mesh"]) == "#ff0000"
    assert layers.check("mesh", "color", "#FF0000", data["mesh"]) == "#ff0000"
    settings = {**layers.defaults("tractogram"), "scalars": "length", "clim": [1.0, 2.0], "log_scale": True}
    other = layers.changed("tractogram", settings, "scalars", "fa")
    assert (other["clim"], other["log_scale"]) == (None, False)
    assert layers.changed("tractogram", settings, "scalars", "length")["clim"] == [1.0, 2.0]


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
    | st.sampled_from(["orientation", "length", "viridis", "red", "composite", "two-phase", "layers"]),
    lambda parts: st.lists(parts, max_size=3) | st.dictionaries(st.text(max_size=4), parts, max_size=2),
    max_leaves=6,
)  # fmt: skip


@given(st.sampled_from([(kind, prop.name) for kind, prop in EVERY]), json_values)
def test_whatever_is_sent_is_refused_or_plain(which, value):
    kind, name = which
    sphere = pv.Sphere(theta_resolution=4, phi_resolution=4)  # of this, choices and limits need bounds and arrays alone
    thing = {"mesh": sphere}.get(kind)
    if thing is None:
        thing = _thing(kind)
    try:
        found = layers.check(kind, name, value, thing)
    except ValueError as error:
        said = str(error)
    else:
        said = name
        assert json.loads(json.dumps(found, allow_nan=False)) == found
        assert layers.check(kind, name, found, thing) == found
    assert name in said
    assert len(said) < 2000


def _thing(kind, made={}):  # noqa: B006 - made once
    if not made:
        line = np.array([(0, 0, 0), (5, 1, 0), (10, 0, 0)], float)
        made["tractogram"] = made["selection"] = pvfiblets.compress(pvfiblets.Streamlines.from_list([line]))
        made["tubes"] = as_spline_tubes([line], radius=1.0)
        made["volume"] = RaycastVolume(np.arange(64.0).reshape(4, 4, 4))
        made["image"] = as_slice_image(np.arange(64.0).reshape(4, 4, 4))
    return made[kind]


@pytest.mark.parametrize(
    ("file", "kind"),
    [("lines.fiblets", "tractogram"), ("vessel.vtp", "tubes"), ("head.nii.gz", "volume"), ("ball.ply", "mesh")],
)
def test_actors_do_what_settings_say(scene, file, kind):
    """What is set reads back from the actor, and its description is JSON."""
    layer = scene.open(file)
    assert layer.kind == kind
    told = {
        "tractogram": {"scalars": "fa", "cmap": "plasma", "clim": [0.1, 0.5], "opacity": 0.5, "line_width": 3.0,
                       "tube_radius": 0.5, "culling": None, "illuminated": True, "halos": True, "lighting": False},
        "tubes": {"scalars": "radius", "cmap": "hot", "min_width": 2.0, "solver": "newton", "opacity": 0.25,
                  "clim": [0.5, 2.0]},
        "volume": {"mode": "mip", "cmap": "hot", "clim": [0.0, 0.5], "step": 0.25, "thresholds": [0.1, 0.9]},
        "mesh": {"opacity": 0.5, "color": "#00ff00", "specular": 0.5},
    }[kind]  # fmt: skip
    for name, value in told.items():
        scene.set(layer.id, name, value)
    described = {entry["name"]: entry for entry in scene.queries.properties(layer.id)}
    json.dumps(list(described.values()), allow_nan=False)
    actor = scene.actor(layer.id)
    for name, value in told.items():
        assert described[name]["value"] == value
        if kind == "mesh":
            got = getattr(actor.prop, name)
            assert got == value if name != "color" else got.hex_rgb == value
        else:
            got = getattr(actor, name)
            got = list(got) if isinstance(got, tuple) else bool(got) if value is True else got
            assert got == pytest.approx(value) if isinstance(value, (float, list)) else got == value


def test_runs_of_ids_are_what_they_were_made_of():
    ids = np.array([5, 3, 4, 9, 11, 3, 12, 0])
    runs = Ids.from_numbers(ids)
    assert runs.array().tolist() == sorted(set(ids.tolist()))
    assert (len(runs), runs.highest) == (7, 12)
    assert runs == Ids.from_numbers([0, 3, 4, 5, 9, 11, 12])
    assert hash(runs) == hash(Ids(runs.runs))
    none = Ids.from_numbers([])
    assert (len(none), none.highest, none.array().tolist()) == (0, -1, [])
    for bad in ([[3, 3]], [[5, 4]], [[0, 2], [1, 3]], [[-1, 2]], [[0, 2], [2, 3]]):
        with pytest.raises(ValueError, match="rising"):
            Ids(np.array(bad))
