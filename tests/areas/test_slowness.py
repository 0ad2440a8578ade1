"""Slowness of robots: from speeds, in scenarios, and what is wrong with it."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from trihex.areas import Frame

AREA = th.Area("square", [[0] * 4] * 3)
HALL = th.Area("hexagonal", [[0] * 4] * 3, frame=Frame(cell_size=0.5, robot_radius=0.1))


@pytest.mark.parametrize(
    ("speeds", "fastest", "want"),
    [
        ([1.4, 0.7, 0.5], None, [1, 2, 3]),
        ([0.3, 0.1, 0.1 + 1e-17], None, [1, 3, 3]),  # 0.3 / 0.1 is a little less than 3, 0.3 / 3 a little less than 0.1
        ([1.5, 1.0], 3, [2, 3]),
        ([2.0, 1.0], 1.5, [1, 2]),
        ([], None, []),
    ],
)
def test_nobody_is_faster_than_its_speed_and_whole_parts_are_whole(speeds, fastest, want):
    assert th.slowness_of(speeds, fastest=fastest).tolist() == want


@pytest.mark.parametrize(
    ("speeds", "fastest", "message"),
    [
        ([1, 0], None, r"speeds\[1\] must be a number above 0, not 0"),
        ([1, float("nan")], None, r"speeds\[1\] must be a number above 0, not nan"),
        (3.5, None, "speeds must be numbers in a list, one for each robot, not 3.5"),
        (["quick"], None, "speeds must be numbers above 0, not"),
        ([1], -2, "fastest must be a number above 0, not -2"),
    ],
)
def test_what_is_no_speed_is_refused(speeds, fastest, message):
    with pytest.raises(th.ScenarioError, match=message):
        th.slowness_of(speeds, fastest=fastest)


@pytest.mark.parametrize(
    ("slowness", "message"),
    [
        ([3], "slowness must be one for each of 2 robots, not 1"),
        ([1, 0], r"slowness\[1\] must be a whole number from 1 to 30: no move may last longer than 30 ticks, not 0"),
        ([1, 31], r"slowness\[1\] must be a whole number from 1 to 30: .* not 31"),
        ([1, 1.5], r"slowness must be whole numbers, one for each robot, not \[1, 1.5\]"),
        ("2", "slowness must be whole numbers, one for each robot, not '2'"),
    ],
)
def test_what_is_no_slowness_is_refused(slowness, message):
    with pytest.raises(th.ScenarioError, match=message):
        th.Scenario(AREA, (3, 2), [(0, 0), (1, 0)], slowness=slowness)


def test_by_the_clock_of_costs_moves_last_longer_so_slowness_may_be_less():
    with pytest.raises(th.ScenarioError, match=r"slowness\[0\] must be a whole number from 1 to 4: .* not 5"):
        th.Scenario(AREA, (3, 2), [(0, 0)], clock="costs", slowness=5)


def test_it_is_of_each_robot_and_told_in_words():
    fast = th.Scenario(AREA, (3, 2), [(0, 0), (1, 0)])
    slow = replace(fast, slowness=[1, 3])
    assert slow.in_words() == fast.in_words() + ", slowness=1..3" and slow != fast
    assert fast.is_stepwise and not slow.is_stepwise and slow.has_slowness and not fast.has_slowness
    assert th.Scenario(AREA, (3, 2), [(0, 0), (1, 0)], slowness=2).slowness.tolist() == [2, 2]
    assert replace(fast, slowness=[1, 1]) == fast
    assert replace(fast, robots=[(2, 2)], start_times=()).slowness.tolist() == [1]
    assert slow.with_robots([(2, 2)]).slowness.tolist() == [1]


def test_in_metres_nobody_follows_a_slower_one():
    fast = th.Scenario(HALL, (3, 2), [(0, 0), (1, 0)])
    assert fast.following == "allow"
    assert th.Scenario(HALL, (3, 2), [(0, 0), (1, 0)], slowness=[1, 3]).following == "forbid"
    with pytest.raises(th.ScenarioError, match="following must be 'forbid' where robots have slowness in an area in m"):
        th.Scenario(HALL, (3, 2), [(0, 0), (1, 0)], slowness=[1, 3], following="allow")
    assert th.Scenario(HALL, (3, 2), np.array([0]), slowness=[1], following="allow").following == "allow"
