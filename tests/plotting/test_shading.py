"""The actor's shading: settings that are live, checked, copied and shown."""

from __future__ import annotations

import numpy as np
import pytest

EFFECTS = ("illuminated", "ambient_occlusion", "depth_cue", "halos")


@pytest.fixture
def actor(plotter, three_lines):
    return plotter.add_fiblets(three_lines, lighting=True)


def picture(plotter):
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    return np.asarray(plotter.screenshot(return_img=True))[..., :3]


def test_all_is_off_at_first(actor):
    assert [getattr(actor, name) for name in EFFECTS] == [False] * 4
    assert actor.style == "surface"
    assert set(actor.mapper.effects) == {"light"}


@pytest.mark.few(3)
@pytest.mark.parametrize("name", EFFECTS)
@pytest.mark.parametrize("off", [False, None])
def test_an_effect_is_set_and_taken_away_while_it_is_shown(plotter, actor, name, off):
    before = picture(plotter)
    features = set(actor.explain()["features"])
    setattr(actor, name, True)
    assert getattr(actor, name)
    during = picture(plotter)
    piece = {"halos": "halo"}.get(name, name)
    without = {"line_light"} if name == "illuminated" else set()  # one light takes the other's place
    assert set(actor.explain()["features"]) == features - without | {piece}
    if name != "ambient_occlusion":  # three lines stand over nothing
        assert not np.array_equal(during, before)
    setattr(actor, name, off)
    assert getattr(actor, name) is False
    assert np.array_equal(picture(plotter), before)
    assert set(actor.explain()["features"]) == features


def test_settings_are_read_back_with_their_defaults(actor):
    actor.ambient_occlusion = {"radius": 3, "strength": 0.5}
    assert actor.ambient_occlusion == {"radius": 3.0, "samples": 16, "strength": 0.5}
    actor.depth_cue = {"range": (10, 20), "color": "red"}
    assert actor.depth_cue == {"strength": 0.7, "color": "red", "range": (10.0, 20.0)}
    actor.halos = True
    assert actor.halos == {"width": None, "depth": None, "color": "white"}
    actor.halos = actor.halos | {"width": 2.0}
    assert actor.halos["width"] == 2.0


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [("ambient_occlusion", {"radius": -1}, "radius of ambient occlusion is -1"),
     ("ambient_occlusion", {"bias": 1}, r"no settings \['bias'\]; it has \['radius', 'samples', 'strength'\]"),
     ("depth_cue", 0.5, "depth_cue is 0.5; give True, False or a dict"), ("halos", {"color": "no colour"}, "no colour"),
     ("halos", {"width": 0}, "width of halos is 0"), ("style", "wire", "style is 'wire'; choose one of")],
)  # fmt: skip
def test_what_cannot_be_set_is_refused_and_changes_nothing(actor, name, value, message):
    actor.halos = {"width": 1.0}
    before, effects = getattr(actor, name), actor.mapper.effects
    with pytest.raises(ValueError, match=message):
        setattr(actor, name, value)
    assert getattr(actor, name) == before
    assert actor.mapper.effects == effects


def test_the_style_of_halos_is_ink_on_paper(plotter, actor, colours_in):
    before = picture(plotter)
    plotter.set_background("white")
    actor.style = "halo"
    drawn = picture(plotter)
    assert {tuple(map(int, colour)) for colour in np.unique(drawn.reshape(-1, 3), axis=0)} == {
        (0, 0, 0),
        (255, 255, 255),
    }
    assert actor.halos["color"] == "white"
    assert actor.lighting
    plotter.set_background("black")
    assert colours_in(picture(plotter)) == {(255, 255, 255)}
    actor.halos = {"width": 0.5, "color": "grey"}
    actor.style = "halo"
    assert actor.halos["width"] == 0.5
    actor.halos, actor.style = True, "surface"
    actor.style = "halo"
    actor.style = "surface"
    assert actor.halos is False
    assert np.array_equal(picture(plotter), before)


def test_a_copy_is_shaded_alike(actor):
    actor.style = "halo"
    actor.illuminated = True
    actor.ambient_occlusion = {"radius": 4.0}
    twin = actor.copy()
    assert twin.style == "halo"
    for name in EFFECTS:
        assert getattr(twin, name) == getattr(actor, name)
    assert set(twin.mapper.effects) == set(actor.mapper.effects)
