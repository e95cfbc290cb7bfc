"""What ``plotter.add_spline_tubes`` draws, from which sources, and how its actor changes."""

from __future__ import annotations

from dataclasses import replace

import matplotlib as mpl
import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from scipy.ndimage import map_coordinates

import pvfiblets as pf
from pvfiblets.codec.encoding.compress import compress
from pvfiblets.plotting import TubeActor
from pvfiblets.plotting.tubes.sources import with_built_in
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.tubes.measures import tube_lengths

from .views import facing_shot

FLAT = {"lighting": False, "show_scalar_bar": False, "radius": 1.6}


def mapped(cmap, fraction, n_colors=256):
    """One colour of a matplotlib map, as VTK's table of ``n_colors`` has it."""
    entry = min(int(fraction * n_colors), n_colors - 1)
    return np.round(255 * np.array(mpl.colormaps[cmap].resampled(n_colors)(entry)[:3]))


@pytest.fixture
def front(plotter):
    """Return a function: the picture from -y, 5 pixels a mm, z upwards."""
    return lambda: facing_shot(plotter)


def at(picture, x, z):
    """The pixel of a place in the plane of the picture."""
    return picture[99 - int(np.floor(5 * z)), 100 + int(np.floor(5 * x))]


def covered(picture):
    return int((picture.max(axis=2) > 0).sum())


@pytest.fixture
def bars():
    """Three bars along x, 10 mm apart in z, each of five points from -15 to 15."""
    x = np.linspace(-15.0, 15.0, 5)
    return [np.stack([x, 0 * x, 0 * x + z], axis=1) for z in (-10.0, 0.0, 10.0)]


@pytest.mark.parametrize("kind", ["list", "polydata", "streamlines", "fiblets", "tubes", "segments", "trk"])
def test_every_kind_of_source_gives_the_same_picture(plotter, bars, front, tmp_path, kind):
    lines = pf.Streamlines.from_list(bars)
    if kind == "trk":
        source = str(tmp_path / "bars.trk")
        pf.write(source, lines)
    else:
        source = {
            "list": lambda: bars,
            "polydata": lines.to_polydata,
            "streamlines": lambda: lines,
            "fiblets": lambda: compress(lines),
            "tubes": lambda: as_spline_tubes(bars, radius=1.6),
            "segments": lambda: (
                np.concatenate(bars), np.array([[5 * k + i, 5 * k + i + 1] for k in range(3) for i in range(4)])
            ),
        }[kind]()  # fmt: skip
    actor = plotter.add_spline_tubes(source, **({} if kind == "tubes" else {"radius": 1.6}), lighting=False)
    assert isinstance(actor, TubeActor)
    assert actor.tubes.n_tubes == 3
    area = covered(front()) / 25
    assert area == pytest.approx(3 * (30 * 3.2 + np.pi * 1.6**2), rel=0.02)


def test_the_radius_varies_as_it_is_given(plotter, bars, front):
    plotter.add_spline_tubes(bars[1], radius=[1.0, 2.0, 3.0, 4.0, 5.0], lighting=False)
    rows = (front().max(axis=2) > 0).sum(axis=0)
    x = (np.arange(200) + 0.5 - 100) / 5
    # A ball's outline is ahead of its middle where the radius grows: half the height is r sqrt(1 + r'^2).
    grown = (3.0 + x * 4 / 30) / np.sqrt(1 - (4 / 30) ** 2)
    inside = np.abs(x) < 12
    assert np.abs(rows[inside] / 10 - grown[inside]).max() < 0.2


def test_given_tangents_lead_the_curve(plotter, front):
    """A cubic from (-10, 0) to (10, 0) with tangents straight up and down reaches their quarter."""
    ends, tangents = np.array([(-10.0, 0, -5), (10.0, 0, -5)]), np.array([(0, 0, 48), (0, 0, -48)])
    plotter.add_spline_tubes(ends, tangents=tangents, radius=0.5, lighting=False)
    picture = front()
    assert at(picture, 0.0, -5 + 48 / 4).any()
    assert not at(picture, 0.0, -5).any()
    assert not at(picture, 0.0, -5 + 48 / 4 + 1).any()


