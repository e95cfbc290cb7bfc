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


def test_a_first_frame_that_compiled_makes_no_other_level_seem_quick():
    pace = Pace()
    pace.took(LEVELS[0], 1.5 * BUDGET)
    assert pace.choose() is LEVELS[1]
    pace.took(LEVELS[1], 1.2 * BUDGET)  # compiles and copies
    pace.took(LEVELS[0], 0.4 * BUDGET, moved=False)  # the camera is where it was
    for seconds in (0.3, 0.31, 0.29, 0.3, 0.3, 0.32, 0.3):
        assert pace.choose() is LEVELS[1]
        pace.took(LEVELS[1], seconds * BUDGET)


def test_lucky_frames_of_a_coarse_level_are_no_reason_for_a_slow_one():
    pace, level = Pace(), LEVELS[4]
    pace.took(LEVELS[0], 16.0 * BUDGET)
    for k in range(60):
        assert pace.choose() is level
        pace.took(level, BUDGET * (0.2 if k % 4 == 1 else 0.9))


def test_a_level_that_was_expected_to_be_quicker_is_left_at_once():
    pace = Pace()
    for level, seconds in ((LEVELS[0], 4.0), (LEVELS[2], 0.8), (LEVELS[2], 0.8), (LEVELS[1], 3.0), (LEVELS[1], 3.0)):
        pace.took(level, seconds * BUDGET)
    assert pace.choose() is LEVELS[2]


def test_a_frame_is_practised_once():
    pace = Pace()
    pace.took(LEVELS[0], 4.0 * BUDGET)
    assert pace.untried
    pace.took(pace.level, 0.9 * BUDGET)
    assert not pace.untried
