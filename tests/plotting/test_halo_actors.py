"""Actors of lines and points with halos: every setting is live, and what cannot be is refused in words."""

from __future__ import annotations

from dataclasses import replace

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from scipy.ndimage import map_coordinates

import pvfiblets as pf
from pvfiblets import compress, write
from pvfiblets.halos import HaloLines, HaloPoints

from .views import facing as facing_camera
from .views import facing_shot as shot
from .views import shot as picture_of

PIXELS = 5.0  # a mm in the view `flat`
GREEN, WHITE, BLACK, BACK = (0, 255, 0), (255, 255, 255), (0, 0, 0), (64, 64, 64)
BAR = np.array([(x, 0.0, 0.0) for x in np.linspace(-15.0, 15.0, 31)])
LOOKS = {"line_width": 2.0, "strip_width": 8.0, "max_displacement": 4.0, "width_cue": 0.0, "tapering": False,
         "smooth": False, "min_width": 0.0, "light_on_dark": False}  # fmt: skip
OF_POINTS = {"point_size": 2.0, "halo_size": 8.0, "max_displacement": 4.0, "width_cue": 0.0, "smooth": False,
             "min_width": 0.0, "light_on_dark": False}  # fmt: skip


@pytest.fixture
def stage(plotter):
    """A plotter of 200 x 200 pixels, 5 pixels a mm, seen from -y."""
    plotter.set_background([part / 255 for part in BACK])
    return plotter


def widths(plotter, x, line=GREEN, halo=WHITE):
    """Width of line and of halos, mm, in the column of `x`."""
    column = shot(plotter)[:, round(100 + PIXELS * x)]
    return tuple(float((column == np.array(colour)).all(axis=1).sum()) / PIXELS for colour in (line, halo))


def about(wanted):
    return pytest.approx(wanted, abs=1.01 / PIXELS)


def near(*wanted):
    return pytest.approx(wanted, abs=1.01 / PIXELS)


def add(plotter, source=BAR, **arguments):
    arguments = {"color": "lime", "show_scalar_bar": False, **LOOKS, **arguments}
    return plotter.add_halo_lines(source, **arguments)


def test_every_width_is_live(stage):
    actor = add(stage)
    assert widths(stage, 7) == near(2, 6)
    actor.line_width = 4.0
    assert widths(stage, 7) == near(4, 4)
    actor.strip_width = 4.0
    assert widths(stage, 7) == near(4, 0)
    actor.strip_width, actor.line_width = 10.0, 0.1
    actor.min_width = 6.0
    assert widths(stage, 7) == near(1.2, 9.9)
    actor.line_width, actor.min_width = 2.0, 0.0
    other = stage.add_halo_lines([[(7, 3, -15), (7, 3, 15)]], **{**LOOKS, "strip_width": 2.0}, color="red")
    for displacement, hidden in ((10.0, 3.0), (6.0, 5.0), (0.0, 10.0)):
        actor.max_displacement = displacement
        column = shot(stage)[:, 135]
        red = (column == np.array((255, 0, 0))).all(axis=1).sum() / PIXELS
        assert red == pytest.approx(30 - hidden, abs=2.01 / PIXELS)
    actor.max_displacement, actor.displacement = 6.0, "square"  # hidden where r^2 < 1/2
    assert widths(stage, 7)[1] == about(10 * np.sqrt(0.5) - 2)
    actor.displacement = lambda x: x**2
    assert widths(stage, 7)[1] == about(10 * np.sqrt(0.5) - 2)
    actor.displacement = [0.0, 1.0, 1.0]
    assert widths(stage, 7)[1] == about(10 * 0.25 - 2)
    assert actor.displacement == [0.0, 1.0, 1.0]
    stage.remove_actor(other)


