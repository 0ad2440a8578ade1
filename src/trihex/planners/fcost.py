"""Planner `fcost`: the paper's planner, which weighs a longer way against waiting."""

from __future__ import annotations

import numpy as np

from trihex.areas import Scenario
from trihex.errors import PlanError, check_choice, check_whole
from trihex.fields import DScheme, NScheme, make_d_scheme
from trihex.kernels.codes import NOT_REACHED
from trihex.planners.catchments import Catchments, exits_of
from trihex.planners.crowd import count_going, make_crowd
from trihex.planners.greedy import run_greedy
from trihex.planners.lanes import Lanes, make_lanes, price_of_waiting
from trihex.planners.mending import may_mend, mend
from trihex.planners.recording import Progress, Recording
from trihex.planners.slots import Slots
from trihex.planners.timely import simulate
from trihex.plans import Arrivals, Plan, make_arrivals

RULES = ("best", "paper", "queue", "aside", "lanes")
# Robot-steps up to which "best" tries "lanes" as well, and how many cells times destinations there may be for each of
# them: a search for a lane may visit all cells, once for each way into a destination.
_FEW, _SPARSE = 2_000_000, 32
# Looking for lanes may take about as long as planning does: so many nodes, and one for every fourth robot-step.
_VISITS = 50_000
# Exits get prices where robots lose more than such a part of the time, among so many destinations at most;
_WORTH, _MOST_DESTINATIONS = 0.03, 1000
# up to so many robot-steps, and so many cells times destinations for each of them, as some robots are asked for all.
_MANY_STEPS, _SPARSER = 20_000_000, 128
# Lanes without prices are then not looked for where so many robot-steps take no more than so many times the distances.
_LARGE, _ENOUGH = 100_000, 1.08
# Of so many robots and more each looks for a way better than a free one in every fourth step only: half the time, and
# totals 0.2 % larger; in small crowds it would be 1 to 2 %.
_MANY, _PERIOD = 10_000, 4
# Robots look ahead without being told to in plans of so many actions at most: beyond, plans take a tenth of a millionth
# of a second for each, and to look ahead takes two to six times that.
_MOST_ACTIONS = 2_000_000


def plan_fcost(
    n_scheme: NScheme, *, rule: str = "best", rounds: int | None = None, progress: Progress | None = None
) -> Plan:
    """Plan by the least Fcost = v + V + w_t * c (section IV of the paper), step by step.

    In each step each robot takes the free direction of least Fcost, and waits where the best direction, though taken,
    promises less. Who stands in the way of another is asked before it. Regions are as in `plan_greedy`; under "paper"
    there are none.

    Parameters
    ----------
    n_scheme : NScheme
    rule : {"best", "paper", "queue", "aside", "lanes"}
        What c is. "paper": the number of other robots whose shortest path meets the path that starts with a direction
        (same cell, same step); the first robot of each branch of the D-scheme descends. "queue": the length of the line
        that they have formed when the robot gets there, each place at w_t or the cheapest move, whichever is less; a
        robot that would wait may step to a cell no farther away if that costs no more. "aside": the same, and a blocked
        robot always steps to such a cell unless it has just left it. "lanes": the same, and V is not the least distance
        but that along lanes, as many as there is room for, see `trihex.planners.lanes`. "best": "aside" or greedy
        descent, whichever takes less total time, and "lanes", too, where to look for them takes no longer than to plan;
        with several exits also lanes within the catchment of each, see `trihex.planners.catchments`.
    rounds : int, optional
        How often all robots go along their ways and look ahead for cheaper ones, see `trihex.planners.mending`. More
        rounds, better plans: with 8 it takes four to nine times as long. Default: once, under "best", where not all
        steps cost the same and the plan has two millions of them at most; else never.
    progress : callable, optional
        Called with (robots arrived, robots that can arrive), of one rule or round after the other.

    Raises
    ------
    PlanError
        If robots cannot act by the rule in the scenario, or look ahead in it.
    """
    _check_rounds(rounds, n_scheme.scenario)
    plan = _run(n_scheme, rule, True, progress).make_plan("fcost")
    if rounds is None:
        rounds = int(_looks_ahead(n_scheme, rule) and plan.actions.size <= _MOST_ACTIONS)
    return mend(plan, n_scheme, rounds, progress) if rounds else plan


def arrivals_fcost(
    n_scheme: NScheme, *, rule: str = "best", rounds: int | None = None, progress: Progress | None = None
) -> Arrivals:
    """Return the arrivals of what `plan_fcost` plans; where robots look ahead, all is planned for it."""
    _check_rounds(rounds, n_scheme.scenario)
    if rounds or (rounds is None and _looks_ahead(n_scheme, rule)):
        return make_arrivals(plan_fcost(n_scheme, rule=rule, rounds=rounds, progress=progress))
    return _run(n_scheme, rule, False, progress).make_arrivals("fcost")


def has_unequal_steps(scenario: Scenario) -> bool:
    """Tell whether steps of a scenario cost this or that, so that robots look ahead without being told to."""
    return may_mend(scenario) and bool((scenario.area.tessellation.cost_of_direction != scenario.waiting_cost).any())


def _looks_ahead(n_scheme: NScheme, rule: str) -> bool:
    """Tell whether robots look ahead, without being told to, unless they turn out to wait for long."""
    if rule != "best" or not has_unequal_steps(n_scheme.scenario):
        return False
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots)
    dearest = int(n_scheme.scenario.area.tessellation.cost_of_direction.max())
    return int(distance[distance != NOT_REACHED].sum()) // dearest <= _MOST_ACTIONS


