"""Execution: one safe move a step, whatever it is told of the world in between."""

from threading import Event

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.kernels.codes import WAIT
from trihex.running import ARRIVED, BROKEN, GOING, LEFT, Execution


def row(cells, robots, destination=None, **rules):
    """Return a corridor of so many cells, with the destination at its east end."""
    area = th.Area("square", np.zeros((1, cells), dtype=bool))
    return th.Scenario(area, [(cells - 1 if destination is None else destination, 0)], robots, **rules)


def cells(orders):
    return orders.cell_of_robot.tolist()


@pytest.mark.parametrize("planner", ["greedy", "fcost"])
def test_a_queue_moves_as_one_and_robots_leave_at_the_destination(planner):
    execution = Execution(row(5, [(0, 0), (1, 0), (2, 0)]), planner)
    assert cells(execution.step()) == [1, 2, 3]
    assert cells(execution.step()) == [2, 3, 4]
    assert execution.state_of_robot.tolist() == [GOING, GOING, ARRIVED]
    assert cells(execution.step()) == [3, 4, -1]
    assert not execution.is_over
    orders = execution.step()
    assert cells(orders) == [4, -1, -1] and orders.action_of_robot.tolist() == [1, WAIT, WAIT]
    assert execution.is_over and orders.step == execution.steps_done == 4


def test_late_robots_stay_and_nobody_runs_into_them():
    execution = Execution(row(6, [(0, 0), (1, 0)]))
    assert cells(execution.step(late=[1])) == [0, 1]
    assert cells(execution.step(late=[0])) == [0, 2]
    assert cells(execution.step()) == [1, 3]


def way_from(cell, distance, moves):
    """Return the cells of the shortest way that takes the first best direction everywhere, the destination last."""
    way = [cell]
    while distance[way[-1]]:
        here = way[-1]
        way.append(next(to for to, cost, _ in moves[here] if distance[to] + cost == distance[here]))
    return way


def slot_of(cell, distance, moves):
    """Return the last cell before the destination, and the number of steps to it."""
    way = way_from(cell, distance, moves)
    return way[-2], len(way) - 1


def expected_step(scenario, planner, aside, places, came_from):
    """Return where all robots go, by the rules of the docs; the slow twin of the kernel."""
    area, tessellation = scenario.area, scenario.area.tessellation
    distance = th.make_n_scheme(scenario).distance.reshape(-1).tolist()
    moves = {}
    for cell in range(area.cell_count):
        x, y = cell % area.width, cell // area.width
        side = int(tessellation.orientation_of_cell(x, y))
        site = int(area.layout.cell_to_site(np.array([cell]))[0])
        moves[cell] = []
        for k, (dx, dy) in enumerate(tessellation.step_of_direction[side].tolist()):
            if scenario.moves[site] >> k & 1:
                passed = site + int(area.layout.vertex_of_direction[side, k]) if k >= tessellation.edge_count else None
                to = (y + dy) * area.width + x + dx
                moves[cell].append((to, int(tessellation.cost_of_direction[k]), passed))
    robots = [r for r, cell in places.items() if distance[cell] < 2**31 - 1]
    standing, passed, entered, led, result = set(places.values()), set(), {}, set(), dict(places)
    slots = [slot_of(places[r], distance, moves) for r in robots]

    def line_at(branch, steps):
        line = 0
        for at in range(1, steps + 1):
            line = max(0, line - 1) + slots.count((branch, at))
        return line

    for robot in sorted(robots, key=lambda r: (distance[places[r]], r)):
        here, options, every = places[robot], [], []
        branch, own_steps = slot_of(here, distance, moves)
        for to, cost, vertex in moves[here]:
            if planner == "greedy" and distance[to] + cost != distance[here]:
                continue
            fcost = cost + distance[to]
            if planner == "fcost" and distance[to]:
                other, steps = slot_of(to, distance, moves)
                found = line_at(other, steps + 1) - ((other, steps + 1) == (branch, own_steps))
                fcost += scenario.waiting_cost * max(0, found)
            every.append(fcost)
            full = scenario.destination_capacity is not None and entered.get(to, 0) >= scenario.destination_capacity
            crossed = scenario.crossing == "forbid" and vertex in passed
            if to not in standing and not crossed and not (distance[to] == 0 and full):
                options.append((fcost, distance[to], len(options), to, cost, vertex))
        descents = [option for option in options if option[1] + option[4] == distance[here]]
        if planner == "greedy" or (branch not in led and descents):
            choice = descents[0] if descents else None
        else:
            choice = min(options, default=None)
            if choice and choice[0] != min(every) and choice[0] >= min(every) + scenario.waiting_cost:
                is_back = choice[1] == distance[here] and choice[3] == came_from[robot]
                is_dear = choice[0] > min(every) + scenario.waiting_cost
                stays = {"never": True, "worth": is_dear, "always": is_back}[aside]
                choice = choice if choice[1] <= distance[here] and not stays else None
        led.add(branch)
        if choice:
            _, _, _, to, _, vertex = choice
            standing.discard(here)
            if vertex is not None:
                passed.add(vertex)
            if distance[to]:
                standing.add(to)
            else:
                entered[to] = entered.get(to, 0) + 1
            result[robot], came_from[robot] = to, here
    return result


