"""Connectomes as nodes and edges: what is drawn against NumPy's pairs and closed forms, picks, filters and removal."""

import numpy as np
import pytest
import pyvista as pv
from scipy.ndimage import center_of_mass

from pvfiblets import Streamlines, compress
from pvfiblets.plotting.connectomes.graph import ConnectomePick

PLACES = np.array([(0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (40.0, 40.0, 0.0), (0.0, 40.0, 0.0)])
WEIGHTS = np.array([[9, 0.3, np.nan, -2], [0.3, 0, 1, 0], [np.nan, 1, 0, 0.7], [-2, 0, 0.7, 0]])
PAIRS = [[0, 1], [0, 3], [1, 2], [2, 3]]
VALUES = np.array([0.3, -2.0, 1.0, 0.7])


@pytest.fixture
def atlas():
    """Four cubes, labels 2, 4, 6 and 7, on a flipped and sheared grid."""
    volume = np.zeros((24, 24, 12), np.uint8)
    for label, (i, j) in zip((2, 4, 6, 7), ((2, 3), (15, 3), (15, 16), (2, 15)), strict=True):
        volume[i : i + 5, j : j + 5, 3:8] = label
    return volume, np.array([[-2.0, 0.3, 0, 10], [0, 2.0, 0, -20], [0, 0.2, 2.5, 5], [0, 0, 0, 1]])


def pixel_of(plotter, point):
    plotter.renderer.SetWorldPoint(*point, 1.0)
    plotter.renderer.WorldToDisplay()
    return np.rint(plotter.renderer.GetDisplayPoint()[:2]).astype(int)


def seen_from_above(plotter):
    plotter.view_xy()
    plotter.show(auto_close=False)


def test_radius_and_colour_are_the_weight(plotter):
    graph = plotter.add_connectome(WEIGHTS, PLACES, radius=3.0, node_radius=[1, 2, 3, 4])
    assert graph.pairs.tolist() == PAIRS
    np.testing.assert_array_equal(graph.pair_weights, VALUES)
    tubes = graph.edge_actor.tubes
    np.testing.assert_allclose(tubes.points[tubes.segments], PLACES[np.array(PAIRS)])
    np.testing.assert_allclose(tubes.radius[tubes.segments], 3.0 * abs(VALUES[:, None]) / 2.0 * [1, 1], rtol=1e-6)
    np.testing.assert_array_equal(tubes.tube_values["weight"], VALUES)
    assert (graph.edge_actor.clim, graph.edge_actor.cmap) == ((-2.0, 2.0), "coolwarm")
    assert list(plotter.scalar_bars.keys()) == ["weight"]
    balls = graph.node_actor.tubes
    np.testing.assert_allclose(balls.points[balls.segments[:, 0]], PLACES)
    np.testing.assert_allclose(balls.radius[balls.segments[:, 0]], [1, 2, 3, 4])


def test_weights_of_one_sign_have_the_range_of_the_data_and_the_themes_map(plotter):
    graph = plotter.add_connectome(abs(WEIGHTS), PLACES)
    assert (graph.edge_actor.clim, graph.edge_actor.cmap) == ((0.3, 2.0), plotter.theme.cmap)
    graph = plotter.add_connectome(WEIGHTS, PLACES, cmap="plasma", clim=(-1, 3))
    assert (graph.edge_actor.clim, graph.edge_actor.cmap) == ((-1.0, 3.0), "plasma")
    assert graph.name == "connectome 2"


@pytest.mark.parametrize("edges", ["tubes", "lines"])
def test_the_colour_in_the_picture_is_that_of_the_map(plotter, edges):
    graph = plotter.add_connectome(WEIGHTS, PLACES, nodes=None, edges=edges, radius=4.0, show_scalar_bar=False)
    graph.edge_actor.prop.lighting = False
    seen_from_above(plotter)
    picture = plotter.screenshot(return_img=True)
    colours = pv.get_cmap_safe("coolwarm")((VALUES + 2.0) / 4.0)[:, :3]
    for (a, b), colour in zip(PAIRS, colours, strict=True):
        x, y = pixel_of(plotter, PLACES[[a, b]].mean(axis=0))
        np.testing.assert_allclose(picture[picture.shape[0] - 1 - y, x] / 255.0, colour, atol=0.03)


@pytest.mark.parametrize("edges", ["tubes", "lines"])
def test_the_threshold_filters(plotter, edges):
    graph = plotter.add_connectome(WEIGHTS, PLACES, edges=edges, threshold=0.7)
    for threshold in (0.7, 0.0, 0.3, 0.71, 1.0, 2.0, 2.1, 0.0):
        graph.threshold = threshold
        np.testing.assert_array_equal(graph.shown, abs(VALUES) >= threshold)
        np.testing.assert_array_equal(graph.edge_actor.shown, abs(VALUES) >= threshold)
    graph.threshold = 0.5
    graph.edge_actor.show_only((graph.pairs == 3).any(axis=1))
    assert graph.pairs[graph.shown].tolist() == [[0, 3], [2, 3]]
    for bad in (-1.0, np.nan, "5"):
        with pytest.raises(ValueError, match="threshold is"):
            graph.threshold = bad


@pytest.mark.parametrize("edges", ["tubes", "lines"])
def test_picks_are_nodes_and_edges(plotter, edges):
    graph = plotter.add_connectome(WEIGHTS, PLACES, edges=edges, names=list("NESW"), radius=1.5, node_radius=4.0)
    seen_from_above(plotter)
    for row, place in enumerate(PLACES):
        picked = graph.pick_at(*pixel_of(plotter, place))
        assert (picked.nodes, picked.names) == ((row,), ("NESW"[row],))
        assert np.isnan(picked.weight)
    for (a, b), weight in zip(PAIRS, VALUES, strict=True):
        found = graph.pick_at(*pixel_of(plotter, PLACES[[a, b]].mean(axis=0)))
        assert found == ConnectomePick((a, b), ("NESW"[a], "NESW"[b]), weight)
    assert graph.pick_at(*pixel_of(plotter, PLACES.mean(axis=0))) is None
    x, y = pixel_of(plotter, PLACES[[0, 1]].mean(axis=0))
    graph.threshold = 0.5
    plotter.render()
    assert graph.pick_at(x, y) is None
    graph.threshold = 0.0
    plotter.add_mesh(pv.Sphere(radius=3.0, center=(20.0, 0.0, 6.0)), reset_camera=False)
    plotter.render()
    assert graph.pick_at(x, y) is None


def test_meshes_are_the_labels_surfaces(plotter, atlas):
    volume, affine = atlas
    graph = plotter.add_connectome(WEIGHTS, atlas, nodes="meshes", names={4: ("four", "red"), 7: "seven"})
    centres = np.array(center_of_mass(volume > 0, volume, (2, 4, 6, 7))) @ affine[:3, :3].T + affine[:3, 3]
    np.testing.assert_allclose(graph.positions, centres)
    assert graph.names == ["2", "four", "6", "seven"]
    surface = graph.node_actor.mapper.dataset
    for row, centre in enumerate(centres):
        cells = surface.extract_cells(surface["node"] == row).extract_surface(algorithm=None).triangulate()
        np.testing.assert_allclose(cells.center, centre, atol=0.1)
        assert cells.n_open_edges == 0
        voxels = (cells.points - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T
        low, high = np.argwhere(volume == (2, 4, 6, 7)[row])[[0, -1]]
        outside = np.maximum(np.maximum(low - 0.5 - voxels, voxels - high - 0.5), 0.0)
        inside = np.minimum(voxels - low + 0.5, high + 0.5 - voxels).min(axis=1)
        assert outside.max() < 1e-4
        assert inside.max() < 0.6
    assert (surface["color"][surface["node"] == 1] == (255, 0, 0, 255)).all()
    seen_from_above(plotter)
    assert graph.pick_at(*pixel_of(plotter, centres[3])).names == ("seven",)
    graph.nodes = "spheres"
    plotter.render()
    assert graph.pick_at(*pixel_of(plotter, centres[1])).names == ("four",)


def bundle(start, stop, rng):
    """Return lines from a place to another on three sides of a bow, some of them reversed."""
    t = np.linspace(0.0, 1.0, 30)[:, None]
    bow = start + t * (stop - start) + np.sin(np.pi * t) * rng.normal(size=3) * 8.0
    return [(bow + shift * np.sin(np.pi * t))[:: rng.choice([-1, 1])] for shift in np.eye(3)], bow


def test_edges_run_along_the_mean_streamline(plotter, atlas):
    rng, (volume, affine) = np.random.default_rng(0), atlas
    centres = np.array(center_of_mass(volume > 0, volume, (2, 4, 6, 7))) @ affine[:3, :3].T + affine[:3, 3]
    made = [bundle(centres[a], centres[b], rng) for a, b in PAIRS[:3]]
    lines = Streamlines.from_list([line for three, _ in made for line in three])
    actor = plotter.add_fiblets(lines)
    with pytest.warns(UserWarning, match="1 of 4 edges have no streamlines"):
        graph = plotter.add_connectome(WEIGHTS, atlas, edges="streamlines", streamlines=actor)
    bows = [*(bow for _, bow in made), centres[[2, 3]]]
    for pair, bow, path in zip(PAIRS, bows, paths(graph), strict=True):
        np.testing.assert_allclose(path[[0, -1]], centres[pair], atol=1e-4)
        mean = bow + np.sin(np.pi * np.linspace(0.0, 1.0, len(bow)))[:, None] / 3.0
        gaps = np.linalg.norm(path[:, None] - mean, axis=2).min(axis=1)
        assert gaps.max() < 1.5  # between 30 places on a bow of about 40 mm
    matrix = compress(lines, exact=True).connectome(atlas)
    near = plotter.add_connectome(matrix, centres, edges="streamlines", streamlines=lines)
    away = plotter.add_connectome(matrix, centres + 2.0, edges="streamlines", streamlines=lines)
    assert away.pair_weights.tolist() == [3.0, 3.0, 3.0]
    for one, other in zip(paths(near), paths(away), strict=True):
        t = np.linspace(0.0, 1.0, len(one))[:, None]
        np.testing.assert_allclose(other - one, 2.0 * ((1 - t) ** 4 + t**4) * np.ones(3), atol=1e-4)
    away.edges = "lines"
    assert away.edge_actor.fiblets.decompress().counts.tolist() == [2, 2, 2]


def paths(graph):
    """Return the points of each tube in their order."""
    tubes = graph.edge_actor.tubes
    runs = [tubes.segments[tubes.tubes == edge] for edge in range(tubes.n_tubes)]
    return [tubes.points[np.append(run[:, 0], run[-1, 1])] for run in runs]


def test_kinds_change_in_their_own_view_and_keep_colours(atlas):
    plotter = pv.Plotter(off_screen=True, window_size=(300, 150), shape=(1, 2))
    graph = plotter.add_connectome(WEIGHTS, atlas, threshold=0.5, name="mine")
    graph.edge_actor.cmap, graph.edge_actor.clim = "plasma", (0.0, 1.0)
    plotter.subplot(0, 1)
    for nodes in ("meshes", None, "spheres"):
        for edges in ("lines", None, "tubes"):
            graph.nodes, graph.edges = nodes, edges
            plotter.render()
            first, second = (set(renderer.actors) for renderer in plotter.renderers)
            expected = {f"mine {what}" for what, kind in (("nodes", nodes), ("edges", edges)) if kind}
            assert {name for name in first if name.startswith("mine")} == expected
            assert not any(name.startswith("mine") for name in second)
            np.testing.assert_array_equal(graph.shown, abs(VALUES) >= 0.5)
            assert list(plotter.connectomes) == [graph]
    assert (graph.edge_actor.cmap, graph.edge_actor.clim) == ("plasma", (0.0, 1.0))
    assert plotter.renderers.active_index == 1
    plotter.close()


def test_removal_takes_all_away(plotter):
    before = set(plotter.actors)
    graph = plotter.add_connectome(WEIGHTS, PLACES, name="one")
    assert list(plotter.connectomes) == [graph]
    other = plotter.add_connectome(WEIGHTS, PLACES, name="one", threshold=1.0)  # replaces it
    assert list(plotter.connectomes) == [other]
    assert other.edge_actor.shown.tolist() == [False, True, True, False]
    other.remove()
    other.remove()
    assert other.pick_at(100, 100) is None
    with pytest.raises(RuntimeError, match="'one' was removed"):
        other.nodes = None
    assert set(plotter.actors) == before
    assert not plotter.scalar_bars.keys()
    assert len(plotter.connectomes) == len(plotter.spline_tubes) == 0
    plotter.add_connectome(WEIGHTS, PLACES)
    plotter.clear()
    assert len(plotter.connectomes) == 0


def test_nothing_is_left_of_a_refused_call(plotter, atlas):
    for given, kind, message in [
        ({"nodes": "balls"}, ValueError, "nodes is 'balls'; choose one of 'spheres', 'meshes', None"),
        ({"edges": "arcs"}, ValueError, "edges is 'arcs'"),
        ({"edges": "streamlines"}, ValueError, "give streamlines="),
        ({"nodes": "meshes"}, ValueError, "needs labels as an image"),
        ({"threshold": -1}, ValueError, "threshold is -1"),
        ({"radius": "x"}, ValueError, "radius is 'x'"),
        ({"node_radius": [1, 2]}, ValueError, "node_radius is"),
        ({"names": ["a"]}, ValueError, "1 names for 4 nodes"),
        ({"cmap": "nothing"}, ValueError, "cmap is 'nothing'"),
        ({"line_width": 3}, TypeError, "add_connectome\\(\\) takes no line_width: radius"),
        ({"show_edges": True}, TypeError, "add_connectome\\(\\) got an unexpected keyword argument 'show_edges'"),
    ]:
        with pytest.raises(kind, match=message):
            plotter.add_connectome(WEIGHTS, PLACES, **given)
    assert not plotter.actors
    graph = plotter.add_connectome(WEIGHTS, PLACES)
    for name, value in (("nodes", "meshes"), ("edges", "streamlines"), ("edges", "arcs")):
        with pytest.raises(ValueError, match="needs|choose"):
            setattr(graph, name, value)
    assert (graph.nodes, graph.edges) == ("spheres", "tubes")


def test_graphs_without_edges_and_labels_without_voxels(plotter, atlas):
    graph = plotter.add_connectome(np.zeros((4, 4)), atlas)
    assert graph.edge_actor is None
    graph.threshold = 3.0
    graph.remove()
    seven = np.zeros((7, 7))
    seven[1, 3] = seven[0, 1] = 1.0
    with pytest.warns(UserWarning, match="1 edges are left out: nodes 1, 3, 5 have no voxels"):
        graph = plotter.add_connectome(seven, atlas)
    assert graph.pairs.tolist() == [[1, 3]]
    seen_from_above(plotter)
    assert graph.pick_at(*pixel_of(plotter, graph.positions[5])).nodes == (5,)


def test_the_matrix_places_it(plotter):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 5.0, -3.0, 1.0
    graph = plotter.add_connectome(WEIGHTS, PLACES, user_matrix=matrix, pickable=False)
    low, high = np.reshape(graph.edge_actor.bounds, (3, 2)).T
    placed = PLACES @ matrix[:3, :3] + matrix[:3, 3]
    assert (low <= placed.min(axis=0)).all()
    assert (high >= placed.max(axis=0)).all()
    assert not graph.node_actor.GetPickable()
