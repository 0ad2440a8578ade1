"""The paper's planner: its c against a literal count of meetings, and what each rule is worth."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from trihex.planners import make_plan
from trihex.planners.slots import Slots


def shortest_path(n_scheme, d_scheme, cell):
    """Cells of the path that follows the first best direction, `cell` first."""
    area = n_scheme.scenario.area
    path = [cell]
    while n_scheme.distance_of_cell([path[-1]])[0] > 0:
        x, y = (int(i) for i in area.cell_to_xy(path[-1]))
        bits = int(d_scheme.directions[y, x])
        k = next(k for k in range(16) if bits >> k & 1)
        dx, dy = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y)), k]
        path.append(int(area.xy_to_cell(x + dx, y + dy)))
    return path


@pytest.mark.parametrize("seed", range(60))
def test_the_paper_s_count_over_all_paths_is_a_look_up(seed):
    """c: the others that are in one cell at one step with the path that starts with a direction."""
    scenario = random_scenario(seed, sides=(3, 9))
    n_scheme = th.make_n_scheme(scenario)
    d_scheme = th.make_d_scheme(n_scheme)
    layout = scenario.area.layout
    slot_table = Slots(d_scheme, is_literal=True)
    distance = n_scheme.distance_of_cell(scenario.robots)
    going = scenario.robots[(distance > 0) & (distance < 2**31 - 1)]
    path_of_robot = [shortest_path(n_scheme, d_scheme, int(cell))[:-1] for cell in going]
    slot_table.find_regions(layout.cell_to_site(going))
    slots = slot_table.find_slots(layout.cell_to_site(going))
    count = np.bincount(slots, minlength=slot_table.first_slot[-1] + 1)
    reached = np.flatnonzero(n_scheme.distance.reshape(-1) < 2**31 - 1)
    for robot, own_slot in enumerate(slots):
        for target in reached[:: max(1, reached.size // 12)]:  # any cell may stand for the one a direction leads to
            path = [None, *shortest_path(n_scheme, d_scheme, int(target))[:-1]]
            others = [p for r, p in enumerate(path_of_robot) if r != robot]
            literal = sum(any(a == b for a, b in zip(path[1:], other[1:], strict=False)) for other in others)
            looked_up = 0
            if n_scheme.distance_of_cell([target])[0] > 0:
                slot = slot_table.find_slots(layout.cell_to_site(np.array([target])))[0] + 1
                looked_up = count[slot] - (slot == own_slot)
            assert looked_up == literal


@pytest.mark.parametrize("rule", ["paper", "queue", "aside", "lanes"])
@pytest.mark.parametrize("seed", range(60))
def test_each_rule_ends_and_keeps_the_rules(rule, seed):
    scenario = random_scenario(80_000 + seed, sides=(3, 10))
    plan = make_plan(scenario, "fcost", rule=rule)
    assert th.audit_plan(plan).is_clean
    assert not plan.arrived[th.make_n_scheme(scenario).unreachable_robots].any()
    assert plan.arrived.sum() == scenario.robot_count - th.make_n_scheme(scenario).unreachable_robots.size


@pytest.mark.parametrize("seed", range(40))
def test_the_best_of_the_rules_is_never_worse_than_greedy(seed):
    scenario = random_scenario(90_000 + seed, sides=(3, 10))
    totals = {rule: make_plan(scenario, "fcost", rule=rule).total_time for rule in ("best", "aside", "lanes")}
    greedy = make_plan(scenario, "greedy").total_time
    assert totals["best"] == min(greedy, totals["lanes"], totals["aside"])


def test_a_crowd_on_one_side_spreads_round_the_destination():
    """By distance alone all robots enter by the three western gates; the eastern ones are worth the way round."""
    area = th.Area("hexagonal", np.zeros((21, 21), bool))
    scenario = th.Scenario(area, [(12, 10)], [(x, y) for y in range(4, 17) for x in range(10)])
    fcost, greedy = make_plan(scenario, "fcost"), make_plan(scenario, "greedy")
    assert fcost.total_time < 0.85 * greedy.total_time
    last_steps = {int(plan.steps) for plan in (fcost, greedy)}
    assert max(last_steps) == greedy.steps


@pytest.mark.parametrize("rule", ["queue", "aside"])
@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular"])
def test_crowds_that_dislike_waiting_do_not_run_from_line_to_line(tessellation, rule):
    """With w_t three moves, robots that weighed lines at w_t took four times as long as by greedy descent."""
    area = th.make_random_area(tessellation, 64, 64, density=0.1, seed=3)
    exits = [(63, y) for y in (8, 24, 40, 56) if not area.barriers[y, 63]]
    robots = th.random_robots(area, 500, seed=1, avoid=exits)
    scenario = th.Scenario(area, exits, robots, waiting_cost=30)
    plan, greedy = make_plan(scenario, "fcost", rule=rule), make_plan(scenario, "greedy")
    assert plan.total_time < greedy.total_time
    assert plan.arrival_step_of_robot.sum() < greedy.arrival_step_of_robot.sum()
