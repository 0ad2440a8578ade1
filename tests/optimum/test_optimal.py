"""The optimum against min-cost flow, max flow and integer programming over drawn cells; what makes it refuse."""

import numpy as np
import pytest

import trihex as th
from tests.oracles import flow as oracle_flow
from tests.oracles.optimum import least_total_time
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.optimum import Network, earliest, flow, make_network, priced, workspace
from trihex.planners import make_plan, optimal, planner_named


def cannot_always_be_proven(scenario):
    """Where an exchange of cells had to be parted, or one vertex serves moves of several costs."""
    tessellation = scenario.area.tessellation
    two_costs = tessellation.name == "triangular" and tessellation.costs == "euclidean"
    return scenario.waiting_cost > tessellation.edge_cost or (two_costs and scenario.crossing == "forbid")


def crowded_scenario(seed):
    """A scenario of which a flow knows all rules."""
    scenario = random_scenario(seed, sides=(3, 7), most_robots=24)
    while cannot_always_be_proven(scenario):
        seed += 100_000
        scenario = random_scenario(seed, sides=(3, 7), most_robots=24)
    return scenario


@pytest.mark.parametrize("share", range(10))
def test_the_least_total_time_is_that_of_or_tools(share):
    for seed in range(share, swept(300), 10):
        scenario = crowded_scenario(seed)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean
        assert plan.optimal, seed
        assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 5), seed


def least_total_times_by(monkeypatch, module, find, seeds, **changes):
    """Plan the optimum by one way only; check it against OR-tools and return what the way gave."""
    found = []
    for name, value in changes.items():
        monkeypatch.setattr(module, name, value)
    way = getattr(optimal, find)
    monkeypatch.setattr(
        optimal, find, lambda *arguments, **options: found.append(way(*arguments, **options)) or found[-1]
    )
    for seed in seeds:
        scenario = crowded_scenario(seed)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean
        assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 5), seed
    return found


@pytest.mark.parametrize("budget", [500_000, 20])
def test_robots_served_one_after_another_cost_as_little(monkeypatch, budget):
    changes = {"_meet_seldom": lambda network, cells: True, "_BUDGET": budget}
    found = least_total_times_by(monkeypatch, flow, "make_flow_singly", range(1_000, 1_000 + swept(20, 10)), **changes)
    given_up = sum(one is None for one in found)
    assert given_up == 0 if budget > 20 else given_up > 0


@pytest.mark.parametrize("budget", [500_000, 20])
@pytest.mark.parametrize("planner", ["fcost", "greedy"])
def test_slots_exchanged_for_earlier_ones_cost_as_little(monkeypatch, planner, budget):
    monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    monkeypatch.setattr(optimal, "plan_fcost", lambda n_scheme, **options: planner_named(planner)(n_scheme))
    changes = {"_BUDGET": budget, "_LOG": 16}
    if budget == 20:  # labels found anew before each search
        changes |= {"_PATIENCE": 0, "_SHARE": 0}
    seeds = range(2_000, 2_000 + swept(100, 20))
    found = least_total_times_by(monkeypatch, earliest, "make_earliest_flow", seeds, **changes)
    assert len(found) >= len(seeds) / 4


def crowd_that_crosses(seed):
    """A larger crowd than `crowded_scenario` has, in which many slots can only be filled past many others."""
    return random_scenario(90_000 + seed, sides=(8, 24), most_robots=192)


