"""Track scalar files on the page: read beside it, kept by sessions and scripts, undone like all else."""

import asyncio
import json
import subprocess
import sys
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.errors import FormatError
from pvfiblets.formats import attachments
from pvfiblets.streamlines import Streamlines
from pvfiblets.web.session import files as session
from pvfiblets.web.session.document import Source
from pvfiblets.web.session.history import History
from pvfiblets.web.session.script import as_script
from tests.web.conftest import look_down
from tests.web.desk import Desk, assert_script_draws, scene_of_views


@pytest.fixture
def heights(folder, lines):
    """A file with the height of each point."""
    made = Streamlines(lines.points, lines.offsets, {"y": lines.points[:, 1]})
    attachments.write_scalars(folder / "heights.tsf", made, "y")
    return lines.points[:, 1]


@pytest.fixture
def desk(scene, folder):
    return Desk(scene, folder)


def filters_of(desk, layer):
    """Return what the tab Filter shows of a layer."""
    desk.choose(layer)
    desk.filtering.refresh()
    return desk.page.filters


def drawn_x(scene):
    """Return where along x something is drawn, mm, to a pixel of 0.5."""
    look_down(scene, (30, 18, 0), 0.5)
    picture = scene.cameras.screenshot()
    return np.flatnonzero(picture.any(axis=(0, 2))) * 0.5 - 20.0


def values_of(scene, layer):
    return scene.actor(layer.id).fiblets.decompress().per_point["heights"].ravel()


@pytest.mark.parametrize("name", ["lines.trk", "lines.fiblets"])
async def test_a_file_of_values_colours_the_chosen_tractogram(desk, scene, heights, name):
    first = scene.open(name)
    scene.selection.select(first.id, [4, 5])
    scene.open("lines.fiblets")
    desk.page.chosen = first.id
    desk.files.browse("")
    assert "heights.tsf" in {entry["name"] for entry in desk.page.entries}
    desk.files.take("heights.tsf", False)
    await desk.done()
    layer = scene.layer(first.id)
    assert layer.settings["scalars"] == "heights"
    assert len(layer.selected) == 2
    np.testing.assert_allclose(values_of(scene, layer), heights, atol=np.ptp(heights) / 500)
    assert {"name": "heights", "title": "heights"} in scene.queries.arrays(layer.id)
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
    scene.selection.select(layer.id, [4, 5, 6])
    scene.keep_selection(layer.id)
    scene.cameras.screenshot()
    picture = scene.cameras.screenshot()
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

    asyncio.run(test("part.tsf holds values for a tractogram; open that first"))
    layer = scene.open("lines.trk")
    asyncio.run(test("50 streamlines.*60 as the tractogram has"))
    assert scene.layers == (layer,)
    with pytest.raises(FormatError):
        scene.load_values(layer.id, "part.tsf")
    assert pvfiblets.read(folder / "lines.trk").n_points == lines.n_points


def along(lines, values, chosen=slice(None)):
    """Return values at positions of equal length along straight lines, linear between them."""
    found = np.full(lines.n_points, np.nan)
    for line in np.arange(len(lines))[chosen]:
        part = slice(*lines.offsets[line : line + 2])
        x = np.asarray(lines.points[part, 0], float)
        found[part] = np.interp(x / x[-1], np.linspace(0.0, 1.0, len(values)), values)
    return found


def held(scene, layer, name):
    return scene.actor(layer.id).fiblets.decompress().per_point[name].ravel()


@pytest.mark.parametrize("name", ["effect.csv", "effect.txt", "effect.npy", "effect.tsv"])
async def test_values_of_positions_colour_along_the_bundle(desk, scene, folder, lines, name):
    values = np.array([0.5, 2.0, -1.0, 4.0, 3.0])
    if name.endswith(".npy"):
        np.save(folder / name, values)
    else:
        (folder / name).write_text("mean\n" * name.endswith(".tsv") + "".join(f"{value}\n" for value in values))
    layer = scene.open("lines.trk")
    desk.choose(layer)
    desk.files.browse("")
    assert name in {entry["name"] for entry in desk.page.entries}
    desk.files.take(name, False)
    await desk.done()
    assert scene.layer(layer.id).settings["scalars"] == "effect"
    np.testing.assert_allclose(held(scene, layer, "effect"), along(lines, values), atol=0.02)
    choices = next(one for one in scene.queries.properties(layer.id) if one["name"] == "scalars")["choices"]
    assert "effect" in {choice["value"] for choice in choices}
    assert desk.history.undo() == f"values effect of {layer.name}"
    assert scene.layer(layer.id).source.values == ()