def test_what_is_left_out_is_measured(stage):
    rows = [BAR + (0, 0, z) for z in np.arange(-8.0, 9.0, 2.0)]
    actor = stage.add_halo_lines(rows)
    look = actor.look
    assert 0.0 < look.line_width < look.strip_width
    assert look.max_displacement > 0.0
    wide = stage.add_halo_lines([4.0 * row for row in rows])
    for name in ("line_width", "strip_width", "max_displacement"):
        assert getattr(wide, name) == pytest.approx(4.0 * getattr(actor, name), rel=0.05)
    wide.lines = actor.lines  # measured anew
    assert wide.look == look
    actor.line_width = 0.3
    assert actor.line_width == 0.3
    actor.line_width = None
    assert actor.look == look
    narrow = stage.add_halo_lines(rows, strip_width=0.01)
    assert narrow.line_width <= 0.005
    assert stage.add_halo_lines(rows, line_width=5.0).strip_width > 5.0


def test_depth_cueing_by_width_is_live(stage):
    near_and_far = [BAR + (0, y, z) for y, z in ((-20, -10), (20, 10))]
    actor = add(stage, near_and_far)

    def each():
        column = (shot(stage)[:, 135] == np.array(GREEN)).all(axis=1)
        return column[:100].sum() / PIXELS, column[100:].sum() / PIXELS

    assert each() == near(2, 2)
    actor.width_cue = 0.5
    assert each() == near(1, 2)


def test_ends_taper_by_their_settings(stage):
    actor = add(stage)
    assert widths(stage, -14.5) == near(2, 6)
    assert actor.tapering == (0, 0.2)
    actor.tapering = (10, 0.2)
    for x in (-14.5, -10.5, -5.5, 6.5, 12.5):
        u = min(x + 15.1, 15 - (x + 0.1)) / 10 * 0.2
        share = np.sqrt(min(1, u / 0.2) * (2 - min(1, u / 0.2)))
        assert widths(stage, x) == pytest.approx((2 * share, 6 * share), abs=2.01 / PIXELS)
    actor.t_tapered = 0.5
    assert actor.tapering == (10, 0.5)
    actor.n_tapered = 3
    assert actor.tapering == (3, 0.5)
    actor.tapering = True
    assert actor.tapering == (2, 0.2)
    actor.tapering = False
    assert widths(stage, -14.5) == near(2, 6)


def test_the_threshold_is_live_and_copies_nothing(stage):
    actor = add(stage, filter_by="arc_length", threshold=10.0, filter_taper=0.0)
    assert [widths(stage, x)[0] for x in (-7, -4, 12)] == [0.0, about(2), about(2)]
    buffers = {row["name"]: row["bytes"] for row in actor.explain()["buffers"]}
    engine = actor.mapper._renderers()[0]
    actor.threshold = (10.0, 20.0)
    assert [widths(stage, x)[0] for x in (-7, 0, 7)] == [0.0, about(2), 0.0]
    actor.threshold = (None, 20.0)
    assert [widths(stage, x)[0] for x in (-7, 0, 7)] == [about(2), about(2), 0.0]
    assert actor.mapper._renderers()[0] is engine
    assert {row["name"]: row["bytes"] for row in actor.explain()["buffers"]} == buffers
    actor.filter_by = None
    assert actor.threshold is None
    assert [widths(stage, x)[0] for x in (-7, 0, 7)] == [about(2)] * 3
    assert sum(row["bytes"] for row in actor.explain()["buffers"]) < sum(buffers.values())


def test_filtered_ends_taper_over_two_segments_by_default(stage):
    actor = add(stage, filter_by="arc_length", threshold=10.0)
    assert actor.filter_taper == pytest.approx(2.0)
    for x in (-4.5, -3.9, -2.5):
        share = min(1.0, (x + 0.1 + 5.0) / 2.0)
        share = np.sqrt(share * (2 - share))
        assert widths(stage, x) == pytest.approx((2 * share, 6 * share), abs=2.01 / PIXELS)  # two edges each
    actor.filter_taper = 0.0
    assert widths(stage, -4.5) == near(2, 6)
    actor.filter_taper = None
    assert actor.filter_taper == pytest.approx(2.0)


