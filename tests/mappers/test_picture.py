"""The picture of a scene against VTK's own polylines of the same points."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonMath import vtkMatrix4x4


def matrix(rows) -> vtkMatrix4x4:
    result = vtkMatrix4x4()
    result.DeepCopy(np.asarray(rows, dtype=float).ravel().tolist())
    return result


def yellow(image):
    return (image[..., 0] > 100) & (image[..., 1] > 100) & (image[..., 2] < 100)


@pytest.mark.parametrize("inside", [False, True])
def test_the_picture_is_that_of_polylines(compare, tools, lines, inside):
    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        if hasattr(mapper, "fiblets"):
            assert np.allclose(plotter.bounds, lines.fiblets.bounds)
            assert np.allclose(actor.GetBounds(), lines.fiblets.bounds)
        if inside:
            plotter.camera_position = [(0, 0, 0), (1, 0.3, 0.2), (0, 0, 1)]
            plotter.renderer.ResetCameraClippingRange()

    ours, theirs = compare(scene)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.99
    assert np.array_equal(np.unique(ours[tools.covered(ours)], axis=0), [[255, 255, 0]])


@pytest.mark.parametrize("parallel", [False, True])
def test_meshes_hide_fiblets_and_are_hidden(compare, tools, parallel):
    def scene(plotter, actor, mapper):
        plotter.add_mesh(pv.Sphere(radius=18), color="blue", lighting=False, reset_camera=False)
        plotter.add_mesh(pv.Box((-60, -40, -15, 60, 25, 26)), color="red", lighting=False, reset_camera=False)
        if parallel:
            plotter.enable_parallel_projection()
        plotter.reset_camera()

    ours, theirs = compare(scene)
    assert tools.agreement(yellow(ours), yellow(theirs)) >= 0.99
    hidden = yellow(theirs).sum() / max(1, tools.covered(theirs).sum())
    assert 0.05 < hidden < 0.95, "the scene must show both"
    # Away from the lines both pictures show the same meshes.
    clear = ~tools.grown(yellow(ours) | yellow(theirs))
    assert np.array_equal(ours[clear], theirs[clear])


PLACEMENTS = {
    "position": lambda actor: actor.SetPosition(20, -10, 5),
    "scale": lambda actor: actor.SetScale(1.5, 0.4, 0.8),
    "orientation": lambda actor: actor.SetOrientation(30, 50, -70),
    "origin": lambda actor: (actor.SetOrigin(30, 0, 0), actor.SetOrientation(0, 0, 90)),
    "mirrored": lambda actor: actor.SetScale(-1, 1, 1),
    "user matrix": lambda actor: actor.SetUserMatrix(
        matrix([[0.3, -0.9, 0.1, 12], [0.8, 0.5, 0.4, -7], [0, 0.2, 1.1, 3], [0, 0, 0, 1]])
    ),
}


@pytest.mark.few(4)
@pytest.mark.parametrize("placement", PLACEMENTS)
def test_an_actor_is_placed_as_vtk_places_it(compare, tools, placement):
    def scene(plotter, actor, mapper):
        PLACEMENTS[placement](actor)
        plotter.reset_camera()
        plotter.add_mesh(pv.Sphere(radius=15), color="blue", lighting=False, reset_camera=False)

    ours, theirs = compare(scene)
    assert tools.agreement(yellow(ours), yellow(theirs)) >= 0.99


@pytest.mark.parametrize(("offset", "scale"), [(0.0, 1.0), (0.0, 1e-4), (1e6, 1.0)])
def test_far_and_tiny_data(make_plotter, make_fibres, tools, offset, scale):
    base = tools.helices()
    streamlines = type(base)(base.points.astype(np.float64) * scale + offset, base.offsets)
    fibres = make_fibres(streamlines)
    mapper, actor = fibres.actor()
    ours = make_plotter()
    ours.add_actor(actor)
    theirs = make_plotter()
    theirs.add_mesh(tools.polylines(base), color="white", lighting=False)
    for plotter in (ours, theirs):
        plotter.camera_position = "xz"
        plotter.reset_camera()
    assert tools.agreement(tools.covered(tools.picture(ours, mapper)), tools.covered(tools.picture(theirs))) >= 0.99


def test_depth_is_that_of_polylines(compare, lines, tools):
    seen = []

    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        plotter.show(auto_close=False)
        seen.append((plotter.get_image_depth(fill_value=np.nan), plotter.camera.distance))

    compare(scene)
    (ours, distance), (theirs, _) = seen
    both = ~np.isnan(ours) & ~np.isnan(theirs)
    assert both.sum() > 500
    # The engine takes another point of the line's pixel; beyond that only where two lines cross pixels may differ.
    pixel = 2 * distance * np.tan(np.radians(15)) / ours.shape[0]
    assert (np.abs(ours - theirs)[both] < pixel).mean() > 0.9


def test_a_wider_line_covers_more(make_plotter, tools):
    mapper, actor = tools.fibres(tools.helices()).actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    thin = tools.covered(tools.picture(plotter, mapper)).sum()
    mapper.line_width = 4.0
    wide = tools.covered(tools.picture(plotter, mapper)).sum()
    assert 2.0 < wide / thin < 4.5
    with pytest.raises(ValueError, match="line_width"):
        mapper.line_width = 0.0
    before = tools.picture(plotter, mapper)
    for change in ("SetRepresentationToWireframe", "SetRepresentationToPoints", "EdgeVisibilityOn"):
        getattr(actor.GetProperty(), change)()
        assert np.array_equal(tools.picture(plotter, mapper), before)  # nothing changes


def test_coincident_topology(compare, tools):
    """Polygon offset changes VTK's shader text; fiblets have no slope, only the offset."""
    from vtkmodules.vtkRenderingCore import vtkMapper

    def scene(plotter, actor, mapper):
        plotter.add_mesh(pv.Sphere(radius=18), color="blue", lighting=False, reset_camera=False)
        plotter.reset_camera()

    before = vtkMapper.GetResolveCoincidentTopology()
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    try:
        ours, theirs = compare(scene)
    finally:
        vtkMapper.SetResolveCoincidentTopology(before)
    assert tools.agreement(yellow(ours), yellow(theirs)) >= 0.99


def test_an_actor_inside_an_assembly(make_plotter, lines, tools):
    from vtkmodules.vtkRenderingCore import vtkAssembly

    images = []
    for ours in (True, False):
        plotter = make_plotter()
        if ours:
            mapper, actor = lines.actor()
        else:
            actor = pv.Actor(mapper=pv.DataSetMapper(lines.polydata()))
            actor.prop.lighting = False
        assembly = vtkAssembly()
        assembly.AddPart(actor)
        assembly.SetOrientation(0, 0, 40)
        assembly.SetScale(1, 0.5, 1)
        plotter.add_actor(assembly)
        plotter.camera_position = "xz"
        plotter.reset_camera()
        images.append(tools.covered(tools.picture(plotter)))
    tools.check(mapper)
    assert tools.agreement(*images) >= 0.99
