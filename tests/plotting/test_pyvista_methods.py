"""What PyVista's plotters, actors, properties and cameras can do to a picture, and what lines of ours do under it."""

from __future__ import annotations

import inspect
import warnings
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonTransforms import vtkTransform

KNOWN = Path(__file__).with_name("pyvista_names.txt")
"""Public names of PyVista that have been looked at: a line of names for each class."""

LINE = pv.MultipleLines(np.array([[-5.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 0.0, 0.0]]))
LINE["height"] = np.array([0.0, 1.0, 2.0])
ADDERS = {
    "add_fiblets": {"line_width": 4},
    "add_spline_tubes": {"radius": 0.1},
    "add_halo_lines": {"line_width": 0.1, "strip_width": 0.2},
}
COMPONENTS = ("_CachedComponent", "_Pending")  # what PyVista makes of one, and ours before it is imported


@pytest.mark.parametrize("kind", [pv.Plotter, pv.Actor, pv.Property, pv.Camera])
def test_each_public_name_has_been_looked_at(kind):
    known = dict(line.split(": ", 1) for line in KNOWN.read_text().splitlines())[kind.__name__].split()
    names = {name for name in dir(kind) if name[0] == name[0].lower() and not name.startswith("_")}
    names -= {name for name in names if type(inspect.getattr_static(kind, name)).__name__ in COMPONENTS}
    new = sorted(names - set(known))
    assert not new, f"see what our actors do under {new} of pyvista.{kind.__name__}, and add them to {KNOWN.name}"


def shifted(plotter, _actor):
    plotter.camera.SetWindowCenter(0.3, 0.0)


def turned(plotter, _actor):
    turn = vtkTransform()
    turn.RotateZ(20.0)
    plotter.camera.SetUserViewTransform(turn)


def placed(plotter, _actor):
    plotter.camera.model_transform_matrix = np.diag([0.5, 0.5, 0.5, 1.0])


def replaced(_plotter, actor):
    tag = "//VTK::Color::Impl"
    actor.add_shader_replacement("fragment", tag, f"{tag}\n  diffuseColor = vec3(0, 1, 0);")


def distorted(plotter):
    plotter.enable_camera_distortion((-0.3, 0.0, 0.0, 0.0))
    plotter.render()
    plotter.disable_camera_distortion()


SAME = {
    "scale of the scene": lambda plotter, _: plotter.set_scale(1, 3, 1),
    "scale of the actor": lambda _, actor: setattr(actor, "scale", (1, 3, 1)),
    "window centre": shifted,
    "user view transform": turned,
    "model transform": placed,
    "visibility": lambda _, actor: setattr(actor, "visibility", False),
    "force_opaque": lambda _, actor: setattr(actor, "force_opaque", True),
    "static mapper": lambda _, actor: setattr(actor.mapper, "static", True),
    "fragment replacement": replaced,
    "depth peeling": lambda plotter, _: plotter.enable_depth_peeling(),
    "shadows": lambda plotter, _: plotter.enable_shadows(),
    "hidden lines": lambda plotter, _: plotter.enable_hidden_line_removal(),
    "parallel": lambda plotter, _: plotter.enable_parallel_projection(),
}
UNDONE = {
    "camera distortion": lambda plotter, _: plotter.enable_camera_distortion((-0.3, 0.0, 0.0, 0.0)),
    "camera distortion, off again": lambda plotter, _: distorted(plotter),
    "maximum intensity": lambda _, actor: actor.enable_maximum_intensity_projection(),
    "wireframe": lambda _, actor: setattr(actor.prop, "style", "wireframe"),
    "points": lambda _, actor: setattr(actor.prop, "style", "points"),
    "edges": lambda _, actor: setattr(actor.prop, "show_edges", True),
}


def picture(adder, change, *, first=False, **look):
    """Return a picture of the line, changed before or after it was first drawn."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    actor = getattr(plotter, adder)(LINE, scalars="height", cmap=["white", "yellow"], show_scalar_bar=False, **look)
    plotter.view_xy()
    if not first:
        plotter.show(auto_close=False)
    if change is not None:
        change(plotter, actor)
    plotter.render()
    found = plotter.screenshot(return_img=True).astype(int)
    plotter.close()
    return found


def box(found):
    ys, xs = np.nonzero(found.max(2) > 100)
    return (xs.min(), xs.max(), ys.min(), ys.max()) if len(xs) else (0, 0, 0, 0)


@pytest.mark.parametrize("name", SAME)
@pytest.mark.parametrize("adder", ADDERS)
def test_lines_lie_where_those_of_add_mesh_do(adder, name):
    mesh = picture("add_mesh", SAME[name], line_width=4, lighting=False)
    np.testing.assert_allclose(box(picture(adder, SAME[name], **ADDERS[adder])), box(mesh), atol=5)


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize("name", UNDONE)
@pytest.mark.parametrize("adder", ADDERS)
def test_what_cannot_be_done_is_said_and_the_picture_stays(adder, name, first):
    plain = picture(adder, None, **ADDERS[adder])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        changed = picture(adder, UNDONE[name], first=first, **ADDERS[adder])
    assert any("changes nothing here" in str(one.message) for one in told) or (first and name.endswith("off again"))
    np.testing.assert_array_equal(changed, plain)