def test_lines_are_filtered_by_numbers_of_any_kind(stage):
    rows = [BAR + (0, 0, z) for z in (-12.0, 0.0, 12.0)]
    actor = add(stage, rows, filter_by=[5.0, np.nan, 7.0])

    def present():
        column = (shot(stage)[:, 135] == np.array(GREEN)).all(axis=1)
        return [bool(column[100 - 60 * z - 3 : 100 - 60 * z + 3].any()) for z in (-1, 0, 1)]

    assert present() == [True, False, True]
    actor.threshold = 6
    assert actor.filter_by == "filter"
    assert present() == [False, False, True]
    actor.filter_by = np.repeat([1.0, 8.0, 9.0], 31)
    assert present() == [False, True, True]
    actor.filter_by = "length"
    assert present() == [True, True, True]
    actor.threshold = 31.0
    assert present() == [False, False, False]


def test_points_have_sizes_and_filters(stage):
    points = np.array([(-10.0, 0, 0), (0, 0, 0), (10, 0, 0)])
    actor = stage.add_halo_points(points, color="lime", **OF_POINTS, filter_by=[1, 2, 3])
    assert [widths(stage, x) for x in (-10, 0, 10)] == [near(2, 6)] * 3
    actor.point_size = 3.0
    assert widths(stage, 0) == near(3, 5)
    actor.halo_size = 5.0
    assert widths(stage, 0) == near(3, 2)
    actor.threshold = 1.5
    assert [widths(stage, x)[0] for x in (-10, 0, 10)] == [0.0, about(3), about(3)]
    assert actor.pick_at(150, 100) == 2
    assert actor.pick_at(50, 100) is None
    actor.points = HaloPoints(points[1:] * 0.5, {"filter": np.array([0.0, 9.0])})
    assert [widths(stage, x)[0] for x in (0, 5)] == [0.0, about(3)]
    with pytest.raises(ValueError, match=r"halo_size is 1\.0; give at least point_size, 2\.0"):
        stage.add_halo_points(BAR, point_size=2.0, halo_size=1.0)
    with pytest.raises(ValueError, match=r"point_size is -2\.0"):
        stage.add_halo_points(BAR, point_size=-2.0)
    with pytest.raises(KeyError, match="orientation"):
        stage.add_halo_points(HaloPoints(BAR), scalars="orientation")


@pytest.mark.parametrize("add_halos", ["add_halo_lines", "add_halo_points"])
def test_default_colours_follow_the_background(plotter, add_halos):
    sizes = LOOKS if add_halos == "add_halo_lines" else OF_POINTS
    actor = getattr(plotter, add_halos)(BAR, **{**sizes, "light_on_dark": None})
    for ground, ink in (("black", WHITE), ("white", BLACK), ("#303060", WHITE), ("#e0e0c0", BLACK)):
        plotter.background_color = ground
        image, rest = shot(plotter), pv.Color(ground).int_rgb
        assert {tuple(map(int, colour)) for colour in np.unique(image.reshape(-1, 3), axis=0)} == {rest, ink}
        assert (image == np.array(ink)).all(axis=2).sum() > 500
        assert (actor.color, actor.halo_color) == (pv.Color(ink), "background")
        assert actor.legend_color == pv.Color(ink)
    plotter.set_background("black", top="#202020")  # dark at both ends
    assert (shot(plotter)[100] == np.array(WHITE)).all(axis=1).any()
    assert actor.copy().light_on_dark is None


def test_an_actor_in_two_subplots_has_the_ink_of_each():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 100), shape=(1, 2))
    actor = plotter.add_halo_lines(BAR, **{**LOOKS, "light_on_dark": None})
    plotter.set_background("white", all_renderers=False)
    plotter.subplot(0, 1)
    plotter.add_actor(actor)
    plotter.set_background("black", all_renderers=False)
    plotter.disable_anti_aliasing()
    for number in (0, 1):
        plotter.subplot(0, number)
        facing_camera(plotter)
    image = picture_of(plotter)
    assert (image[:, :100].min(), image[:, :100].max()) == (0, 255)
    assert (image[40, 50], image[40, 150]) == (pytest.approx(255), pytest.approx(0))
    assert (image[50, 50], image[50, 150]) == (pytest.approx(0), pytest.approx(255))
    plotter.close()