def test_colours_of_points_lines_and_geometry(plotter, bars, front):
    lines = pf.Streamlines.from_list(bars)
    mesh = pv.wrap(lines.to_polydata())
    mesh.point_data["along"] = np.tile(np.linspace(0.0, 1.0, 5), 3)
    mesh.cell_data["weight"] = [1.0, 2.0, 3.0]
    actor = plotter.add_spline_tubes(mesh, scalars="along", cmap="viridis", **FLAT)
    picture = front()
    for x in (-13.0, -4.0, 3.1, 12.0):
        assert np.abs(at(picture, x, 0.0) - mapped("viridis", (x + 0.1 + 15) / 30)).max() <= 4
    assert actor.clim == (0.0, 1.0)
    actor.scalars = "weight"
    picture = front()
    for z, share in ((-10, 0.0), (0, 0.5), (10, 1.0)):
        assert np.abs(at(picture, 0.0, z) - mapped("viridis", share)).max() <= 1
    actor.scalars = "orientation"
    assert at(front(), 0.0, 0.0).tolist() == [255, 0, 0]
    actor.scalars = np.array([[0, 0, 255], [255, 255, 0], [0, 255, 0]], np.uint8)
    assert [at(front(), 0.0, z).tolist() for z in (-10, 0, 10)] == [[0, 0, 255], [255, 255, 0], [0, 255, 0]]
    actor.color = "magenta"
    assert at(front(), 0.0, 0.0).tolist() == [255, 0, 255]
    assert actor.scalars is None


def test_lengths_and_places_along_tubes(plotter, front):
    angle = np.linspace(0.0, np.pi, 60)
    arcs = [np.stack([r * np.cos(angle), 0 * angle, r * np.sin(angle)], axis=1) for r in (6.0, 12.0)]
    actor = plotter.add_spline_tubes(arcs, scalars="arc_length", cmap="gray", **FLAT)
    assert actor.clim == pytest.approx((0.0, 12 * np.pi), rel=1e-4)
    assert tube_lengths(actor.tubes) == pytest.approx([6 * np.pi, 12 * np.pi], rel=1e-4)
    picture = front()
    for r in (6.0, 12.0):
        for turn in (0.3, 1.0, 2.0, 2.8):
            shade = at(picture, r * np.cos(turn), r * np.sin(turn))[0]
            assert shade == pytest.approx(255 * r * turn / (12 * np.pi), abs=4)
    actor.scalars = "length"
    assert actor.clim == pytest.approx((6 * np.pi, 12 * np.pi), rel=1e-4)


def test_a_node_that_tubes_share_is_a_place_along_each(plotter, front):
    """A fork, and a ring that ends at the node where it begins: each has its own zero."""
    mesh = pv.PolyData(
        np.array([(-15.0, 0, 0), (0, 0, 0), (12, 0, 0), (0, 0, 12), (-6, 0, -6), (-12, 0, -12), (-6, 0, -18)]),
        lines=[3, 0, 1, 2, 2, 1, 3, 5, 4, 5, 6, 5, 4],
    )
    tangents = np.array([(15.0, 0, 0), (15, 0, 0), (12, 0, 0), (0, 0, 12), (-6, 0, 0), (0, 0, -6), (6, 0, 0)])
    actor = plotter.add_spline_tubes(
        mesh, tangents=tangents, radius=0.5, scalars="arc_length", cmap="gray", clim=(0, 27), lighting=False,
        show_scalar_bar=False,
    )  # fmt: skip
    measured = with_built_in(actor.tubes, "arc_length")
    along, segments = measured.values["arc_length"].values, measured.segments
    lengths = tube_lengths(actor.tubes)
    assert lengths[0] == pytest.approx(27.0)
    ends = along[segments]
    assert ends[:3] == pytest.approx(np.array([(0, 15), (15, 27), (0, lengths[1])]), rel=1e-6)
    assert (ends[3, 0], ends[-1, 1]) == pytest.approx((0.0, lengths[2]))
    assert measured.points[segments[:3]].tolist() == mesh.points[[[0, 1], [1, 2], [1, 3]]].tolist()
    picture = front()
    assert at(picture, 0.0, 11.5)[0] == pytest.approx(255 * (lengths[1] - 0.4) / 27, abs=3)
    assert at(picture, 6.0, 0.0)[0] == pytest.approx(255 * 21.1 / 27, abs=3)