@pytest.mark.parametrize(
    ("planner", "aside"), [("greedy", "always"), ("fcost", "always"), ("fcost", "worth"), ("fcost", "never")]
)
def test_every_step_is_as_the_rules_say(planner, aside):
    for seed in range(swept(25, 6)):
        scenario = random_scenario(seed, sides=(3, 9), most_robots=20)
        execution = Execution(scenario, planner, aside=aside)
        came_from = dict.fromkeys(range(scenario.robot_count))
        for _ in range(4):
            places = {r: c for r, c in enumerate(execution.cell_of_robot.tolist()) if c >= 0}
            wanted = expected_step(scenario, planner, aside, places, came_from)
            found = dict(enumerate(execution.step().cell_of_robot.tolist()))
            assert {r: found[r] for r in wanted} == wanted, seed


def test_fcost_steps_aside_as_it_is_told():
    area = th.make_caves_area("hexagonal", 24, 36, seed=4)
    scenario = th.Scenario(area, [(18, 12)], th.random_robots(area, 60, seed=1, avoid=[(18, 12)]))
    totals = {}
    for aside in ("always", "worth", "never"):
        execution, moves = Execution(scenario, aside=aside), 0
        while not execution.is_over:
            moves += np.count_nonzero(execution.step().action_of_robot != WAIT)
        assert (execution.state_of_robot == ARRIVED).all()
        totals[aside] = moves
    assert totals["never"] < totals["always"]


def test_what_is_observed_changes_the_way():
    scenario = th.Scenario(th.Area("square", np.zeros((3, 5), dtype=bool)), [(4, 1)], [(0, 1)])
    execution = Execution(scenario)
    assert cells(execution.step()) == [6]
    assert execution.observe(blocked=[(2, 0), (2, 1)]).touched > 0
    assert cells(execution.step()) == [12]
    execution.observe(freed=[(2, 1)], opened=[(1, 2)], closed=[(4, 1)])
    assert cells(execution.step()) == [11]
    assert execution.is_over


def test_cut_off_robots_are_named_and_go_on_when_a_way_opens():
    execution = Execution(row(5, [(0, 0), (3, 0)]))
    execution.observe(blocked=[(2, 0)])
    assert execution.cut_off_robots.tolist() == [0]
    assert cells(execution.step()) == [0, 4]
    assert execution.is_over
    execution.observe(freed=[(2, 0)])
    assert execution.cut_off_robots.tolist() == [] and not execution.is_over
    execution.observe(closed=[(4, 0)])
    assert execution.is_over and execution.cut_off_robots.tolist() == [0]
    assert cells(execution.step()) == [0, -1]