def test_dark_and_light_change_places_and_what_was_given_stays(stage):
    actor = stage.add_halo_lines(BAR, **LOOKS)
    assert widths(stage, 7, BLACK, WHITE) == near(2, 6)
    assert (actor.color, actor.halo_color) == (pv.Color("black"), pv.Color("white"))
    actor.light_on_dark = True
    assert widths(stage, 7, WHITE, BLACK) == near(2, 6)
    actor.color = "lime"
    assert widths(stage, 7, GREEN, BLACK) == near(2, 6)
    actor.light_on_dark = False
    assert widths(stage, 7, GREEN, WHITE) == near(2, 6)
    actor.halo_color = "blue"
    assert widths(stage, 7, GREEN, (0, 0, 255)) == near(2, 6)
    actor.halo_color = "background"
    assert actor.halo_color == "background"
    assert widths(stage, 7, GREEN, BACK)[1] == about(38)
    actor.halo_color, actor.color = None, None
    assert widths(stage, 7, BLACK, WHITE) == near(2, 6)
    actor.scalars, actor.light_on_dark = "orientation", True
    assert widths(stage, 7, (255, 0, 0), BLACK) == near(2, 6)
    twin = actor.copy()
    assert (twin.look, twin.light_on_dark, twin.scalars) == (actor.look, True, "orientation")


def test_colours_by_line_by_point_and_by_name(stage, colours_in):
    rows = [BAR + (0, 0, z) for z in (-10.0, 10.0)]
    actor = add(stage, rows, color=None, scalars=np.array([(255, 0, 0), (0, 0, 255)], np.uint8))
    stage.set_background("black")
    assert colours_in(shot(stage)) == {(255, 0, 0), (0, 0, 255), WHITE}
    actor.scalars = np.tile([(0.0, 1.0, 0.0)], (62, 1))
    assert colours_in(shot(stage)) == {GREEN, WHITE}
    actor.scalars = np.repeat([0.0, 1.0], 31)
    actor.cmap, actor.clim = ["red", "lime"], (0, 1)
    assert colours_in(shot(stage)) == {(255, 0, 0), GREEN, WHITE}
    actor.scalars = [1.0, np.nan]
    actor.nan_color = "yellow"
    assert {(255, 255, 0), GREEN} < colours_in(shot(stage))
    actor.scalars = "Data"  # what was there per point
    assert colours_in(shot(stage)) == {(255, 0, 0), GREEN, WHITE}


def test_data_of_a_polydata_colour_and_filter_it(stage):
    mesh = pv.merge([pv.lines_from_points(BAR + (0, 0, z)) for z in (-10.0, 10.0)])
    mesh.cell_data["each"] = np.array([1.0, 2.0] if mesh.n_cells == 2 else np.arange(mesh.n_cells))
    mesh.point_data["x"] = mesh.points[:, 0]
    actor = add(stage, mesh, color=None, scalars="x", filter_by="each", threshold=0, show_scalar_bar=True)
    assert (actor.scalars, actor.filter_by, actor.clim) == ("x", "each", (-15.0, 15.0))
    assert list(stage.scalar_bars.keys()) == ["x"]
    with pytest.raises(KeyError, match="nothere"):
        stage.add_halo_lines(mesh, scalars="nothere")
    with pytest.raises(KeyError, match="nothere"):
        actor.scalars = "nothere"
    assert actor.scalars == "x"
    with pytest.raises(KeyError, match="filter_by is 'nothere'"):
        actor.filter_by = "nothere"
    assert actor.filter_by == "each"


