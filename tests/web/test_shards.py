"""Sets in shards on the page: a folder of shards opens like a file, and is not put together where it does not fit."""

from __future__ import annotations

import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.engine.fiblets import streamed_renderer
from pvfiblets.web import session
from pvfiblets.web.confined import Confined
from pvfiblets.web.loading import Files
from pvfiblets.web.options import Options
from pvfiblets.web.scene import Scene


@pytest.fixture
def shards(folder, lines):
    """The sixty lines in shards, which alone would be gathered: they keep every bit of so few points."""
    coded = pvfiblets.compress(lines, per_point=["fa"], exact=False)
    coded.save(folder / "many.fiblets", shards=coded.nbytes // 4)
    return folder / "many.fiblets"


@pytest.fixture
def _apart(monkeypatch):
    monkeypatch.setattr(streamed_renderer, "free_host_memory", lambda: 100)
    monkeypatch.setattr(pvfiblets.ShardedSet, "gather", lambda *_: pytest.fail("all shards were put together"))


def test_a_folder_of_shards_is_listed_as_a_file(folder, shards):
    found = {entry.name: entry for entry in Confined(folder).listing("")}["many.fiblets"]
    assert not found.folder
    assert found.size == sum(file.stat().st_size for file in shards.iterdir())
    assert Confined(folder).existing("many.fiblets") == shards
    assert not any(path == "many.fiblets" for path, _ in Confined(folder).walk())


def test_a_shard_that_leads_out_is_refused(folder, shards, tmp_path):
    outside = tmp_path / "secret.fiblets"
    (shards / "000001.fiblets").rename(outside)
    (shards / "000001.fiblets").symlink_to(outside)
    with pytest.raises(PermissionError, match="names a file that is not in the folder"):
        Files(folder).resolve("many.fiblets")


def test_options_take_a_folder_of_shards(folder, shards):
    assert Options(root=str(folder), files=[str(shards)], token=None, host="127.0.0.1").checked()
    with pytest.raises(FileNotFoundError):
        Options(root=str(folder), files=[str(folder)], token=None, host="127.0.0.1").checked()


@pytest.mark.more
@pytest.mark.usefixtures("_apart")
def test_a_session_of_shards_brings_everything_back(scene, shards, tmp_path):
    layer = scene.open("many.fiblets")
    scene.set(layer.id, "scalars", "fa")
    scene.set_filter(layer.id, "length", 20, None)
    box = {"how": "ends_in", "region": {"kind": "box", "bounds": [-1, 5, -1, 50, -1, 50]}}
    scene.set_regions(layer.id, box)
    scene.set_groups(layer.id, ["far"])
    scene.add_clip("plane", normal=[0, 0, 1], origin=[0, 0, 4], layers=[layer.id])
    scene.view("axial")
    picture = scene.screenshot()
    actor = scene.actor(layer.id)
    assert actor.explain()["parts"]["total"] > 3
    assert actor.explain()["share"] == 1.0
    assert scene.select_box(0, 0, 200, 160) > 5
    told = scene.table()
    assert len(told["rows"]) > 5
    scene.export(layer.id, "some.tck")
    assert len(pvfiblets.read(shards.parent / "some.tck")) == scene.count()
    scene.deselect()
    session.save(scene, "a.json")
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.disable_anti_aliasing()
    other = Scene(plotter, shards.parent)
    session.load(other, "a.json")
    assert (other.screenshot() == picture).all()
    assert picture.max() > 50
    other.close()
    plotter.close()
