"""Matrices of a frame against VTK's own transformations, and what float32 leaves of them."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkAssembly, vtkRenderer, vtkRenderWindow

from pvfiblets.mappers.frames.scene import frame_of, renderers_of


@pytest.fixture
def view():
    """Return a function that makes renderer, actor and frame of a camera."""
    kept = []

    def make(*, offset=0.0, near=10.0, far=1000.0, parallel=False):
        window, renderer, actor = vtkRenderWindow(), vtkRenderer(), vtkActor()
        window.SetSize(400, 300)
        window.AddRenderer(renderer)
        renderer.AddActor(actor)
        actor.SetPosition(offset, -offset, offset)
        actor.SetScale(1.0, 2.0, -0.5)
        actor.SetOrientation(10, 20, 30)
        camera = renderer.GetActiveCamera()
        camera.SetPosition(offset + 30, -offset - 200, offset + 50)
        camera.SetFocalPoint(offset, -offset, offset)
        camera.SetParallelProjection(parallel)
        camera.SetParallelScale(100)
        camera.SetClippingRange(near, far)
        kept.append((window, renderer, actor))
        return renderer, actor, frame_of(renderer, actor, (0, 0, 400, 300))

    return make


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_model_view_projection_is_vtks(view, parallel, offset):
    renderer, actor, frame = view(offset=offset, parallel=parallel)
    point = np.array([3.0, -4.0, 5.0, 1.0])
    world = np.array(actor.GetMatrix().MultiplyPoint(point))
    renderer.SetWorldPoint(world)
    renderer.WorldToView()
    clip = frame.model_view_projection @ point
    x, y, z = renderer.GetViewPoint()  # whose depth runs from 0 to 1
    assert np.allclose(clip[:3] / clip[3], (x, y, 2 * z - 1), rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(("near", "far"), [(10.0, 1000.0), (0.1, 10_000.0), (1e-4, 1e-2)])
def test_positions_come_back_from_depth_in_float32(view, parallel, near, far):
    """The error of a position is what the depth buffer's step is worth there, not more."""
    _, _, frame = view(offset=1e6, near=near, far=far, parallel=parallel)
    distance = np.geomspace(near * 1.001, far * 0.999, 200)
    points = np.stack([0.2 * distance, -0.1 * distance, -distance, np.ones(200)])
    clip = frame.projection @ points
    ndc = clip[:3] / clip[3]
    keys = np.round((0.5 + 0.5 * ndc[2]) * 4294967295.0)
    complement = np.float32(4294967295.0 - keys) / np.float32(4294967295.0)
    matrix = frame.pixel_to_view.astype(np.float32)
    pixels = np.stack([*ndc[:2].astype(np.float32), complement, np.ones(200, np.float32)])
    back = matrix @ pixels
    back = back[:3] / back[3]
    relative = np.abs(back - points[:3]).max(axis=0) / distance
    if parallel:  # there depth is linear in distance: the error is a share of the range
        relative = np.abs(back - points[:3]).max(axis=0) / far
    step = distance * (far - near) / (far * near) / 4294967295.0
    assert (relative < 3e-6 + 2 * step).all()


@pytest.mark.parametrize("offset", [1e3, 1e6])
def test_planes_keep_the_same_points_in_data_coordinates(view, offset):
    _, actor, frame = view(offset=offset)
    random = np.random.default_rng(1)
    planes = np.c_[random.normal(size=(50, 3)), random.normal(size=50) * 100]
    planes[:, 3] -= planes[:, :3] @ (offset, -offset, offset)
    data = np.r_[random.normal(size=3) * 20, 1.0]
    world = np.array(actor.GetMatrix().MultiplyPoint(data))
    assert np.allclose(frame.planes_in_data(planes) @ data, planes @ world, atol=1e-8)


def test_renderers_are_found_through_assemblies():
    renderer, assembly, actor = vtkRenderer(), vtkAssembly(), vtkActor()
    assembly.AddPart(actor)
    renderer.AddActor(assembly)
    assert list(renderers_of(actor)) == [renderer]
    renderer.RemoveActor(assembly)
    assert list(renderers_of(actor)) == []


@pytest.mark.few(1)
@pytest.mark.parametrize("parallel", [False, True])
def test_the_rectangle_holds_every_point_and_little_else(parallel: bool) -> None:
    rng = np.random.default_rng(5)
    bounds = (-3.0, 5.0, 10.0, 11.0, -2.0, 2.0)
    points = np.array([[x, y, z] for x in bounds[:2] for y in bounds[2:4] for z in bounds[4:]])
    for k in range(30):
        plotter = pv.Plotter(off_screen=True, window_size=(400, 300))
        plotter.camera.position = (0 if k == 0 else 30.0) * rng.normal(size=3) / 1.7 + (0, 10.5, 0)  # among them first
        plotter.camera.focal_point = rng.uniform(-3, 3, 3) + (0, 10, 0)
        plotter.camera.up = rng.normal(size=3)
        plotter.camera.parallel_projection = parallel
        plotter.renderer.SetActiveCamera(plotter.camera)
        frame = frame_of(plotter.renderer, pv.Actor(), (0, 0, 400, 300))
        left, lower, right, upper = frame.rectangle(bounds, 0.0, 2.0)
        clip = np.c_[points, np.ones(8)] @ frame.model_view_projection.T
        plotter.close()
        assert k > 0 or clip[:, 3].min() <= 0 or parallel
        if clip[:, 3].min() <= 0:
            assert (left, lower, right, upper) == (-1, -1, 1, 1)
            continue
        place = np.clip(clip[:, :2] / clip[:, 3:], -1, 1)
        slack = 1.01 * 4.0 / np.array([400, 300])
        assert (place.min(0) >= (left, lower)).all()
        assert (place.max(0) <= (right, upper)).all()
        assert (place.min(0) - (left, lower) <= slack).all()
        assert ((right, upper) - place.max(0) <= slack).all()