def test_other_lines_take_the_place(stage):
    actor = add(stage, [BAR, BAR + (0, 0, 8)], color=None, scalars=[1.0, 2.0])
    with pytest.raises(ValueError, match="3 lines"):
        actor.lines = HaloLines(np.tile(BAR, (3, 1)), [0, 31, 62, 93])
    assert actor.lines.n_lines == 2
    actor.scalars = None
    actor.lines = HaloLines(BAR + (0, 0, -10), [0, 31])
    shown = (shot(stage)[:, 135] == np.array(BLACK)).all(axis=1)
    assert shown[150] or shown[149]
    assert not shown[:130].any()
    with pytest.raises(TypeError, match=r"pvfiblets\.halos\.build\.as_halo_lines"):
        actor.lines = HaloPoints(BAR)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [({"line_width": 0.0}, r"line_width is 0\.0; give a number of mm, above 0"),
     ({"line_width": "wide"}, "line_width is 'wide'"), ({"line_width": np.nan}, "line_width is nan"),
     ({"line_width": 2.0, "strip_width": 1.0}, r"strip_width is 1\.0; give at least line_width, 2\.0"),
     ({"max_displacement": -1.0}, r"max_displacement is -1\.0"), ({"displacement": "cubic"}, "displacement is 'cubic'"),
     ({"displacement": [0.0, 2.0]}, "2 at 1"), ({"displacement": lambda x: x - 0.5}, "-0.5"),
     ({"tapering": "soft"}, "tapering is 'soft'"), ({"tapering": (2, 0.7)}, r"t_tapered is 0\.7"),
     ({"tapering": (2.5, 0.2)}, r"n_tapered is 2\.5"), ({"width_cue": 1.5}, r"width_cue is 1\.5"),
     ({"min_width": -1}, "min_width is -1"),
     ({"threshold": 1.0}, r"threshold is 1\.0, but there are no numbers to filter by"),
     ({"filter_by": "arc_length", "threshold": "high"}, "threshold is 'high'"),
     ({"filter_by": "arc_length", "threshold": (2.0, 1.0)}, r"thresholds are 2\.0 and 1\.0"),
     ({"filter_by": "arc_length", "threshold": (1, 2, 3)}, r"threshold is \(1, 2, 3\)"),
     ({"filter_by": "arc_length", "filter_taper": -1}, "filter_taper is -1"), ({"filter_by": np.zeros(7)}, "7"),
     ({"scalars": np.zeros((31, 5)), "rgb": True}, "5"), ({"opacity": 2.0}, "opacity is 2"),
     ({"culling": "magic"}, "culling is 'magic'"), ({"halo_color": "nocolour"}, "nocolour")],
    ids=lambda value: "" if isinstance(value, str) else "-".join(value),
)  # fmt: skip
def test_what_has_no_meaning_is_refused_and_leaves_nothing_behind(stage, arguments, message):
    with pytest.raises((ValueError, TypeError), match=message):
        stage.add_halo_lines(BAR, **arguments)
    assert not stage.actors
    if len(arguments) == 1:
        ((name, value),) = arguments.items()
        actor = add(stage)
        before = actor.look
        with pytest.raises((ValueError, TypeError)):
            setattr(actor, name, value)
        assert actor.look == before


def test_empty_data_draw_nothing(stage):
    with pytest.warns(UserWarning, match="no lines: nothing is drawn"):
        lines = stage.add_halo_lines(HaloLines(np.zeros((0, 3)), [0]))
    with pytest.warns(UserWarning, match="nothing is drawn"):
        points = stage.add_halo_points(np.zeros((0, 3)))
    with pytest.warns(UserWarning, match="no lines: nothing is drawn"):
        single = stage.add_halo_lines([BAR[:1]])
    assert (shot(stage) == np.array(BACK)).all()
    assert replace(lines.look, n_tapered=0) == lines.look or lines.look.n_tapered == 2
    assert (points.look.line_width, single.look.line_width) > (0.0, 0.0)


def test_lines_and_points_come_from_every_kind_of_source(plotter, three_lines, tmp_path):
    lines = [np.array([(-10.0, 0, z), (0, 0, z + 2), (10, 0, z)]) for z in (-6.0, 0.0, 6.0)]
    points, cloud = np.concatenate(lines), pv.PolyData(np.concatenate(lines))
    cloud.save(tmp_path / "cloud.ply")
    write(tmp_path / "lines.tck", three_lines)
    for source, n_segments in (
        (pv.merge([pv.lines_from_points(line) for line in lines]), 6), (three_lines, 120), (compress(three_lines), 120),
        (lines[0], 2), (lines, 6), ((points, np.array([(0, 1), (1, 2), (3, 4)])), 3),
        (HaloLines(points, [0, 3, 6, 9]), 6), (tmp_path / "lines.tck", 120), (str(tmp_path / "lines.tck"), 120),
    ):  # fmt: skip
        assert plotter.add_halo_lines(source).lines.n_segments == n_segments
    for source, n_points in (
        (cloud, 9), (pv.ImageData(dimensions=(2, 3, 4)), 24), (three_lines, 123), (lines[0], 3),
        (HaloPoints(lines[0]), 3), (tmp_path / "cloud.ply", 9),
    ):  # fmt: skip
        assert plotter.add_halo_points(source).points.n_points == n_points


