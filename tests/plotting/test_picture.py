"""``plotter.picture`` as its user has it, on all that the package draws."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray

from pvfiblets.mappers.frames import windows

from ..engine import lenses

FOCUS = {"focal_distance": 90.0, "aperture": 10.0, "max_blur": 4.0}


def shot(plotter):
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    return np.array(plotter.screenshot(return_img=True))


def ball(centre, radius):
    """Return a volume whose value falls with the distance from a point."""
    image = pv.ImageData(dimensions=(24, 24, 24), spacing=(1.0, 1.0, 1.0), origin=(-12.0, -12.0, -12.0))
    image["values"] = radius + 5.0 - np.linalg.norm(image.points, axis=1)
    image.origin = np.array(image.origin) + centre
    return image


def everything(plotter):
    """Show one of each, from 60 to 140 mm away."""
    t = np.linspace(0.0, 1.0, 60)
    wave = np.stack([40 * t - 20, 4 * np.sin(9 * t), 0 * t], axis=1)
    plotter.add_fiblets([wave + (0, 12 - i, 30 - 12 * i) for i in range(8)], line_width=2)
    plotter.add_spline_tubes(wave + (0, -8, 20), radius=2.0, color="orange")
    plotter.add_halo_lines([wave + (0, -14, -30)], line_width=1.0, strip_width=4.0)
    plotter.add_raycast_volume(ball((-8.0, 2.0, 38.0), 6.0), mode="isosurface", values=5.0, show_scalar_bar=False)
    plotter.add_mesh(pv.Sphere(radius=9, center=(12, 4, -20)), color="skyblue")
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.renderer.ResetCameraClippingRange()


@pytest.fixture
def scene():
    """Return an open plotter with one of each."""
    plotter = pv.Plotter(off_screen=True, window_size=(110, 80))
    plotter.set_background("dimgray")
    plotter.disable_anti_aliasing()
    everything(plotter)
    yield plotter
    context = next(iter(windows._contexts.values()))
    context.window.MakeCurrent()
    assert context.ctx.error == "GL_NO_ERROR"
    plotter.close()
    assert not any(context.alive for context in windows._contexts.values())


def test_all_that_the_package_draws_is_blurred_by_its_depth(scene):
    before = shot(scene)
    width, height = scene.window_size
    data = vtkFloatArray()
    scene.render_window.GetZbufferData(0, 0, width - 1, height - 1, data)
    depths = vtk_to_numpy(data).reshape(height, width)[::-1].astype(np.float64)
    near, far = scene.camera.clipping_range
    distances = np.where(depths < 1.0, near * far / (far - depths * (far - near)), np.inf)
    found = np.unique(np.round(distances[depths < 1.0], -1))
    assert found.min() <= 60 < 130 <= found.max()
    scene.picture.depth_of_field = FOCUS
    after = shot(scene)
    projection = lenses.perspective((width, height), angle=scene.camera.view_angle)
    radii = lenses.radii_of(projection, distances, rows=height, focus=90.0, aperture=10.0, widest=4.0)
    wanted = lenses.gathered(before, depths, radii)
    # Pixels of just one depth may be sorted apart in float32 and in float64.
    assert np.abs(after - wanted).max() <= 3.0
    assert np.abs(after.astype(int) - before).mean() > 2
    scene.picture.reset()
    assert np.array_equal(shot(scene), before)


def test_settings_are_read_as_they_are(plotter):
    picture = plotter.picture
    assert picture.depth_of_field is False
    assert picture.tone is False
    assert (picture.brightness, picture.contrast, picture.gamma) == (0.0, 1.0, 1.0)
    assert picture.focal_distance is None
    picture.depth_of_field = True
    assert picture.depth_of_field == {
        "focal_distance": None, "aperture": None, "darkening": 0.0, "max_blur": 16.0, "smooth": 0.0,
    }  # fmt: skip
    picture.depth_of_field = {"darkening": 0.5}
    assert picture.depth_of_field["darkening"] == 0.5
    picture.tone = True
    assert picture.tone == {"operator": "aces", "exposure": 1.0, "white": None}
    picture.tone = {"operator": "hable", "white": 8.0}
    picture.gamma = 2
    assert picture.tone == {"operator": "hable", "exposure": 1.0, "white": 8.0}
    picture.tone = None
    assert picture.tone is False
    assert picture.gamma == 2
    picture.reset()
    assert picture.gamma == 1.0
    picture.depth_of_field = None
    assert picture.depth_of_field is False


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [("depth_of_field", 3.0, "give True, False or a dict"),
     ("depth_of_field", {"focus": 3.0}, r"no settings \['focus'\]; it has \['focal_distance', 'aperture'"),
     ("depth_of_field", {"focal_distance": "mouse"}, "focal_distance is 'mouse'"),
     ("depth_of_field", {"focal_distance": np.inf}, "focal_distance"),
     ("depth_of_field", {"max_blur": 500}, "max_blur is 500"), ("depth_of_field", {"aperture": "wide"}, "aperture"),
     ("depth_of_field", {"darkening": 1.1}, "darkening"), ("depth_of_field", {"smooth": -1.0}, "smooth"),
     ("tone", "aces", "give True, False or a dict"), ("tone", {"gamma": 2.0}, r"no settings \['gamma'\]"),
     ("tone", {"operator": "filmic"}, "operator is 'filmic'; choose one of"),
     ("tone", {"exposure": 0}, "exposure is 0; give a number above 0"),
     ("tone", {"white": 2.0}, "operator 'aces' has none"), ("gamma", 0, "gamma is 0"),
     ("brightness", 2, "brightness is 2; give a number from -1 to 1"), ("contrast", "high", "contrast is 'high'")],
)  # fmt: skip
def test_what_has_no_meaning_is_refused_and_changes_nothing(plotter, name, value, message):
    plotter.picture.depth_of_field = FOCUS
    plotter.picture.tone = True
    before = {known: getattr(plotter.picture, known) for known in ("depth_of_field", "tone", "gamma", "brightness")}
    with pytest.raises(ValueError, match=message):
        setattr(plotter.picture, name, value)
    with pytest.raises(AttributeError):
        plotter.picture.gama = 2.0
    assert before == {known: getattr(plotter.picture, known) for known in before}


def test_the_mouse_moves_the_focus_and_the_picture(plotter):
    """The event alone renders, as long as the focus follows the mouse."""
    plotter.add_mesh(pv.Plane(center=(0, 0, 20), i_size=200, j_size=200))
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.picture.depth_of_field = {"focal_distance": "cursor", "max_blur": 2.0}
    mouse = plotter.iren.interactor
    shot(plotter)
    renders = []
    plotter.render_window.AddObserver("EndEvent", lambda *_: renders.append(1))
    mouse.SetEventPosition(100, 100)
    mouse.InvokeEvent("MouseMoveEvent")
    assert len(renders) == 1
    assert plotter.picture.focal_distance == pytest.approx(80.0, rel=1e-4)
    mouse.InvokeEvent("TimerEvent")  # arrived: nothing to be shown
    assert len(renders) == 1
    plotter.picture.depth_of_field = {"focal_distance": 30.0}
    mouse.InvokeEvent("MouseMoveEvent")
    assert len(renders) == 1


def test_a_focus_on_its_way_goes_on_when_the_mouse_rests(plotter):
    for x, z in ((-50, 20), (50, 60)):
        plotter.add_mesh(pv.Plane(center=(x, 0, z), i_size=100, j_size=200))
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.picture.depth_of_field = {"focal_distance": "cursor", "max_blur": 2.0, "smooth": 0.1}
    now = [0.0]
    plotter.picture._picture().focusing.clock = lambda: now[0]
    mouse = plotter.iren.interactor
    mouse.SetEventPosition(50, 100)
    shot(plotter)
    mouse.SetEventPosition(150, 100)
    passed = []
    for event in ("MouseMoveEvent", *["TimerEvent"] * 12):
        now[0] += 0.1
        mouse.InvokeEvent(event)
        passed.append(plotter.picture.focal_distance)
    assert passed[0] == pytest.approx(40.0 * 2.0 ** np.exp(-1.0), rel=1e-3)
    assert passed[-1] == passed[-2] == pytest.approx(40.0, rel=1e-4)


def test_memory_is_given_back_and_errors_of_a_draw_are_raised_by_what_rendered(plotter, monkeypatch):
    plotter.add_mesh(pv.Sphere())
    assert plotter.picture.explain() == {"buffers": []}
    plotter.picture.gamma = 2.0
    shot(plotter)
    assert plotter.picture.explain()["buffers"][0]["bytes"] == 200 * 200 * 4
    plotter.picture.reset()
    assert plotter.picture.explain() == {"buffers": []}
    assert not windows._contexts
    plotter.picture.gamma = 2.0
    shot(plotter)
    with monkeypatch.context() as patched:
        patched.setattr("pvfiblets.mappers.picture.picture.COLOUR", 0x8CE7)
        with pytest.raises(RuntimeError, match="draw into textures"):
            plotter.render()
    plotter.close()
    assert not windows._contexts


@pytest.mark.more
def test_no_import_is_needed_and_nothing_is_imported_before():
    code = (
        "import sys, pyvista as pv\n"
        "pl = pv.Plotter(off_screen=True)\n"
        "assert 'picture' in dir(pl)\n"
        "pl.add_mesh(pv.Sphere())\n"
        "pl.show(auto_close=False)\n"
        "assert 'pvfiblets.mappers.picture.picture' not in sys.modules\n"
        "print(pl.picture.gamma)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["1.0"], done.stderr
