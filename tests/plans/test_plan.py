"""Plans: what follows from the actions of the robots, on worlds that fit in the head."""

import numpy as np
import pytest

import trihex as th
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import plan_from_lists

ROW = th.Area("square", np.zeros((1, 5), bool))
N, E, S, W = range(4)  # the edge directions of squares
# Robot 0 waits once behind robot 1; robot 2 stands on the destination.
SCENARIO = th.Scenario(ROW, destinations=[(4, 0)], robots=[(1, 0), (2, 0), (4, 0)], waiting_cost=7)
PLAN = plan_from_lists(SCENARIO, [[WAIT, E, E, E], [E, E], []])


def test_times_are_distance_and_waiting():
    assert PLAN.distance_of_robot.tolist() == [30, 20, 0]
    assert PLAN.waiting_of_robot.tolist() == [7, 0, 0]
    assert PLAN.time_of_robot.tolist() == [37, 20, 0]
    assert PLAN.total_time == 57
    assert PLAN.arrival_step_of_robot.tolist() == [4, 2, 0]
    assert PLAN.steps == 4


def test_cells_by_step_end_when_a_robot_has_left():
    assert [c.tolist() for c in PLAN.cells_by_step()] == [
        [1, 2, -1], [1, 3, -1], [2, -1, -1], [3, -1, -1], [-1, -1, -1],
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("step", "filled", "waiting", "final"), [(1, [1], [0], [2]), (2, [0, 1], [], [2]), (3, [0], [], [1, 2])]
)
def test_the_sets_of_the_paper(step, filled, waiting, final):
    sets = PLAN.sets_at(step)
    assert (sets.filled.tolist(), sets.waiting.tolist(), sets.final.tolist()) == (filled, waiting, final)
    assert sorted([*sets.filled, *sets.waiting]) == sets.begin.tolist()
    assert sorted([*sets.begin, *sets.final]) == [0, 1, 2]


def test_a_robot_that_never_arrives_waits_and_does_not_count():
    walled = th.Area("square", [[0, 1, 0, 0]])
    plan = plan_from_lists(th.Scenario(walled, [(3, 0)], [(0, 0), (2, 0)]), [[], [E]])
    assert plan.arrived.tolist() == [False, True]
    assert plan.arrival_step_of_robot.tolist() == [-1, 1]
    assert plan.sets_at(1).waiting.tolist() == [0]
    assert plan.total_time == 10
    assert [c.tolist() for c in plan.cells_by_step()] == [[0, 2], [0, -1]]


def test_a_jump_leads_where_its_list_says():
    scenario = th.Scenario(ROW, [(4, 0)], [(0, 0), (1, 0)])
    plan = plan_from_lists(scenario, [[JUMP, E], [E, JUMP]], jumps=[(0, 3), (3, 4)])
    assert [c.tolist() for c in plan.cells_by_step()] == [[0, 1], [3, 2], [-1, -1]]
    assert plan.time_of_robot.tolist() == [10, 10]


def test_triangles_replay_by_orientation():
    area = th.Area("triangular", np.zeros((2, 4), bool))
    names = area.tessellation.direction_names
    plan = plan_from_lists(
        th.Scenario(area, [(3, 1)], [(0, 0)]),
        [[names[0].index("S"), names[1].index("E"), names[0].index("EE")]],
    )
    assert [c.tolist() for c in plan.cells_by_step()] == [[0], [4], [5], [-1]]
    assert plan.time_of_robot.tolist() == [34]


def test_a_plan_without_robots_is_empty():
    plan = plan_from_lists(th.Scenario(ROW, [(0, 0)]), [])
    assert (plan.steps, plan.total_time, len(list(plan.cells_by_step()))) == (0, 0, 1)


@pytest.mark.parametrize(
    ("actions", "first_action", "jumps", "message"),
    [
        ([E], [0, 1], [], "in 4 entries, one more than robots"),
        ([E, E], [0, 2, 1, 2], [], "must rise"),
        ([9], [0, 1, 1, 1], [], "actions must be directions 0..7 or WAIT, not 9"),
        ([JUMP], [0, 1, 1, 1], [], "jumps must list every JUMP"),
        ([JUMP], [0, 1, 1, 1], [(0, 5)], "jumps must lead to cells of the area"),
    ],
)
def test_arrays_that_make_no_plan_are_refused(actions, first_action, jumps, message):
    with pytest.raises(th.PlanError, match=message):
        th.Plan(SCENARIO, actions, first_action, jumps=jumps)


def test_there_are_no_sets_before_the_first_step():
    with pytest.raises(th.PlanError, match=r"step must be 1\.\.5, .*, not 0"):
        PLAN.sets_at(0)


def test_after_the_last_step_all_are_final_as_the_paper_ends():
    sets = PLAN.sets_at(PLAN.steps + 1)
    assert [own.tolist() for own in sets] == [[], [], [], list(range(PLAN.scenario.robot_count))]
    with pytest.raises(th.PlanError, match="step must be"):
        PLAN.sets_at(PLAN.steps + 2)
    nothing = th.make_plan(th.Scenario(th.Area("square", [[0, 0]]), (0, 0), (0, 0)))
    assert nothing.sets_at(1).final.tolist() == [0]


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_the_path_of_one_robot_is_that_of_all_step_by_step(name):
    area = th.make_random_area(name, 9, 12, density=0.25, seed=1)
    plan = th.make_plan(th.Scenario(area, np.flatnonzero(~area.barriers)[:1], th.random_robots(area, 20, seed=2)))
    steps = list(plan.cells_by_step())
    for robot in range(20):
        path = plan.cells_of_robot(robot)
        last = max(0, int(plan.arrival_step_of_robot[robot]))
        assert path.size == last + 1
        assert path[:last].tolist() == [int(cells[robot]) for cells in steps[:last]]
        assert path[-1] == plan.last_cell_of_robot[robot]


def test_the_path_follows_jumps_of_plans_that_were_read():
    scenario = th.Scenario(th.Area("hexagonal", [[0] * 9]), (8, 0), [(0, 0), (2, 0)])
    first = np.array([0, 0, 3])
    plan = th.Plan(scenario, np.array([WAIT, JUMP, WAIT], dtype=np.uint8), first, jumps=[[1, 8]])
    assert plan.cells_of_robot(0).tolist() == [0]
    assert plan.cells_of_robot(1).tolist() == [2, 2, 8, 8]
    for robot in (-1, 2, "0", True):
        with pytest.raises(th.PlanError, match=r"robot must be one of 0\.\.1, not"):
            plan.cells_of_robot(robot)
