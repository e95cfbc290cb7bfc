"""Displacement functions, and the widths of halos against strips that are looked at place by place."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.halos import HaloStyle
from pvfiblets.halos.displacement import as_displacement, displaced
from pvfiblets.halos.style import DISPLACEMENTS, TABLE_SIZE
from pvfiblets.halos.widths import halo_width

X = np.linspace(0, 1, 1001)


@pytest.mark.parametrize(
    ("name", "function"), [("linear", lambda x: x), ("square", lambda x: x**2), ("square root", lambda x: x**0.5)]
)
def test_names(name, function):
    assert as_displacement(name) == name
    np.testing.assert_array_equal(displaced(X, name), function(X))
    # The same as a function is a table, which is linear between its places.
    table = as_displacement(function)
    assert len(table) == TABLE_SIZE
    assert displaced(np.linspace(0, 1, TABLE_SIZE), table) == pytest.approx(function(np.linspace(0, 1, TABLE_SIZE)))
    error = np.abs(displaced(X, table) - function(X))
    assert error.max() <= 1 / 31
    assert error[X > 0.15].max() < 1e-3


def test_tables_are_linear_between_equally_spaced_places():
    for table in ([0, 0.5, 0.25], (0, 0.5, 0.25), np.array([0, 0.5, 0.25], np.float32)):
        form = as_displacement(table)
        assert form == (0.0, 0.5, 0.25)
        assert all(type(entry) is float for entry in form)
        assert displaced([0, 0.25, 0.5, 0.75, 1], form).tolist() == [0, 0.25, 0.5, 0.375, 0.25]
        assert HaloStyle(1, 2, 3, form).displacement == form


def test_what_lies_outside_counts_as_the_nearer_end_and_functions_may_round():
    for form in (*DISPLACEMENTS, (0.25, 0.5)):
        assert as_displacement(form) == form
        np.testing.assert_array_equal(displaced([-3, 4], form), displaced([0, 1], form))
    assert np.isnan(displaced(np.nan, "square"))
    assert displaced(0.5, "square").shape == ()
    assert displaced(np.full((2, 3), 0.5), "square").tolist() == [[0.25] * 3] * 2
    assert as_displacement(lambda x: 1.0) == (1.0,) * TABLE_SIZE
    assert as_displacement(np.zeros_like) == (0.0,) * TABLE_SIZE
    table = as_displacement(lambda x: np.where(x < 0.5, -1e-12, 1 + 1e-12))
    assert set(table) == {0.0, 1.0}
    assert as_displacement(lambda x: list(x))[-1] == 1.0


@pytest.mark.parametrize(
    ("given", "message"),
    [("cubic", r"'cubic'; choose one of \('linear', 'square', 'square root'\), or give a table or a function"),
     ([0.5], r"shape \(1,\), expected 2 to 64 numbers"), (np.zeros(65), r"shape \(65,\), expected 2 to 64 numbers"),
     (np.zeros((4, 4)), r"shape \(4, 4\)"), ([0, 1.5, 1], "1.5 at 0.5, expected 0 to 1"),
     ([0, 0.5, -0.1], "-0.1 at 1, expected 0 to 1"), ([0, np.nan], "nan at 1, expected"),
     (["a", "b"], "expected numbers"), ([[1], [1, 2]], "expected numbers"),
     (lambda x: 2 * x, "function gives .* expected 0 to 1"),
     (lambda x: x[:5], r"function gives the shape \(5,\), expected 64 numbers for an array of that length"),
     (lambda x: x / (x - x), "function gives nan at 0"), (lambda x: None, "function gives"),
     (lambda x: "dark", "function gives 'dark', expected numbers")],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore:.*encountered in divide:RuntimeWarning")
def test_what_cannot_be(given, message):
    with pytest.raises(ValueError, match=message):
        as_displacement(given)
    with pytest.raises(ValueError, match=message):
        displaced(X, given)
    for other in (None, 0.5, b"linear", {0.0: 1.0}):
        with pytest.raises(TypeError, match=f"displacement is a {type(other).__name__}"):
            as_displacement(other)


DZ = np.linspace(-1, 7, 161)


def looked_at(dz, line, strip, largest, displacement, n=200_001):
    """Go out from the line's edge until the other line shows: what is nearer to the viewer is seen."""
    out = np.linspace(line / 2, strip / 2, n)
    behind = largest * displaced(2 * out / strip, displacement)
    found = []
    for d in np.atleast_1d(dz):
        seen = behind >= d
        end = out[np.argmax(seen)] if seen.any() else strip / 2
        found.append(0.0 if d <= 0.0 else end - line / 2)
    return np.array(found)