def test_an_array_for_the_actors_own_nodes(plotter, bars, front):
    actor = plotter.add_spline_tubes(bars, color="white", **FLAT)
    actor.scalars = actor.tubes.points[:, 0]
    actor.cmap = "plasma"
    picture = front()
    for x in (-12.0, -3.0, 5.0, 13.0):
        assert np.abs(at(picture, x, 10.0) - mapped("plasma", (x + 0.1 + 15) / 30)).max() <= 4
    red_to_blue = np.zeros((15, 4))
    red_to_blue[:, 0], red_to_blue[:, 2] = np.tile(np.linspace(1, 0, 5), 3), np.tile(np.linspace(0, 1, 5), 3)
    red_to_blue[:, 3] = 1.0
    actor.scalars = red_to_blue
    picture = front()
    for x in (-9.0, 0.0, 9.0):
        share = (x + 0.1 + 15) / 30
        assert np.abs(at(picture, x, 0.0) - [255 * (1 - share), 0, 255 * share]).max() <= 4
    with pytest.raises(ValueError, match="15 nodes or 3 tubes"):
        actor.scalars = np.zeros(7)


def test_colours_at_points_with_alpha_are_looked_through(plotter, bars, front):
    wall = pv.Plane(center=(0, 5, 0), direction=(0, 1, 0), i_size=60, j_size=60)
    plotter.add_mesh(wall, color="blue", lighting=False)
    colours = np.tile([255, 0, 0, 128], (5, 1)).astype(np.uint8)
    plotter.add_spline_tubes(bars[1], scalars=colours, **FLAT)
    assert np.abs(at(front(), 0.0, 0.0) - [128, 0, 127]).max() <= 2


def test_nan_and_values_outside_have_their_colours(plotter, bars, front):
    actor = plotter.add_spline_tubes(
        bars, scalars=np.array([np.nan, -5.0, 5.0]), clim=(0, 1), nan_color="magenta", below_color="cyan",
        above_color="yellow", **FLAT,
    )  # fmt: skip
    picture = front()
    assert [at(picture, 0.0, z).tolist() for z in (-10, 0, 10)] == [[255, 0, 255], [0, 255, 255], [255, 255, 0]]
    actor.scalars = np.tile([0.0, 1e300, -1e300, np.inf, -np.inf], 3)  # beyond float32, and infinite
    assert at(front(), 12.0, 0.0).tolist() == [255, 0, 255]
    actor.scalars = np.repeat([0.0, 1.0, np.nan], 5)
    assert at(front(), 0.0, 10.0).tolist() == [255, 0, 255]


def test_properties_take_effect_at_the_next_render(plotter, bars, front):
    actor = plotter.add_spline_tubes(bars, color="lime", **FLAT)
    whole = front()
    actor.visibility = False
    assert covered(front()) == 0
    actor.visibility = True
    actor.opacity = 0.5
    assert np.abs(at(front(), 0.0, 0.0) - [0, 128, 0]).max() <= 1
    actor.opacity = 1.0
    actor.tubes = as_spline_tubes(bars[:2], radius=1.6)
    assert covered(front()) == pytest.approx(covered(whole) * 2 / 3, rel=0.01)
    actor.tubes = as_spline_tubes(bars, radius=1.6)
    for silhouettes in ("boxes", "pulled-boxes", "rectangles"):
        actor.silhouettes = silhouettes
        assert (front() != whole).any(axis=2).mean() < 1e-3
        assert actor.explain()["silhouettes"] == silhouettes
    for solver in ("bisection", "illinois", "itp", "newton"):
        actor.solver = solver
        assert (front() != whole).any(axis=2).mean() < 1e-3
        assert actor.explain()["solver"] == solver
    actor.culling = None
    assert (front() == whole).all()
    actor.iterations = 25
    front()
    assert actor.explain()["iterations"] == 25
    actor.tubes = as_spline_tubes(bars, radius=0.01)
    thin = covered(front())
    actor.min_width = 6
    assert covered(front()) > 4 * thin


def test_effects_of_surfaces_and_a_way_back(plotter, bars, front):
    actor = plotter.add_spline_tubes([*bars, bars[1] + (0, 4, 2.5)], color="white", **FLAT)
    before = front()
    actor.ambient_occlusion = {"radius": 5.0}
    assert (front()[before.max(axis=2) > 0] < 250).any()
    actor.ambient_occlusion = False
    actor.depth_cue = {"color": "black", "strength": 1.0, "range": (90.0, 110.0)}
    cued = front()
    assert at(cued, 0.0, 0.0)[0] > at(cued, 0.0, 2.9)[0] > 0
    actor.depth_cue = False
    actor.silhouette = {"color": "red", "width": 3, "tubes": [1]}
    picture = front()
    assert at(picture, 0.0, -1.8).tolist() == [255, 0, 0]
    assert at(picture, 0.0, -8.2).tolist() == [0, 0, 0]
    actor.silhouette = {"tubes": []}
    assert (front() == before).all()
    actor.silhouette = True
    assert at(front(), 0.0, -8.2).tolist() == [255, 255, 255]
    actor.silhouette = False
    assert (front() == before).all()


