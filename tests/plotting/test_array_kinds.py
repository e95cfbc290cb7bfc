"""Arrays of every kind colour as they do in `add_mesh`: colours, vectors by magnitude, words as categories."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets

VECTORS = np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 1.0], [6.0, 0.0, 8.0]])


def test_vectors_of_streamlines_by_their_magnitude(plotter, three_lines):
    cloud = pv.PolyData(np.eye(3))
    cloud["v"] = VECTORS
    wanted = plotter.add_mesh(cloud, scalars="v").mapper.scalar_range
    three_lines.per_streamline["v"] = VECTORS
    for scalars in ("v", VECTORS):
        actor = plotter.add_fiblets(three_lines, scalars=scalars)
        np.testing.assert_allclose(actor.active_scalars.values, [5.0, 1.0, 10.0])
        assert actor.clim == pytest.approx(wanted)
    plotter.show(auto_close=False)


def test_columns_are_colours_or_vectors_as_rgb_says(plotter, three_lines, colours_in):
    colours = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    actor = plotter.add_fiblets(three_lines, scalars=colours, rgb=True, lighting=False)
    plotter.show(auto_close=False)
    assert colours_in(plotter.screenshot(None)) == {(255, 0, 0), (0, 255, 0), (0, 0, 255)}
    actor.rgb = False
    np.testing.assert_allclose(actor.active_scalars.values, 1.0)
    actor.scalars = VECTORS
    with pytest.raises(ValueError, match="floats must lie between 0 and 1"):
        actor.rgb = True
    assert actor.rgb is False
    assert actor.scalars is not None
    pairs = np.array([[3.0, 4.0], [0.0, 2.0], [1.0, 0.0]])
    actor.scalars = pairs
    np.testing.assert_allclose(actor.active_scalars.values, [5.0, 2.0, 1.0])
    assert actor.copy().rgb is False


def test_three_bytes_are_a_colour_unless_rgb_is_false(plotter, three_lines, colours_in):
    three_lines.per_streamline["colors"] = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], np.uint8)
    actor = plotter.add_fiblets(three_lines, scalars="colors", lighting=False)
    plotter.show(auto_close=False)
    assert colours_in(plotter.screenshot(None)) == {(255, 0, 0), (0, 255, 0), (0, 0, 255)}
    actor.rgb = False
    np.testing.assert_array_equal(actor.active_scalars.values, 255.0)


@pytest.mark.parametrize("how", ["array", "name", "compressed", "later"])
def test_vectors_of_points_by_their_magnitude(plotter, three_lines, how):
    rng = np.random.default_rng(2)
    vectors = rng.normal(size=(123, 3)) * 4.0
    if how == "name":
        three_lines.per_point["v"] = vectors
        actor = plotter.add_fiblets(three_lines, scalars="v", per_point=["v"])
        assert {"v", "v[0]", "v[1]", "v[2]"} <= set(actor.fiblets.per_point)
    elif how == "array":
        actor = plotter.add_fiblets(three_lines, scalars=vectors)
    elif how == "compressed":
        actor = plotter.add_fiblets(pvfiblets.compress(three_lines), scalars=vectors)
    else:
        actor = plotter.add_fiblets(three_lines)
        actor.scalars = vectors
    stored = actor.fiblets.per_point["v" if how == "name" else "Data"]
    wanted = np.linalg.norm(vectors, axis=1)
    np.testing.assert_allclose(stored.values(), wanted, atol=(wanted.max() - wanted.min()) / 254)
    plotter.show(auto_close=False)


def test_words_are_categories(plotter, three_lines, colours_in):
    three_lines.per_streamline["side"] = np.array(["right", "left", "right"])
    actor = plotter.add_fiblets(three_lines, scalars="side", cmap=["red", "blue"], lighting=False)
    assert actor.active_scalars.categories == {0: "left", 1: "right"}
    plotter.remove_scalar_bar()
    plotter.show(auto_close=False)
    assert colours_in(plotter.screenshot(None)) == {(255, 0, 0), (0, 0, 255)}
    table = actor.lookup_table
    assert [table.GetAnnotation(i) for i in range(table.GetNumberOfAnnotatedValues())] == ["left", "right"]
    actor.scalars = ["a", "", "b"]
    assert actor.active_scalars.categories == {0: "a", 1: "b"}
    np.testing.assert_array_equal(actor.active_scalars.values, [0.0, np.nan, 1.0])


def lines_with(kind):
    """Two lines of three points with active scalars of one kind."""
    mesh = pv.PolyData(np.arange(18.0).reshape(6, 3) ** 1.5, lines=[3, 0, 1, 2, 3, 3, 4, 5])
    if kind == "points":
        mesh["h"] = np.linspace(2.0, 7.0, 6)
    elif kind == "cells":
        mesh.cell_data["h"] = np.array([3.0, 5.0])
    elif kind == "vectors":
        mesh["h"] = np.arange(18.0).reshape(6, 3)
    elif kind == "vectors of cells":
        mesh.cell_data["h"] = np.array([[3.0, 4.0, 0.0], [0.0, 5.0, 12.0]])
    elif kind == "named":
        mesh["h_rgb"] = np.linspace(0.0, 1.0, 18).reshape(6, 3)
    return mesh


@pytest.mark.few(6)
@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines", "add_halo_points"])
@pytest.mark.parametrize("kind", ["points", "cells", "vectors", "vectors of cells", "named", "none"])
def test_active_scalars_colour_as_in_add_mesh(add, kind):
    ours, meshes = pv.Plotter(off_screen=True), pv.Plotter(off_screen=True)
    drawn = lines_with(kind)
    if add == "add_halo_points" and "cells" in kind:
        drawn = drawn.cell_data_to_point_data()
    actor, mesh = getattr(ours, add)(drawn), meshes.add_mesh(drawn)
    assert list(ours.scalar_bars.keys()) == list(meshes.scalar_bars.keys())
    assert (actor.scalars is not None) == mesh.mapper.scalar_visibility
    if ours.scalar_bars.keys():
        assert actor.clim == pytest.approx(mesh.mapper.scalar_range)
    one = getattr(ours, add)(drawn, color="red")  # a colour goes before them
    assert one.scalars is None
    raw = pv.PolyData(drawn, deep=True)
    raw.set_active_scalars(None)
    assert getattr(ours, add)(raw).scalars is None
    ours.close()
    meshes.close()


@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
def test_vectors_and_colours_of_tubes_and_halos(plotter, add):
    mesh = lines_with("vectors")
    colours = np.full((6, 3), 255, np.uint8)
    actor = getattr(plotter, add)(mesh, scalars=colours)
    assert actor.scalars_title is None
    actor = getattr(plotter, add)(mesh, scalars=colours, rgb=False)
    assert actor.scalars_title == "Data"
    assert actor.clim == pytest.approx((255.0 * 3**0.5,) * 2)
    actor.scalars = mesh["h"]
    sizes = np.linalg.norm(mesh["h"], axis=1)
    assert actor.clim == pytest.approx((sizes.min(), sizes.max()))
    actor.scalars = mesh["h"] / mesh["h"].max()  # from 0 to 1: colours
    assert actor.scalars_title is None
    with pytest.raises(ValueError, match="expected 0 to 1"):
        getattr(plotter, add)(mesh, scalars="h", rgb=True)


def named_lines():
    """Three lines with a word for each line and each point, as VTK keeps text."""
    mesh = pv.PolyData()
    mesh.points = np.concatenate([np.c_[np.linspace(0.0, 9.0, 5), np.zeros(5), np.full(5, float(k))] for k in range(3)])
    mesh.lines = np.concatenate([[5, *range(5 * k, 5 * k + 5)] for k in range(3)])
    mesh.cell_data["side"] = ["right", "left", "right"]
    mesh.point_data["tissue"] = ["white", "grey", "white"] * 5
    return mesh


@pytest.mark.few(5)
@pytest.mark.parametrize("scalars", ["side", ["right", "left", "right"], np.array(["right", "left", "right"])])
@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
def test_words_of_lines_are_categories_as_in_add_mesh(plotter, add, scalars):
    table = plotter.add_mesh(named_lines(), scalars=scalars).mapper.lookup_table
    wanted = [table.GetAnnotation(i) for i in range(table.GetNumberOfAnnotatedValues())]
    actor = getattr(plotter, add)(named_lines(), scalars=scalars)
    table = actor.lookup_table
    assert [table.GetAnnotation(i) for i in range(table.GetNumberOfAnnotatedValues())] == wanted == ["left", "right"]
    assert actor.scalars_title == ("side" if isinstance(scalars, str) else "Data")
    actor.scalars = None
    actor.scalars = np.array(["b", "c", "a"])
    assert [actor.lookup_table.GetAnnotation(i) for i in range(3)] == ["a", "b", "c"]
    actor.scalars = np.array(["a", None, "b"], object)  # words may be missing
    table = actor.lookup_table
    assert actor.shows_labels
    assert {"a", "b"} < {table.GetAnnotation(k) for k in range(table.GetNumberOfAnnotatedValues())}
    plotter.show(auto_close=False)


@pytest.mark.every("pair")
@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("later", [False, True])
@pytest.mark.parametrize("ragged", [False, True])
def test_a_list_of_arrays_is_of_points(plotter, add, later, ragged):
    """One for each line, also where all are of one length, so that they look like vectors."""
    lengths = [5, 7, 6] if ragged else [6, 6, 6]
    lines = [np.linspace([0.0, 0.0, k], [9.0, 5.0, k], n) for k, n in enumerate(lengths)]
    values = [10.0 * k + np.arange(n) for k, n in enumerate(lengths)]
    if later:
        actor = getattr(plotter, add)(lines)
        actor.scalars = values
    else:
        actor = getattr(plotter, add)(lines, scalars=values)
    assert actor.scalars_title == "Data"
    assert actor.clim == pytest.approx((0.0, 20.0 + lengths[2] - 1.0))


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
def test_what_lines_cannot_have_is_said(plotter, three_lines, add):
    """`add_mesh` says of numbers: RGB array must be n_points/n_cells by 3/4 in shape."""
    for scalars in ("height", "weight", "length", np.arange(3.0), np.arange(123.0)):
        with pytest.raises(ValueError, match="rgb=True asks for colours, but .* one number"):
            getattr(plotter, add)(three_lines, scalars=scalars, rgb=True)
    for scalars in ("tissue", ["white", "grey", "white"] * 5):
        with pytest.raises(ValueError, match="words per point; words are taken per line, and numbers per point"):
            getattr(plotter, add)(named_lines(), scalars=scalars)
    assert not plotter.actors


SQUARE = np.ones((3, 3))
LINES = [np.eye(3), 2.0 * np.eye(3)]


@pytest.mark.parametrize("kind", [complex, str, object])
@pytest.mark.parametrize(
    "give",
    [
        lambda plotter, of: plotter.add_spline_tubes([of(line) for line in LINES], radius=1.0),
        lambda plotter, of: plotter.add_halo_lines([of(line) for line in LINES]),
        lambda plotter, of: plotter.add_connectome(of(SQUARE), np.eye(3)),
        lambda plotter, of: plotter.add_connectome(SQUARE, of(np.eye(3))),
        lambda plotter, of: plotter.add_fiblets(LINES).color_along(of(np.arange(3.0))),
        lambda plotter, of: pvfiblets.compress(
            pvfiblets.Streamlines(np.eye(3), [0, 3], per_point={"a": of(np.arange(3.0))}), per_point="all"
        ),
    ],
    ids=["tubes", "halos", "matrix", "positions", "along", "stored"],
)
def test_what_are_no_real_numbers_is_refused_by_name(plotter, give, kind):
    def of(values):
        return np.full(values.shape, "no number", object) if kind is object else values.astype(kind)

    with pytest.raises(ValueError, match=r"have the type (complex128|<U32|object), expected real numbers"):
        give(plotter, of)
