"""Effects on the picture in VTK's renderers: what they read, where they write, and what they leave alone."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkFloatArray
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkHardwareSelector, vtkPolyDataMapper2D

from pvfiblets.engine.effects.tone import Tone
from pvfiblets.mappers.frames import windows
from pvfiblets.mappers.frames.scene import others_before, others_opaque
from pvfiblets.mappers.picture.lens_focus import DepthOfField
from pvfiblets.mappers.picture.picture import Picture
from tests.gl_calls import possible, recording

from ..engine import lenses

CAMERA = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]


def shot(plotter, *pictures, **options):
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    image = np.array(plotter.screenshot(return_img=True, **options))
    for picture in pictures:
        picture.raise_pending()
    return image


def fill(plotter, opacity=1.0):
    """Show spheres before and behind the focal point, 100 mm away, on grey."""
    plotter.set_background("dimgray")
    for place, colour in (((-14, 0, 30), "tomato"), ((0, 4, 0), "gold"), ((14, 0, -50), "skyblue")):
        mesh = pv.Sphere(radius=11, center=place, theta_resolution=60, phi_resolution=60)
        plotter.add_mesh(mesh, color=colour, opacity=opacity)
    plotter.camera_position = CAMERA
    plotter.renderer.ResetCameraClippingRange()


def depths_of(plotter):
    """Return VTK's own depths of the whole window, the top row first."""
    width, height = plotter.window_size
    data = vtkFloatArray()
    plotter.render_window.GetZbufferData(0, 0, width - 1, height - 1, data)
    assert isinstance(data, vtkDataArray)
    return vtk_to_numpy(data).reshape(height, width)[::-1]


def distances_of(plotter, depths):
    near, far = plotter.camera.clipping_range
    if plotter.camera.parallel_projection:
        distances = near + depths * (far - near)
    else:
        distances = near * far / (far - depths * (far - near))
    return np.where(depths < 1.0, distances, np.inf)


def modes(plotter, mode):
    if mode == "msaa":
        plotter.enable_anti_aliasing("msaa", multi_samples=4)
    elif mode == "ssao":
        plotter.enable_ssao(radius=10.0, kernel_size=16)
    elif mode == "ssaa":
        plotter.enable_anti_aliasing("ssaa")
    elif mode == "eye-dome lighting":
        plotter.enable_eye_dome_lighting()
    elif mode == "peeling":
        plotter.enable_depth_peeling()
    elif mode == "stereo":
        plotter.enable_stereo_render()
        plotter.render_window.SetStereoTypeToLeft()


@pytest.mark.few(2)
@pytest.mark.parametrize("mode", ["plain", "msaa", "peeling", "ssao", "eye-dome lighting", "ssaa", "stereo"])
def test_tones_are_those_of_the_picture_that_vtk_draws(make_plotter, mode):
    plotter = make_plotter()
    modes(plotter, mode)
    fill(plotter, opacity=0.6 if mode == "peeling" else 1.0)
    before = shot(plotter)
    picture = Picture(plotter.renderer)
    picture.tone = Tone(operator="aces", exposure=1.3, contrast=0.8, gamma=1.5)
    after = shot(plotter, picture)
    wanted = lenses.toned(before / 255.0, operator="aces", exposure=1.3, contrast=0.8, gamma=1.5) * 255.0
    off = np.abs(after - wanted).max(axis=-1)
    # Supersampling takes the mean of changed pixels: at edges that is another.
    assert (off <= 1.0).mean() >= (0.95 if mode == "ssaa" else 1.0)
    assert np.abs(after.astype(int) - before).max() > 20
    picture.tone = Tone()
    assert np.array_equal(shot(plotter), before)


def stamp(renderer, colour=(0.8, 0.4, 0.2)):
    """Lay a rectangle of one colour over the picture."""
    corners = np.array([(20, 20, 0), (120, 20, 0), (120, 90, 0), (20, 90, 0)], float)
    mapper, actor = vtkPolyDataMapper2D(), vtkActor2D()
    mapper.SetInputData(pv.PolyData(corners, faces=[4, 0, 1, 2, 3]))
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    renderer.AddViewProp(actor)


@pytest.mark.parametrize(("mode", "first"), [("plain", True), ("msaa", False), ("peeling", False), ("ssao", True)])
def test_what_lies_over_the_picture_is_left_alone(make_plotter, mode, first):
    plotter = make_plotter()
    modes(plotter, mode)
    picture = Picture(plotter.renderer)
    if first:
        stamp(plotter.renderer)
    picture.tone = Tone(gamma=2.0)
    picture.depth_of_field = DepthOfField(focal_distance=60.0)
    fill(plotter)
    if not first:
        stamp(plotter.renderer)
    image = shot(plotter, picture)
    flat = image[::-1][21:89, 21:119].reshape(-1, 3)
    assert (flat == (204, 102, 51)).all()
    # Beside it: grey of 105, lightened.
    assert np.abs(image[2, 2] - 255.0 * (105 / 255.0) ** 0.5).max() <= 1


