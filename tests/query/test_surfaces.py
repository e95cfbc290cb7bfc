"""Closed surfaces: against VTK's enclosure and distance filters, closed forms, and lattices that meet every tie."""

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
from vtkmodules.vtkFiltersModeling import vtkSelectEnclosedPoints

from pvfiblets import regions
from pvfiblets.query.regions import surfaces

from .test_shapes import SHEAR, place, placement, rotation

RNG = np.random.default_rng(11)


def mesh_of(polydata):
    polydata = polydata.triangulate().clean()
    return np.asarray(polydata.points, np.float64), np.asarray(polydata.regular_faces)


def torus():
    made = pv.ParametricTorus(ringradius=2.0, crosssectionradius=0.7, u_res=50, v_res=30)
    return made.triangulate().clean().compute_normals(consistent_normals=True, auto_orient_normals=True)


def bumpy():
    ball = pv.Sphere(radius=1.0, theta_resolution=60, phi_resolution=60)
    x, y, z = ball.points.T
    waves = 1.8 + 0.5 * np.sin(5 * x) * np.cos(6 * y) + 0.3 * np.sin(9 * z)
    ball.points = ball.points * waves[:, None]
    return ball.compute_normals(consistent_normals=True, auto_orient_normals=True)


CONCAVE = {"torus": torus, "bumpy": bumpy}


@pytest.fixture(params=list(CONCAVE))
def concave(request):
    polydata = CONCAVE[request.param]()
    return polydata, regions.Surface(*mesh_of(polydata))


def vtk_signed(polydata, points):
    function = vtkImplicitPolyDataDistance()
    function.SetInput(polydata)
    return -np.array([function.EvaluateFunction(point) for point in points])


def test_inside_is_where_vtk_says(concave):
    polydata, surface = concave
    points = RNG.uniform(-3.2, 3.2, (20_000, 3))
    cloud = pv.PolyData(points)
    enclosing = vtkSelectEnclosedPoints()
    enclosing.SetInputData(cloud)
    enclosing.SetSurfaceData(polydata)
    enclosing.Update()
    enclosed = np.asarray(pv.wrap(enclosing.GetOutput())["SelectedPoints"]).astype(bool)
    held = surface.contains(points)
    differ = held != enclosed
    # Its rays graze an edge now and then; there VTK's distance function has the last word.
    assert differ.mean() < 1e-3
    assert (held[differ] == (vtk_signed(polydata, points[differ]) > 0)).all()
    assert 0.02 < held.mean() < 0.98


def test_distances_are_vtks(concave):
    polydata, surface = concave
    points = RNG.uniform(-3.2, 3.2, (3000, 3))
    expected = vtk_signed(polydata, points)
    assert surface.distance(points) == pytest.approx(np.abs(expected), abs=1e-9)
    assert surface.signed_distance(points) == pytest.approx(expected, abs=1e-9)
    either = surface | regions.Plane((0, 0, 1), (0, 0, 100.0))
    assert either.distance(points) == pytest.approx(np.maximum(-expected, 0.0), abs=1e-9)
    assert surface.distance(points[::-1]) == pytest.approx(np.abs(expected)[::-1], abs=1e-9), "order must not matter"


def test_a_lattice_through_all_corners_and_edges_of_a_box():
    """Each tie there is: rays through corners, along edges and diagonals, positions on faces."""
    points, triangles = mesh_of(pv.Cube(x_length=4, y_length=4, z_length=4).triangulate().subdivide(2))
    surface = regions.Surface(points, triangles)
    axis = np.linspace(-3, 3, 25)
    lattice = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    held = surface.contains(lattice)
    largest = np.abs(lattice).max(axis=1)
    assert held[largest < 2].all()
    assert not held[largest > 2].any()
    # Half-open on the surface itself: two boxes side by side share no position and leave none out.
    shifted = regions.Surface(points + (4.0, 0.0, 0.0), triangles)
    both = regions.Surface(np.concatenate([points, points + (4.0, 0, 0)]),
                           np.concatenate([triangles, triangles + len(points)]))  # fmt: skip
    assert not (held & shifted.contains(lattice)).any()
    assert (both.contains(lattice) == (held | shifted.contains(lattice))).all()
    assert held.sum() == 16**3, "each position of the half-open cube once"


