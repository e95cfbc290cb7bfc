"""Selections: what they hold, how they look, what they measure, and files of them."""

from __future__ import annotations

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.plotting.fiblets.profiles import Profile
from pvfiblets.plotting.fiblets.selection_overlay import part_of_filter
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines

mpl.use("Agg")


@pytest.fixture
def rods(plotter):
    """Return an actor of 30 red rods along x, 2 mm apart in y, seen from above, and a function: their colours."""
    along = np.linspace(0, 40, 81)[:, None] * np.array((1.0, 0.0, 0.0))
    lines = Streamlines.from_list([along + np.array((0, 2.0 * i, 0)) for i in range(30)])
    lines.per_streamline["row"] = np.arange(30.0)
    actor = plotter.add_fiblets(lines, color="red", lighting=False)
    plotter.view_xy()
    plotter.show(auto_close=False)

    def picture():
        plotter.render()
        plotter.render()
        return plotter.screenshot(return_img=True)[::-1, :, :3].astype(int)

    def place(i, x=20.0):
        plotter.renderer.SetWorldPoint(x, 2.0 * i, 0.0, 1.0)
        plotter.renderer.WorldToDisplay()
        return np.round(plotter.renderer.GetDisplayPoint()[:2]).astype(int)

    def colours():
        image = picture()
        found = []
        for i in range(30):
            x, y = place(i)
            part = image[y - 1 : y + 2, x]
            found.append(part[part.sum(axis=1).argmax()])
        return np.array(found)

    actor_tools = type("Tools", (), {"picture": staticmethod(picture), "colours": staticmethod(colours)})
    return actor, actor_tools


def test_selections_are_sets(rods):
    actor, _ = rods
    rng = np.random.default_rng(7)
    expected = np.zeros(30, bool)
    for mode in ("replace", "add", "toggle", "remove", "add", "toggle", "replace", "remove"):
        ids = rng.integers(0, 30, 12)
        given = np.isin(np.arange(30), ids)
        actor.select(ids if mode != "add" else given, mode=mode)
        expected = {
            "replace": given,
            "add": expected | given,
            "remove": expected & ~given,
            "toggle": expected ^ given,
        }[mode]
        assert np.array_equal(actor.selection, np.flatnonzero(expected))
    actor.selection = slice(3, 9)
    assert actor.selection.tolist() == [3, 4, 5, 6, 7, 8]
    assert actor.selection.dtype == np.int64
    actor.invert_selection()
    assert len(actor.selection) == 24
    actor.deselect([0, -1])
    assert len(actor.selection) == 22
    actor.deselect()
    assert len(actor.selection) == 0
    actor.invert_selection()
    assert len(actor.selection) == 30
    actor.select([1], mode="remove")
    actor.deselect()
    actor.select([1], mode="remove")
    assert len(actor.selection) == 0


def test_bad_input_is_refused_and_changes_nothing(rods):
    actor, _ = rods
    actor.select([4])
    with pytest.raises(IndexError, match="streamline 30 is not among the 30"):
        actor.select([2, 30])
    with pytest.raises(IndexError, match=r"mask of shape \(29,\)"):
        actor.select(np.ones(29, bool))
    with pytest.raises(IndexError, match="whole numbers"):
        actor.select([0.5])
    with pytest.raises(ValueError, match="replace, add, remove, toggle"):
        actor.select([1], mode="xor")
    with pytest.raises(ValueError, match="distance"):
        actor.grow_selection(-1.0)
    for wrong in ({"dim": 2.0}, {"width": 0.0}, {"radius": -1.0}, {"color": "nocolour"}):
        with pytest.raises(ValueError, match="dim|width|radius|color"):
            actor.selection_style(**wrong)
    assert actor.selection.tolist() == [4]
    assert actor.selection_style() == type(actor.selection_style())()


def test_an_empty_selection_costs_nothing(rods):
    actor, tools = rods
    before, features = tools.picture(), actor.explain()["features"]
    actor.selection_style(width=5, color="cyan", silhouette=True)
    actor.select([3, 5])
    assert not np.array_equal(tools.picture(), before)
    actor.deselect()
    assert np.array_equal(tools.picture(), before)
    assert actor.explain()["features"] == features
    assert not actor.mapper.effects
    assert len(actor.picking_layers) == 1


