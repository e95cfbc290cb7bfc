"""Looks: names for settings, widths that follow the distance between lines, and ranges that outliers do not stretch."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.engine.effects.halos import HaloPass
from pvfiblets.mappers.effects.spacing import MOST_STREAMLINES, line_spacing_of
from pvfiblets.plotting.fiblets.looks import LOOKS, PLAIN, Apart, Fewer, look_of, settings_of
from pvfiblets.query.measures.measures import measure
from pvfiblets.streamlines import Streamlines
from pvfiblets.web.scene import layers

from .views import shot


def sheet(pitch, count, length=50.0):
    """Return parallel lines, all in one plane and as far apart as the pitch."""
    steps = np.linspace(0.0, length, 51)
    lines = [np.column_stack([steps, np.full(51, k * pitch), np.zeros(51)]) for k in range(count)]
    return Streamlines(np.concatenate(lines), np.arange(count + 1) * 51)


def scattered(density, count):
    """Return parallel lines at random places of a square, so many of them to a square millimetre."""
    steps, places = np.linspace(0.0, 40.0, 21), np.random.default_rng(1).random((count, 2)) * (count / density) ** 0.5
    lines = [np.column_stack([steps, np.full(21, y), np.full(21, z)]) for y, z in places]
    return Streamlines(np.concatenate(lines), np.arange(count + 1) * 21)


def diagonal(fiblets):
    bounds = np.array(fiblets.bounds)
    return float(np.linalg.norm(bounds[1::2] - bounds[::2]))


def test_the_distance_between_lines_is_that_of_their_grid():
    assert line_spacing_of(compress(sheet(2.0, 12))) == pytest.approx(2.0, rel=0.02)
    assert line_spacing_of(compress(sheet(0.25, 12))) == pytest.approx(0.25, rel=0.05)
    for count in (MOST_STREAMLINES // 2, 3 * MOST_STREAMLINES):  # of more, a share is measured
        # Of random places in a plane, exp(-pi density r^2) have no other within r.
        wanted = (np.log(2.0) / (np.pi * 0.2)) ** 0.5
        assert line_spacing_of(compress(scattered(0.2, count))) == pytest.approx(wanted, rel=0.15)
    assert line_spacing_of(compress(sheet(2.0, 1))) is None
    assert line_spacing_of(object()) is None


def test_a_width_goes_by_it_between_its_ends():
    few, dense = compress(sheet(3.0, 8)), compress(sheet(0.01, 8))
    size = diagonal(few)
    assert Apart(0.1, 1e-9, 1.0).value_for(few) == pytest.approx(0.3, rel=0.03)
    assert Apart(0.1, 0.01, 1.0).value_for(dense) == pytest.approx(0.01 * diagonal(dense), rel=0.01)
    assert Apart(0.1, 1e-9, 0.001).value_for(few) == pytest.approx(0.001 * size, rel=0.01)
    assert Apart(1.0, 1e-9, 1.0, 1000.0).value_for(few) == pytest.approx(1000.0 * 3.0 / size, rel=0.03)
    alone = compress(sheet(3.0, 1))
    assert Apart(0.1, 1e-9, 0.02).value_for(alone) == pytest.approx(0.02 * 50.0, rel=0.01)


def test_looks_can_be_set_and_read_back(plotter):
    actor = plotter.add_fiblets(sheet(2.0, 5), color="red")
    assert actor.look == "plain"
    for name in [*LOOKS, *reversed(LOOKS)]:
        actor.look = name
        assert (actor.look, actor.explain()["look"]) == (name, name)
        for key, value in settings_of(name, actor.fiblets).items():
            found = getattr(actor, key)
            if isinstance(value, dict):
                assert {**found, **{k: v for k, v in value.items() if k != "color"}} == found
            else:
                assert bool(found) == value if isinstance(value, bool) else found == value
        assert actor.color == "red"
        assert shot(plotter).any()
    actor.look = "studio"
    twin = actor.copy()
    assert twin.look == "studio"
    actor.depth_cue = False
    assert actor.look is None
    assert actor.copy().look is None
    actor.look = None
    assert not actor.depth_cue
    with pytest.raises(ValueError, match="look is 'fancy'; give one of 'plain', 'illuminated', 'tubes', 'glass'"):
        actor.look = "fancy"
    with pytest.raises(ValueError, match="look is 'fancy'; give one of"):
        plotter.add_fiblets(sheet(2.0, 5), look="fancy")


def test_glass_is_the_fainter_the_more_streamlines_there_are():
    found = [settings_of("glass", compress(sheet(0.5, count)))["opacity"] for count in (2, 300, 4800)]
    assert found == [0.5, 0.3, 0.15]
    assert Fewer(0.3, 0.2, 0.5).value_for(compress(sheet(0.5, 4800))) == 0.2


def test_a_look_is_the_same_in_the_call_and_afterwards(plotter):
    """Of all of them: defaults of other arguments do not come after it."""
    for name in LOOKS:
        made = plotter.add_fiblets(sheet(2.0, 5), look=name, name="one")
        assert made.look == name
        changed = plotter.add_fiblets(sheet(2.0, 5), name="one")
        changed.look = name
        assert {key: getattr(made, key) for key in PLAIN} == {key: getattr(changed, key) for key in PLAIN}
        assert list(made.mapper.effects) == list(changed.mapper.effects)


def test_arguments_go_before_a_look(plotter):
    actor = plotter.add_fiblets(sheet(2.0, 5), look="illuminated", line_width=7.0, opacity=0.5)
    assert (actor.line_width, actor.opacity, actor.illuminated, actor.look) == (7.0, 0.5, True, None)
    wide = plotter.add_fiblets(sheet(2.0, 5), look="illuminated", line_width=None)
    assert wide.look == "illuminated"
    assert 1.0 < wide.line_width <= 2.5


@pytest.mark.parametrize(("ground", "ink"), [("black", 255), ("white", 0), ("#303060", 255), ("#e0e0c0", 0)])
def test_ink_stands_out_from_its_ground(plotter, ground, ink):
    plotter.set_background(ground)
    plotter.add_fiblets(sheet(6.0, 5), color="orange", show_scalar_bar=False).style = "ink"
    plotter.view_xy()
    picture = shot(plotter)
    colours, counts = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
    rest = np.array(plotter.background_color.int_rgb)
    assert {tuple(colour) for colour in colours} == {tuple(rest), (ink, ink, ink)}
    assert counts.min() > 100


@pytest.mark.parametrize(("pitch", "zoom"), [(0.5, 1.0), (2.0, 1.0), (2.0, 4.0), (6.0, 1.0)])
def test_halos_are_as_wide_as_lines_leave_room_for(plotter, monkeypatch, pitch, zoom):
    """In pixels of the picture: half the distance between lines, from 1.25 to 5."""
    found = []
    drawn = HaloPass.draw

    def draw(self, *given, **more):
        found.append(more)
        return drawn(self, *given, **more)

    monkeypatch.setattr(HaloPass, "draw", draw)
    plotter.add_fiblets(sheet(pitch, 9), show_scalar_bar=False).halos = True
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.zoom(zoom)
    shot(plotter)
    pixels_per_mm = plotter.window_size[1] / (2.0 * plotter.camera.parallel_scale)
    wanted = min(max(0.5 * pitch * pixels_per_mm, 1.25), 5.0)
    assert found[-1]["width"] * pixels_per_mm == pytest.approx(wanted, rel=0.05)
    assert found[-1]["depth"] == pytest.approx(8.0 * found[-1]["width"])


def test_one_sharp_bend_does_not_stretch_the_range_of_curvature(plotter):
    """99 gentle arcs and a line that folds back: of its mean curvature the others would all have the first colour."""
    angle = np.linspace(0.0, 1.0, 40)
    arcs = [np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(40, k)]) for k, r in
            enumerate(np.linspace(20.0, 40.0, 99))]  # fmt: skip
    fold = np.array([[0.02 * (k % 2), 0.01 * k, 0.0] for k in range(40)])
    actor = plotter.add_fiblets([*arcs, fold], scalars="mean_curvature", max_error=1e-4)
    low, high = actor.clim
    assert low == 0.0
    assert 1.0 / 21.0 < high < 0.06
    assert actor.explain()["colours"] == {"clim": (low, high), "percentile": 98.0}
    assert measure(actor.fiblets, "mean_curvature").array().max() > 10.0 * high
    actor.clim = (0.0, 1.0)
    assert actor.explain()["colours"] == {"clim": (0.0, 1.0), "percentile": None}
    actor.clim = None
    actor.scalars = np.r_[np.zeros(99), 1e6]  # users' own numbers keep their least and largest
    assert actor.clim == (0.0, 1e6)
    assert actor.explain()["colours"]["percentile"] is None
    actor.scalars = "orientation"
    assert actor.explain()["colours"] is None


def test_a_page_takes_a_look_and_says_when_it_is_one_no_more():
    data = compress(sheet(2.0, 5))
    settings = layers.defaults("tractogram")
    assert settings["look"] == "plain" == look_of(settings, data)
    for name in LOOKS:
        assert layers.check("tractogram", "look", name, data) == name
        settings = layers.changed("tractogram", settings, "look", name, data)
        assert settings["look"] == name
        for key, value in settings.items():
            if key in PLAIN:
                assert layers.check("tractogram", key, value, data) == value
        told = layers.looks("tractogram", settings)
        wanted = settings_of(name, data)
        if wanted["style"] != "surface":
            del wanted["halos"]  # which other styles set
        assert {key: told[key] for key in wanted} == wanted
    settings = layers.changed("tractogram", settings, "line_width", 9.0, data)
    assert settings["look"] is None
    assert layers.changed("tractogram", settings, "look", None, data)["line_width"] == 9.0
    assert layers.changed("tractogram", settings, "line_width", 1.0, data)["look"] == "studio"