STATS = "bundle,value,position,mean,p\nnear,fa,0,1,\nnear,fa,1,3,0.5\nfar,fa,0,5,0.1\nfar,fa,1,4,0.2\nlost,fa,0,9,9\n"


def test_a_table_of_bundles_colours_each_along_itself(scene, folder, lines):
    (folder / "stats.csv").write_text(STATS)
    layer = scene.open("lines.fiblets")
    scene.attach(layer.id, scene.load_values(layer.id, "stats.csv"))
    assert scene.layer(layer.id).settings["scalars"] == "stats"
    near, far = slice(0, 30), slice(30, 60)
    both = np.fmax(along(lines, [1.0, 3.0], near), along(lines, [5.0, 4.0], far))
    np.testing.assert_allclose(held(scene, layer, "stats"), both, atol=0.02)
    found = held(scene, layer, "stats p")
    share = along(lines, [0.0, 1.0])
    half = (share > 0.5) & (np.arange(lines.n_points) < lines.offsets[30])  # nearest to a position with a value
    np.testing.assert_allclose(found[half], 0.5, atol=0.02)
    assert np.isnan(found[: lines.offsets[30]][share[: lines.offsets[30]] < 0.5]).all()
    (folder / "p.csv").write_text(STATS.replace("mean", "effect"))
    scene.attach(layer.id, scene.load_values(layer.id, "p.csv"))
    assert scene.layer(layer.id).settings["scalars"] == "p effect"
    state = session.to_dict(scene)
    assert state["layers"][0]["source"]["values"] == ["stats.csv", "p.csv"]
    scene.remove(layer.id)
    scene.forget_unused()
    session.from_dict(scene, state)
    assert scene.layers[0].settings["scalars"] == "p effect"


def plotted(desk):
    """Return the tab's curves of values along bundles: (positions, values) by colour, read from the picture's axes."""
    chart = ET.fromstring(desk.page.bundles["along"]["chart"])
    assert chart.get("role") == "img"
    runs = [one for one in chart.iter("polyline") if one.get("stroke") != "currentColor"]  # between missing values
    texts = {stroke: " ".join(one.get("points") for one in runs if one.get("stroke") == stroke)
             for stroke in [one.get("stroke") for one in runs]}  # fmt: skip
    places = {stroke: np.array([pair.split(",") for pair in text.split()], float) for stroke, text in texts.items()}
    low, high = (text for text in chart.iter("text") if text.get("text-anchor") == "end" and "%" not in text.text)
    (first, last), ends = (sorted(float(one.get("x")) for one in chart.iter("text") if one.text in ("0 %", "100 %")),
                           [float(one.get("y")) - 4.0 for one in (low, high)])  # fmt: skip
    found = {}
    for stroke, at in places.items():
        values = np.interp(-at[:, 1], [-ends[0], -ends[1]], [float(low.text), float(high.text)])
        found[stroke] = (at[:, 0] - first) / (last - first), values
    return found, chart.get("aria-label")


def test_values_along_bundles_are_plotted_beside_them(desk, scene, folder, lines):
    (folder / "stats.csv").write_text(STATS)
    layer = scene.open("lines.fiblets")
    desk.choose(layer)
    desk.bundles.refresh()
    assert desk.page.bundles["along"] == {}
    scene.attach(layer.id, scene.load_values(layer.id, "stats.csv"))
    desk.bundles.refresh()
    colours = {row["name"]: row["color"] for row in desk.page.bundles["rows"]}
    curves, label = plotted(desk)
    for name, values in (("near", [1.0, 3.0]), ("far", [5.0, 4.0])):
        np.testing.assert_allclose(curves[colours[name]], [[0.0, 1.0], values], atol=0.02)
    assert label == "stats along near, far"
    assert "100 % of the way: near 3, far 4<" in desk.page.bundles["along"]["chart"]
    assert [one["name"] for one in desk.page.bundles["along"]["legend"]] == ["near", "far"]
    scene.bundles.set_bundle(layer.id, "near", visible=False)
    desk.bundles.refresh()
    assert list(plotted(desk)[0]) == [colours["far"]]
    desk.history.undo()
    desk.bundles.refresh()
    assert len(plotted(desk)[0]) == 2
    state = session.to_dict(scene)
    scene.set(layer.id, "scalars", "orientation")
    desk.bundles.refresh()
    assert desk.page.bundles["along"] == {}
    session.from_dict(scene, state)
    desk.choose(scene.layers[0])
    desk.bundles.refresh()
    assert plotted(desk)[1] == "stats along near, far"
    (folder / "stats.csv").unlink()
    scene.set(scene.layers[0].id, "scalars", "stats p")
    desk.bundles.refresh()
    assert desk.page.bundles["along"] == {}