@pytest.mark.parametrize("share", range(5))
def test_labels_found_anew_change_no_optimum(monkeypatch, share):
    """What is found dead stays so: one late path's nodes taken for dead were too much in 9 of the first 60."""
    monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    monkeypatch.setattr(optimal, "plan_fcost", lambda n_scheme, **options: planner_named("greedy")(n_scheme))
    find, times = earliest._find_labels, []
    monkeypatch.setattr(earliest, "_find_labels", lambda *arguments: times.append(1) or find(*arguments))
    for seed in ((17, 20, 22, 38, 40)[share], *range(share, swept(25, 5), 5)):
        sums = []
        for patience, budget, ahead in [(1 << 40, 500_000, 4), (0, 500_000, 4), (0, 30, 0)]:
            changes = {"_PATIENCE": patience, "_SHARE": 0, "_BUDGET": budget, "_AHEAD": ahead}
            for name, value in changes.items():
                monkeypatch.setattr(earliest, name, value)
            plan = make_plan(crowd_that_crosses(seed), "optimal", objective="steps")
            assert th.audit_plan(plan).is_clean
            sums.append(plan.arrival_step_of_robot[plan.arrived].sum())
        assert sums == [sums[0]] * 3, seed
    assert times


def plan_at_prices(monkeypatch, rebate):
    """Plan at prices that rise only; arrivals are priced by so much below what they are worth, or above, at first."""
    monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    monkeypatch.setattr(Network, "has_equal_steps", property(lambda self: False))
    monkeypatch.setattr(priced, "_REBATE", rebate)


# Arrivals a little too cheap, as ever; some too dear, so that prices fall, too; all for nothing.
REBATES = [1, -2, 1000]


@pytest.mark.parametrize("share", range(10))
def test_prices_that_rise_cost_as_little(monkeypatch, share):
    """All that may become full or end early does so; the robots crowd, on all tessellations."""
    plan_at_prices(monkeypatch, REBATES[share % 3])
    monkeypatch.setattr(workspace, "SPARE_LAYERS", 4)
    changes = {"_BUDGET": 50, "_LIST": 16, "_RISES": 8, "SPARE_LAYERS": 4}
    seeds = range(3_000 + share, 3_000 + swept(300, 30), 10)
    found = least_total_times_by(monkeypatch, priced, "make_flow_at_prices", seeds, **changes)
    assert len(found) >= len(seeds) / 4  # where waiting is free no flow is needed


def with_doors_and_start_times(seed):
    return with_random_doors(with_start_times(crowded_scenario(seed), seed))


@pytest.mark.parametrize("rebate", REBATES)
def test_prices_know_shut_doors_and_robots_that_may_not_go_yet(monkeypatch, rebate):
    """In the last three robots stand in cells that are doors, so that no way leads on past their gates."""
    plan_at_prices(monkeypatch, rebate)
    find_paths, is_toll_laid = priced._PricedWork.find_paths, []
    monkeypatch.setattr(
        priced._PricedWork, "find_paths", lambda work, *how: is_toll_laid.append(how[0]) or find_paths(work, *how)
    )
    for seed in (900_010, 900_046, 900_047, *range(4_000, 4_000 + swept(60, 9)), 4_019, 4_020, 4_029):
        scenario = with_doors_and_start_times(seed)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean, seed
        assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 5), seed
    assert all(is_toll_laid)


def test_prices_begin_at_0_once_more_where_tolls_are_not_fair(monkeypatch):
    """A toll at a gate from which no way leads on, as tests had found it: it would fall for ever."""
    plan_at_prices(monkeypatch, 1)
    lay_tolls, laid = priced._PricedWork.lay_tolls, []

    def lay_dead_end(work):
        laid.append(lay_tolls(work))
        words = work.nodes.leaving
        dead = np.flatnonzero(words == words.max())[:1]
        # 5 units more, wanted (4) and passed (8); whoever was laid there goes on by the first arc.
        work.nodes.entering[dead], work.nodes.flow[dead] = words[dead] + (5 << 4) | 4 | 8, 1
        return np.concatenate([laid[-1], dead])

    monkeypatch.setattr(priced._PricedWork, "lay_tolls", lay_dead_end)
    scenario = with_doors_and_start_times(4_029)
    plan = make_plan(scenario, "optimal")
    assert len(laid) == 1
    assert th.audit_plan(plan).is_clean
    assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 5)


