"""Sliders that are dragged: the picture follows, the page's record waits, and all of it is one step."""

import asyncio

import numpy as np
import pytest

from pvfiblets.web.panels import sliders
from pvfiblets.web.panels.controls import axis_of, controls, moved
from pvfiblets.web.panels.describe import typed, typed_or_none
from pvfiblets.web.panels.sliders import SlideActions
from pvfiblets.web.panels.tabs.filter_regions import condition, flat
from tests.web.desk import Desk
from tests.web.visitors import until


@pytest.fixture
def desk(scene, folder):
    layer = scene.open("lines.fiblets")
    desk = Desk(scene, folder)
    desk.page.chosen, desk.page.chosen_kind = layer.id, layer.kind
    desk.sliders = SlideActions(desk)
    scene.watch(lambda _: desk.sliders.moving or desk.refresh())
    return desk


def drag(desk, *moves, release=True):
    async def test():
        for move in moves:
            desk.sliders.slide(*move)
        if release:
            desk.sliders.release()
        else:
            await until(lambda: desk.page.held == {})

    before = desk.refreshed
    asyncio.run(test())
    return desk.refreshed - before


def test_every_value_acts_and_the_page_is_brought_in_step_once(desk, scene):
    (layer,) = scene.layers
    refreshed = drag(desk, *(("property", layer.id, "opacity", value) for value in (0.9, 0.5, 0.25)))
    assert refreshed == 1
    assert scene.actor(layer.id).opacity == 0.25
    assert desk.page.held == {}
    assert len(desk.history) == 1
    drag(desk, ("property", layer.id, "opacity", 0.5))
    assert desk.history.undo() == "opacity of lines.fiblets"
    desk.history.undo()
    assert scene.actor(layer.id).opacity == 1.0


def test_a_slider_that_rests_without_being_let_go_is_shown_as_it_is(desk, scene, monkeypatch):
    monkeypatch.setattr(sliders, "SETTLED", 0.05)
    assert drag(desk, ("property", scene.layers[0].id, "line_width", 3.0), release=False) == 1


def test_cuts_filters_and_regions_slide(desk, scene):
    (layer,) = scene.layers
    clip = scene.filters.add_clip("box")
    drag(desk, ("clip", clip.id, "x", [1.0, 5.0]), ("clip", clip.id, "x", [1.0, 7.0]))
    assert scene.state.clip(clip.id).shape["bounds"][:2] == [1.0, 7.0]
    scene.filters.remove_clip(clip.id)
    desk.filtering.add("length")

    async def held():
        desk.sliders.slide("criterion", "of", "length", [40.25, 69.5])
        return dict(desk.page.held)

    assert asyncio.run(held()) == {
        "at": "criterion of length", "shown": ["40.25", "69.5"], "counted": "29 of 60 streamlines"
    }  # fmt: skip
    desk.filtering.remove("length")
    drag(desk, ("share", "of", "streamlines", 50))
    assert scene.layer(layer.id).filters.subset["amount"] == 0.5
    desk.regions.add("sphere")
    drag(desk, ("region", 0, "radius", 7.0))
    assert scene.layer(layer.id).filters.regions["of"][0]["region"]["radius"] == 7.0


@pytest.mark.parametrize(
    ("move", "says"),
    [
        (("camera", "x", "y", 1.0), "no sliders of 'camera'"),
        (([], "x", "y", 1.0), "no sliders of"),
        (("property", "layer99", "opacity", 1.0), "layer99"),
        (("property", "layer1", "opacity", 7.0), "from 0 to 1"),
        (("property", "layer1", "opacity", [1.0]), "opacity"),
        (("region", 3, "radius", 7.0), "no region 3"),
    ],
)
def test_what_no_slider_sends_is_refused_and_changes_nothing(desk, scene, move, says):
    state = scene.state
    with pytest.raises((ValueError, KeyError), match=says):
        drag(desk, move)
    assert scene.state is state
    assert not desk.sliders.moving


BOUNDS = (-10.0, 30.0, 0.0, 20.0, -5.0, 5.0)
SPHERE = {"kind": "sphere", "center": [1.0, 2.0, 3.0], "radius": 4.0}


