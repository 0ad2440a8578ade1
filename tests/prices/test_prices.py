"""Prices: equal to optima made afresh, whatever cell changes; what is not known is told."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.sweeps import swept
from trihex.errors import PlanError, TooLargeError
from trihex.optimum import Variations

SHAPES = (("hexagonal", "full"), ("square", "edge"), ("triangular", "edge"))


def crowded_scenario(seed, least=6, most=13, tessellation=None, **rules):
    """Many robots, few destinations, walls; some robots cannot arrive."""
    rng = np.random.default_rng(seed)
    tessellation = tessellation or th.Tessellation(*SHAPES[seed % 3])
    area = th.Area(tessellation, rng.random(rng.integers(least, most, 2)) < rng.uniform(0.1, 0.4))
    free = rng.permutation(np.flatnonzero(~area.barriers))
    goals = int(rng.integers(1, 3))
    robots = free[goals:][: int(rng.integers(5, 60))]
    return th.Scenario(area, free[:goals], robots, destination_capacity=(None, 1, 2)[seed // 3 % 3], **rules)


def afresh(scenario, kind, cell):
    """Return the optimum if the cell is another than it is; who starts there is left out."""
    barriers = scenario.area.barriers.copy()
    barriers.reshape(-1)[cell] = kind == "choke"
    destinations = np.append(scenario.destinations, cell) if kind == "door" else scenario.destinations
    area = th.Area(scenario.area.tessellation, barriers)
    stays = scenario.robots != cell
    changed = {"robots": scenario.robots[stays], "start_times": scenario.start_times[stays]}
    return th.make_plan(replace(scenario, area=area, destinations=destinations, **changed), "optimal")


def assert_is_afresh(prices, rows):
    """Compare some of the prices with optima made afresh."""
    plan = prices.plan
    for i in rows:
        kind, cell = str(prices.kind[i]), int(prices.cell[i])
        other = afresh(plan.scenario, kind, cell)
        assert prices.proven[i]
        assert int(other.arrived.sum()) - int(plan.arrived.sum()) == prices.robots[i]
        if prices.robots[i]:
            assert prices.price[i] == 0
        else:
            saved = plan.total_time - other.total_time
            assert prices.price[i] == (-saved if kind == "choke" else saved), (kind, cell)


def test_prices_are_those_of_optima_made_afresh():
    saved = lost = cut_off = given_a_way = 0
    for seed in range(swept(10, 9)):
        scenario = crowded_scenario(seed)
        plan = th.make_plan(scenario, "optimal")
        all_cells = np.setdiff1d(np.arange(scenario.area.cell_count), scenario.destinations)
        prices = th.make_prices(plan, kinds=("barrier", "choke"), cells=all_cells)
        assert prices.cell.tolist() == [*np.flatnonzero(scenario.area.barriers), *prices.cell[prices.kind == "choke"]]
        assert prices.cell.size == all_cells.size
        rng = np.random.default_rng(seed)
        telling = np.flatnonzero((prices.price > 0) | (prices.robots != 0))
        assert_is_afresh(prices, np.union1d(rng.permutation(telling)[:20], rng.integers(0, prices.cell.size, 5)))
        saved += ((prices.kind == "barrier") & (prices.price > 0)).sum()
        lost += ((prices.kind == "choke") & (prices.price > 0)).sum()
        cut_off += (prices.robots < 0).sum()
        given_a_way += (prices.robots > 0).sum()
    assert min(saved, lost, cut_off, given_a_way) > 0


def test_the_best_door_saves_most_of_all_barriers():
    found = unfinished = 0
    for seed in range(swept(10, 6)):
        scenario = crowded_scenario(seed, 5, 9)
        plan = th.make_plan(scenario, "optimal")
        prices = th.make_prices(plan, kinds="door")
        best = 0
        for cell in np.flatnonzero(scenario.area.barriers).tolist():
            other = afresh(scenario, "door", cell)
            if np.array_equal(other.arrived, plan.arrived):
                best = max(best, plan.total_time - other.total_time)
        rows = [i for i in range(prices.cell.size) if prices.kind[i] == "door" and prices.robots[i] == 0]
        assert [int(prices.price[i]) for i in rows] == ([best] if best else [])
        assert_is_afresh(prices, rows)
        found += len(rows)
        stopped = [th.make_prices(plan, kinds="door", stop=iter([False] * k + [True] * 999).__next__) for k in range(3)]
        for part in stopped:
            assert all(part.price <= best) and all(part.most >= best) and all(part.proven == (part.most == part.price))
            assert part.cell.size or best == 0
        unfinished += not stopped[0].is_complete
    assert found and unfinished


def test_the_chokes_are_the_cells_of_least_cuts():
    area = th.Area(th.Tessellation("square", "edge"), [[0, 1, 0], [0, 0, 0], [0, 1, 0]])
    plan = th.make_plan(th.Scenario(area, [(2, 1)], [(0, 0), (0, 2), (0, 1)]), "optimal")
    prices = th.make_prices(plan, kinds=["choke"])
    assert prices.rows() == [
        {"x": 1, "y": 1, "kind": "choke", "price": None, "robots": -3, "proven": True, "most": None}
    ]


@pytest.mark.parametrize(
    ("tessellation", "waiting_cost", "late"),
    [("triangular", None, False), ("square", None, False), ("hexagonal", 6, False), ("hexagonal", None, True)],
)
def test_where_steps_cost_differently_or_robots_start_late_optima_are_made_afresh(tessellation, waiting_cost, late):
    scenario = crowded_scenario(4, 4, 6, tessellation, waiting_cost=waiting_cost)
    scenario = replace(scenario, start_times=np.arange(scenario.robot_count) % (1 + 3 * late))
    plan = th.make_plan(scenario, "optimal")
    prices = th.make_prices(plan)
    assert prices.is_complete
    assert_is_afresh(prices, range(prices.cell.size))


def test_what_is_known_is_not_found_again_and_what_is_not_done_is_told():
    plan = th.make_plan(crowded_scenario(28), "optimal")
    told, looks = {}, []
    whole = th.make_prices(plan, tell=lambda kind, cell, price: told.__setitem__((kind, cell), price))
    assert len(told) > 8

    def stop():
        looks.append(True)
        return len(looks) > 5

    first = {}
    part = th.make_prices(plan, tell=lambda kind, cell, price: first.__setitem__((kind, cell), price), stop=stop)
    assert not part.is_complete
    assert len(first) == 5
    assert first.items() <= told.items()
    others = part.kind != "door"
    keys = ("kind", "cell")
    assert all(np.array_equal(getattr(part, key)[others], getattr(whole, key)[whole.kind != "door"]) for key in keys)
    assert (part.price[others] <= whole.price[whole.kind != "door"]).all()
    assert (part.price[part.kind == "barrier"] > 0).any()
    bounded = others & (part.most >= 0)
    assert (part.most[bounded] >= whole.price[whole.kind != "door"][bounded[others]]).all()
    assert (bounded & ~part.proven).any()
    second = []
    again = th.make_prices(plan, known=first, tell=lambda kind, cell, price: second.append((kind, cell)))
    assert again == whole
    assert set(second) == told.keys() - first.keys()


def test_progress_comes_to_an_end():
    plan = th.make_plan(crowded_scenario(28), "optimal")
    seen = []
    th.make_prices(plan, progress=lambda done, total: seen.append((done, total)))
    assert seen == sorted(seen)
    assert seen[-1][0] == seen[-1][1]


def test_prices_are_an_array_of_the_area_and_rows():
    area = th.Area(th.Tessellation("square", "edge"), [[0, 1, 0], [0, 1, 0], [0, 0, 0]], frame=th.Frame(0.5))
    plan = th.make_plan(th.Scenario(area, [(2, 0)], [(0, 0), (0, 1)], following="allow"), "optimal")
    prices = th.make_prices(plan, kinds="barrier")
    assert prices.price_of_cell("barrier").tolist() == [[-1, 60, -1], [-1, 40, -1], [-1, -1, -1]]
    assert prices.rows(speed=0.5) == [
        {"x": 1, "y": 0, "kind": "barrier", "price": 60, "seconds": 6.0, "robots": 0, "proven": True, "most": 60},
        {"x": 1, "y": 1, "kind": "barrier", "price": 40, "seconds": 4.0, "robots": 0, "proven": True, "most": 40},
    ]
    assert prices.best_door is None
    assert th.make_prices(plan, kinds="door").best_door in {(1, 0), (1, 1)}
    assert "2 prices, all proven" in repr(prices)


@pytest.mark.parametrize("robots", [[], [(2, 0)]])
def test_nobody_pays_where_nobody_has_to_go(robots):
    area = th.Area("hexagonal", [[0, 1, 0]])
    prices = th.make_prices(th.make_plan(th.Scenario(area, [(2, 0)], robots), "optimal"))
    assert prices.price.tolist() == [0]
    assert prices.is_complete


def row_of(*robots, **rules):
    return th.Scenario(th.Area("hexagonal", [[0, 0, 0, 1]]), [(2, 0)], robots, **rules)


def test_the_plan_must_be_the_best_and_whole():
    plan = th.make_plan(row_of((1, 0), (0, 0)), "optimal")
    late = replace(plan, actions=np.insert(plan.actions, 1, 255), first_action=plan.first_action + np.array([0, 0, 1]))
    with pytest.raises(PlanError, match="prices need the best plan: its robots take 4 steps together, 3 will do"):
        th.make_prices(late)
    short = replace(plan, actions=plan.actions[:-1], first_action=plan.first_action - np.array([0, 0, 1]))
    with pytest.raises(PlanError, match="all arrive who can, unlike robot 1"):
        th.make_prices(short)
    both = replace(plan, actions=np.insert(plan.actions, 0, 255), first_action=plan.first_action + np.array([0, 1, 1]))
    with pytest.raises(PlanError, match="without conflicts"):
        th.make_prices(both)
    triangles = th.Scenario(th.Area("triangular", [[0, 0, 0, 0, 0]]), [(4, 0)], [(0, 0), (1, 0)])
    plan = th.make_plan(triangles, "optimal")
    late = replace(plan, actions=np.insert(plan.actions, 0, 255), first_action=plan.first_action + np.array([0, 1, 1]))
    with pytest.raises(PlanError, match="prices need the best plan: its sum of t_r is"):
        th.make_prices(late)


def test_other_mistakes_are_told():
    plan = th.make_plan(row_of((0, 0)), "optimal")
    with pytest.raises(PlanError, match="kinds must be one of barrier, choke, door, not 'wall'"):
        th.make_prices(plan, kinds=["wall"])
    with pytest.raises(PlanError, match="cells"):
        th.make_prices(plan, cells=[(4, 0)])
    with pytest.raises(TooLargeError, match="memory_limit"):
        th.make_prices(plan, memory_limit=10)
    with pytest.raises(PlanError, match="planner 'optimal' needs following='allow'"):
        th.make_prices(th.make_plan(row_of((0, 0), following="forbid"), "greedy"))


def test_variations_grow_what_they_search_in(monkeypatch):
    from trihex.optimum import laid, variations

    plan = th.make_plan(crowded_scenario(1), "optimal")
    whole = th.make_prices(plan)
    monkeypatch.setattr(laid, "_STACK", 1)
    monkeypatch.setattr(laid, "_BUDGET", 50)
    monkeypatch.setattr(variations, "_LOG", 20)
    monkeypatch.setattr(variations, "_BUDGET", 50)
    assert th.make_prices(plan) == whole
    assert Variations(plan).unit == 10


def test_what_an_opened_cell_changed_is_undone_before_a_door_or_another_cell_is_asked_for():
    asked = 0
    for seed in range(swept(10, 4)):
        plan = th.make_plan(crowded_scenario(seed), "optimal")
        barriers = np.flatnonzero(plan.scenario.area.barriers)
        barriers = barriers[Variations(plan).robots_if_opened(barriers) == Variations(plan).robot_count]
        variations = Variations(plan)
        helpful = [int(barriers[place]) for place, _, _ in Variations(plan).openings(barriers)]
        for cell, door in zip(helpful[:5], helpful[::-1], strict=False):
            next(variations.openings(np.array([cell])))
            assert variations.saved_by_door(door) == Variations(plan).saved_by_door(door)
            assert variations.saved_if_open(door) == Variations(plan).saved_if_open(door) > 0
            asked += 1
    assert asked