def test_the_order_of_triangles_and_of_corners_does_not_matter():
    points, triangles = mesh_of(bumpy())
    places = np.concatenate([RNG.uniform(-2.5, 2.5, (5000, 3)), points[:500], points[triangles[:500]].mean(axis=1)])
    held = regions.Surface(points, triangles).contains(places)
    order = RNG.permutation(len(triangles))
    turned = np.stack([np.roll(row, k % 3) for k, row in enumerate(triangles[order])])
    assert (regions.Surface(points, turned).contains(places) == held).all()
    soup = points[triangles].reshape(-1, 3)
    assert (regions.Surface(soup, np.arange(len(soup)).reshape(-1, 3)).contains(places) == held).all()


def test_nested_and_separate_shells():
    points, triangles = mesh_of(pv.Sphere(radius=1.0))
    inner, far = points * 0.5, points + (5.0, 0.0, 0.0)
    n = len(points)
    places = np.array([[0, 0, 0], [0.75, 0, 0], [5, 0, 0], [3, 0, 0]], float)
    hollow = regions.Surface(np.concatenate([points, inner]), np.concatenate([triangles, triangles[:, ::-1] + n]))
    assert hollow.contains(places).tolist() == [False, True, False, False]
    filled = regions.Surface(np.concatenate([points, inner]), np.concatenate([triangles, triangles + n]))
    assert filled.contains(places).tolist() == [True, True, False, False]
    apart = regions.Surface(np.concatenate([points, far]), np.concatenate([triangles, triangles + n]))
    assert apart.contains(places).tolist() == [True, True, True, False]
    assert hollow.distance(places[:1]) == pytest.approx(0.5, abs=0.01)


def test_an_inside_out_surface_is_turned_round_with_a_warning():
    points, triangles = mesh_of(pv.Sphere())
    with pytest.warns(UserWarning, match="inside out"):
        surface = regions.Surface(points, triangles[:, ::-1])
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    assert surface.contains((0, 0, 0)).all()


def test_what_is_no_closed_surface_is_named():
    points, triangles = mesh_of(pv.Sphere(theta_resolution=12, phi_resolution=12))
    with pytest.raises(ValueError, match="no triangles encloses nothing"):
        regions.Surface(points, np.zeros((0, 3), int))
    with pytest.raises(ValueError, match=r"open: 3 edges have one triangle.*fill_holes"):
        regions.Surface(points, triangles[1:])
    with pytest.raises(ValueError, match=r"not turned the same way: 3 edges.*consistent_normals=True"):
        regions.Surface(points, np.concatenate([triangles[:1, ::-1], triangles[1:]]))
    bad = points.copy()
    bad[5] = np.nan
    with pytest.raises(ValueError, match="point 5 of the surface is"):
        regions.Surface(bad, triangles)
    with pytest.raises(ValueError, match=f"name the points 0 to {len(points)}; there are {len(points)}"):
        regions.Surface(points, np.where(triangles == 3, len(points), triangles))
    with pytest.raises(ValueError, match=r"give \(m, 3\) integers"):
        regions.Surface(points, np.zeros((4, 4), int))
    with pytest.raises(ValueError, match=r"give \(m, 3\) integers"):
        regions.Surface(points, triangles.astype(float))
    with pytest.raises(ValueError, match="two corners at one place"):
        regions.Surface(points, np.zeros((4, 3), int))


def test_degenerate_triangles_and_unused_points_do_no_harm():
    points, triangles = mesh_of(pv.Sphere(radius=2.0))
    a, b = triangles[0, :2]
    # A corner in the middle of an edge: its flat triangle closes the gap between the two that share the edge.
    middle = len(points)
    more = np.concatenate([points, [(points[a] + points[b]) / 2], [[np.nan] * 3]])
    c = triangles[0, 2]
    split = np.concatenate([triangles[1:], [[a, middle, c], [middle, b, c], [a, b, middle], [a, a, b]]])
    surface, plain = regions.Surface(more, split), regions.Surface(points, triangles)
    places = np.concatenate([RNG.uniform(-2.5, 2.5, (5000, 3)), (points[a] + points[b]) / 2 * [[0.99], [1.01]]])
    assert (surface.contains(places) == plain.contains(places)).all()
    assert surface.distance(places) == pytest.approx(plain.distance(places), abs=1e-12)


