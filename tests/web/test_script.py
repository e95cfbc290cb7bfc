"""Scripts: plain Python that makes the same picture, run as anybody would."""

import builtins
import contextlib
import keyword
import re
import subprocess
import sys

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.support.nifti_space import nifti_space
from pvfiblets.support.surface_space import as_stored
from pvfiblets.volumes import RaycastVolume
from pvfiblets.volumes.raycast_options import INTEGRATORS
from pvfiblets.web.scene import layers
from pvfiblets.web.scene.layers import USUAL
from pvfiblets.web.session.document import Source
from pvfiblets.web.session.script import as_script
from tests.web.desk import assert_script_draws


def tracts(scene):
    """Lines that are coloured, filtered, cut and picked, a mesh that is cut, and a hidden layer."""
    lines = scene.open("lines.trk")
    scene.set(lines.id, "scalars", "fa")
    scene.set(lines.id, "cmap", "plasma_r")
    scene.set(lines.id, "line_width", 2)
    scene.set(lines.id, "illuminated", True)
    scene.filters.set_filter(lines.id, "length", 15, None)
    scene.filters.set_subset(lines.id, 0.9)
    labels = {"how": "ends_in", "region": {"kind": "labels", "path": "atlas.nii.gz", "labels": [5]}}
    ball = {"how": "passes", "region": {"kind": "mesh", "path": "ball.ply"}}
    anything = {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 30}, "sampling": "points"}
    scene.filters.set_regions(lines.id, {"op": "or", "of": [labels, ball, {"op": "not", "of": [anything]}, anything]})
    scene.selection.select(lines.id, [*range(10, 20), 40, 45])
    scene.set(lines.id, "selection_color", "#00ff00")
    scene.set(lines.id, "selection_dim", 0.4)
    mesh = scene.open("ball.ply")
    scene.set(mesh.id, "color", "#ff8800")
    scene.set(mesh.id, "show_edges", True)
    scene.filters.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 3], layers=[lines.id, mesh.id])
    scene.filters.add_clip("sphere", inside=False, center=[10, 0, 0], radius=6)
    scene.filters.add_clip("sphere", inside=False, center=[20, 18, 18], radius=5, layers=[mesh.id])
    scene.filters.add_clip("box", bounds=[0, 24, 0, 40, 0, 40], layers=[mesh.id])
    scene.show(scene.duplicate(lines.id).id, False)
    scene.cameras.view("coronal")


def anatomy(scene):
    """A volume, tubes, a selection on its own and tubes in the style of ink; parallel, on white."""
    lines = scene.open("lines.fiblets")
    scene.set(lines.id, "scalars", "length")
    scene.set(lines.id, "opacity", 0.6)
    scene.set(lines.id, "transparency", "layers")
    scene.filters.set_groups(lines.id, ["near"])
    scene.selection.select(lines.id, [5, 6, 7, 50, 52])
    part = scene.keep_selection(lines.id)
    scene.set(part.id, "scalars", None)
    scene.set(part.id, "color", "#cc0000")
    scene.set(part.id, "tube_radius", 1.0)
    scene.selection.deselect()
    head = scene.open("head.nii.gz")
    scene.set(head.id, "mode", "composite")
    scene.set(head.id, "opacity", "sigmoid_5")
    scene.set(head.id, "opacity_unit_distance", 20.0)
    tubes = scene.open("vessel.vtp")
    scene.set(tubes.id, "scalars", "radius")
    scene.set(tubes.id, "silhouette", True)
    scene.set(tubes.id, "radius_scale", 1.5)
    grouped = scene.duplicate(lines.id)
    scene.set(grouped.id, "scalars", "group")
    scene.filters.set_groups(grouped.id, ["far"])
    ink = scene.duplicate(part.id)
    scene.set(ink.id, "style", "halo")
    scene.set_background("white")
    scene.cameras.view("sagittal")
    scene.cameras.parallel = True