def test_wider_lines_follow_their_actor(rods, plotter):
    actor, tools = rods
    actor.select([10])
    actor.selection_style(width=7, color="lime", dim=0.0)
    thick = np.array((0, 255, 0))

    def rows():
        return (tools.picture() == thick).all(axis=-1).any(axis=1).sum()

    assert rows() == 7
    actor.visibility = False
    assert rows() == 0
    actor.visibility = True
    actor.position = (0, 5, 0)
    moved = (tools.picture() == thick).all(axis=-1).any(axis=1)
    actor.position = (0, 0, 0)
    back = (tools.picture() == thick).all(axis=-1).any(axis=1)
    assert moved.sum() == back.sum() == 7
    assert np.flatnonzero(moved)[0] > np.flatnonzero(back)[0]
    actor.mapper.filtering = Filter(np.arange(30) != 10)
    assert rows() == 0
    actor.mapper.filtering = None
    actor.selection_style(color=None)
    actor.color = "blue"
    assert (tools.picture() == (0, 0, 255)).all(axis=-1).any(axis=1).sum() >= 7
    actor.scalars = "row"
    colour = tools.colours()[10]
    actor.selection_style(width=None)
    assert (tools.colours()[10] == colour).all()
    actor.selection_style(width=7)
    props = plotter.renderer.GetViewProps().GetNumberOfItems()
    plotter.remove_actor(actor)
    assert plotter.renderer.GetViewProps().GetNumberOfItems() <= props - 2
    assert not (tools.picture() != 0).any()


def test_tubes_of_selected_streamlines_have_their_radius(rods, plotter):
    actor, tools = rods
    plotter.enable_parallel_projection()
    actor.select([12])
    actor.selection_style(as_tubes=True, radius=0.8, color="lime", dim=0.5)
    high = (tools.picture() == (0, 255, 0)).all(axis=-1)
    pixel = 2.0 * plotter.camera.parallel_scale / plotter.window_size[1]
    assert abs(high.any(axis=1).sum() * pixel - 1.6) <= 1.5 * pixel
    assert abs(high.any(axis=0).sum() * pixel - 41.6) <= 1.5 * pixel  # round ends stand out
    assert {"STREAMLINE_MASK"}.isdisjoint(actor.explain()["features"])
    y, x = np.argwhere(high).mean(axis=0).round().astype(int)
    picked = actor.pick_polygon([(x, y)], tolerance=0.6)
    assert picked.ids.tolist() == [12]


def test_other_fiblets_keep_the_selection_if_ids_mean_the_same(rods, three_lines):
    actor, tools = rods
    actor.selection_style(width=4)
    actor.select([1, 5])
    actor.scalars = np.arange(actor.fiblets.n_points, dtype=float)
    tools.picture()
    assert actor.selection.tolist() == [1, 5]
    actor.color = "red"
    actor.fiblets = pf.compress(three_lines)
    tools.picture()
    assert len(actor.selection) == 0


def test_a_filter_of_a_part_keeps_the_same_points():
    fiblets = pf.compress(brain_streamlines(40), order="hilbert")
    rng = np.random.default_rng(3)
    kept = rng.random(fiblets.n_points) < 0.5  # in coded order
    words = np.packbits(np.pad(kept, (0, -len(kept) % 32 + 32)), bitorder="little").view("<u4").astype(np.uint32)
    ids = np.sort(rng.choice(40, 15, replace=False))
    mask = rng.random(40) < 0.5
    part = fiblets.extract(ids)
    found = part_of_filter(Filter(mask, words), fiblets, ids)
    assert np.array_equal(found.streamlines, mask[ids])
    bits = np.unpackbits(found.points.astype("<u4").view(np.uint8), bitorder="little")[: part.n_points]
    whole = [kept[a : a + n] for a, n in zip(*_coded(fiblets), strict=True)]
    mine = [bits[a : a + n] for a, n in zip(*_coded(part), strict=True)]
    for k, i in enumerate(ids):
        assert np.array_equal(mine[k], whole[i])
    assert part_of_filter(None, fiblets, ids) is None


def _coded(fiblets):
    """Where each streamline's points begin in coded order, and how many they are, from the records."""
    owners, counts = fiblets.fiblet_streamlines(), fiblets.fiblet_counts()
    starts = np.cumsum(counts) - counts
    first = [starts[owners == i].min() for i in range(fiblets.n_streamlines)]
    return first, [counts[owners == i].sum() for i in range(fiblets.n_streamlines)]


def test_growing_adds_streamlines_with_similar_ends(plotter):
    lines = brain_streamlines(300)
    actor = plotter.add_fiblets(lines)
    actor.select([3, 50])
    actor.grow_selection(12.0)
    ends = [line[[0, -1]] for line in actor.fiblets.decompress(dtype=np.float64).to_list()]

    def alike(a, b):
        return any(np.linalg.norm(a - way, axis=1).max() <= 12.0 for way in (b, b[::-1]))

    expected = [i for i in range(300) if any(alike(ends[i], ends[k]) for k in (3, 50))]
    assert actor.selection.tolist() == expected
    assert len(expected) > 2


