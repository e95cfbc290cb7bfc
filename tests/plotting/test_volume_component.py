"""PyVista's conventions hold for ``plotter.add_raycast_volume``, its settings are live, and bad input is refused."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting.volumes.component  # noqa: F401 - for environments that were installed before it was there
from pvfiblets.plotting.volumes.opacity import opacities, value_limits

from .views import facing as look
from .views import shot as plain_shot

X = np.linspace(-10.0, 10.0, 21)
AT = {"spacing": 1.0, "origin": (-10.0, -10.0, -10.0)}
BALL = (10.0 - np.sqrt(X[:, None, None] ** 2 + X[:, None] ** 2 + X**2)).astype(np.float32)
FOG = np.ones((5, 5, 5), np.uint8)
FOG_AT = {"spacing": 5.0, "origin": (-10.0, -10.0, -10.0)}


def shot(plotter):
    return plain_shot(plotter).astype(float)


def middle(plotter):
    return shot(plotter)[100, 100]


def shown(plotter, source=BALL, **arguments):
    place = FOG_AT if source is FOG else AT
    actor = plotter.add_raycast_volume(source, **{"show_scalar_bar": False, **place, **arguments})
    look(plotter)
    return actor


def image():
    grid = pv.ImageData(dimensions=BALL.shape, spacing=(1, 1, 1), origin=(-10, -10, -10))
    grid["density"] = BALL.ravel(order="F")
    return grid


def test_light_looks_as_vtks(plotter):
    """The same transfer function, unit and place through ``add_volume``, sampled finely."""
    arguments = {"cmap": "viridis", "clim": (0, 10), "opacity": "sigmoid_5", "opacity_unit_distance": 5.0}
    actor = plotter.add_raycast_volume(image(), show_scalar_bar=False, **arguments)
    look(plotter)
    ours = shot(plotter)
    plotter.remove_actor(actor)
    other = plotter.add_volume(image(), show_scalar_bar=False, shade=False, **arguments)
    other.prop.interpolation_type = "linear"
    other.mapper.SetAutoAdjustSampleDistances(False)
    other.mapper.SetSampleDistance(0.1)
    look(plotter)
    theirs = shot(plotter)
    there = (ours.max(-1) > 8) & (theirs.max(-1) > 8)
    assert there.sum() > 3000
    assert np.median(np.abs(ours - theirs)[there]) <= 2
    assert (np.abs(ours - theirs)[there] <= 8).mean() > 0.97


@pytest.mark.parametrize("integrator", ["preintegrated", "exponential", "simpson"])
def test_opacity_is_of_its_unit_whatever_the_step(plotter, integrator):
    actor = shown(plotter, FOG, cmap=["white"], opacity=0.3, clim=(0, 2), integrator=integrator)
    for unit, step in ((5.0, 0.5), (5.0, 0.1), (20.0, 0.5), (20.0, 1.0)):
        actor.opacity_unit_distance, actor.step = unit, step
        assert middle(plotter) == pytest.approx([255 * (1 - 0.7 ** (20.0 / unit))] * 3, abs=1.5)
    actor.opacity_unit_distance = None
    assert actor.opacity_unit_distance == 5.0


def test_colours_and_opacities_are_those_of_the_value(plotter):
    actor = shown(plotter, FOG, cmap="viridis", clim=(0, 4), opacity=[0, 0, 1, 0, 0], mode="mip")
    lut = pv.LookupTable("viridis", 256)
    colour = lut.values[64, :3] * 1.0
    alpha = np.interp(64 / 255, np.linspace(0, 1, 5), [0, 0, 1, 0, 0])
    assert middle(plotter) == pytest.approx(colour * alpha, abs=2)
    actor.opacity = [1, 1]
    assert middle(plotter) == pytest.approx(colour, abs=1)
    actor.cmap = "gray"
    assert middle(plotter) == pytest.approx([64] * 3, abs=1)
    actor.clim = 0, 2
    assert middle(plotter) == pytest.approx([128] * 3, abs=1)
    assert actor.clim == (0.0, 2.0)
    actor.color = "red"
    assert middle(plotter).tolist() == [255, 0, 0]
    assert actor.color == pv.Color("red")
    actor.opacity = 0.5
    assert middle(plotter) == pytest.approx([128, 0, 0], abs=1)
    actor.color = None
    assert middle(plotter) == pytest.approx([64] * 3, abs=1)


def test_surfaces_have_values_that_change(plotter):
    actor = shown(plotter, mode="isosurface", lighting=False, cmap="gray", clim=(0, 10))
    assert actor.values == (pytest.approx(np.mean([BALL.min(), BALL.max()]), abs=1e-6),)
    for value in (2.0, [6.0, 8.0], np.float32(4)):
        actor.values = value
        least = np.min(value)
        picture = shot(plotter)
        assert picture[100, 100] == pytest.approx([255 * least / 10] * 3, abs=1)
        area = (picture.max(-1) > 0).sum() / 25
        assert area == pytest.approx(np.pi * (10 - least) ** 2, rel=0.02)
        hit = actor.pick_at(100, 100)
        assert hit.position == pytest.approx([0.1, -(10 - least), 0.1], abs=0.05)
        assert hit.value == least
    actor.color, actor.opacity = "lime", 0.5
    assert middle(plotter) == pytest.approx([0, 128, 0], abs=1)
    actor.mode = "mip"
    assert actor.prop.opacity == 1.0
    assert middle(plotter) == pytest.approx([0, 128, 0], abs=1)  # half as opaque as a pixel now
    actor.mode, actor.opacity = "isosurface", "linear"
    assert middle(plotter) == pytest.approx([0, 255, 0], abs=1)


def test_only_surfaces_are_lit(plotter):
    actor = shown(plotter, mode="isosurface", color="white", values=5.0)
    lit = shot(plotter)[100, 75:126, 0]
    assert lit[25] > lit[5] + 20  # a ball darkens towards its rim
    actor.mode = "mip"
    assert not actor.prop.lighting
    assert actor.lighting
    actor.mode = "isosurface"
    assert (shot(plotter)[100, 75:126, 0] == lit).all()
    actor.lighting = False
    assert (shot(plotter)[100, 76:125, 0] == 255).all()


def test_thresholds_box_and_smoothing_are_live(plotter):
    actor = shown(plotter, mode="mip", cmap="gray", clim=(0, 10), opacity=1.0, step=0.1)
    assert middle(plotter) == pytest.approx([253] * 3, abs=3)
    actor.thresholds = None, 6.0
    assert middle(plotter) == pytest.approx([153] * 3, abs=4)
    actor.thresholds = 7.0
    picture = shot(plotter)
    assert (picture.max(-1) > 0).sum() / 25 == pytest.approx(np.pi * 9.0, rel=0.03)
    actor.thresholds = None
    actor.box = 10, 20, 0, 20, 0, 14
    rows, columns = np.nonzero(shot(plotter).max(-1))
    assert (columns.min(), rows.min()) == (100, 80)  # 0 mm, and 4 mm up, 5 pixels a mm
    actor.box = None
    actor.smooth = 2.0
    assert middle(plotter).max() < 240  # the tip of the cone is gone
    assert actor.volume.value_range[1] == 10.0
    actor.smooth = None
    assert middle(plotter) == pytest.approx([253] * 3, abs=3)


def test_another_volume_may_be_shown(plotter):
    actor = shown(plotter, FOG, mode="mip", cmap="gray", opacity=1.0)
    assert actor.clim == (1.0, 2.0)  # the range of one value ends beside it
    assert middle(plotter).max() == 0.0
    actor.volume = actor.volume.__class__(FOG * np.uint8(3) - np.indices(FOG.shape)[0].astype(np.uint8) % 2)
    assert actor.clim == (2.0, 3.0)
    with pytest.raises(TypeError, match="RaycastVolume"):
        actor.volume = FOG


def test_pyvistas_images_bring_names_and_bars(plotter):
    grid = image()
    grid["other"] = np.arange(grid.n_points, dtype=float)
    actor = plotter.add_raycast_volume(grid, scalars="density", scalar_bar_args={"n_labels": 3})
    assert list(plotter.scalar_bars.keys()) == ["density"]
    assert actor.clim == pytest.approx((BALL.min(), BALL.max()))
    plotter.update_scalar_bar_range((1, 5), "density")
    assert actor.clim == (1.0, 5.0)
    assert actor.casting.transfer.clim == (1.0, 5.0)
    actor.color = "red"
    assert not plotter.scalar_bars
    actor.color = None
    assert list(plotter.scalar_bars.keys()) == ["density"]
    plotter.remove_actor(actor)
    assert not plotter.scalar_bars


def test_the_same_name_replaces_and_memory_is_given_back(plotter):
    first = shown(plotter, name="volume")
    shot(plotter)
    assert first.explain()["gpu_bytes"] > BALL.nbytes
    second = shown(plotter, name="volume", mode="mip")
    assert list(plotter.raycast_volumes) == [second]
    assert first.explain()["gpu_bytes"] == 0
    shot(plotter)
    told = plotter.raycast_volumes.explain()[0]
    assert (told["name"], told["mode"], told["voxels_total"], told["nodes"]) == ("volume", "mip", BALL.size, 36)
    plotter.remove_actor("volume")
    assert len(plotter.raycast_volumes) == 0
    assert second.explain()["buffers"] == []


def test_skipped_parts_are_told_and_change_nothing(plotter):
    corner = np.zeros((33, 33, 33), np.float32)
    corner[2:6, 2:6, 2:6] = 1.0
    actor = shown(plotter, corner, mode="isosurface", values=0.5)
    assert actor.explain()["octree"] is None
    one = shot(plotter)
    assert actor.explain()["skipped"] > 0.9
    octree = actor.explain()["octree"]
    assert octree["bytes"] == pytest.approx(octree["share"] * corner.nbytes)
    assert octree["share"] <= 0.05
    assert octree["ms"] > 0
    actor.octree = False
    assert (shot(plotter) == one).all()
    assert actor.explain()["skipped"] == 0.0


def test_tubes_and_volumes_meet_in_one_picture(plotter):
    """A tube of 2 mm along x within fog: 8 mm of fog are before it."""
    shown(plotter, FOG, cmap=["white"], opacity=0.1, opacity_unit_distance=1.0, clim=(0, 2))
    plotter.add_spline_tubes([[(-20, 0, 0), (0, 0, 0), (20, 0, 0)]], radius=2.0, color="red", lighting=False)
    look(plotter)
    left = 0.9**8.0
    assert middle(plotter) == pytest.approx([255, 255 * (1 - left), 255 * (1 - left)], abs=3)
    assert shot(plotter)[70, 100] == pytest.approx([255 * (1 - 0.9**20.0)] * 3, abs=2)


def test_a_copy_looks_the_same(plotter):
    actor = shown(plotter, cmap="viridis", clim=(0, 9), opacity=[0, 0.2], thresholds=(1, None), step=0.3, smooth=0.5)
    actor.depth_cue = True
    picture = shot(plotter)
    twin = actor.copy()
    plotter.remove_actor(actor)
    plotter.add_actor(twin, reset_camera=False)
    assert (shot(plotter) == picture).all()
    twin._mapper.raise_pending()
    assert twin.casting.step == 0.3
    twin.sparse = 4
    assert twin.casting.sparse == 4
    with pytest.raises(ValueError, match="sparse is 3"):
        twin.sparse = 3
    twin.release()


def test_one_surface_has_the_themes_colour_and_no_bar(plotter):
    actor = shown(plotter, mode="isosurface", values=5.0)
    assert actor.color == plotter.theme.color
    assert not plotter.scalar_bars
    actor.color = None
    assert actor.color is None
    for given in ({"values": [5, 8]}, {"values": 5.0, "cmap": "gray"}, {"values": 5.0, "clim": (0, 10)}):
        assert plotter.add_raycast_volume(BALL, mode="isosurface", **given).color is None
    assert plotter.add_raycast_volume(BALL, opacity=0.1).color is None


TWO = {"mode": "isosurface", "values": [5, 8]}


@pytest.fixture(scope="module")
def held():
    """An actor that refuses what is refused in the call, too."""
    plotter = pv.Plotter(off_screen=True)
    yield plotter.add_raycast_volume(BALL, clim=(0, 8), opacity="sigmoid", **AT)
    plotter.close()


@pytest.mark.parametrize(
    ("source", "arguments", "error", "told"),
    [
        (np.zeros((4, 4)), {}, ValueError, r"shape \(4, 4\)"),
        (np.zeros((0, 4, 4)), {}, ValueError, "no voxels"),
        (np.zeros((4, 4, 4, 3)), {}, ValueError, r"shape \(4, 4, 4, 3\)"),
        (np.zeros((4, 4, 4), complex), {}, ValueError, "complex"),
        (object(), {}, TypeError, "object"),
        (BALL, {"affine": np.zeros((4, 4))}, ValueError, "affine"),
        (BALL, {"affine": np.diag([1, 0, 1, 1])}, ValueError, "flattens space"),
        (BALL, {"spacing": (1, 0, 1)}, ValueError, "spacing"),
        (BALL, {"clim": (5, 1)}, ValueError, r"clim is \(5, 1\)"),
        (BALL, {"clim": (3, 3)}, ValueError, r"clim=\(3.0, 3.0\)"),
        (BALL, {"clim": (np.nan, 1)}, ValueError, "clim"),
        (BALL, {"mode": "rays"}, ValueError, "mode is 'rays'; choose one of"),
        (BALL, {"opacity": [0, 1.5]}, ValueError, "opacity is 1.5 at place 1; give numbers from 0 to 1"),
        (BALL, {"opacity": [-0.1, 1]}, ValueError, "opacity is -0.1"),
        (BALL, {"opacity": [np.nan]}, ValueError, "opacity is nan"),
        (BALL, {"opacity": 2.0}, ValueError, "opacity is 2"),
        (BALL, {"opacity": "steep"}, ValueError, "steep"),
        (BALL, {"opacity": []}, ValueError, "opacity has the shape"),
        (BALL, {"opacity": np.zeros((3, 4))}, ValueError, r"opacity has the shape \(3, 4\)"),
        (BALL, {"opacity": np.zeros(300)}, ValueError, "300 entries for n_colors=256"),
        (BALL, {"opacity": {}}, TypeError, "opacity is a dict"),
        (BALL, {"opacity_unit_distance": 0.0}, ValueError, "unit of opacity is 0 mm"),
        (BALL, {"n_colors": 0}, ValueError, "n_colors is 0"),
        (BALL, {"n_colors": 2000}, ValueError, "n_colors is 2000, .* integrator='exponential'"),
        (BALL, {"cmap": "no such map"}, ValueError, "no such map"),
        (BALL, {"values": [np.nan], "mode": "isosurface"}, ValueError, "values of isosurfaces"),
        (BALL, {"values": [], "mode": "isosurface"}, ValueError, "1 to 8 finite numbers"),
        (BALL, {"values": np.arange(9), "mode": "isosurface"}, ValueError, "1 to 8 finite numbers"),
        (BALL, {"values": "middle"}, ValueError, "values is 'middle'"),
        (BALL, {"thresholds": (2, 1)}, ValueError, "give the lower one first"),
        (BALL, {"thresholds": (1, 2, 3)}, ValueError, "thresholds is"),
        (BALL, {"peak": np.nan, "mode": "local-mip"}, ValueError, "threshold is nan"),
        (BALL, {"step": 0.0}, ValueError, "step is 0"),
        (BALL, {"filter": "cubic"}, ValueError, "filter is 'cubic'"),
        (BALL, {"refine": "brent"}, ValueError, "refine is 'brent'"),
        (BALL, {"integrator": "euler"}, ValueError, "integrator is 'euler'"),
        (BALL, {"iterations": 0}, ValueError, "iterations is 0"),
        (BALL, {"box": (0, 1, 0, 1)}, ValueError, "box is"),
        (BALL, {"smooth": -1.0}, ValueError, "sigma"),
        (BALL, {"label": 3}, TypeError, "label"),
        (BALL, {"color": "no such colour"}, ValueError, "no such colour"),
        (BALL, {"clim": "wide"}, ValueError, "clim"),
        (BALL, {"step": "x"}, ValueError, "step is 'x'; give a number of voxels from 0.001 to 1000"),
        (BALL, {"stop": "x"}, ValueError, "stop is 'x'; give an opacity above 0, at most 1"),
        (BALL, {"homogeneous": "x"}, ValueError, "homogeneous is 'x'; give a difference of values"),
        (BALL, {"iterations": 2.5}, ValueError, "iterations is 2.5; give a whole number from 1 to 64"),
        (BALL, {"box": "corner"}, ValueError, r"box is 'corner'; give \(xmin"),
        (BALL, {"peak": "x"}, ValueError, "peak is 'x'; give the least value of a peak"),
        (BALL, {"opacity_unit_distance": "x"}, ValueError, "opacity_unit_distance is 'x'; give a length above 0, mm"),
        (BALL, {"smooth": "x"}, ValueError, "sigma='x'; expected one or three finite numbers"),
        (BALL, {"values": 1e40, "mode": "isosurface"}, ValueError, "finite numbers that float32 holds"),
        (BALL, {"cmap": []}, ValueError, "cmap is an empty list"),
        (BALL, {"spacing": "there"}, ValueError, "spacing='there'; expected "),
        (BALL, {"origin": "there"}, ValueError, "origin='there'; expected "),
        (BALL, {"affine": "there"}, ValueError, "affine='there'; expected "),
        (BALL * np.float32(1e-42), {}, ValueError, "a range that float32, in which rays are cast, cannot compute with"),
        (np.where(BALL > 5, 3e38, -3e38), {}, ValueError, r"run from -3e\+38 to 3e\+38, a range that"),
        (BALL.astype("M8[s]"), {}, ValueError, "of type datetime64"),
        (BALL.astype(object), {}, ValueError, "of type object"),
        ([[[1, 2], [3]], [[1, 2], [3, 4]]], {}, ValueError, "rows are of unlike lengths"),
        ((BALL, np.eye(3)), {}, ValueError, r"give a finite \(4, 4\) matrix"),
        (BALL, {"blending": "maximum", "mode": "mip"}, ValueError, "give one of the two"),
        (BALL, {"blending": "additive"}, ValueError, "mode 'average'"),
        (BALL, {"blending": "sum"}, ValueError, "choose one of"),
        (BALL, {"resolution": 2.0, "spacing": 2.0}, ValueError, "give one of the two"),
        (BALL, {"surface_opacities": [0.1], **TWO}, ValueError, "surface_opacities is .*one for each of the 2 values"),
        (BALL, {"surface_opacities": [0.1, 1.2], **TWO}, ValueError, "surface_opacities"),
        (BALL, {"surface_opacities": "linear", **TWO}, ValueError, "surface_opacities is 'linear'"),
        (BALL, {"surface_colors": "red", **TWO}, ValueError, "surface_colors is 'red'; give a list"),
        (BALL, {"surface_colors": ["red"], **TWO}, ValueError, "each of the 2 values"),
        (BALL, {"interactive_quality": 1.5}, ValueError, "interactive_quality is 1.5; give a number from 0 to 1"),
        (BALL, {"interactive_quality": "low"}, ValueError, "is 'low'"),
        (BALL, {"interactive_quality": True}, ValueError, "is True"),
        (BALL, {"interactive_quality": {"step": 0.5}}, ValueError, r"\['step'\] is 0.5"),
        (BALL, {"interactive_quality": {"sparse": 3}}, ValueError, r"\['sparse'\] is 3"),
        (BALL, {"interactive_quality": {"speed": 2}}, ValueError, r"has \['speed'\]"),
        (BALL, {"ray_occlusion": {"samples": 0}}, ValueError, "samples of ray occlusion is 0; give a whole number"),
        (BALL, {"ray_occlusion": {"samples": 2.5}}, ValueError, "samples of ray occlusion is 2.5"),
        (BALL, {"ray_occlusion": {"radius": np.nan}}, ValueError, "radius of ray occlusion is nan"),
        (BALL, {"ray_occlusion": {"strength": 1.5}}, ValueError, "strength of ray occlusion is 1.5"),
        (BALL, {"ray_occlusion": {"seed": -1}}, ValueError, "seed of ray occlusion is -1"),
        (BALL, {"ray_occlusion": {"bias": 1.0}}, ValueError, r"ray_occlusion has no settings \['bias'\]; it has"),
        (BALL, {"ray_occlusion": 32}, ValueError, "ray_occlusion is 32; give True, False or a dict"),
    ],
)
def test_bad_input_is_refused_in_words_and_changes_nothing(plotter, held, source, arguments, error, told):
    with pytest.raises(error, match=told):
        plotter.add_raycast_volume(source, **arguments)
    assert len(plotter.raycast_volumes) == 0
    assert not plotter.actors
    ((name, value),) = list(arguments.items())[:1] or [("", None)]
    if len(arguments) != 1 or name not in type(held).DECLARED:
        return
    before = held.casting, getattr(held, name), np.array(held.lookup_table.values), held.clim
    with pytest.raises(error, match=told):
        setattr(held, name, value)
    assert held.casting is held._mapper.casting is before[0]
    assert np.all(getattr(held, name) == before[1])
    assert (np.array(held.lookup_table.values) == before[2]).all()
    assert held.clim == before[3]


def test_settings_that_others_have_are_refused_by_name():
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_raycast_volume(BALL)
    for name in ("nan_color", "below_color", "above_color"):
        with pytest.raises(AttributeError, match=f"have no {name}: "):
            setattr(actor, name, 1)
    assert repr(actor).endswith("21 x 21 x 21 voxels, composite>")
    plotter.close()


def test_opacities_are_pyvistas_where_they_have_a_name():
    for name in ("linear", "geom_r", "sigmoid_8", "foreground"):
        assert (opacities(name, 64) * 255.0 == pv.opacity_transfer_function(name, 64)).all()
    table = pv.opacity_transfer_function("sigmoid", 64)
    assert (opacities(table, 64) == table / 255.0).all()
    assert opacities([0, 1, 0], 5).tolist() == [0.0, 0.5, 1.0, 0.5, 0.0]
    assert opacities(0.25, 3).tolist() == [0.25] * 3
    assert opacities([True, False], 2).tolist() == [1.0, 0.0]
    assert value_limits((None, 3)) == (-np.inf, 3.0)
    assert value_limits(np.float32(2)) == (2.0, np.inf)