def test_a_robot_on_a_cell_that_becomes_a_destination_has_arrived():
    execution = Execution(row(5, [(0, 0), (1, 0)]))
    execution.observe(opened=[(1, 0)])
    assert execution.state_of_robot.tolist() == [GOING, ARRIVED]
    assert cells(execution.step()) == [1, -1]


def test_robots_join_leave_and_break_down():
    execution = Execution(row(6, [(0, 0), (2, 0)]))
    assert execution.join((4, 0)) == 2
    assert cells(execution.step()) == [1, 3, 5]
    execution.leave(1)
    assert execution.join((5, 0)) == 3
    assert execution.state_of_robot.tolist() == [GOING, LEFT, ARRIVED, ARRIVED]
    execution.break_down(0)
    assert execution.state_of_robot[0] == BROKEN and execution.field.barriers[0, 1]
    assert execution.join((0, 0)) == 4
    assert execution.cut_off_robots.tolist() == [4]


def test_robots_that_are_elsewhere_are_put_where_they_are():
    execution = Execution(row(6, [(0, 0), (2, 0)]))
    execution.place({0: (1, 0)})
    assert execution.cell_of_robot.tolist() == [1, 2]
    execution.place({0: (2, 0), 1: (1, 0)})
    assert cells(execution.step()) == [3, 2]


def test_what_no_robot_can_follow_is_refused_and_changes_nothing():
    execution = Execution(row(6, [(0, 0), (2, 0)]))
    with pytest.raises(th.ExecutionError, match=r"robot 1 stands at \(2, 0\)"):
        execution.observe(blocked=[(4, 0), (2, 0)])
    with pytest.raises(th.ScenarioError, match=r"blocked while it is a destination: \(5, 0\)"):
        execution.observe(blocked=[(5, 0)])
    with pytest.raises(th.ExecutionError, match=r"robot 0 stands at \(0, 0\)"):
        execution.join((0, 0))
    for late in ([2], [-1]):
        with pytest.raises(th.ExecutionError, match=rf"late must name robots 0\.\.1, not {late[0]}"):
            execution.step(late)
    with pytest.raises(th.ExecutionError, match="distinct free cells"):
        execution.place({0: (2, 0)})
    with pytest.raises(th.ExecutionError, match=r"one of 0\.\.1, not 2"):
        execution.leave(2)
    assert not execution.field.barriers.any() and execution.cell_of_robot.tolist() == [0, 2]
    execution.observe(blocked=[(4, 0)])
    with pytest.raises(th.ExecutionError, match=r"\(4, 0\) is a barrier"):
        execution.join((4, 0))
    execution.leave(0)
    with pytest.raises(th.ExecutionError, match="robot 0 is not on its way: it has left"):
        execution.break_down(0)
    with pytest.raises(th.ExecutionError, match="planner of an execution must be one of greedy, fcost"):
        Execution(row(3, []), "magic")


def test_an_execution_goes_on_from_a_state_with_the_same_moves():
    for seed in range(12):
        scenario = random_scenario(seed, sides=(6, 14))
        execution = Execution(scenario)
        for _ in range(3):
            execution.step()
        free = np.flatnonzero(~scenario.area.barriers)
        taken = np.concatenate([execution.cell_of_robot, scenario.destinations])
        execution.observe(blocked=np.setdiff1d(free, taken)[:3])
        state = execution.state()
        rest = [execution.step().action_of_robot.tolist() for _ in range(6)]
        for other in (Execution(scenario), execution):
            other.restore(state)
            assert [other.step().action_of_robot.tolist() for _ in range(6)] == rest, seed


def crowd():
    area = th.make_rooms_area("hexagonal", 20, 24, seed=2)
    return th.Scenario(area, [(3, 4)], th.random_robots(area, 60, seed=1, avoid=[(3, 4)]))