def test_sliders_of_shapes_give_back_what_they_were_moved_to():
    shapes = [
        {"kind": "plane", "normal": [0.0, 2.0, 0.0], "origin": [1.0, 2.0, 3.0]},
        {"kind": "slab", "normal": [1.0, 1.0, 0.0], "origin": [1.0, 2.0, 3.0], "thickness": 2.0},
        {"kind": "box", "bounds": [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]},
        SPHERE,
    ]
    for shape in shapes:
        for found in controls(shape, BOUNDS):
            low, high = found["limits"]
            assert low <= np.min(found["value"]) <= np.max(found["value"]) <= high
            wanted = [low, high] if found["type"] == "range" else 0.5 * (low + high)
            changed = {**shape, **moved(shape, found["name"], wanted)}
            again = next(item for item in controls(changed, BOUNDS) if item["name"] == found["name"])
            np.testing.assert_allclose(again["value"], wanted, atol=1e-9)
        with pytest.raises(ValueError, match="has no 'colour'"):
            moved(shape, "colour", 1.0)


def test_planes_move_along_their_normal_and_numbers_are_typed_with_units():
    plane = {"kind": "plane", "normal": [0.0, 2.0, 0.0], "origin": [1.0, 2.0, 3.0]}
    assert moved(plane, "position", 7.0)["origin"] == [1.0, 7.0, 3.0]
    assert axis_of([0.0, -3.0, 0.0]) == "y"
    assert axis_of([1.0, 1.0, 0.0]) == ""
    assert typed("1.5", "x") == 1.5
    assert typed(" 1,5 mm", "x") == 1.5
    assert typed_or_none("", "x") is None
    for text in ("", "nan", "inf", "two"):
        with pytest.raises(ValueError, match="is not a number"):
            typed(text, "x")
    from xml.etree import ElementTree as ET

    from pvfiblets.web.panels.charts import profile_chart

    chart = profile_chart([0.0, 1.0], [1.0, 2.0], [1.0, 2.0], [1.0, 2.0], "<img src=x>")
    assert "<img" not in chart
    assert "<img src=x>" in [text.text for text in ET.fromstring(chart).iter("text")]


def test_regions_are_rows_joined_by_a_word_and_back():
    rows = [
        {"not": False, "how": "passes", "region": SPHERE},
        {"not": True, "how": "ends_in", "region": SPHERE},
        {"not": True, "how": "stays_in", "region": SPHERE, "sampling": "points"},
    ]
    assert flat(condition("or", rows)) == ("or", rows)
    assert condition("and", []) is None
    assert flat(None) == ("and", [])
    nested = {"op": "and", "of": [{"op": "or", "of": [{"how": "passes", "region": SPHERE}]}]}
    with pytest.raises(ValueError, match="nested"):
        flat(nested)


def test_profiles_have_axes_with_units_and_tell_what_lies_under_the_pointer():
    from xml.etree import ElementTree as ET

    from pvfiblets.web.panels.charts import profile_chart

    mean = np.array([1.0, np.nan, 3.0])
    chart = ET.fromstring(profile_chart([0.0, 0.5, 1.0], mean, mean - 0.5, mean + 0.5, "curvature [1/mm]"))
    told = [title.text for title in chart.iter("title")]
    assert told == [
        "0 % of the way: curvature [1/mm] 1 (0.5 to 1.5)",
        "100 % of the way: curvature [1/mm] 3 (2.5 to 3.5)",
    ]
    written = [text.text for text in chart.iter("text")]
    assert {"share of the streamline's length", "curvature [1/mm]", "0 %", "100 %"} <= set(written)