@pytest.mark.parametrize("wanted", [3, {"colour": "red"}, {"width": 99}, {"tubes": [7]}])
def test_a_silhouette_that_is_none_is_refused(plotter, bars, wanted):
    actor = plotter.add_spline_tubes(bars, radius=1.0)
    with pytest.raises((ValueError, IndexError), match="silhouette"):
        actor.silhouette = wanted
    assert actor.silhouette is False


@pytest.mark.parametrize("name", ["illuminated", "tube_shading", "tube_radius", "line_width", "halos"])
def test_settings_of_lines_say_what_to_use(plotter, bars, name):
    actor = plotter.add_spline_tubes(bars, radius=1.0)
    assert not hasattr(actor, name)
    with pytest.raises(AttributeError, match=f"{name} is for lines"):
        setattr(actor, name, True)


def test_scalars_with_tubes_that_are_made_already(bars):
    tubes = as_spline_tubes(bars, radius=1.0)
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_spline_tubes(tubes, scalars=np.arange(15.0))
    assert actor.clim == (0.0, 14.0)
    assert tubes.values == {}
    with pytest.raises(TypeError, match="with them came radius"):
        plotter.add_spline_tubes(tubes, radius=2.0)
    plotter.close()


X = np.linspace(-15.0, 15.0, 5)
BARS = [np.stack([X, 0 * X, 0 * X + z], axis=1) for z in (-10.0, 0.0, 10.0)]
FORK = (np.array([(0, 0, 0), (10, 0, 0), (20, 5, 0), (20, -5, 0)], float), np.array([(0, 1), (1, 2), (1, 3)]))


def test_computed_colours_are_those_of_the_tubes_that_show():
    actor = TubeActor(as_spline_tubes(BARS[0], radius=[1, 2, 3, 4, 5]), scalars="radius")
    assert actor.clim == (1.0, 5.0)
    actor.tubes = replace(actor.tubes, radius=2 * actor.tubes.radius)
    assert actor.clim == (2.0, 10.0)
    actor.scalars = "arc_length"
    actor.tubes = replace(actor.tubes, points=3 * actor.tubes.points)
    assert actor.clim == pytest.approx((0.0, 90.0))
    assert actor.tubes.values == {}


def test_arc_lengths_leave_the_tubes_of_the_actor_as_they_were():
    """Three tubes meet in one node that lies 10 mm, 0 mm and 0 mm along them; numbers are still given per node."""
    tubes = as_spline_tubes(FORK, tangents=np.tile([1.0, 0, 0], (4, 1)), scaled=True, radius=1.0)
    tubes = replace(tubes, tubes=np.arange(3), n_tubes=3)
    actor = TubeActor(tubes, scalars="arc_length")
    assert actor.tubes is tubes
    actor.scalars = np.arange(4.0)
    assert (actor.tubes.n_nodes, actor.clim) == (4, (0.0, 3.0))


