"""Painted regions and masks as conditions of actors."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets import Streamlines, regions


@pytest.fixture
def actor():
    lines = [np.array([(0.0, y, 1.0), (9.0, y, 1.0)]) for y in range(10)]
    plotter = pv.Plotter(off_screen=True)
    yield plotter.add_fiblets(Streamlines.from_list(lines))
    plotter.close()


def test_painted_regions_filter_again_after_each_stroke(actor):
    painter = regions.RegionPainter(((10, 10, 3), np.eye(4)))
    painter.add("A")
    painter.add("B")
    live = regions.LiveRegions(actor.fiblets, painter)
    painter.paint("A", (4, 5, 1), 1.2)
    name = actor.include_painted(live, include="A")
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6]
    painter.paint("A", (4, 8, 1), 1.2)
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6, 7, 8, 9]
    painter.undo()
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6]
    other = actor.include_painted(live, ends_in="B", name="ends")
    assert not actor.shown.any()
    painter.paint("B", (9, 5, 1), 0.6)
    assert np.flatnonzero(actor.shown).tolist() == [5]
    actor.remove_condition(other)
    actor.remove_condition(name)
    painter.paint("A", (4, 1, 1), 1.2)
    assert actor.shown.all()
    assert len(painter.listeners) == 1  # that of the live regions alone
    with pytest.raises(KeyError, match="no region 'C'"):
        actor.include_painted(live, include="C")


def test_a_mask_is_a_condition_and_joins_with_others(actor):
    mask = np.arange(10) < 6
    actor.include(mask, name="first")
    mask[:] = False  # it was copied
    actor.exclude(np.arange(10) == 2)
    assert np.flatnonzero(actor.shown).tolist() == [0, 1, 3, 4, 5]
    with pytest.raises(ValueError, match="shape"):
        actor.include(np.ones(9, bool))
    other = regions.LiveRegions(actor.fiblets.extract(slice(0, 5)), regions.RegionPainter(((10, 10, 3), np.eye(4))))
    with pytest.raises(ValueError, match="other fiblets"):
        actor.include_painted(other, include="A")