def test_profiles_break_where_values_are_missing():
    from xml.etree import ElementTree as ET

    from pvfiblets.web.panels.charts import Band, profiles_chart

    nan, x = np.nan, np.linspace(0.0, 1.0, 8)
    mean = np.array([nan, 0.0, 2.0, nan, 1.0, nan, 3.0, 4.0])
    wide = np.array([nan, 1.0, 1.0, nan, 1.0, nan, nan, 1.0])  # a band is unknown where one streamline has a value
    chart = ET.fromstring(profiles_chart(x, [Band("a", "#123456", mean, mean - wide, mean + wide)]))
    ends = ET.fromstring(profiles_chart(np.array([0.0, 1.0]), [Band("a", "#123456", *np.array([[-1.0, 5.0]] * 3))]))
    first, last = _places(ends, "polyline")[0]
    place = first + np.c_[x, (mean + 1.0) / 6.0] * (last - first)  # the band's lowest value is -1, the highest 5
    lines = [[1, 2], [4, 4], [6, 7]]  # a value between two gaps is a dot
    for found, expected in zip(_places(chart, "polyline"), lines, strict=True):
        np.testing.assert_allclose(found, place[expected], atol=0.06)
    bands = _places(chart, "polygon")
    assert [len(found) for found in bands] == [4, 2, 2]  # the last two have no width
    for found, (low, high) in zip(bands, [[1, 2], [4, 4], [7, 7]], strict=True):
        assert (found[:, 0].min(), found[:, 0].max()) == pytest.approx((place[low, 0], place[high, 0]), abs=0.06)
    alone = profiles_chart(x, [Band("a", "#123456", mean, np.full(8, nan), np.full(8, nan))])
    assert len(_places(ET.fromstring(alone), "polyline")) == 3
    assert profiles_chart(x, [Band("a", "#123456", *np.full((3, 8), nan))]) == ""


def _places(chart, kind):
    """Return the corners of a chart's lines or bands."""
    return [
        np.array([pair.split(",") for pair in one.get("points").split()], float)
        for one in chart.iter(kind)
        if "#123456" in (one.get("stroke"), one.get("fill"))
    ]


def test_facts_are_tables_with_units(scene):
    from pvfiblets.web.panels.tabs.info_tables import tables

    lines = scene.open("lines.trk")
    scene.cameras.screenshot()
    found = {table["title"]: table for table in tables(scene.queries.info(lines.id))}
    layer = dict(found["Layer"]["rows"])
    assert layer["Streamlines"] == "60 of 60 shown"
    assert layer["File"] == "lines.trk"
    assert layer["GPU memory"].split()[1] in ("bytes", "kB", "MB")
    assert found["Extent"]["columns"] == ["mm", "from", "to", "size"]
    assert found["Extent"]["rows"] == [
        ["left – right", "0", "69", "69"], ["back – front", "0", "36", "36"], ["down – up", "0", "20", "20"],
    ]  # fmt: skip
    assert found["Measured error"]["columns"] == ["", "mm", "steps"]
    assert [row[0] for row in found["Measured error"]["rows"]] == ["mean", "99.9 % below", "largest"]
    assert {title for title, table in found.items() if table["folded"]} == {
        "Passes of the last redraw",
        "Buffers",
        "Drawing",
    }
    assert all(isinstance(cell, str) for table in found.values() for row in table["rows"] for cell in row)
    head = {table["title"]: table for table in tables(scene.queries.info(scene.open("head.nii.gz").id))}
    assert head["Voxels to mm"]["rows"][0] == ["4", "0", "0", "0"]
    assert tables({}) == []


def test_volumes_begin_with_the_window_of_their_percentiles(scene, folder):
    import nibabel

    rng = np.random.default_rng(2)
    values = rng.normal(500.0, 100.0, (20, 20, 20)).astype(np.float32)
    values[:, :8] = 0.0
    values[3, 12, 4] = 1e6  # one voxel of a vessel, as T1 images have them
    nibabel.save(nibabel.Nifti1Image(values, np.eye(4)), folder / "t1.nii.gz")
    layer = scene.open("t1.nii.gz")
    head = values[values != 0]
    assert scene.actor(layer.id).clim == pytest.approx(tuple(np.percentile(head, (1, 99))), rel=1e-6)
    labels = scene.open("atlas.nii.gz")
    assert scene.layer(labels.id).settings["clim"] is None
    scene.set(layer.id, "clim", None)
    assert scene.actor(layer.id).clim == pytest.approx((0.0, 1e6))