@pytest.mark.parametrize("other", [None, BARS[0], "tubes"])
def test_other_things_than_tubes_are_refused_in_words(other):
    actor = TubeActor(as_spline_tubes(BARS, radius=1.0))
    before = actor.tubes
    with pytest.raises(TypeError, match="as_spline_tubes"):
        actor.tubes = other
    assert actor.tubes is before


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"radius": -1.0}, ValueError, "radius"),
        ({"radius": [1.0]}, ValueError, r"radius has the shape \(1,\)"),
        ({"scalars": "fa"}, KeyError, "no array 'fa'.*'arc_length'"),
        ({"scalars": np.zeros((15, 2)), "rgb": True}, ValueError, r"\(15, 2\)"),
        ({"method": "magic"}, ValueError, "method is 'magic'"),
        ({"opacity": 2}, ValueError, "opacity is 2"),
        ({"solver": "luck"}, ValueError, "solver is 'luck'"),
        ({"min_width": 1000}, ValueError, "min_width is 1000"),
        ({"scalars": "length", "clim": (2, 1)}, ValueError, "the low one first"),
        ({"scalars": "length", "n_colors": None}, ValueError, "n_colors is None"),
        ({"scalars": "length", "n_colors": 1e30}, ValueError, "n_colors is 1e"),
        ({"scalars": "length", "scalar_bar_args": {"size": 3}}, TypeError, "size"),
        ({"scalar_bar_args": "title"}, TypeError, "scalar_bar_args is 'title'"),
        ({"opacity": "linear"}, ValueError, "opacity 'linear' follows the numbers"),
        ({"silhouettes": ["boxes"]}, ValueError, r"silhouettes is \['boxes'\]"),
        ({"solver": {}}, ValueError, "solver is {}"),
        ({"iterations": "many"}, ValueError, "iterations is 'many'"),
        ({"iterations": float("inf")}, ValueError, "iterations is inf"),
        ({"min_width": None}, ValueError, "min_width is None"),
        ({"scalars": "arc_length", "scalar_slopes": np.ones(15)}, ValueError, "scalar_slopes came with 'arc_length'"),
        ({"label": 3}, TypeError, "label is 3; give a string"),
    ],
)
def test_nonsense_is_refused_in_words(plotter, arguments, error, message):
    with pytest.raises(error, match=message):
        plotter.add_spline_tubes(BARS, **arguments)
    assert not plotter.actors
    ((name, value),) = list(arguments.items())[-1:]
    if name in ("opacity", "solver", "min_width", "clim", "n_colors", "silhouettes", "iterations", "scalars"):
        actor = plotter.add_spline_tubes(BARS, scalars="length")
        before = getattr(actor, name)
        if value != "linear" and (name != "scalars" or isinstance(value, str)):
            with pytest.raises(error, match=message):
                setattr(actor, name, value)
        assert getattr(actor, name) == before


ADDS = ("add_spline_tubes", "add_halo_lines")


@pytest.fixture
def tractogram():
    random = np.random.default_rng(0)
    lines = [np.cumsum(random.random((n, 3)), axis=0).astype(np.float32) for n in (10, 20, 5)]
    fa = [random.random((len(line), 1)).astype(np.float32) for line in lines]
    return nib.streamlines.Tractogram(
        lines, data_per_point={"fa": fa}, data_per_streamline={"w": np.arange(3.0)[:, None]}, affine_to_rasmm=np.eye(4)
    )


def values_of(actor):
    drawn = actor.tubes if hasattr(actor, "tubes") else actor.lines
    held = drawn.values["fa"]
    return held.values if hasattr(held, "values") else held


@pytest.mark.parametrize("add", ADDS)
@pytest.mark.parametrize("kind", ["Tractogram", "TrkFile", "StatefulTractogram", "MultiBlock"])
def test_data_of_other_libraries_go_by_their_names(plotter, tractogram, add, kind, tmp_path):
    source = tractogram
    wanted = np.concatenate(tractogram.data_per_point["fa"])[:, 0]
    if kind == "TrkFile":
        nib.streamlines.save(tractogram, tmp_path / "lines.trk")
        source = nib.streamlines.load(tmp_path / "lines.trk")
    elif kind == "StatefulTractogram":
        dipy = pytest.importorskip("dipy.io.stateful_tractogram")
        image = nib.Nifti1Image(np.zeros((40, 40, 40), np.float32), np.eye(4))
        source = dipy.StatefulTractogram(
            tractogram.streamlines, image, dipy.Space.RASMM,
            data_per_point=tractogram.data_per_point, data_per_streamline=tractogram.data_per_streamline,
        )  # fmt: skip
    elif kind == "MultiBlock":
        source = pv.MultiBlock()
        for line, fa, w in zip(tractogram.streamlines, tractogram.data_per_point["fa"], range(3), strict=True):
            block = pv.PolyData(line, lines=[len(line), *range(len(line))])
            block.point_data["fa"], block.cell_data["w"] = fa[:, 0], [float(w)]
            source.append(block)
    actor = getattr(plotter, add)(source, scalars="fa", show_scalar_bar=False)
    np.testing.assert_allclose(values_of(actor), wanted, atol=1e-6)
    per_line = getattr(plotter, add)(source, scalars="w", cmap="gray", show_scalar_bar=False)
    assert per_line.clim == (0.0, 2.0)


SIDES = (10, 5, 8)
PLACE = np.array([[4.0, 0.5, 0.0, -18.0], [0.0, 4.0, 0.3, -9.0], [0.2, 0.0, 4.0, -14.0], [0.0, 0.0, 0.0, 1.0]])
GRAINS = np.random.default_rng(8).random(SIDES).astype(np.float32) + 0.5


