"""How coarse the pictures of a moving camera are."""

import itertools

import pytest

from pvfiblets.web.pace import BUDGET, LEVELS, Pace


def settled(seconds, frames=40, slower=1.0):
    """Return the levels of frames that take a time in proportion to their costs; the tenth and on take more."""
    pace, found = Pace(), []
    for k in range(frames):
        level = pace.choose()
        pace.took(level, seconds * level.cost * (slower if k >= 10 else 1.0))
        found.append(LEVELS.index(level))
    return found


def test_quick_scenes_are_never_coarse():
    assert set(settled(0.5 * BUDGET)) == {0}


@pytest.mark.parametrize(("seconds", "level"), [(1.5, 1), (4.0, 2), (7.0, 3), (14.0, 4), (1000.0, 4)])
def test_one_slow_frame_is_enough_to_find_the_level(seconds, level):
    assert settled(seconds * BUDGET)[1:] == [level] * 39


def test_what_becomes_faster_becomes_finer_again_and_stays():
    found = settled(7.0 * BUDGET, slower=0.05)
    assert found[9] == 3
    assert found[-5:] == [0] * 5
    assert sum(a != b for a, b in itertools.pairwise(found)) <= 5


def test_a_level_at_the_edge_does_not_flicker():
    for share in (0.9, 0.98, 1.02, 1.1):
        found = settled(share * BUDGET / LEVELS[1].cost, frames=60)
        assert len(set(found[5:])) == 1


def test_one_slow_frame_among_quick_ones_changes_nothing():
    pace = Pace()
    for k in range(20):
        pace.took(pace.choose(), 5.0 * BUDGET if k == 12 else 0.3 * BUDGET)
        assert pace.choose() is LEVELS[0]


def test_a_frame_is_practised_once():
    pace = Pace()
    pace.took(LEVELS[0], 4.0 * BUDGET)
    assert pace.untried
    pace.took(pace.level, 0.9 * BUDGET)
    assert not pace.untried
