"""The matrix of the page: made beside, undone, kept, scripted, and cells that filter."""

import base64
import io

import numpy as np
import pytest

from pvfiblets.query.connectome import matrix as kernels
from pvfiblets.web.panels.matrix_panel import matrix_image
from pvfiblets.web.scene import matrix as scene_matrix
from pvfiblets.web.scene.matrix import colour_range
from pvfiblets.web.session import files as session
from pvfiblets.web.session.script import as_script
from tests.web.desk import Desk, assert_script_draws


@pytest.fixture
def desk(scene, folder):
    made = Desk(scene, folder)
    made.choose(scene.open("lines.fiblets"))
    (folder / "atlas.tsv").write_text("index\tname\n3\tback\n5\t=front\n")
    made.matrix.open(True)
    made.refresh = made.matrix.refresh
    return made


def make(desk, **chosen):
    for name, value in {"labels": "atlas.nii.gz", "radius": "0", **chosen}.items():
        desk.matrix.set(name, value)
    desk.run(desk.matrix.make)
    return desk.page.matrix


def shown(desk):
    return np.flatnonzero(desk.scene.actor(desk.page.chosen).shown).tolist()


def parcels():
    """The parcels of the last points of the sixty lines, which begin in 3: voxels of 4 mm, the first at 0.3 mm."""
    voxel = np.rint((np.arange(10, 70) - 0.3) / 4.0)
    return np.where(voxel < 4, 3, np.where(voxel < 8, 5, 0))


def test_a_matrix_is_computed_and_reported(desk):
    told = make(desk)
    back, front = int((parcels() == 3).sum()), int((parcels() == 5).sum())
    assert told["n"] == 2
    assert told["said"].endswith(f"streamline count; {back + front} of 60 streamlines connect two labels (radius 0 mm)")
    assert desk.matrix.at(0, 0) == f"back (3) – back (3): {back} streamlines"
    assert desk.matrix.at(0, 1) == desk.matrix.at(1, 0).replace("=front (5) – back (3)", "back (3) – =front (5)")
    assert desk.matrix.at(0, 1).endswith(f": {front} streamlines")
    assert desk.matrix.at(1, 1).endswith(": 0 streamlines")
    rows = desk.matrix.fetch(".csv").splitlines()
    assert rows == [",back,'=front", f"back,{back},{front}", f"'=front,{front},0"]
    np.testing.assert_array_equal(np.load(io.BytesIO(desk.matrix.fetch(".npy"))), [[back, front], [front, 0]])
    make(desk, contrast="length", statistic="max")
    longest = np.arange(10, 70)[parcels() == 5].max()
    assert desk.matrix.at(0, 1).endswith(f": {longest} ({front} streamlines)")
    make(desk, contrast="count", weights="weight", statistic="")
    assert desk.matrix.at(0, 1).endswith(f": {np.arange(60)[parcels() == 5].sum()} ({front} streamlines)")


def test_a_cell_shows_its_streamlines_and_again_all(desk):
    make(desk)
    wanted = np.flatnonzero(parcels() == 5).tolist()
    desk.matrix.connect(1, 0)
    assert shown(desk) == wanted
    desk.matrix.refresh()
    assert desk.page.matrix["cell"] == "back – =front"
    assert desk.page.matrix["pair"] == [0, 1]
    desk.scene.filters.set_filter(desk.page.chosen, "weight", 8, 50)
    assert shown(desk) == [line for line in wanted if line >= 8]
    assert desk.history.undo() == "range of weight of lines.fiblets"
    assert desk.history.undo() == "connection of lines.fiblets"
    assert shown(desk) == list(range(60))
    desk.history.redo()
    assert shown(desk) == wanted
    desk.matrix.connect(0, 1)
    assert shown(desk) == list(range(60))
    desk.matrix.connect(1, 1)
    assert "No streamline connects" in desk.said[-1][1]
    assert shown(desk) == list(range(60))


def test_undo_and_removal_take_the_matrix_away(desk):
    make(desk)
    assert desk.history.undo() == "the matrix"
    desk.matrix.refresh()
    assert desk.page.matrix["n"] == 0
    assert desk.page.matrix_image == ""
    desk.history.redo()
    desk.matrix.refresh()  # known still: nothing is done beside
    assert not desk.tasks
    assert desk.page.matrix["n"] == 2
    desk.scene.remove(desk.page.chosen)
    assert desk.scene.state.matrix is None