def grains_at(points):
    """Values of the image as SciPy has them."""
    voxels = (np.asarray(points, float) - PLACE[:3, 3]) @ np.linalg.inv(PLACE[:3, :3]).T
    return map_coordinates(GRAINS.astype(float), voxels.T, order=1, mode="nearest")


def test_images_colour_and_widen_tubes(plotter, bars, tmp_path):
    values = grains_at(np.concatenate(bars))
    nib.save(nib.Nifti1Image(GRAINS, PLACE), tmp_path / "fa.nii.gz")
    for image in ((GRAINS, PLACE), tmp_path / "fa.nii.gz", nib.Nifti1Image(GRAINS, PLACE)):
        name = "fa" if isinstance(image, type(tmp_path)) else "volume"
        actor = plotter.add_spline_tubes(bars, scalars=image, radius=image, show_scalar_bar=False)
        own = plotter.add_spline_tubes(bars, scalars=values, radius=values, show_scalar_bar=False)
        assert actor.scalars == name
        for found, wanted in ((actor.tubes.values[name], own.tubes.values["Data"]), (actor.tubes, own.tubes)):
            for field in ("values", "slopes") if found is actor.tubes.values[name] else ("radius", "radius_slopes"):
                np.testing.assert_allclose(getattr(found, field), getattr(wanted, field), atol=1e-5)
        own.scalars = image  # and later
        assert own.scalars == name
        np.testing.assert_allclose(own.tubes.values[name].values, values, atol=1e-5)
    fork = pv.PolyData(np.array([[0, 0, 0], [5, 0, 0], [9, 3, 0], [9, -3, 0.0]]), lines=[3, 0, 1, 2, 2, 1, 3])
    shared = plotter.add_spline_tubes(fork, radius=(GRAINS, PLACE))
    wanted = np.sort(grains_at(fork.points))
    np.testing.assert_allclose(np.unique(shared.tubes.radius.round(6)), wanted, atol=1e-5)


def test_what_images_cannot_say_of_tubes_is_told(plotter, bars):
    half = (GRAINS[:5], PLACE)
    with pytest.raises(ValueError, match=r"radius 3 \(line 0\) is nan, expected finite numbers .* outside of the"):
        plotter.add_spline_tubes(bars, radius=half)
    for what in ("radius", "scalars"):
        with pytest.raises(ValueError, match=r"the affine of the image is .*; give a finite \(4, 4\) matrix"):
            plotter.add_spline_tubes(bars, **{what: (GRAINS, np.eye(3))})
        with pytest.raises(FileNotFoundError, match="none.mif"):
            plotter.add_spline_tubes(bars, **{what: "/nowhere/none.mif"})
    assert not plotter.actors
    actor = plotter.add_spline_tubes(bars, scalars=half, radius=1.0, nan_color="magenta", lighting=False)
    assert np.isnan(actor.tubes.values["volume"].values).sum() > 3


def test_the_radius_is_that_of_the_tubes_and_not_of_what_they_were_made_of(plotter):
    line = pv.MultipleLines([(0.0, 0.0, 0.0), (5.0, 1.0, 0.0), (9.0, 0.0, 0.0)])
    line["radius"] = [1.0, 2.0, 3.0]
    actor = plotter.add_spline_tubes(line, radius="radius", scalars=None)
    actor.tubes = replace(actor.tubes, radius=1.5 * actor.tubes.radius)
    actor.scalars = "radius"
    assert actor.clim == (1.5, 4.5)


@pytest.mark.parametrize("method", ["finite", "catmull-rom"])
def test_simplified_tubes_look_the_same(plotter, front, method):
    t = np.linspace(0.0, 4 * np.pi, 1500)
    spring = np.stack([14 * np.cos(t), 14 * np.sin(t), 2 * t - 12], axis=1)
    branch = np.stack([14 - 0.02 * t**3, 0 * t, 1.2 * t - 12], axis=1)
    whole = as_spline_tubes([spring, branch], radius=np.tile(1.5 + 0.5 * np.sin(t), 2),
                            scalars=np.tile(np.cos(t), 2), method=method)  # fmt: skip
    small = whole.simplify(0.02)
    assert small.n_segments < 0.05 * whole.n_segments
    actor = plotter.add_spline_tubes(whole, scalars="scalars", clim=(-1, 1), show_scalar_bar=False)
    before = front()
    actor.tubes = small
    after = front()
    assert covered(before) > 4000
    # The surfaces are within 0.04 mm of each other, a fifth of a pixel: few pixels of an edge are another's.
    assert (np.abs(after - before).max(axis=2) > 8).mean() < 1e-3