def test_statistics(plotter):
    lines = brain_streamlines(60)
    rng = np.random.default_rng(2)
    lines.per_point["fa"] = rng.random(lines.n_points).astype(np.float32)
    lines.per_streamline["weight"] = rng.random(60)
    actor = plotter.add_fiblets(lines, per_point=("fa",))
    ids = np.array([4, 7, 33])
    actor.select(ids)
    decoded = actor.fiblets.decompress(dtype=np.float64).to_list()
    lengths = [np.linalg.norm(np.diff(decoded[i], axis=0), axis=1).sum() for i in ids]
    found = actor.selection_statistics()
    assert found["count"] == 3
    assert found["points"] == sum(len(decoded[i]) for i in ids)
    assert found["length_mean"] == pytest.approx(np.mean(lengths), rel=1e-4)
    assert found["length_min"] == pytest.approx(min(lengths), rel=1e-4)
    assert found["length_max"] == pytest.approx(max(lengths), rel=1e-4)
    assert found["length_total"] == pytest.approx(sum(lengths), rel=1e-4)
    assert "mean" not in found
    fa = np.concatenate([lines.per_point["fa"][lines.offsets[i] : lines.offsets[i + 1]] for i in ids])
    weight = lines.per_streamline["weight"]
    for scalars, values in (("fa", fa), (np.asarray(lines.per_point["fa"]), fa), ("weight", weight[ids])):
        found = actor.selection_statistics(scalars)
        assert found["mean"] == pytest.approx(values.mean(), abs=0.005)
        assert found["std"] == pytest.approx(values.std(), abs=0.005)
    actor.scalars = "weight"
    assert actor.selection_statistics()["scalars"] == "weight"
    actor.deselect()
    empty = actor.selection_statistics()
    assert empty["count"] == empty["points"] == empty["length_total"] == 0
    assert np.isnan(empty["length_mean"])
    with pytest.raises(KeyError, match="nothing like it"):
        actor.selection_statistics("nothing like it")


def test_profile(plotter, three_lines):
    reverse = Streamlines.from_list([three_lines[0], three_lines[0][::-1]])
    height = np.asarray(three_lines.per_point["height"][:41])
    reverse.per_point["height"] = np.concatenate([height, height[::-1] + 0.2])
    actor = plotter.add_fiblets(reverse, scalars="height")
    actor.select([0, 1])
    profile = actor.selection_profile(n=11)
    assert profile.name == "height"
    assert profile.count == 2
    assert len(profile) == 11
    assert profile.position == pytest.approx(np.linspace(0, 1, 11))
    assert profile.mean == pytest.approx(np.linspace(0, 1, 11) + 0.1, abs=0.01)
    assert profile.std == pytest.approx(np.full(11, 0.1), abs=0.01)
    chart = profile.chart()
    assert len(list(chart.plots())) == 2
    plotter.add_chart(chart)
    plotter.show(auto_close=False)
    ax = profile.plot()
    assert ax.get_ylabel() == "height"
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), profile.mean)
    assert profile.plot(ax) is ax
    nothing = Profile(np.full(3, np.nan), np.full(3, np.nan), np.linspace(0, 1, 3))
    assert len(list(nothing.chart().plots())) == 0
    plt.close(ax.figure)
    twin = actor.copy()
    assert twin.selection.tolist() == [0, 1]
    twin.deselect()
    assert actor.selection.tolist() == [0, 1]
    with pytest.raises(ValueError, match="per streamline"):
        actor.selection_profile("length")
    actor.color = "red"
    with pytest.raises(ValueError, match="name an array"):
        actor.selection_profile()


@pytest.mark.parametrize("suffix", ["fiblets", "trk", "tck", "trx", "vtk"])
def test_saved_selections_come_back(plotter, three_lines, tmp_path, suffix):
    actor = plotter.add_fiblets(three_lines, per_point=("height",))
    actor.select([0, 2])
    path = tmp_path / f"chosen.{suffix}"
    actor.save_selection(path)
    back = pf.FibletSet.open(path).decompress() if suffix == "fiblets" else pf.read(path)
    expected = actor.fiblets.decompress([0, 2])
    assert len(back) == 2
    # Exported points are moved into the bounds of the original, by no more than coding moved them out.
    assert np.abs(back.points - expected.points).max() < actor.fiblets.promise
    if suffix in ("fiblets", "trx"):
        assert np.asarray(back.per_streamline["weight"]).ravel().tolist() == [1.0, 100.0]
    with pytest.raises(UnknownFormatError, match="obj"):
        actor.save_selection(tmp_path / "chosen.obj")
