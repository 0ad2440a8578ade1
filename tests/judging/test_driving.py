"""Robots driven along plans: discs of the greatest legal radius never touch, and would if they were a little wider."""

import numpy as np
import pytest

import trihex as th
from tests.areas.test_clearance import KINDS, pairs_of
from tests.oracles.continuous import contacts_between_robots
from tests.oracles.driving import drive, random_plan_in_metres, tracks_of_adversary, tracks_on_time
from tests.sweeps import swept
from trihex.areas import CLOCKS, Tessellation
from trihex.areas.clearance import least_distance
from trihex.kernels.codes import WAIT
from trihex.plans import plan_from_lists

A_LITTLE = 1e-4  # a tenth of a millimetre; cells are a metre apart


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_where_nobody_follows_robots_never_touch_whatever_their_speeds_and_stops(name, neighbourhood, clock):
    tessellation = Tessellation(name, neighbourhood, "euclidean", clock)
    _, moves, nearest, contacts = drive(tessellation, "forbid", range(swept(50)))
    assert moves > 20 and contacts == 0
    assert nearest >= least_distance(tessellation, following="forbid") - 1e-6


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_where_robots_follow_they_never_touch_on_time(name, neighbourhood, clock):
    tessellation = Tessellation(name, neighbourhood, "euclidean", clock)
    _, moves, nearest, contacts = drive(tessellation, "allow", range(swept(50)))
    assert moves > 20 and contacts == 0
    assert nearest >= least_distance(tessellation) - 1e-6


def nearest_plan(tessellation, following):
    """Return two robots that come as near as they can, the row of their pair, and by how much the second is later."""
    pairs = pairs_of(tessellation.name, tessellation.neighbourhood)
    least, (row, delay) = pairs.nearest_legal(tessellation, following)
    frame = th.Frame(1.0, robot_radius=least_distance(tessellation, following=following) / 2)
    area = th.Area(tessellation, np.zeros((40, 40)), frame=frame)
    a, to_a, b, to_b = (tuple(map(int, cell)) for cell in pairs.cells[row])
    actions = []
    for start, target, late in ((a, to_a, max(0, -delay)), (b, to_b, max(0, delay))):
        steps = tessellation.step_of_direction[int(tessellation.orientation_of_cell(*start))].tolist()
        step = [target[0] - start[0], target[1] - start[1]]
        actions.append([WAIT] * late + [WAIT if step == [0, 0] else steps.index(step)])
    scenario = th.Scenario(area, [(0, 0)], [a, b], following=following)
    plan = plan_from_lists(scenario, actions)
    assert {conflict.kind for conflict in th.audit_plan(plan).conflicts} == {"arrival"}  # both stop on the way
    return plan, pairs.point[row], least


def touch_when_wider(tracks, radius):
    assert contacts_between_robots(tracks, radius) == []
    return len(contacts_between_robots(tracks, radius + A_LITTLE)) >= 1


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_on_time_robots_of_the_greatest_radius_just_touch(name, neighbourhood, clock):
    plan, _, _ = nearest_plan(Tessellation(name, neighbourhood, "euclidean", clock), "allow")
    assert touch_when_wider(tracks_on_time(plan), plan.scenario.area.frame.robot_radius)


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_an_adversary_lets_robots_of_the_greatest_radius_just_touch(name, neighbourhood, clock):
    plan, (a, to_a, b, to_b), least = nearest_plan(Tessellation(name, neighbourhood, "euclidean", clock), "forbid")
    shares = np.linspace(0, 1, 61)  # the nearest points of two such segments lie at halves or thirds
    first, second = a + shares[:, None] * (to_a - a), b + shares[:, None] * (to_b - b)
    apart = np.hypot(*np.moveaxis(first[:, None] - second, -1, 0))
    at = np.unravel_index(apart.argmin(), apart.shape)
    assert apart[at] == pytest.approx(least)

    def pace(move):
        share = shares[at[move.robot]]
        return 0.0, [(share, share), (100.0, share), (1 - share, 1.0)]  # both stop where they are nearest

    assert touch_when_wider(tracks_of_adversary(plan, pace), plan.scenario.area.frame.robot_radius)


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_where_robots_follow_an_adversary_would_be_caught(name, neighbourhood):
    """The judge sees contacts where there are some: plans of followers, at the radius that the other rule allows."""
    tessellation = Tessellation(name, neighbourhood, "euclidean")
    radius, seen = least_distance(tessellation, following="forbid") / 2, 0
    for seed in range(4):
        tracks = tracks_on_time(random_plan_in_metres(tessellation, "allow", seed))
        seen += len(contacts_between_robots(tracks, radius))
    assert seen > 0