def test_sessions_and_scripts_have_it(desk, folder):
    make(desk, radius="4,5", names="atlas.tsv")
    desk.matrix.connect(0, 1)
    wanted = shown(desk)
    state = session.to_dict(desk.scene, folder)
    assert state["matrix"]["labels"] == "atlas.nii.gz"
    assert state["matrix"]["radius"] == 4.5
    text = as_script(desk.scene, str(folder / "found.png"))
    text = text.replace('FOLDER = Path(".")', f"FOLDER = Path({str(folder)!r})")
    made = {}
    exec(compile(text.replace("plotter.close()", ""), "script", "exec"), made)
    assert np.flatnonzero(made["lines"].shown).tolist() == wanted
    assert made["matrix"].names == ["back", "=front"]
    assert made["matrix"].counts[0, 1] == len(wanted)
    made["plotter"].close()
    desk.scene.remove(desk.page.chosen)
    desk.scene.forget_unused()
    session.from_dict(desk.scene, state, folder)
    desk.choose(desk.scene.layers[0])
    assert shown(desk) == wanted
    desk.run(desk.matrix.refresh)  # put together again, beside
    assert desk.page.matrix["n"] == 2
    for wrong, said in (
        ({"labels": "none.nii.gz"}, "no such file"), ({"labels": "../x.nii"}, "outside"),
        ({"contrast": "price"}, "'price' is none of"), ({"radius": -1}, "radius"), ({"layer": "layer99"}, "no layer"),
        ({"statistic": "median"}, "median"), ({"colour": 1}, "colour"),
    ):  # fmt: skip
        with pytest.raises(session.SessionError, match=said):
            session.from_dict(desk.scene, {**state, "matrix": {**state["matrix"], **wrong}}, folder)
    layer = state["layers"][0]
    for wrong, said in (({"pair": [1]}, "two labels"), ({"pair": [1, 0.5]}, "whole"), ({"labels": "x.nii"}, "no such")):
        filters = {**layer["filters"], "connection": {**layer["filters"]["connection"], **wrong}}
        with pytest.raises(session.SessionError, match=said):
            session.from_dict(desk.scene, {**state, "layers": [{**layer, "filters": filters}]}, folder)
    assert shown(desk) == wanted


def edges(desk):
    """The connectome in the 3-D view."""
    (graph,) = desk.plotter.connectomes
    return graph


def centre(desk, label):
    import nibabel

    volume = nibabel.load(desk.scene.root / "atlas.nii.gz")
    voxel = np.argwhere(np.asarray(volume.dataobj) == label).mean(axis=0)
    return nibabel.affines.apply_affine(volume.affine, voxel)


def test_the_matrix_is_nodes_and_edges_too(desk):
    make(desk)
    desk.matrix.show_graph(True)
    graph, front = edges(desk), int((parcels() == 5).sum())
    assert (graph.names, graph.pairs.tolist(), graph.pair_weights.tolist()) == (["back", "=front"], [[0, 1]], [front])
    np.testing.assert_allclose(graph.positions, [centre(desk, 3), centre(desk, 5)])
    back = int((parcels() == 3).sum())  # colours are those of the cells, the diagonal's included
    actor = graph.edge_actor
    assert (actor.cmap, actor.clim, actor.log_scale) == ("viridis", tuple(sorted((back, front))), True)
    desk.matrix.set_scale(False)
    assert (actor.clim, actor.log_scale) == ((0.0, max(back, front)), False)
    desk.matrix.connect(0, 1)
    assert edges(desk) is graph  # not made anew
    assert actor.selection.tolist() == [0]
    desk.matrix.connect(0, 1)
    assert actor.selection.tolist() == []
    desk.matrix.set_threshold(str(front + 1))
    assert graph.shown.tolist() == [False]
    desk.matrix.set_threshold(str(front))
    assert graph.shown.tolist() == [True]
    assert [desk.history.undo() for _ in range(2)] == ["threshold of the matrix"] * 2
    assert graph.threshold == 0.0
    make(desk, contrast="length", statistic="max")
    np.testing.assert_allclose(edges(desk).pair_weights, np.arange(10, 70)[parcels() == 5].max(), atol=0.01)
    assert edges(desk).edge_actor.log_scale is False
    desk.matrix.show_graph(False)
    assert not list(desk.plotter.connectomes)
    desk.history.undo()
    desk.scene.remove(desk.page.chosen)
    assert not list(desk.plotter.connectomes)


def test_cells_below_the_threshold_are_grey(desk):
    make(desk)
    whole = desk.page.matrix_image
    desk.matrix.set_threshold("1e6")
    desk.matrix.refresh()
    assert desk.page.matrix_image == matrix_image(np.full((2, 2), np.nan), True, (1.0, 2.0)) != whole
    for wrong, said in (("-1", "threshold"), ("many", "threshold")):
        with pytest.raises(ValueError, match=said):
            desk.matrix.set_threshold(wrong)