def test_robots_that_queue_where_one_arrives_in_a_step_go_there_at_once(monkeypatch):
    """Nobody else is in the way of nearly all of them, so that hardly any has to be searched for."""
    go, found = priced._PricedWork._go_to_goals, []

    def go_and_count(work, slot):
        go(work, slot)
        found.append(np.count_nonzero(work.nodes.flow[work.search.start] & 15) / work.cells.size)

    monkeypatch.setattr(priced._PricedWork, "_go_to_goals", go_and_count)
    for seed, tessellation in enumerate(("triangular", "square")):
        area = th.make_caves_area(tessellation, 12, 12, seed=seed)
        goal = th.random_robots(area, 1, seed=seed)
        robots = th.random_robots(area, 22, seed=seed + 1, avoid=goal)
        scenario = th.Scenario(area, goal, robots, destination_capacity=1, start_times=[seed] * 22)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean
        assert plan.total_time == oracle_flow.least_total_time(scenario, plan.steps + 2), seed
    assert len(found) == 2
    assert min(found) > 0.9, found


@pytest.mark.parametrize("share", range(5))
def test_the_ways_to_the_optimum_agree(monkeypatch, share):
    monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    compared = 0
    for seed in range(share, swept(100, 20), 5):
        scenario = random_scenario(90_000 + seed, sides=(8, 24), most_robots=120)
        for objective in ("time", "steps"):
            with monkeypatch.context() as patch:
                one = make_plan(scenario, "optimal", objective=objective)
                patch.setattr(Network, "has_equal_steps", property(lambda self: False))
                other = make_plan(scenario, "optimal", objective=objective)
            if objective == "steps":
                assert one.arrival_step_of_robot[one.arrived].sum() == other.arrival_step_of_robot[other.arrived].sum()
            elif one.optimal and other.optimal:
                assert one.total_time == other.total_time, seed
                compared += 1
    assert compared >= swept(11)


@pytest.mark.parametrize("share", range(5))
def test_the_last_arrival_is_that_of_max_flow(share):
    for seed in range(share, swept(50, 10), 5):
        scenario = crowded_scenario(7_000 + seed)
        plan = make_plan(scenario, "optimal", objective="steps")
        assert th.audit_plan(plan).is_clean
        arriving = np.count_nonzero(plan.arrived & (plan.arrival_step_of_robot > 0))
        if arriving == 0:
            continue
        assert oracle_flow.most_arrivals(scenario, plan.steps) == arriving, seed
        assert oracle_flow.most_arrivals(scenario, plan.steps - 1) < arriving, seed


@pytest.mark.parametrize("share", range(5))
def test_the_least_total_time_is_that_of_integer_programming(share):
    proven = 0
    for seed in range(share, swept(100, 20), 5):
        scenario = random_scenario(seed, sides=(1, 5), most_robots=9)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean
        least = least_total_time(scenario, 8 + scenario.robot_count)
        if plan.optimal:
            assert plan.total_time == least, seed
        else:
            assert cannot_always_be_proven(scenario), seed
            assert plan.total_time >= least, seed
        proven += plan.optimal
    assert proven >= swept(17, 3)


def test_where_waiting_is_dear_no_planner_is_better():
    """Robots that had to wait in place of an exchange may pay more than `fcost` does, which may then even be proven."""
    for seed in range(40, 60):
        scenario = random_scenario(seed, sides=(3, 7), most_robots=24, waiting_costs=(15, 40))
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean
        assert plan.total_time <= min(make_plan(scenario, planner).total_time for planner in ("fcost", "greedy")), seed
    for seed, least in ((31, 35_000), (141, 58_000), (169, 200)):
        scenario = random_scenario(seed, sides=(3, 7), most_robots=24, waiting_costs=(15, 40))
        plan = make_plan(scenario, "optimal")
        assert (plan.planner, plan.optimal, plan.total_time) == ("optimal", True, least)


