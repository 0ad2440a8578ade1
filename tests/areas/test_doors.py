"""Flows as users write them, doors and their schedule, against one that is counted slot by slot."""

from fractions import Fraction

import numpy as np
import pytest

import trihex as th
from tests.oracles.doors import Openings
from tests.strategies import random_scenario, with_random_doors
from tests.sweeps import swept
from trihex.areas import flow_from, flow_in_words

CELLS = th.Area("hexagonal", np.zeros((3, 4), bool), zones=[th.Zone("north", [0, 1])])
METRES = th.Area("hexagonal", np.zeros((3, 4), bool), frame=th.Frame(0.5))


@pytest.mark.parametrize(
    ("given", "flow"),
    [(2, 2), (np.int64(3), 3), (0.5, Fraction(1, 2)), (Fraction(2, 7), Fraction(2, 7)), ("1/3", Fraction(1, 3)),
     ("0.25", Fraction(1, 4)), (".5", Fraction(1, 2)), (np.float32(0.25), Fraction(1, 4)), (0.1, Fraction(1, 10))],
)  # fmt: skip
def test_a_flow_may_be_written_in_many_ways(given, flow):
    scenario = th.Scenario(CELLS, [11], destination_capacity=given)
    assert scenario.destination_capacity == flow
    assert type(scenario.destination_capacity) is (int if flow == int(flow) else Fraction)
    assert th.Scenario(CELLS, [0], doors={"north": given}).doors[0].flow == flow


def test_robots_a_second_depend_on_how_long_a_step_lasts():
    assert th.Scenario(METRES, [0], destination_capacity="1.6/s").destination_capacity == Fraction(4, 5)
    assert flow_from("it", "1.6/s", METRES, step_seconds=0.25) == Fraction(2, 5)
    assert flow_in_words(Fraction(4, 5), METRES, 0.5) == "1.6/s"
    assert flow_in_words(Fraction(4, 5), CELLS) == "4/5 a step"


@pytest.mark.parametrize(
    "given", [0, -1, "0", "x", "", "1/0", True, None, [1], float("nan"), "1e9", 2**31, "-1/s", "1.6 m"]
)
def test_what_is_no_flow_is_refused(given):
    with pytest.raises(th.ScenarioError, match="capacity of door 'north' must be a number of robots above 0: a step"):
        th.Scenario(CELLS, [0], doors={"north": given})


@pytest.mark.parametrize(
    ("doors", "message"),
    [
        ({"north": "1.6/s"}, "capacity of door 'north' must be robots a step, such as 0.5, in an area without metres"),
        ({"north": 1e-6}, "capacity of door 'north' must be from 1/10000 to 1073741824 robots a step, not 1e-06"),
        ({"nroth": 1}, "door: zone must be one of north, not 'nroth'; did you mean 'north'"),
        ([([0, 1], 1), ([1, 2], 1)], r"doors must not share cells; door 1 and door 0 have \(1, 0\)"),
        ([([], 1)], "door 0 must have 1 to 10000 free cells, not 0"),
        ([([99], 1)], "cells of a door: cell number 99 lies outside"),
        ([3], r"a door must be a pair \(places or a name, flow\), not 3"),
        (7, "doors must be flows by the names of zones, or a list of doors, not int"),
    ],
)  # fmt: skip
def test_doors_that_do_not_fit_are_refused(doors, message):
    with pytest.raises(th.ScenarioError, match=message):
        th.Scenario(CELLS, [0], doors=doors)


def test_a_door_on_a_barrier_is_refused():
    area = th.Area("square", [[0, 1, 0]])
    with pytest.raises(th.ScenarioError, match=r"door 0 must have free cells; \(1, 0\) is a barrier"):
        th.Scenario(area, [0], doors=[([1, 2], 1)])


def test_the_schedule_lets_in_as_it_is_told_in_words():
    for seed in range(swept(200, 40)):
        scenario = with_random_doors(random_scenario(seed))
        openings, schedule = Openings(scenario), scenario.schedule
        places = list(zip(*(axis.tolist() for axis in scenario.area.cell_to_xy(schedule.cells)), strict=True))
        own = schedule.openings(np.arange(1, 30)).tolist()
        assert own == [[openings(place, step) for step in range(1, 30)] for place in places], seed


def test_cells_of_an_exit_that_nobody_can_enter_take_no_turns():
    """Of two rows of destinations the one behind is never entered; the front lets in all that the exit does."""
    area = th.Area("square", np.zeros((3, 4), bool))
    scenario = th.Scenario(area, range(8), [11], doors=[(range(8), 1)])
    assert scenario.schedule.cells.tolist() == [4, 5, 6, 7]
    assert scenario.schedule.openings(np.arange(1, 9)).sum(axis=0).tolist() == [1] * 8


def test_a_fraction_is_that_of_each_destination_but_doors():
    scenario = th.Scenario(CELLS, [0, 11], destination_capacity=0.5, doors={"north": 0.25})
    assert dict(
        zip(
            scenario.schedule.cells.tolist(), scenario.schedule.openings([1, 2, 3, 4, 5, 6, 7, 8]).tolist(), strict=True
        )
    ) == {
        0: [0, 0, 0, 1, 0, 0, 0, 0],
        1: [0, 0, 0, 0, 0, 0, 0, 1],
        11: [0, 1, 0, 1, 0, 1, 0, 1],
    }
    assert "door north: 1/4" in repr(scenario) and "destination_capacity=1/2" in repr(scenario)
    assert scenario.entry_limit == 1 and scenario.has_flows and not scenario.moves_by_steps
    assert th.Scenario(CELLS, [0]).moves_by_steps