@pytest.mark.parametrize(
    "displacement",
    ["linear", "square", "square root", (0.0, 0.1, 0.9, 1.0), (0.2, 0.4), (0.0, 0.8, 0.3, 1.0), (1.0, 0.0), (0.5, 0.5),
     lambda x: np.sin(np.pi / 2 * x), lambda x: 0.0 * x],
)  # fmt: skip
@pytest.mark.parametrize(("line", "strip", "largest"), [(0.5, 3.0, 5.0), (0.01, 2.0, 0.5), (1.0, 1.1, 6.0)])
def test_widths_are_those_of_the_strip(displacement, line, strip, largest):
    found = halo_width(DZ, line, strip, largest, displacement)
    wanted = looked_at(DZ, line, strip, largest, displacement)
    # Where a function has a level part, a line at its very depth is either.
    level = np.abs(np.subtract.outer(DZ / largest, displaced(np.linspace(0, 1, 64), displacement))).min(axis=1) < 1e-9
    level &= not isinstance(displacement, str)
    assert found[~level] == pytest.approx(wanted[~level], abs=2e-5 * strip)


def test_the_three_cases_of_equation_4():
    line, strip, largest = 0.75, 4.5, 3.0
    first = largest * line / strip
    assert not halo_width(np.linspace(-2, first, 20), line, strip, largest).any()
    between = np.linspace(first, largest, 20)
    np.testing.assert_allclose(
        halo_width(between, line, strip, largest), (strip * between / largest - line) / 2, atol=1e-15
    )
    assert halo_width([largest, 2 * largest, 1e300, np.inf], line, strip, largest).tolist() == [(strip - line) / 2] * 4


def test_shapes_units_and_special_widths():
    assert halo_width(1.0, 1.0, 3.0, 1.0).shape == ()
    assert halo_width(np.ones((2, 3)), 1.0, 3.0, 1.0).tolist() == [[1.0] * 3] * 2
    assert halo_width([], 1.0, 3.0, 1.0).shape == (0,)
    for displacement in ("linear", (0.0, 1.0)):
        assert np.isnan(halo_width([np.nan, 1.0], 1.0, 3.0, 1.0, displacement)).tolist() == [True, False]
        assert not halo_width(DZ, 2.0, 2.0, 3.0, displacement).any()  # as wide as its line
        # Without displacement all that is behind is hidden.
        assert halo_width([-1, 0, 1e-9, 5], 1.0, 3.0, 0.0, displacement).tolist() == [0, 0, 1, 1]
    one = halo_width(DZ, 0.5, 3.0, 5.0, "square root")
    for unit in (1e-9, 1e9):
        np.testing.assert_allclose(halo_width(DZ * unit, 0.5 * unit, 3 * unit, 5 * unit, "square root"), one * unit)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [((0.0, 1.0, 1.0), "line_width is 0.0"), ((2.0, 1.0, 1.0), "strip_width is 1.0; give at least line_width, 2.0"),
     ((1.0, 2.0, -1.0), "max_displacement is -1.0"), ((1.0, 2.0, np.nan), "max_displacement is nan"),
     ((1.0, 2.0, 1.0, "cubic"), "displacement is 'cubic'")],
)  # fmt: skip
def test_widths_that_cannot_be(arguments, message):
    with pytest.raises(ValueError, match=message):
        halo_width(1.0, *arguments)