@pytest.mark.parametrize("share", range(5))
def test_the_least_sum_of_steps_is_that_of_integer_programming(share):
    for seed in range(share, swept(40, 10), 5):
        scenario = random_scenario(seed, sides=(1, 5), most_robots=9)
        plan = make_plan(scenario, "optimal", objective="steps")
        assert th.audit_plan(plan).is_clean
        steps = int(plan.arrival_step_of_robot[plan.arrived].sum())
        assert steps == least_total_time(scenario, 8 + scenario.robot_count, count_steps=True), seed


def test_exchanges_through_a_vertex_are_parted():
    """To go to the cell across an edge through a vertex takes as many steps, so that one of two may go there so."""
    scenario = th.Scenario(th.Area("triangular", np.zeros((3, 3), bool)), [0], [4, 0, 5, 7, 6, 3], corners="no-squeeze")
    plan = make_plan(scenario, "optimal", objective="steps")
    assert th.audit_plan(plan).is_clean
    assert plan.arrival_step_of_robot.sum() == least_total_time(scenario, 14, count_steps=True) == 9


@pytest.mark.parametrize("seed", range(swept(40, 10)))
def test_bounds_below_and_planners_above(seed):
    scenario = random_scenario(60_000 + seed, sides=(4, 9))
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, "optimal", n_scheme=n_scheme)
    assert plan.total_time >= th.make_lower_bound(n_scheme).value
    if plan.optimal:
        for planner in ("greedy", "fcost"):
            assert plan.total_time <= make_plan(scenario, planner, n_scheme=n_scheme).total_time


def test_a_plan_that_goes_through_a_barrier_is_refused():
    open_area = th.Area("hexagonal", [[0, 0, 0, 0], [1, 1, 1, 1]])
    area = th.Area("hexagonal", [[0, 0, 1, 0], [0, 0, 0, 0]])
    plan = make_plan(th.Scenario(open_area, [(0, 0)], [(3, 0)]), "greedy")
    network = make_network(th.make_n_scheme(th.Scenario(area, [(0, 0)], [(3, 0)])))
    cells = network.node_of_site[area.layout.cell_to_site(np.array([3]))].astype(np.int64)
    with pytest.raises(th.PlanError, match="plan takes a move that is not open"):
        earliest.make_earliest_flow(network, cells, np.array([0]), plan)


def test_what_would_not_fit_is_refused_with_the_estimate():
    area = th.Area("hexagonal", np.zeros((30, 30), bool))
    scenario = th.Scenario(area, [(0, 0)], th.random_robots(area, 200, avoid=[(0, 0)]))
    with pytest.raises(
        th.TooLargeError, match=r"at least \d+\.\d GiB \(\d+ steps of \d+ cells and vertices\), more than"
    ):
        make_plan(scenario, "optimal", memory_limit=1000)
    queue = th.Scenario(area, [(0, 0)], scenario.robots, destination_capacity=1)
    with pytest.raises(th.TooLargeError, match="area, a destination_capacity above 1, or use planner 'fcost'"):
        make_plan(queue, "optimal", memory_limit=1000)
    with pytest.raises(th.PlanError, match="objective must be one of time, steps, not 'step'; did you mean 'steps'"):
        make_plan(scenario, "optimal", objective="step")


@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular"])
def test_a_search_that_outgrows_the_limit_is_refused_too(monkeypatch, tessellation):
    area = th.make_caves_area(tessellation, 40, 40, seed=2)
    scenario = th.Scenario(area, th.random_robots(area, 1, seed=2), th.random_robots(area, 300, seed=1))
    needs = []

    def check(network, cells, layers, need, limit):
        needs.append(need)
        check_as_ever(network, cells, layers, need, needs[0])

    check_as_ever = workspace.check_memory
    for module in (workspace, earliest, priced):
        monkeypatch.setattr(module, "check_memory", check)
    monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    monkeypatch.setattr(earliest, "_LOG", 16)
    monkeypatch.setattr(priced, "_LIST", 16)
    with pytest.raises(th.TooLargeError, match="the optimum for 300 robots needs at least"):
        make_plan(scenario, "optimal")
    assert len(needs) == 2
    assert needs[1] > needs[0]