@pytest.mark.parametrize("matrix", [SHEAR, placement(rotation() * 1.5, (3, -4, 5)), np.diag([1.0, -1.0, 1.0, 1.0])])
def test_a_moved_surface_is_the_surface_of_moved_points(matrix):
    points, triangles = mesh_of(torus())
    moved = regions.Surface(points, triangles).moved(matrix)
    if np.linalg.det(matrix) < 0:
        triangles = triangles[:, ::-1]
    made = regions.Surface(place(matrix, points), triangles)
    places = place(matrix, RNG.uniform(-3.2, 3.2, (5000, 3)))
    assert (moved.contains(places) == made.contains(places)).all()
    assert moved.distance(places) == pytest.approx(made.distance(places), abs=1e-12)
    assert moved.bounds == pytest.approx(made.bounds)
    assert moved.field is regions.Surface.moved(moved, matrix).field
    assert moved == regions.Surface.moved(moved, np.eye(4))
    assert moved != made


@pytest.mark.few(1)
@pytest.mark.parametrize(("offset", "size"), [(1e6, 1.0), (0.0, 1e-6), (1e6, 1e-3), (0.0, 1e6)])
def test_extreme_places_and_sizes(offset, size):
    ball = pv.Icosphere(radius=1.0, nsub=3)
    points, triangles = mesh_of(ball)
    surface = regions.Surface(points * size + offset, triangles)
    towards = RNG.normal(size=(2000, 3))
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    radius = RNG.uniform(0, 2, 2000)
    places = towards * (radius * size)[:, None] + offset
    clear = np.abs(radius - 1.0) > 0.02
    assert (surface.contains(places) == (radius < 1.0))[clear].all()
    assert surface.distance(places) == pytest.approx(np.abs(radius - 1) * size, abs=0.012 * size)
    sides = regions.classify(surface, places, 0.0)
    assert (surface.contains(places) == (sides > 0))[sides != 0].all()
    assert (sides != 0).mean() > 0.8
    assert (sides[radius > 1.2] == -1).all()


def test_balls_near_a_surface(concave):
    _, surface = concave
    centres, radii = RNG.uniform(-3.5, 3.5, (20_000, 3)), RNG.exponential(0.2, 20_000)
    sides, signed = regions.classify(surface, centres, radii), surface.signed_distance(centres)
    assert (signed[sides > 0] > radii[sides > 0]).all()
    assert (signed[sides < 0] < -radii[sides < 0]).all()
    step = surface.field.spacing[0]
    low, high = surface.bounds[::2] - 2 * step, surface.bounds[1::2] + 2 * step
    near = ((centres >= low) & (centres <= high)).all(axis=1)
    settled = np.abs(signed) > radii + np.sqrt(3) * step
    assert (sides != 0)[settled & near].all(), "a ball clear of the surface by a cell's diagonal is settled"
    assert (sides != 0)[settled].mean() > 0.98


@pytest.mark.few(1)
@pytest.mark.parametrize("loss", [0.0, 0.03])
def test_the_field_is_a_lower_bound_at_every_grid_point(concave, loss, monkeypatch):
    monkeypatch.setattr(surfaces, "FEW", 0 if loss else 10**9)
    _, surface = concave
    field = surface.field
    nz, ny, nx = field.values.shape
    assert field.values.dtype == np.float32
    assert max(nx, ny, nz) == 64 + 4 + 1
    i, j, k = np.meshgrid(range(nx), range(ny), range(nz), indexing="ij")
    nodes = field.origin + field.spacing * np.stack([i, j, k], axis=-1).reshape(-1, 3)
    values = field.values.transpose(2, 1, 0).ravel()
    signed = surface.signed_distance(nodes)
    assert (np.sign(values) == np.sign(signed)).all()
    assert (np.abs(values) <= np.abs(signed)).all()
    assert (np.abs(values) >= np.abs(signed) * (1.0 - loss) - 1e-6).all()
    # Two cells of margin all around.
    low, high = surface.bounds[::2], surface.bounds[1::2]
    assert (field.origin <= low - 2 * field.spacing + 1e-9).all()
    assert (nodes[-1] >= high + 2 * field.spacing - 1e-9).all()