def volumes(scene):
    """Lines that are coloured by volumes: of labels, of numbers, of another format, and of a demo."""
    scene.open("head.nii.gz")
    scene.open("atlas.nii.gz")
    image = pv.ImageData(dimensions=(8, 8, 8), spacing=(9.0, 6.0, 4.0))
    image["height"] = image.points[:, 1].astype(np.float32)
    image.save(scene.root / "height.vti")
    scene.open("height.vti")
    _, demo = scene.add_loaded_demo(scene.load_demo(4, 8))
    names = ("head.nii.gz", "atlas.nii.gz", "height.vti")
    wanted = [*({"volume": {"path": name}} for name in names), {"volume": {"demo": "head", "size": 8}}]
    for layer in scene.layers:
        scene.show(layer.id, False)
    for group, value in enumerate(wanted):
        lines = scene.open("lines.fiblets")
        scene.set(lines.id, "scalars", value)
        scene.set(lines.id, "line_width", 2.0)
        scene.filters.set_filter(lines.id, "weight", 15 * group, 15 * group + 14)
    scene.filters.set_filter(scene.layers[-1].id, "atlas", 3, 3, image=Source("atlas.nii.gz"))
    scene.remove(demo.id)
    scene.cameras.view("coronal")


@pytest.mark.more
@pytest.mark.usefixtures("usual_limits")  # which the script has
@pytest.mark.parametrize("fill", [tracts, anatomy, volumes])
def test_a_script_makes_the_same_picture(scene, folder, fill):
    scene.plotter.window_size = 420, 360
    fill(scene)
    scene.cameras.screenshot()
    picture = scene.cameras.screenshot()
    assert fill is anatomy or any(bar.GetVisibility() for bar in scene.plotter.scalar_bars.values())
    script = as_script(scene, "again.png")
    assert str(folder) not in script
    assert "trame" not in script
    assert "pvfiblets.web" not in script
    (folder / "again.py").write_text(script)
    done = subprocess.run(
        [sys.executable, "again.py"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr + script
    again = np.asarray(pv.read(folder / "again.png").active_scalars).reshape(360, 420, -1)[::-1]
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100
    differ = (again != picture).any(axis=-1)
    assert differ.sum() == 0, f"{differ.sum()} of {differ.size} pixels differ"


@contextlib.contextmanager
def as_told():
    """What ``serve --nifti-space qform --nifti-units header --tkras`` does."""
    with nifti_space("qform", units="header"), as_stored():
        yield


def test_a_script_places_images_and_surfaces_as_the_server_does(scene, folder):
    mirrored = np.diag([-4.0, 4.0, 4.0, 1.0])
    mirrored[0, 3] = 60.0
    image = nib.Nifti1Image(np.arange(16**3, dtype=np.float32).reshape(16, 16, 16), np.diag([4.0, 4.0, 4.0, 1.0]))
    image.set_qform(mirrored)
    nib.save(image, folder / "both.nii")
    ball = pv.Icosphere(radius=8.0, nsub=1)
    space = {"head": [2, 0, 20], "valid": "1", "filename": "t1", "volume": [9, 9, 9], "voxelsize": [1.0] * 3,
             "xras": [-1.0, 0, 0], "yras": [0, 0, -1.0], "zras": [0, 1.0, 0], "cras": [30.0, 20.0, 0]}  # fmt: skip
    nib.freesurfer.write_geometry(folder / "lh.pial", ball.points, ball.regular_faces, volume_info=space)
    with as_told():
        layer = scene.open("lines.fiblets")
        scene.open("lh.pial")
        scene.open("both.nii", "volume")
        scene.set(layer.id, "scalars", {"volume": {"path": "both.nii"}})
        scene.show(scene.layers[-1].id, False)
        picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture, as_told)
    for kept in (nifti_space("qform", units="header"), as_stored()):  # either moves something
        with pytest.warns(UserWarning, match="both.nii|lh.pial"), pytest.raises(AssertionError):
            assert_script_draws(scene, folder, picture, lambda kept=kept: kept)


def test_a_script_can_be_read(scene):
    layer = scene.open("lines.fiblets")
    scene.rename(layer.id, "class: arcuate (left) #1")
    scene.rename(scene.duplicate(layer.id).id, "class_arcuate_left_1")
    scene.selection.select(layer.id, np.arange(0, 60, 2))
    script = as_script(scene)
    compile(script, "script", "exec")
    assert max(map(len, script.splitlines())) <= 120
    assert "\nclass_arcuate_left_1 = plotter.add_fiblets(" in script
    assert "\nclass_arcuate_left_1_2 = plotter.add_fiblets(" in script
    assert script.rstrip().endswith("plotter.show()")


HOSTILE = (
    "print.tck", "float.trk", "class.trk", "pv.tck", "np.trk", "plotter.tck", "match.tck", "1.tck", "path.tck",
    "it's \"quoted\".tck", "matrix.trk", "range.tck", "folder.tck", "region.tck", "_.tck", "twice/lines.trk",
    "lines.trk", "end_labels.tck", "as_slice_image.tck", "parcels.tck", "fiblets.tck", "bundle.tck",
)  # fmt: skip


def test_no_file_is_called_as_what_the_script_uses(scene, folder, lines):
    (folder / "twice").mkdir()
    for name in HOSTILE:
        if not (folder / name).exists():
            pvfiblets.write(folder / name, lines)
    made = [scene.open(name) for name in HOSTILE]
    one = made[0]
    scene.filters.set_filter(made[1].id, "length", 20, None)  # float('inf')
    scene.bundles.add_bundle(made[1].id, [1, 2, 3], "for")
    scene.selection.select(one.id, [3, 4])
    scene.keep_selection(one.id)
    scene.remove(one.id)  # of which the selection is a part: fiblets
    scene.matrix.show_matrix(
        scene.matrix.prepare_matrix(layer=made[1].id, labels="atlas.nii.gz")
    )  # print(matrix), parcels
    scene.matrix.set_connection(made[2].id, [3, 5], "atlas.nii.gz")  # ends
    scene.measurements.add_measurement([0, 0, 0], [1, 2, 3])
    scene.filters.add_clip("plane")
    script = as_script(scene)
    variables = re.findall(r"^(\w+) = plotter\.add_fiblets\(", script, re.MULTILINE)
    assert len(set(variables)) == len(HOSTILE)
    assert not set(variables) & {*dir(builtins), *keyword.kwlist}
    assert {"layer_class", "layer_1", "lines", "lines_2"} <= set(variables)
    shown = "print('drawn:', len(plotter.actors))\nplotter.close()"
    (folder / "again.py").write_text(script.replace("plotter.show()", shown))
    done = subprocess.run(
        [sys.executable, "again.py"], cwd=folder, capture_output=True, text=True, timeout=240, check=False
    )
    assert done.returncode == 0, done.stderr + script
    assert "drawn:" in done.stdout


def test_a_script_can_be_read_and_makes_demos(scene):
    tracts, head = scene.add_loaded_demo(scene.load_demo(50, 8))
    assert tracts.visible
    assert not head.visible
    script = as_script(scene)
    assert "brain_streamlines(50, 0.5)" in script
    assert "brain_like(8)" in script
    compile(script, "script", "exec")
    (prop,) = (prop for prop in layers.TABLES["volume"] if prop.name == "integrator")
    assert [value for value, _ in prop.choices] == list(INTEGRATORS)


@pytest.mark.parametrize(
    ("kind", "method", "what"),
    [
        ("tractogram", "add_fiblets", [np.arange(12.0).reshape(4, 3)]),
        ("tubes", "add_spline_tubes", [np.arange(12.0).reshape(4, 3)]),
        ("volume", "add_raycast_volume", RaycastVolume(np.arange(64.0).reshape(4, 4, 4))),
    ],
)
def test_what_is_not_said_is_so_anyhow(kind, method, what):
    plotter = pv.Plotter(off_screen=True)
    actor = getattr(plotter, method)(what)
    unsaid = {name: value for name, value in USUAL[kind].items() if hasattr(actor, name) and value is not None}
    unsaid.pop("scalars", None)  # None of an actor, whose colours are then by orientation
    assert {name: getattr(actor, name) for name in unsaid} == unsaid
    plotter.close()