@pytest.mark.few(1)
@pytest.mark.parametrize(("parallel", "mode"), [(False, "plain"), (True, "plain"), (False, "stereo")])
def test_depth_of_field_is_numpys_of_vtks_own_depths(make_plotter, parallel, mode):
    plotter = make_plotter(window_size=(100, 80))
    modes(plotter, mode)
    fill(plotter)
    plotter.camera.parallel_projection = parallel
    plotter.camera.parallel_scale = 26.0
    before = shot(plotter)
    depths = depths_of(plotter)
    picture = Picture(plotter.renderer)
    picture.depth_of_field = DepthOfField(focal_distance=90.0, aperture=9.0, max_blur=5.0)
    after = shot(plotter, picture)
    rows = 80
    kind = lenses.parallel if parallel else lenses.perspective
    projection = kind((100, rows), tall=52.0) if parallel else kind((100, rows), angle=plotter.camera.view_angle)
    distances = distances_of(plotter, depths.astype(np.float64))
    radii = lenses.radii_of(projection, distances, rows=rows, focus=90.0, aperture=9.0, widest=5.0)
    assert radii.min() < 0.5
    wanted = lenses.gathered(before, depths, radii)
    assert np.abs(after - wanted).max() <= 1.5
    assert np.abs(after.astype(int) - before).max() > 30
    assert picture.focal_distance == 90.0


def test_subplots_have_effects_of_their_own(make_plotter):
    plotter = make_plotter(shape=(1, 3), border=False, window_size=(300, 100))
    images = []
    for effects in (False, True):
        for index in range(3):
            plotter.subplot(0, index)
            if not effects:
                fill(plotter)
        if effects:
            pictures = [Picture(renderer) for renderer in plotter.renderers[1:]]
            pictures[0].tone = Tone(brightness=0.3)
            pictures[1].depth_of_field = DepthOfField(focal_distance=50.0)
        images.append(shot(plotter))
    before, after = (image.astype(int) for image in images)
    assert np.array_equal(before[:, :100], after[:, :100])
    assert np.abs(after[:, 100:200] - np.minimum(before[:, 100:200] + 76.5, 255)).max() <= 1
    blurred = np.abs(after[:, 200:] - before[:, 200:])
    assert blurred.max() > 30
    # The background of one is not drawn into by the others.
    assert (after[2, 200:] == 105).all()


def walls(plotter):
    """Show a wall 50 mm away on the left, one 80 mm away on the right, nothing above."""
    for x, z in ((-20, 50), (20, 20)):
        plotter.add_mesh(pv.Plane(center=(x, -10, z), i_size=40, j_size=30, i_resolution=1, j_resolution=1))
    plotter.camera_position = CAMERA
    plotter.renderer.ResetCameraClippingRange()


def test_the_focus_follows_the_mouse_or_is_on_the_middle(make_plotter):
    plotter = make_plotter()
    walls(plotter)
    picture = Picture(plotter.renderer)
    picture.depth_of_field = DepthOfField(focal_distance="cursor")
    mouse = plotter.iren.interactor
    mouse.SetEventPosition(120, 195)
    shot(plotter, picture)
    assert picture.focal_distance == 100.0  # nothing there: the camera's focal point
    for x, distance in ((60, 50.0), (180, 80.0)):
        mouse.SetEventPosition(x, 80)
        shot(plotter, picture)
        picker = pv._vtk.vtkCellPicker()
        assert picker.Pick(x, 80, 0, plotter.renderer)
        assert picture.focal_distance == pytest.approx(100.0 - picker.GetPickPosition()[2], rel=1e-4)
        assert picture.focal_distance == pytest.approx(distance, rel=1e-4)
    mouse.SetEventPosition(120, 195)
    shot(plotter, picture)
    assert picture.focal_distance == pytest.approx(80.0, rel=1e-4)  # stays where it was
    mouse.SetEventPosition(121, 80)  # just beside the near wall's edge: things are thin
    shot(plotter, picture)
    assert picture.focal_distance == pytest.approx(50.0, rel=1e-4)
    plotter.add_mesh(pv.Sphere(radius=5, center=(0, 0, 70)))
    plotter.renderer.ResetCameraClippingRange()
    picture.depth_of_field = DepthOfField(focal_distance="center")
    shot(plotter, picture)
    assert picture.focal_distance == pytest.approx(25.0, rel=1e-3)