def test_one_bundle_without_a_name_is_plotted_with_its_band(desk, scene, folder):
    values = np.array([0.5, 2.0, np.nan, 4.0, 3.0])
    rows = [f"{value},{value - 0.25},{value + 0.5}\n" for value in values]
    (folder / "fa.csv").write_text("mean,low,high\n" + "".join(rows).replace("nan", ""))
    layer = scene.open("lines.trk")
    scene.attach(layer.id, scene.load_values(layer.id, "fa.csv"))
    desk.choose(layer)
    desk.bundles.refresh()
    ((share, found),) = plotted(desk)[0].values()
    there = np.isfinite(values)
    np.testing.assert_allclose(share, np.linspace(0.0, 1.0, 5)[there], atol=0.01)
    np.testing.assert_allclose(found, values[there], atol=0.02)
    told = desk.page.bundles["along"]["chart"]
    assert "25 % of the way: lines.trk 2 (1.75 to 2.5)<" in told
    assert plotted(desk)[1] == "fa along lines.trk"


def test_values_of_streamlines_are_not_plotted_along(desk, scene, folder, lines):
    (folder / "age.txt").write_text("".join(f"{k}\n" for k in range(len(lines))))
    layer = scene.open("lines.trk")
    scene.attach(layer.id, scene.load_values(layer.id, "age.txt"))
    desk.choose(layer)
    desk.bundles.refresh()
    assert desk.page.bundles["along"] == {}


def test_tables_that_fit_nothing_say_why(scene, folder):
    layer = scene.open("lines.fiblets")
    for text, said in (
        ("bundle,mean\na,1\na,2\nb,1\n", "profiles of a, b"), ("mean\nhigh\nlow\n", "no numbers"),
        ("1\n" * 1500, "60 rows"), ("1\n", "60 rows"), ("", "60 rows"), ("mean\n1,2\n", "1 cells"),
    ):  # fmt: skip
        (folder / "odd.csv").write_text(text)
        with pytest.raises((ValueError, FormatError), match=said):
            scene.load_values(layer.id, "odd.csv")
    assert scene.layers == (layer,)


@pytest.mark.usefixtures("usual_limits")  # which the script has
def test_scripts_colour_along_too(scene, folder):
    (folder / "stats.csv").write_text(STATS)
    layer = scene.open("lines.fiblets")
    scene.attach(layer.id, scene.load_values(layer.id, "stats.csv"))
    assert_script_draws(scene, folder, scene.cameras.screenshot())


HEAD = {"volume": {"path": "head.nii.gz"}}


def distance_from_corner(points):
    """Return what head.nii.gz holds at points, mm, where no cell of it is bent: 1 - the distance from its middle."""
    return 1.0 - np.linalg.norm(points / 4.0 / 7.5 - 1.0, axis=1)


def test_samples_are_trilinear_inside_and_nothing_outside():
    rng = np.random.default_rng(0)

    def field(i, j, k):  # which trilinear interpolation reproduces
        return 3.0 - 2.0 * i + 0.5 * j + 0.25 * k + 0.1 * i * k

    values = field(*np.indices((5, 1, 7)).astype(float))
    affine = np.array([[0.0, 2.0, 0.0, 3.0], [-1.5, 0.0, 0.1, 4.0], [0.0, 0.0, 0.5, -2.0], [0, 0, 0, 1]])
    voxels = rng.uniform((-1, -1, -1), (5, 1, 7), (500, 3))
    points = voxels @ affine[:3, :3].T + affine[:3, 3]
    found = VolumeSource(values, affine).at(points)
    inside = ((voxels >= -0.5) & (voxels <= (4.5, 0.5, 6.5))).all(axis=1)
    assert 50 < inside.sum() < 450
    np.testing.assert_array_equal(np.isnan(found), ~inside)
    expected = field(*np.clip(voxels[inside], 0.0, (4.0, 0.0, 6.0)).T)
    np.testing.assert_allclose(found[inside], expected, atol=1e-9)
    labels = rng.integers(0, 9, (5, 1, 7))
    nearest = np.rint(voxels[inside]).astype(int)
    np.testing.assert_array_equal(VolumeSource(labels, affine).at(points)[inside], labels[tuple(nearest.T)])
    values[2, 0, 3] = np.nan
    assert np.isnan(VolumeSource(values, affine).at((affine @ [2.5, 0, 3, 1])[:3][None])).all()
    assert np.isfinite(VolumeSource(values, affine).at((affine @ [3, 0, 3, 1])[:3][None])).all()


