"""From values to colours, and layers over each other, against formulas."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pyvista as pv

from pvfiblets.slices import colours


def test_numbers_take_the_colours_of_the_window():
    table = np.array(pv.LookupTable("viridis", n_values=256).values, np.uint8)
    values = np.linspace(-1.0, 3.0, 50).reshape(5, 10)
    found = colours.mapped(values, table, (0.0, 2.0), False)
    wanted = mpl.colormaps["viridis"](np.clip(values / 2.0, 0.0, 1.0))
    assert abs(found - wanted).max() < 0.02
    powers = 10.0 ** np.linspace(0, 4, 9)[None]
    found = colours.mapped(powers, table, (1.0, 1e4), True)
    assert abs(found - mpl.colormaps["viridis"](np.linspace(0, 1, 9))[None]).max() < 0.02
    vectors = np.array([[[3.0, 0, 0], [0, 2.0, 2.0], [0, 0, 0]]])  # directions are colours, brighter by weights
    found = colours.direction_colours(vectors, np.array([[0.5, 1.0, 1.0]]), (0.0, 1.0))
    np.testing.assert_allclose(found[0, :, :3], [[0.5, 0, 0], [0, 0.5**0.5, 0.5**0.5], [0, 0, 0]], atol=1e-6)


def test_thresholds_hide_and_so_does_what_is_no_number():
    values = np.array([[0.0, 1.0, 2.0, 3.0, np.nan, np.inf]])
    assert colours.shown(values, 1.0, 2.0).tolist() == [[False, True, True, False, False, False]]
    assert colours.shown(values, None, None).sum() == 4


def test_over_and_add_are_what_they_are_in_every_textbook():
    rng = np.random.default_rng(0)
    bottom, top = rng.random((2, 3, 4, 4)).astype(np.float32)
    all_of_it = np.ones((3, 4), bool)
    under = colours.blend(None, bottom, all_of_it, 0.8, "over")
    over = colours.blend(under.copy(), top, all_of_it, 0.5, "over")
    a, b = 0.5 * top[..., 3:], 0.8 * bottom[..., 3:]
    np.testing.assert_allclose(over[..., 3:], a + b * (1 - a), rtol=1e-6)
    np.testing.assert_allclose(over[..., :3], top[..., :3] * a + bottom[..., :3] * b * (1 - a), rtol=1e-5)
    add = colours.blend(under.copy(), top, all_of_it, 0.5, "add")
    alpha = a + b * (1 - a)
    np.testing.assert_allclose(add[..., :3], np.minimum(top[..., :3] * a + bottom[..., :3] * b, alpha), rtol=1e-5)
    shown = np.arange(12).reshape(3, 4) % 2 == 0  # what is hidden leaves what lies below
    found = colours.blend(under.copy(), top, shown, 0.5, "over")
    np.testing.assert_array_equal(found[~shown], under[~shown])
    np.testing.assert_array_equal(found[shown], over[shown])
    plain = colours.to_bytes(over)
    np.testing.assert_allclose(plain[..., 3], 255 * over[..., 3], atol=0.51)
    np.testing.assert_allclose(plain[..., :3], 255 * over[..., :3] / over[..., 3:], atol=0.51)


def test_outlines_are_where_the_neighbour_is_another():
    codes = np.zeros((6, 6), int)
    codes[2:4, 2:4] = 1
    edge = colours.outlines(codes)
    assert edge[2:4, 2:4].all()
    assert edge[1, 2]
    assert not edge[0].any()