@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
def test_a_focus_follows_a_hand_without_waiting_for_the_gpu(make_plotter):
    plotter = make_plotter()
    walls(plotter)
    picture = Picture(plotter.renderer)
    picture.depth_of_field = DepthOfField(focal_distance="cursor")
    mouse = plotter.iren.interactor
    mouse.SetEventPosition(60, 80)
    with recording() as calls:
        shot(plotter, picture)
        assert picture.focal_distance == pytest.approx(50.0, rel=1e-4)
        assert set(calls.waits) == {"glReadPixels"}
        calls.forget()
        plotter.render_window.SetDesiredUpdateRate(15.0)  # as VTK's interactor styles do
        mouse.SetEventPosition(180, 80)
        for _ in range(4):
            plotter.render()
            plotter.render_window.WaitForCompletion()
        assert picture.focal_distance == pytest.approx(80.0, rel=1e-4)
        assert calls.waits == []
        plotter.render_window.SetDesiredUpdateRate(1e-4)
        mouse.SetEventPosition(60, 80)
        plotter.render()
        assert picture.focal_distance == pytest.approx(50.0, rel=1e-4)
    picture.raise_pending()


@pytest.mark.parametrize("columns", [1, 2])
def test_an_enlarged_picture_has_no_seams(make_plotter, columns):
    """Tiles blur over their edges: the picture is that of a window twice as large, with or without subplots."""
    images = []
    for factor in (1, 2):
        size = 120 * factor, 100 * factor
        plotter = make_plotter(shape=(1, columns), border=False, window_size=size)
        pictures = []
        for column in range(columns):
            plotter.subplot(0, column)
            fill(plotter)
            pictures.append(Picture(plotter.renderer))
            pictures[-1].depth_of_field = DepthOfField(focal_distance=70.0, aperture=10.0, max_blur=6.0 * factor)
        images.append(shot(plotter, *pictures, scale=2 // factor).astype(int))
    off = np.abs(images[0] - images[1]).max(axis=-1)
    assert (off <= 2).mean() > 0.99
    if columns == 1:
        assert off[:, 116:124].max() <= 8
        assert off[96:104].max() <= 8


def test_nothing_exists_while_nothing_is_changed(make_plotter):
    plotter = make_plotter()
    fill(plotter)
    props = plotter.renderer.GetViewProps()
    count = props.GetNumberOfItems()
    picture = Picture(plotter.renderer)
    picture.tone, picture.depth_of_field = Tone(), None
    shot(plotter)
    assert props.GetNumberOfItems() == count
    assert not windows._contexts
    assert picture.explain() == {"buffers": []}
    picture.tone = Tone(gamma=2.0)
    shot(plotter, picture)
    assert picture.explain() == {"buffers": [{"name": "picture", "bytes": 240 * 200 * 4}]}

    picture.tone = Tone()
    assert props.GetNumberOfItems() == count
    assert not windows._contexts
    assert not plotter.renderer.HasObserver("StartEvent")
    before = shot(plotter)
    picture.tone = Tone(brightness=0.5)
    shot(plotter, picture)
    del picture  # one that nobody keeps stops to act
    gc.collect()
    assert np.array_equal(shot(plotter), before)


def test_selection_sees_the_actors(make_plotter):
    plotter = make_plotter()
    fill(plotter)
    picture = Picture(plotter.renderer)
    picture.tone = Tone(gamma=2.0)
    picture.depth_of_field = DepthOfField()
    shot(plotter, picture)
    selector = vtkHardwareSelector()
    selector.SetRenderer(plotter.renderer)
    selector.SetArea(118, 105, 122, 109)
    found = selector.Select()
    assert found.GetNumberOfNodes() == 1
    picture.raise_pending()


def test_a_transparent_background_stays_transparent(make_plotter):
    plotter = make_plotter()
    fill(plotter)
    plain = shot(plotter, transparent_background=True)
    picture = Picture(plotter.renderer)
    picture.tone = Tone(gamma=2.0)
    toned = shot(plotter, picture, transparent_background=True)
    assert np.array_equal(plain[..., 3], toned[..., 3])
    assert set(np.unique(plain[..., 3])) == {0, 255}
    picture.depth_of_field = DepthOfField(focal_distance=40.0, max_blur=8.0)
    blurred = shot(plotter, picture, transparent_background=True)
    assert len(np.unique(blurred[..., 3])) > 20  # edges fade into it


def test_culling_does_not_take_the_prop_for_something_in_front(make_plotter):
    plotter = make_plotter()
    actor = plotter.add_mesh(pv.Sphere())
    picture = Picture(plotter.renderer)
    picture.tone = Tone(gamma=2.0)
    assert not others_before(plotter.renderer, actor)
    assert not others_opaque(plotter.renderer, actor)