@pytest.mark.parametrize("kind", ["image", "volume"])
def test_open_images_colour_and_stand_after_the_usual_four(folder, kind):
    """An image that is open as slices colours as one that is open as a volume."""
    with scene_of_views(folder) as scene:
        layer = scene.open("lines.fiblets")
        scene.open("head.nii.gz", kind)
        (scalars,) = (item for item in scene.queries.properties(layer.id) if item["name"] == "scalars")
        titles = [choice["title"] for choice in scalars["choices"]]
        assert titles[:5] == ["orientation", "one colour", "a colour each", "group", "volume head.nii.gz"]
        assert len(set(titles)) == len(titles)
        scene.set(layer.id, "scalars", HEAD)
        assert isinstance(scene.actor(layer.id).scalars, VolumeSource)


def test_volumes_of_the_scene_are_choices_and_stay_when_their_layer_goes(scene, lines):
    layer = scene.open("lines.fiblets")

    def choices():
        (scalars,) = (item for item in scene.queries.properties(layer.id) if item["name"] == "scalars")
        return {choice["title"]: choice["value"] for choice in scalars["choices"]}

    assert "volume head.nii.gz" not in choices()
    with pytest.raises(ValueError, match="choose one of"):
        scene.set(layer.id, "scalars", HEAD)
    head = scene.open("head.nii.gz")
    assert choices()["volume head.nii.gz"] == HEAD
    history = History(scene)
    scene.set(layer.id, "scalars", HEAD)
    volume = scene.actor(layer.id).scalars
    assert isinstance(volume, VolumeSource)
    scene.remove(head.id)
    scene.forget_unused()
    scene.set(layer.id, "line_width", 2.0)
    assert scene.actor(layer.id).scalars is volume
    assert choices()["volume head.nii.gz"] == HEAD
    assert scene.queries.legend[0]["title"] == "head"
    assert list(scene.plotter.scalar_bars.keys()) == ["head"]
    while history.undo():
        pass
    assert scene.actor(layer.id).scalars != volume
    found = scene.queries.histogram(layer.id)
    assert found["name"] != "head"
    history.redo()
    found = scene.queries.histogram(layer.id)
    assert (found["name"], sum(found["counts"])) == ("head", 16**3)


async def test_an_open_image_is_a_criterion(desk, scene, lines):
    """A voxel of the atlas has 3 up to x = 14.3 mm, then 5 up to 30.3 mm, then 0, and ends at x = 62.3 mm."""
    layer = scene.open("lines.fiblets")
    assert "volume atlas.nii.gz" not in [entry["value"] for entry in filters_of(desk, layer)["more"]]
    atlas = scene.open("atlas.nii.gz")
    scene.show(atlas.id, False)
    name = "volume atlas.nii.gz"
    assert name in [entry["value"] for entry in filters_of(desk, layer)["more"]]
    with pytest.raises(ValueError, match="no values"):
        scene.filters.set_filter(layer.id, name, 3, 3)
    desk.filtering.add(name)
    await desk.done()
    (row,) = filters_of(desk, layer)["criteria"]
    assert (row["name"], row["limits"], row["value"]) == (name, [0.0, 5.0], [0.0, 5.0])
    assert name not in [entry["value"] for entry in filters_of(desk, layer)["more"]]
    counts = scene.queries.histogram(layer.id, Source("atlas.nii.gz"))["counts"]
    x = lines.points[:, 0]
    assert (counts[0], counts[-1]) == (((x > 30.3) & (x < 62.3)).sum(), ((x > 14.3) & (x < 30.3)).sum())

    assert drawn_x(scene).max() == pytest.approx(62.0, abs=0.6)
    desk.filtering.set_criterion(name, [4.5, 5.0])
    scene.remove(atlas.id)
    scene.forget_unused()
    assert dict(scene.actor(layer.id).criteria) == {name: (4.5, 5.0)}
    kept = drawn_x(scene)
    assert kept.min() == pytest.approx(14.5, abs=0.6)
    assert kept.max() == pytest.approx(30.0, abs=0.6)
    script, data = as_script(scene), session.to_dict(scene)
    assert ".criterion(FOLDER / 'atlas.nii.gz', (4.5, 5.0))" in script
    assert data["layers"][0]["filters"]["images"] == {name: {"path": "atlas.nii.gz"}}
    desk.filtering.remove(name)
    assert not scene.layer(layer.id).filters.images
    assert drawn_x(scene).max() == pytest.approx(69.0, abs=0.6)
    desk.history.undo()
    assert drawn_x(scene).max() == pytest.approx(30.0, abs=0.6)

    session.from_dict(scene, data)
    assert dict(scene.actor(layer.id).criteria) == {name: (4.5, 5.0)}
    for bad, says in (
        ({"images": {name: {"path": "../atlas.nii.gz"}}}, "outside of the folder"),
        ({"images": {name: {"path": "lines.fiblets"}}}, "cannot be opened"),
        ({"images": {"other": {"path": "atlas.nii.gz"}}}, "cannot have"),
        ({"images": {}}, "cannot have"),
    ):
        data["layers"][0]["filters"].update(bad)
        with pytest.raises(session.SessionError, match=says):
            session.from_dict(scene, data)