SIDES = (7, 6, 7)
PLACE = np.array([[4.0, 0.5, 0.0, -14.0], [0.0, 4.0, 0.3, -9.0], [0.2, 0.0, 4.0, -12.0], [0.0, 0.0, 0.0, 1.0]])
GRAINS = np.random.default_rng(8).random(SIDES).astype(np.float32)


def grains_at(points):
    """Values of the image as SciPy has them, NaN outside."""
    voxels = (np.asarray(points, float) - PLACE[:3, 3]) @ np.linalg.inv(PLACE[:3, :3]).T
    inside = ((voxels >= -0.5) & (voxels <= np.array(SIDES) - 0.5)).all(axis=1)
    return np.where(inside, map_coordinates(GRAINS.astype(float), voxels.T, order=1, mode="nearest"), np.nan)


def forms_of(path):
    """The image in every form."""
    nib.save(nib.Nifti1Image(GRAINS, PLACE), path)
    return [(GRAINS, PLACE), path, str(path), nib.load(path)]


def test_images_colour_and_filter_lines(stage, tmp_path):
    rows = [BAR + (0, 0, z) for z in (-8.0, 0.0, 8.0)]
    values = grains_at(np.concatenate(rows))
    assert 5 < np.isnan(values).sum() < 40
    for image in forms_of(tmp_path / "fa.nii.gz"):
        name = "fa" if isinstance(image, (str, type(tmp_path))) else "volume"
        actor = add(stage, rows, filter_by=image, threshold=0.5, scalars=image, color=None, cmap="plasma")
        assert actor.filter_by == actor.scalars == name
        np.testing.assert_allclose(actor.lines.values[name], values, atol=1e-5)
        drawn = shot(stage)
        stage.remove_actor(actor)
        own = add(stage, rows, filter_by=values, threshold=0.5, scalars=values, color=None, cmap="plasma")
        np.testing.assert_array_equal(drawn, shot(stage))
        own.scalars = own.filter_by = None
        own.scalars, own.filter_by = image, image  # and later
        own.threshold = 0.5
        assert own.filter_by == name
        np.testing.assert_allclose(own.lines.values[name], values, atol=1e-5)
        stage.remove_actor(own)
    points = stage.add_halo_points(BAR, scalars=(GRAINS, PLACE), filter_by=(GRAINS, PLACE), threshold=0.4, **OF_POINTS)
    np.testing.assert_allclose(points.points.values["volume"], grains_at(BAR), atol=1e-5)
    held = {"volume": np.arange(31.0)}  # an array of that name stays what it is
    named = add(stage, pf.Streamlines.from_list([BAR], per_point=held), scalars="volume", filter_by=(GRAINS, PLACE))
    np.testing.assert_array_equal(named.lines.values["volume"], np.arange(31.0))
    np.testing.assert_allclose(named.lines.values["volume 1"], grains_at(BAR), atol=1e-5)


@pytest.mark.parametrize("what", ["scalars", "filter_by"])
def test_what_is_no_image_is_refused_in_words(stage, what):
    for image, error, told in (
        ((GRAINS, np.eye(3)), ValueError, r"the affine of the image is .*; give a finite \(4, 4\) matrix"),
        ((np.zeros((3, 3, 3, 2)), PLACE), ValueError, r"the image has the shape \(3, 3, 3, 2\); three axes"),
        ("/nowhere/fa.mif", FileNotFoundError, "fa.mif"),
    ):
        with pytest.raises(error, match=told):
            add(stage, **{what: image})
    assert not stage.actors
