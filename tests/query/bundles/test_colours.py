"""Colours of numbers: each is the same alone and among others, however large the number is."""

import numpy as np
import pytest

from pvfiblets.query.bundles.colours import as_colour, distinct_colour, distinct_colours, hex_colour


def test_a_colour_alone_is_that_among_others():
    np.testing.assert_array_equal([distinct_colour(number) for number in range(50)], distinct_colours(50))


def test_large_numbers_take_no_memory():
    assert all(0.0 <= part <= 1.0 for part in distinct_colour(10**15))


@pytest.mark.parametrize("text", ["#000000", "#ff8001", "#ffffff"])
def test_hexadecimal_comes_back(text):
    assert hex_colour(as_colour(text)) == text