def test_images_of_slices_are_criteria_and_colour_lines(folder):
    with scene_of_views(folder) as scene:
        scene.open("atlas.nii.gz", "image")
        layer = scene.open("lines.fiblets")
        desk = Desk(scene, folder)
        assert "volume atlas.nii.gz" in [entry["value"] for entry in filters_of(desk, layer)["more"]]
        scene.set(layer.id, "scalars", {"volume": {"path": "atlas.nii.gz"}})
        desk.choose(layer)
        desk.run(lambda: desk.filtering.add("volume atlas.nii.gz"))
        assert list(scene.actor(layer.id).criteria) == ["volume atlas.nii.gz"]


async def test_an_image_that_no_line_meets_is_no_criterion(desk, scene, folder):
    import nibabel

    far = np.diag([4.0, 4.0, 4.0, 1.0])
    far[:3, 3] = 500.0
    nibabel.save(nibabel.Nifti1Image(np.arange(64, dtype=np.float32).reshape(4, 4, 4), far), folder / "far.nii")
    scene.open("far.nii")
    layer = scene.open("lines.fiblets")
    desk.choose(layer)
    desk.filtering.add("volume far.nii")
    with pytest.raises(ValueError, match="no streamline of 'lines.fiblets' has a value of volume far.nii"):
        await desk.done()
    assert not scene.layer(layer.id).filters.active


def test_tables_and_profiles_say_what_the_volume_has_there(scene, lines):
    scene.open("head.nii.gz")
    layer = scene.open("lines.trk")
    scene.set(layer.id, "scalars", HEAD)
    scene.selection.select(layer.id, [30, 47])
    rows = scene.selection.table()["rows"]
    assert {row["of"] for row in rows} == {"mean of head"}
    for row, line in zip(rows, (lines[30], lines[47]), strict=True):
        inside = line[line[:, 0] <= 62.0]
        assert row["value"] == pytest.approx(distance_from_corner(inside).mean(), abs=0.01)
    scene.selection.select(layer.id, [30])
    found = scene.selection.profile(layer.id, n=5)
    assert (found["name"], found["count"]) == ("head", 1)
    places = np.linspace(lines[30][0], lines[30][-1], 5)
    np.testing.assert_allclose(found["mean"], distance_from_corner(places), atol=0.02)
    assert scene.selection.profile(layer.id, "curvature")["name"] == "curvature"


def test_a_session_finds_its_volume_again_or_is_refused(scene, folder):
    scene.open("head.nii.gz")
    layer = scene.open("lines.fiblets")
    scene.set(layer.id, "scalars", HEAD)
    scene.remove(scene.layers[0].id)
    home = folder / "study"
    home.mkdir()
    for name in ("head.nii.gz", "lines.fiblets"):
        (folder / name).rename(home / name)
    data = session.to_dict(scene)
    assert data["layers"][0]["settings"]["scalars"] == HEAD
    with pytest.raises(session.SessionError, match="no such file"):
        session.from_dict(scene, data)
    session.from_dict(scene, data, home)
    assert scene.layers[0].settings["scalars"] == {"volume": {"path": "study/head.nii.gz"}}
    for bad, says in (
        ({"volume": {"path": "lines.fiblets"}}, "cannot be opened"),
        ({"volume": {"path": "../head.nii.gz"}}, "outside of the folder"),
        ({"volume": {"demo": "tracts", "size": 9}}, "no demonstration"),
        ({"volume": "head.nii.gz"}, "source"),
        ({"volume": {"path": "head.nii.gz", "ids": [0, 1]}}, "ids"),
        ({"image": {}}, "no 'volume'"),
    ):
        broken = json.loads(json.dumps(data))
        broken["layers"][0]["settings"]["scalars"] = bad
        with pytest.raises(session.SessionError, match=says):
            session.from_dict(scene, broken, home)
