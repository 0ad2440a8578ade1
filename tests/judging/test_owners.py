"""The judge where moves last or nobody follows: each rule broken on purpose, and plans against an oracle."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import trihex as th
from tests.judging.test_audit import NE, SE, SW, E, N, S, W, nonsense, squares
from tests.oracles.owners import judge, keeps_to_the_rules
from tests.oracles.wanderers import wandering_plan
from tests.strategies import random_scenario, with_slowness, with_start_times
from tests.sweeps import swept
from trihex.areas import CLOCKS, FOLLOWINGS
from trihex.judging.conflict import KINDS
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import plan_from_lists

ALLOW, FORBID = {"clock": "costs"}, {"clock": "costs", "following": "forbid"}
STEPS = {"following": "forbid"}
AFTER = [WAIT] * 5  # as long as a move across an edge

CLEAN = [
    squares("abD", [[E, E], [E]], **ALLOW),  # each enters the cell that the other leaves
    squares("ab. dcD", [[E, E, S], [E, S], [E], [N, E, E, S]], **ALLOW),  # nobody waits, all turn
    squares("ab DD", [[SE], [SW]], crossing="allow", **ALLOW),
    squares("abD", [[*AFTER, E, *AFTER, E], [E]], **FORBID),
    squares("abD", [[WAIT, E, WAIT, E], [E]], **STEPS),
    squares("a#D", [[]], **FORBID),
    squares("aDb", [[E], [W]], **FORBID),
    squares("aDb", [[E], [*AFTER[:3], W]], destination_capacity=1, **ALLOW),  # one owns D from 2.5 to 5, one from 5.5
    squares("aDb", [[E], [*AFTER, W]], destination_capacity=1, **FORBID),
    squares("ab DD", [[SE], [*AFTER, WAIT, WAIT, SW]], **ALLOW),  # the vertex is free after seven ticks
    squares("abD", [[WAIT, WAIT, E, E], [E]], slowness=[2, 5]),  # a comes after 3 steps, b is gone after 2.5
    squares("abD", [[WAIT, WAIT, WAIT, E, E], [E]], slowness=[1, 3], following="forbid"),
]
BOTH = "robots 0 and 1 both own cell"
# Each rule broken once: the plan, the kind, and how the conflict reads.
BROKEN = [
    # b is in its cell until half of 5 ticks are over, a in the same after half of 5, a tick too early
    (squares("ab.D", [[E, WAIT, E, E], [WAIT, E, E]], **ALLOW), "cell", f"step 3: {BOTH} (1, 0)"),
    (squares("ab.D", [[E, WAIT, E, E], [E, WAIT, WAIT, E]], **ALLOW), "cell", f"step 9: {BOTH} (2, 0)"),
    (squares("abD", [[*AFTER[1:], E, WAIT, E], [E]], **FORBID), "cell", f"step 5: {BOTH} (1, 0)"),
    (squares("abD", [[E, E], [E]], **STEPS), "cell", f"step 1: {BOTH} (1, 0)"),
    (squares("abD", [[WAIT, E, E], [E]], slowness=[1, 5]), "cell", f"step 2: {BOTH} (1, 0)"),
    (
        squares("abD ...", [[E, E], [W, S, E, NE]], **ALLOW),
        "exchange",
        "step 1: robots 0 and 1 exchange cells (0, 0) and (1, 0)",
    ),
    (
        squares("ab DD", [[SE], [*AFTER, WAIT, SW]], **ALLOW),
        "crossing",
        "step 7: robots 0 and 1 pass one vertex, from (0, 0) to (1, 1) and from (1, 0) to (0, 1)",
    ),
    (
        squares("a..D", [[JUMP, E]], jumps=[(0, 2)], **ALLOW),
        "jump",
        "step 1: robot 0 jumps from (0, 0) to (2, 0), which is no neighbour",
    ),
    (squares("a#D", [[WAIT, E, E]], **FORBID), "barrier", "step 2: robot 0 moves from (0, 0) onto the barrier (1, 0)"),
    (squares("aD", [[W]], **FORBID), "barrier", "step 1: robot 0 leaves the area from (0, 0)"),
    (
        squares("a# .D", [[SE]], corners="no-cut", **ALLOW),
        "corner",
        "step 1: robot 0 moves from (0, 0) to (1, 1) round a corner that the rule closes",
    ),
    (
        squares("aDb", [[E], [*AFTER[:2], W]], destination_capacity=1, **ALLOW),
        "capacity",
        "step 5: robot 1 is one too many to enter destination (1, 0)",
    ),
    (
        squares("aDb", [[E], [*AFTER[1:], W]], destination_capacity=1, **FORBID),
        "capacity",
        "step 5: robot 1 is one too many to enter destination (1, 0)",
    ),
    (
        squares("a.D", [[E, WAIT]], **ALLOW),
        "arrival",
        "step 6: robot 0 ends in (1, 0), which is no destination, though it could have reached one",
    ),
    (
        squares("aD.", [[E, E]], **FORBID),
        "arrival",
        "step 5: robot 0 acts on after it has entered destination (1, 0)",
    ),
    (
        squares("aD.", [[*AFTER, E]], start_times=6, **FORBID),
        "start",
        "step 6: robot 0 leaves (0, 0) before its start time, 6",
    ),
]


@pytest.mark.parametrize("plan", CLEAN)
def test_a_clean_plan_is_clean(plan):
    audit = th.audit_plan(plan)
    assert audit.is_clean, [str(c) for c in audit.conflicts]


@pytest.mark.parametrize(("plan", "kind", "text"), BROKEN)
def test_each_rule_broken_once_is_found(plan, kind, text):
    audit = th.audit_plan(plan)
    assert [(c.kind, str(c)) for c in audit.conflicts] == [(kind, text)]
    assert (audit.conflict_count, audit.is_clean) == (1, False)


def test_every_kind_is_broken_above():
    assert {kind for _, kind, _ in BROKEN} == set(KINDS)


def test_where_nobody_follows_an_exchange_is_found_and_that_both_own_both_cells():
    plan = squares("abD ...", [[E, WAIT, E], [W, S, E, WAIT, NE]], **STEPS)
    assert [str(conflict) for conflict in th.audit_plan(plan).conflicts] == [
        "step 1: robots 0 and 1 exchange cells (0, 0) and (1, 0)",
        "step 1: robots 0 and 1 both own cell (1, 0)",
        "step 1: robots 0 and 1 both own cell (0, 0)",
    ]


def test_who_stops_owns_its_cell_for_good_and_who_meets_several_is_charged_with_the_last_to_leave():
    # Robots 1 and 2 share (2, 0): one goes on after 20 ticks, one stays there. Robot 0 comes after both.
    area = th.Area("square", np.zeros((1, 9)))
    scenario = th.Scenario(area, [(8, 0)], [(0, 0), (1, 0), (3, 0)], clock="costs")
    plan = plan_from_lists(scenario, [[WAIT] * 10 + [E, E, WAIT], [E] + [WAIT] * 30 + [E] * 6, [WAIT, W]])
    assert [str(conflict) for conflict in th.audit_plan(plan).conflicts] == [
        "step 4: robots 1 and 2 both own cell (2, 0)",
        "step 6: robot 2 ends in (2, 0), which is no destination, though it could have reached one",
        "step 18: robots 0 and 2 both own cell (2, 0)",
        "step 21: robot 0 ends in (2, 0), which is no destination, though it could have reached one",
    ]


def test_no_more_conflicts_are_described_than_asked_for_but_all_are_counted():
    area = th.Area("square", np.zeros((2, 40), bool))
    scenario = th.Scenario(area, [(39, 1)], [(x, 0) for x in range(30)], **FORBID)
    plan = plan_from_lists(scenario, [[E] * (39 - x) for x in range(30)])
    few, all_of_them = th.audit_plan(plan, limit=4), th.audit_plan(plan)
    assert few.conflict_count == all_of_them.conflict_count > 30
    assert few.conflicts == all_of_them.conflicts[:4]
    told = []
    th.audit_plan(plan, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (plan.actions.size, plan.actions.size)


def timed_scenario(seed, **limits):
    """Return a random scenario with a clock and a rule of following, not the pair that is judged step by step."""
    rng, scenario = np.random.default_rng(seed), random_scenario(seed, **limits)
    clock, following = CLOCKS[rng.integers(2)], FOLLOWINGS[rng.integers(2)]
    timed = replace(scenario, waiting_cost=None, clock=clock, following=following)
    timed = replace(timed, following="forbid") if timed.is_stepwise else timed
    return with_slowness(timed, seed) if seed % 2 else timed


def mutated(plan, rng):
    """Return a plan with some actions changed, left out, put in or taken over from another robot."""
    own = [plan.actions[a:b].tolist() for a, b in zip(plan.first_action, plan.first_action[1:], strict=False)]
    acting = [actions for actions in own if actions]
    for _ in range(rng.integers(1, 4) if acting else 0):
        actions = acting[rng.integers(len(acting))]
        at, change = int(rng.integers(len(actions) + 1)), rng.integers(4)
        if change == 0:
            actions.insert(at, WAIT)
        elif change == 1:
            del actions[at : at + 1]
        elif change == 2:
            actions[at : at + 1] = [int(rng.integers(plan.scenario.area.tessellation.direction_count))]
        else:
            actions[at:] = acting[rng.integers(len(acting))][at:]
    return plan_from_lists(plan.scenario, own)


def check_with_the_oracle(plan):
    audit = th.audit_plan(plan, limit=10**6)
    assert audit.is_clean == keeps_to_the_rules(plan)
    assert sorted((c.kind, c.step, c.robots, c.cells) for c in audit.conflicts) == judge(plan)
    assert audit.conflict_count == len(audit.conflicts)
    assert [c.step for c in audit.conflicts] == sorted(c.step for c in audit.conflicts)


@settings(max_examples=swept(400), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_the_judge_agrees_with_one_that_writes_down_who_owns_what(seed):
    rng, scenario = np.random.default_rng(seed), timed_scenario(seed, sides=(1, 5), most_filled=0.6)
    check_with_the_oracle(nonsense(with_start_times(scenario, seed, latest=9), seed))
    plan = wandering_plan(scenario, seed)
    if plan is not None:
        assert th.audit_plan(plan).is_clean and plan.arrived.sum() == len(plan.scenario.robots) - still(plan)
        check_with_the_oracle(mutated(plan, rng))
        check_with_the_oracle(replace(plan, scenario=replace(scenario, following="forbid")))


def still(plan):
    """How many robots of a plan cannot arrive: those that do nothing and are on no destination."""
    is_home = np.isin(plan.scenario.robots, plan.scenario.destinations)
    return np.count_nonzero((np.diff(plan.first_action) == 0) & ~is_home)


@pytest.mark.parametrize("seed", range(swept(60)))
def test_what_keeps_to_the_rules_in_steps_is_clean_by_both_judges(seed):
    scenario = replace(random_scenario(seed, sides=(2, 5), most_filled=0.5), following="allow")
    plan = wandering_plan(scenario, seed)
    if plan is not None:
        assert scenario.is_stepwise and th.audit_plan(plan).is_clean and keeps_to_the_rules(plan)
    nonsensical = nonsense(scenario, seed)
    assert th.audit_plan(nonsensical).is_clean == keeps_to_the_rules(nonsensical)
