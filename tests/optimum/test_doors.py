"""The optimum where doors have a flow, by each of its ways, against OR-tools; arrivals; what is refused."""

import numpy as np
import pytest

import trihex as th
from tests.optimum.test_optimal import cannot_always_be_proven
from tests.oracles import flow as oracle_flow
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.optimum import Network, flow
from trihex.planners import make_earliest_arrivals, make_plan, optimal


def scenarios(first, count):
    """Scenarios with doors of which a flow knows all rules."""
    for seed in range(first, first + count):
        scenario = random_scenario(seed, sides=(3, 7), most_robots=24)
        if not cannot_always_be_proven(scenario):
            scenario = with_random_doors(scenario)
            yield with_start_times(scenario, seed) if seed % 3 == 0 else scenario


@pytest.mark.parametrize("way", ["usual", "singly", "slots", "prices"])
def test_the_least_total_time_is_that_of_or_tools(monkeypatch, way):
    if way in ("slots", "prices"):
        monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    if way == "singly":
        monkeypatch.setattr(flow, "_meet_seldom", lambda network, cells: True)
    if way == "prices":
        monkeypatch.setattr(Network, "has_equal_steps", property(lambda self: False))
    for scenario in scenarios(0, swept(100, 25)):
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean and plan.optimal, scenario.seed
        assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 5), scenario.seed


def test_the_curve_of_arrivals_is_attained_and_bounded():
    for scenario in scenarios(500, swept(60, 15)):
        plan = make_plan(scenario, "optimal", objective="steps")
        least = oracle_flow.least_total_time(scenario, plan.steps + 5, count_steps=True)
        assert plan.arrival_step_of_robot[plan.arrived].sum() == least, scenario.seed
        earliest = make_earliest_arrivals(scenario)
        assert earliest.name == "optimum"
        bound = make_earliest_arrivals(scenario, most_exact=0)
        assert (bound.steps <= earliest.steps).all(), scenario.seed
        fcost = make_plan(scenario, "fcost")
        assert (np.sort(fcost.arrival_step_of_robot[fcost.arrived]) >= earliest.steps).all(), scenario.seed


def test_a_certificate_needs_doors_that_are_always_open():
    scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 0]]), [0], [2], destination_capacity="1/2")
    with pytest.raises(th.PlanError, match="a certificate needs destinations that let in as many in each step"):
        th.make_certificate(make_plan(scenario, "optimal"))
