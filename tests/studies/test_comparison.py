"""Comparisons: gaps to the best that is known, refusals, seconds by the clock given."""

from itertools import count

import pytest

import trihex as th
from trihex import planners
from trihex.errors import TooLargeError
from trihex.kernels.codes import WAIT
from trihex.plans import plan_from_lists
from trihex.studies import comparison, on_tessellations

ROW = th.Area("square", [[0, 0, 0, 0]], "row")
SCENARIO = th.Scenario(ROW, [(3, 0)], [(0, 0), (1, 0)])
E = 1


class Made:
    """Planners that return what they are told, in place of the registered ones."""

    def __init__(self, **plans):
        self.plans = plans

    def __call__(self, scenario, planner, *, n_scheme=None, **options):
        if scenario.robot_count < 2:
            return plan_from_lists(scenario, [[E, E, E]])
        if self.plans[planner] is None:
            raise TooLargeError(f"memory must be at most 1, not {options['most']}")
        actions, optimal = self.plans[planner]
        return plan_from_lists(scenario, actions, planner=planner, optimal=optimal)


def compared(monkeypatch, scenario, planners, **plans):
    monkeypatch.setattr(comparison, "make_plan", Made(**plans))
    monkeypatch.setattr(comparison, "planner_from", lambda name: (name, {}))
    clock = count()
    return comparison.make_comparison([scenario], planners, clock=lambda: next(clock)).rows()


SLOW = ([[WAIT, E, E, E], [WAIT, E, E]], False)
FAST = ([[E, E, E], [E, E]], False)


def test_a_gap_is_marked_as_one_to_the_bound(monkeypatch):
    (row,) = compared(monkeypatch, SCENARIO, ["slow"], slow=SLOW)
    assert (row["planner"], row["tessellation"], row["area"], row["robots"]) == ("slow", "square", "row", 2)
    assert (row["total_time"], row["reference"], row["reference_name"], row["is_proven"]) == (70, 50, "distance", False)
    assert row["gap"] == pytest.approx(0.4)
    assert (row["steps"], row["longest_time"], row["conflicts"], row["seconds"]) == (4, 40, 0, 1)


def test_a_plan_that_attains_the_bound_proves_it_for_all(monkeypatch):
    slow, fast = compared(monkeypatch, SCENARIO, ["slow", "fast"], slow=SLOW, fast=FAST)
    assert (slow["reference_name"], slow["is_proven"], fast["gap"]) == ("optimum", True, 0)


def test_the_proven_optimum_is_the_reference_even_above_the_bound(monkeypatch):
    # Nobody would prove this one, but the comparison has to believe it.
    slow, proven = compared(monkeypatch, SCENARIO, ["slow", "proven"], slow=SLOW, proven=(SLOW[0], True))
    assert (slow["reference"], slow["gap"], slow["is_proven"], proven["gap"]) == (70, 0, True, 0)


def test_a_refusal_is_an_entry(monkeypatch):
    rows = compared(monkeypatch, SCENARIO, {"refuses": {"most": 2}, "slow": {}}, refuses=None, slow=SLOW)
    assert rows[0]["refusal"] == "memory must be at most 1, not 2"
    assert {rows[0][key] for key in ("total_time", "gap", "seconds", "is_proven")} == {None}
    assert rows[1]["refusal"] == ""
    assert rows[0].keys() == rows[1].keys()


def test_registered_planners_on_all_tessellations_with_progress():
    told = []
    scenarios = on_tessellations(SCENARIO, ["triangular", "hexagonal", "square"])
    rows = th.make_comparison(scenarios, list(planners.PLANNERS), progress=lambda *done: told.append(done)).rows()
    assert [row["tessellation"] for row in rows[:: len(planners.PLANNERS)]] == ["triangular", "hexagonal", "square"]
    assert all(row["conflicts"] == 0 and row["gap"] >= 0 for row in rows)
    assert told == [(i, len(rows)) for i in range(1, len(rows) + 1)]


def test_planners_are_told_apart_by_their_options():
    area = th.Area("square", [[0, 0, 0, 0, 0], [0, 1, 0, 1, 0], [0, 0, 0, 0, 0]])
    scenario = th.Scenario(area, [(2, 1)], th.random_robots(area, 9, seed=2, avoid=[(2, 1)]))
    wanted = ["fcost", "fcost:rule=paper", "fcost: rule=queue"]
    rows = th.make_comparison([scenario], wanted).rows()
    assert [row["planner"] for row in rows] == wanted
    rules = ("best", "paper", "queue")
    assert [row["total_time"] for row in rows] == [th.make_plan(scenario, rule=rule).total_time for rule in rules]
    (mapped,) = th.make_comparison([scenario], {"fcost:rule=best": {"rule": "paper"}}).rows()
    assert mapped["total_time"] == rows[1]["total_time"]


@pytest.mark.parametrize(
    ("planner", "message"),
    [
        (
            "fcost:rulle=paper",
            "option of planner 'fcost' must be one of rule, rounds, not 'rulle'; did you mean 'rule'?",
        ),
        ("fcost:rule", "planner 'fcost:rule' must be NAME:OPTION=VALUE, not 'rule'"),
        ("fcost:rule=a:rule=b", "planner 'fcost:rule=a:rule=b' must name each option once, not 'rule' twice"),
        ("fcost:", "planner 'fcost:' must be NAME:OPTION=VALUE, not ''"),
        ("greedy:rule=paper", "planner 'greedy' has no options, so not 'rule'"),
        ("fcots:rule=", "planner must be one of greedy, fcost, astar, optimal, not 'fcots'; did you mean 'fcost'?"),
        (3, "planner must be a name, such as 'fcost' or 'fcost:rule=paper', not 3"),
    ],
)
def test_mistakes_in_a_planner_with_options_are_told(planner, message):
    with pytest.raises(th.PlanError) as error:
        planners.planner_from(planner)
    assert str(error.value) == message


def test_values_of_options_are_refused_before_anyone_plans():
    told = []
    with pytest.raises(th.PlanError, match=r"rule must be one of .*, not 'papr'"):
        th.make_comparison([SCENARIO], ["greedy", "fcost:rule=papr"], progress=lambda *done: told.append(done))
    assert told == []


def test_numbers_among_options_are_numbers():
    assert planners.planner_from("astar:memory_limit=3e9") == ("astar", {"memory_limit": 3e9})


def test_an_unknown_planner_is_refused():
    with pytest.raises(th.PlanError, match="planner must be one of"):
        th.make_comparison([SCENARIO], ["greedier"])


def test_other_tessellations_keep_costs_and_neighbourhood():
    shape = th.Tessellation("square", "edge", "euclidean")
    scenario = th.Scenario(th.Area(shape, [[0, 0, 1], [0, 0, 0]]), [(0, 0)], [(2, 1)])
    (turned,) = on_tessellations(scenario, ["triangular"])
    assert turned.area.tessellation == th.Tessellation("triangular", "edge", "euclidean")
