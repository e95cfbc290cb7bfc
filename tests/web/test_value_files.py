"""Track scalar files on the page: read beside it, kept by sessions and scripts, undone like all else."""

from __future__ import annotations

import asyncio
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.errors import FormatError
from pvfiblets.formats import attachments
from pvfiblets.streamlines import Streamlines
from pvfiblets.web import session
from pvfiblets.web.script import as_script
from tests.web.desk import Desk


@pytest.fixture
def heights(folder, lines):
    """A file with the height of each point."""
    made = Streamlines(lines.points, lines.offsets, {"y": lines.points[:, 1]})
    attachments.write_scalars(folder / "heights.tsf", made, "y")
    return lines.points[:, 1]


@pytest.fixture
def desk(scene, folder):
    return Desk(scene, folder)


def values_of(scene, layer):
    return scene.actor(layer.id).fiblets.decompress().per_point["heights"].ravel()


@pytest.mark.parametrize("name", ["lines.trk", "lines.fiblets"])
def test_a_file_of_values_colours_the_chosen_tractogram(desk, scene, heights, name):
    first = scene.open(name)
    scene.select(first.id, [4, 5])
    scene.open("lines.fiblets")
    desk.page.chosen = first.id

    async def test():
        desk.files.browse("")
        assert "heights.tsf" in {entry["name"] for entry in desk.page.entries}
        desk.files.take("heights.tsf", False)
        await desk.done()

    asyncio.run(test())
    layer = scene.layer(first.id)
    assert layer.settings["scalars"] == "heights"
    assert len(layer.selected) == 2
    np.testing.assert_allclose(values_of(scene, layer), heights, atol=np.ptp(heights) / 500)
    assert {"name": "heights", "title": "heights"} in scene.arrays(layer.id)
    assert scene.layers[1].source.values == ()
    part = scene.keep_selection(layer.id)
    assert scene.actor(part.id).fiblets.n_streamlines == 2
    assert part.settings["scalars"] == "heights"
    desk.history.undo()
    desk.history.undo()
    assert scene.layer(first.id).source.values == ()
    assert scene.layer(first.id).settings["scalars"] != "heights"


def test_sessions_keep_files_of_values(scene, heights):
    layer = scene.open("lines.trk")
    scene.attach(layer.id, scene.load_values(layer.id, "heights.tsf"))
    data = session.to_dict(scene)
    assert data["layers"][0]["source"] == {"path": "lines.trk", "values": ["heights.tsf"]}
    scene.remove(layer.id)
    scene.forget_unused()
    session.from_dict(scene, data)
    assert scene.layers[0].settings["scalars"] == "heights"
    for wrong in ("heights.tsf", ["../heights.tsf"], ["none.tsf"], [3], ["head.nii.gz"]):
        data["layers"][0]["source"]["values"] = wrong
        with pytest.raises(session.SessionError):
            session.from_dict(scene, data)
    assert len(scene.layers) == 1


@pytest.mark.more
@pytest.mark.usefixtures("usual_limits")  # which the script has
def test_scripts_attach_files_of_values(scene, folder, heights):
    scene.plotter.window_size = 420, 360
    layer = scene.open("lines.trk")
    scene.attach(layer.id, scene.load_values(layer.id, "heights.tsf"))
    scene.select(layer.id, [4, 5, 6])
    scene.keep_selection(layer.id)
    scene.screenshot()
    picture = scene.screenshot()
    (folder / "again.py").write_text(as_script(scene, "again.png"))
    done = subprocess.run([sys.executable, "again.py"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    again = np.asarray(pv.read(folder / "again.png").active_scalars).reshape(360, 420, -1)[::-1]
    np.testing.assert_array_equal(again, picture)


def test_values_of_other_lines_change_nothing(desk, scene, folder, lines):
    attachments.write_scalars(folder / "part.tsf", lines[:50], "fa")

    async def test(says):
        with pytest.raises(ValueError, match=says):
            await desk.files.open("part.tsf")

    asyncio.run(test("part.tsf holds values for the points of a tractogram; open that first"))
    layer = scene.open("lines.trk")
    asyncio.run(test("50 streamlines.*60 as the tractogram has"))
    assert scene.layers == (layer,)
    with pytest.raises(FormatError):
        scene.load_values(layer.id, "part.tsf")
    assert pvfiblets.read(folder / "lines.trk").n_points == lines.n_points