def _check_rounds(rounds: int | None, scenario: Scenario) -> None:
    """Raise PlanError if rounds are no number, or robots cannot look ahead in a scenario."""
    if rounds is None:
        return
    check_whole("rounds", rounds, 0, None, PlanError)
    if rounds and not may_mend(scenario):
        raise PlanError(
            f"rounds must be 0, not {rounds}, where moves last, nobody follows at once, robots have start times or "
            "slowness, doors have a flow, or waiting costs more than 2^25: robots cannot look ahead there"
        )


def _run(n_scheme: NScheme, rule: str, keeps_actions: bool, progress: Progress | None) -> Recording:
    """Return the recording of a rule, or of the best of some.

    What can no longer become the best is given up: greedy descent shows early how much waiting it costs.
    """
    check_choice("rule", rule, RULES, PlanError)
    scenario = n_scheme.scenario
    if rule == "paper" and scenario.has_slowness:
        raise PlanError("rule must not be 'paper' where robots have slowness: in the paper all are as fast")
    if rule == "paper" and not scenario.is_stepwise:
        raise PlanError(
            f"rule must not be 'paper' where clock is {scenario.clock!r} and following {scenario.following!r}: "
            "it counts who is in a cell in the same step; 'queue' counts lines"
        )
    if rule == "paper" and scenario.has_start_times:
        raise PlanError("rule must not be 'paper' where there are start_times: in the paper all robots begin at once")
    if rule == "paper" and scenario.has_flows:
        raise PlanError("rule must not be 'paper' where doors have a flow: in the paper none is ever shut")
    if rule == "lanes":
        return _simulated(make_lanes(n_scheme).d_scheme, "aside", keeps_actions, progress)
    d_scheme = make_d_scheme(n_scheme)
    if rule != "best":
        return _simulated(d_scheme, rule, keeps_actions, progress)
    best = _simulated(d_scheme, "aside", keeps_actions, progress)
    steps = best.crowd.arrival.sum() // scenario.duration_of_direction.min()
    spread = scenario.area.free_count * scenario.destinations.size
    has_lanes = steps <= _FEW and spread <= _SPARSE * steps
    most_visits = _VISITS + int(steps) // 4
    has_prices = steps <= _MANY_STEPS and spread <= _SPARSER * steps
    shared = _shared(d_scheme, best, most_visits) if has_prices else None
    if shared is not None:
        lanes, paid = shared
        distances = best.crowd.total_distance
        best = _better(best, _simulated(lanes.d_scheme, "aside", keeps_actions, progress, best.total_time + paid))
        has_lanes = has_lanes and (steps < _LARGE or best.total_time > _ENOUGH * distances)
    best = _better(best, run_greedy(n_scheme, keeps_actions, progress, best.total_time))
    if steps <= _FEW and not scenario.moves_by_steps:  # small crowds gain 1 to 2 %
        best = _better(best, _simulated(d_scheme, "queue", keeps_actions, progress, best.total_time))
    if has_lanes:
        lanes = make_lanes(n_scheme, most_visits=most_visits)
        best = _better(best, _simulated(lanes.d_scheme, "aside", keeps_actions, progress, best.total_time))
    return best


def _shared(d_scheme: DScheme, first: Recording, most_visits: int) -> tuple[Lanes, int] | None:
    """Return lanes within catchments, and what exits are said to cost; None where nobody had better go elsewhere."""
    scenario = d_scheme.n_scheme.scenario
    is_told = scenario.moves_by_steps and scenario.waiting_cost > 0  # by arrivals, how many an exit lets in
    if not is_told or not 1 < scenario.destinations.size <= _MOST_DESTINATIONS:
        return None
    if first.lost <= _WORTH * first.total_time or exits_of(scenario).max() == 0:
        return None
    return Catchments(d_scheme, first.crowd).make_lanes(most_visits)


def _better(one: Recording, other: Recording) -> Recording:
    """Return the recording of less total time, the first of equal ones; none that has given up."""
    return min(one, other, key=lambda recording: (not recording.is_over, recording.total_time))


def _simulated(
    d_scheme: DScheme, rule: str, keeps_actions: bool, progress: Progress | None, limit: float = float("inf")
) -> Recording:
    """Simulate until all have arrived, or the total time is sure to be `limit` or more."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import choice, fcost as kernels

    scenario = d_scheme.n_scheme.scenario
    is_literal = rule == "paper"
    weighing = choice.Rule(
        counts=choice.MEETINGS if is_literal else choice.QUEUE,
        aside={"paper": choice.STAY, "queue": choice.WORTH, "aside": choice.ALWAYS}[rule],
        period=1 if count_going(d_scheme.n_scheme) <= _MANY else _PERIOD,
        # At w_t robots would run from line to line: with w_t three moves, plans took 4.5 times as long as greedy's.
        price=scenario.waiting_cost if is_literal else price_of_waiting(scenario),
    )
    if not scenario.moves_by_steps:
        return simulate(d_scheme, weighing, keeps_actions, progress, limit)
    slots = Slots(d_scheme, is_literal)
    crowd = make_crowd(d_scheme.n_scheme, slots.find_regions)
    asking = given(
        kernels.Asking,
        row=np.empty(crowd.robot.size, dtype=np.int32),
        asked=np.zeros(crowd.robot.size, dtype=np.int32),
        came_from=np.zeros(crowd.robot.size, dtype=np.int32),
        captain_of_region=np.zeros(crowd.count_of_region.size, dtype=np.int32),
        waiting=np.empty(crowd.robot.size, dtype=np.int32),
    )
    nouns = (weighing, slots.ways, *slots.for_kernels(), asking)
    recording = Recording(crowd, keeps_actions)
    recording.run(lambda *shared: kernels.weigh(*nouns, *shared), progress, limit)
    return recording
