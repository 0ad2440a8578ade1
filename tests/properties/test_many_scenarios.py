"""Many random scenarios of every kind: planners end, nothing collides, all arrive who can, no plan beats a bound."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.bounds import cut_bound, distance_bound, slot_bound
from trihex.planners import PLANNERS, make_plan

COUNT = swept(10_000)
SHARES = 20
# Planners that look at every (cell, step) are asked on the smaller ones only.
THOROUGH = {"optimal", "astar"}


@pytest.mark.parametrize("share", range(SHARES))
def test_every_planner_on_many_scenarios(share):
    for seed in range(share, COUNT, SHARES):
        scenario = random_scenario(seed, sides=(3, 12))
        n_scheme = th.make_n_scheme(scenario)
        can_arrive = np.ones(scenario.robot_count, dtype=bool)
        can_arrive[n_scheme.unreachable_robots] = False
        bound = max(make(n_scheme).value for make in (distance_bound, slot_bound, cut_bound))
        for planner in sorted(set(PLANNERS) - THOROUGH):
            plan = make_plan(scenario, planner, n_scheme=n_scheme)
            audit = th.audit_plan(plan)
            assert audit.is_clean, (seed, planner, [str(conflict) for conflict in audit.conflicts])
            assert (plan.arrived == can_arrive).all(), (seed, planner)
            assert not np.diff(plan.first_action)[~can_arrive].any(), (seed, planner)
            assert plan.total_time >= bound, (seed, planner)