def test_plans_are_followed_until_the_world_changes_and_made_anew():
    scenario = crowd()
    execution = Execution(scenario, replan=True)
    while not execution.is_over:
        execution.step()
    plan = th.make_plan(scenario)
    assert execution.replanner.plans == 1 and execution.steps_done <= plan.steps
    execution = Execution(scenario, replan=True)
    for _ in range(3):
        execution.step()
    taken = set(execution.cell_of_robot.tolist()) | set(scenario.destinations.tolist())
    execution.observe(blocked=[next(c for c in np.flatnonzero(~scenario.area.barriers).tolist() if c not in taken)])
    execution.step()
    execution.join(next(c for c in range(scenario.area.cell_count) if not execution.field.barriers.flat[c]
                        and c not in execution.cell_of_robot and c not in scenario.destinations))  # fmt: skip
    execution.leave(int(np.flatnonzero(execution.state_of_robot == GOING)[0]))
    while not execution.is_over:
        execution.step()
    assert execution.replanner.plans == 3 and execution.replanner.failures == 0


def test_without_a_plan_in_time_robots_go_on_step_by_step_without_a_gap():
    scenario = crowd()
    hurried, stepping = Execution(scenario, replan=True, budget=0.0), Execution(scenario)
    while not stepping.is_over:
        assert cells(hurried.step()) == cells(stepping.step())
    assert hurried.is_over and hurried.replanner.plans == 0 and 1 <= hurried.replanner.failures < hurried.steps_done


def test_where_many_are_late_nobody_keeps_to_a_plan():
    scenario = crowd()
    following, stepping = Execution(scenario, replan=True), Execution(scenario)
    late = list(range(0, 60, 2))
    following.step(late), stepping.step(late)
    for _ in range(3):
        assert cells(following.step(late)) == cells(stepping.step(late))
    assert following.replanner.plans == 0
    while not following.is_over:
        following.step()
    assert following.replanner.plans == 1


def test_the_optimum_is_followed_and_found_again_where_the_world_changes():
    scenario = crowd()
    scenario = scenario.with_robots(scenario.robots[:25])
    least = th.make_plan(scenario, "optimal").total_time
    run = th.Trial(scenario, "optimal").run()
    assert run.total_time == least < th.Trial(scenario, "fcost").run().total_time
    unknowing = th.Trial(scenario, "optimal", sensor=1)
    run = unknowing.run()
    assert run.arrived.all() and run.total_time >= least and unknowing.execution.replanner.plans > 1
    assert th.audit_run(run).is_clean


def test_a_planner_that_does_not_stop_in_time_keeps_nobody_waiting(monkeypatch):
    scenario, asked, go_on = crowd(), [], Event()

    def hang(scenario, planner, *, n_scheme, progress, **options):
        asked.append(planner)
        go_on.wait(60)
        while True:  # until it is stopped
            progress(1, 2)

    stepping = Execution(scenario)
    hurried = Execution(scenario, replan=True, budget=1e-3)
    monkeypatch.setattr("trihex.running.replanning.make_plan", hang)
    for _ in range(8):
        assert cells(hurried.step()) == cells(stepping.step())
    assert asked == ["fcost"] and hurried.replanner.plans == 0  # the next try waits until the first has stopped
    go_on.set()
    hurried.replanner._attempt.join(60)
    assert not hurried.replanner._attempt.is_alive()
    while not hurried.is_over:
        assert cells(hurried.step()) == cells(stepping.step())
    assert len(asked) > 1


def test_what_goes_wrong_in_a_planner_is_told(monkeypatch):
    def fail(*_, **__):
        raise th.PlanError("no")

    monkeypatch.setattr("trihex.running.replanning.make_plan", fail)
    for budget in (None, 60.0):
        with pytest.raises(th.PlanError, match="no"):
            Execution(crowd(), replan=True, budget=budget).step()