def test_a_picked_edge_is_its_cell(desk):
    make(desk)
    desk.matrix.show_graph(True)
    desk.scene.cameras.view("axial")

    def pixel(place):
        renderer = desk.plotter.renderer
        renderer.SetWorldPoint(*place, 1.0)
        renderer.WorldToDisplay()
        return renderer.GetDisplayPoint()[:2]

    desk.scene.cameras.screenshot()
    between = (centre(desk, 3) + centre(desk, 5)) / 2
    assert desk.matrix.pick(*pixel(between))
    assert shown(desk) == np.flatnonzero(parcels() == 5).tolist()
    assert edges(desk).edge_actor.selection.tolist() == [0]
    assert desk.matrix.pick(*pixel(centre(desk, 3)))
    assert desk.said[-1][1] == "back (3)"
    assert not desk.matrix.pick(1, 1)
    desk.matrix.show_graph(False)
    assert not desk.matrix.pick(*pixel(between))


def test_sessions_and_scripts_have_nodes_and_edges(desk, folder):
    make(desk)
    desk.matrix.show_graph(True)
    desk.matrix.set_threshold("2,5")
    desk.matrix.connect(0, 1)
    state = session.to_dict(desk.scene, folder)
    assert_script_draws(desk.scene, folder, desk.scene.cameras.screenshot())
    session.from_dict(desk.scene, {**state, "matrix": {**state["matrix"], "graph": False}}, folder)
    assert not list(desk.plotter.connectomes)
    session.from_dict(desk.scene, state, folder)  # the matrix is known still
    assert edges(desk).threshold == 2.5
    desk.scene.remove(desk.page.chosen)
    desk.history.clear()
    session.from_dict(desk.scene, state, folder)
    desk.choose(desk.scene.layers[0])
    assert not list(desk.plotter.connectomes)
    desk.run(desk.matrix.refresh)  # put together again, beside
    assert edges(desk).threshold == 2.5
    assert edges(desk).edge_actor.selection.tolist() == [0]
    for wrong, said in (({"graph": 1}, "graph"), ({"threshold": -1}, "threshold"), ({"log": "yes"}, "log")):
        with pytest.raises(session.SessionError, match=said):
            session.from_dict(desk.scene, {**state, "matrix": {**state["matrix"], **wrong}}, folder)


def test_work_is_stopped_and_not_begun_again(desk, monkeypatch):
    monkeypatch.setattr(kernels, "TOGETHER", 10)
    whole = kernels.end_points

    def slow(data):
        desk.files.cancel()
        return whole(data)

    monkeypatch.setattr(kernels, "end_points", slow)
    make(desk)
    assert desk.scene.state.matrix is None
    assert "cancelled" in desk.said[-1][1]
    desk.matrix.refresh()
    assert not desk.tasks


def test_what_makes_no_sense_is_refused(desk, monkeypatch):
    with pytest.raises(ValueError, match="choose a volume of labels"):
        desk.matrix.make()
    with pytest.raises(ValueError, match="there is no matrix"):
        desk.matrix.connect(0, 0)
    with pytest.raises(ValueError, match="there is no matrix"):
        desk.matrix.fetch(".csv")
    with pytest.raises(ValueError, match="fractions"):
        make(desk, labels="head.nii.gz")
    assert desk.scene.state.matrix is None
    monkeypatch.setattr(scene_matrix, "PARCELS", 2)
    with pytest.raises(ValueError, match="3 different numbers"):
        make(desk, labels="atlas.nii.gz")
    monkeypatch.undo()
    make(desk)
    for place in (2, -1, 0.5, True, "0"):
        with pytest.raises(ValueError, match="no row or column"):
            desk.matrix.connect(0, place)
    with pytest.raises(ValueError, match="none of"):
        desk.matrix.fetch(".exe")


def test_the_image_has_a_pixel_a_cell():
    from PIL import Image

    matrix = np.array([[1.0, 10.0, np.nan], [10.0, 100.0, 0.0], [np.nan, 0.0, -5.0]])

    def pixels(matrix, log):
        data = matrix_image(matrix, log, colour_range(matrix, log)).removeprefix("data:image/png;base64,")
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(data)))).astype(int)

    found = pixels(matrix, True)
    assert found.shape == (3, 3, 3)
    grey = (found == found[0, 2]).all(axis=2)
    assert grey.tolist() == [[False, False, True], [False, False, True], [True, True, True]]
    light = found.sum(axis=2)
    assert light[0, 0] < light[0, 1] < light[1, 1]
    assert abs(light[0, 1] - light[1, 0]) == 0
    linear = pixels(matrix, False)
    assert (linear[2, 2] != linear[0, 2]).any()  # negative numbers are numbers
    assert len(np.unique(pixels(np.zeros((2, 2)), True).reshape(-1, 3), axis=0)) == 1
