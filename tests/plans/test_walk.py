"""Walks over a plan, against robots followed one by one in Python."""

import numpy as np
from hypothesis import given

from tests.formats.strategies import walks
from trihex import Area, Plan, Scenario
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import Walk, cells_of_rows, steps_of_actions, visits_of, waits_by_step


def ways(plan):
    """Yield the cells of each robot, from its start to its last action, and its actions."""
    area, jumps = plan.scenario.area, dict(plan.jumps.tolist())
    for robot, start in enumerate(plan.scenario.robots.tolist()):
        cells = [start]
        first, last = plan.first_action[robot : robot + 2].tolist()
        for i in range(first, last):
            y, x = divmod(cells[-1], area.width)
            action = int(plan.actions[i])
            if action == JUMP:
                cells.append(jumps[i])
            elif action == WAIT:
                cells.append(cells[-1])
            else:
                steps = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y))]
                cells.append(int((y + steps[action][1]) * area.width + x + steps[action][0]))
        yield cells, plan.actions[first:last].tolist()


def check(plan):
    area = plan.scenario.area
    own = list(ways(plan))
    visits = np.zeros(area.cell_count, dtype=int)
    for cells, actions in own:
        np.add.at(visits, [cells[0], *(to for to, action in zip(cells[1:], actions, strict=True) if action != WAIT)], 1)
    np.testing.assert_array_equal(visits_of(plan), visits.reshape(area.height, area.width))

    first_row = np.cumsum([0, *(len(cells) for cells, _ in own)])
    np.testing.assert_array_equal(cells_of_rows(plan, first_row), [cell for cells, _ in own for cell in cells])

    check_walk(plan, own)


def check_walk(plan, own):
    """Go to some steps, and compare with each robot's list of (cell, action, when it ends)."""
    area = plan.scenario.area
    ends = [ends_of(plan, actions) for _, actions in own]
    walk = Walk(plan)
    for step in sorted({0, plan.steps // 3, plan.steps // 2, plan.steps}):
        walk.go_to(step)
        done = [sum(end <= step for end in ends_of_robot) - 1 for ends_of_robot in ends]
        at = [cells[i] for (cells, _), i in zip(own, done, strict=True)]
        np.testing.assert_array_equal(area.layout.site_to_cell(walk.site), at)
        under_way = [actions[i] if i < len(actions) else WAIT for (_, actions), i in zip(own, done, strict=True)]
        np.testing.assert_array_equal(walk.action_of_robot, under_way)
        later = [cells[min(i + 1, len(cells) - 1)] for (cells, _), i in zip(own, done, strict=True)]
        np.testing.assert_array_equal(area.layout.site_to_cell(walk.next_site()), later)
        for robot, (i, action) in enumerate(zip(done, under_way, strict=True)):
            if i < len(own[robot][1]):
                share = (step + 0.5 - ends[robot][i]) / (ends[robot][i + 1] - ends[robot][i])
                assert np.broadcast_to(walk.done(0.5), len(own))[robot] == share
            assert (robot in walk.sets().filled) == (action != WAIT)
    for robot, expected in enumerate(ends):
        assert plan.ticks_of_robot(robot).tolist() == expected
    assert steps_of_actions(plan).tolist() == [end for one in ends for end in one[1:]]
    waits = np.zeros(plan.steps + 1, dtype=int)
    for (_, actions), one in zip(own, ends, strict=True):
        np.add.at(waits, [end for action, end in zip(actions, one[1:], strict=True) if action == WAIT], 1)
    np.testing.assert_array_equal(waits_by_step(plan), waits)


def ends_of(plan, actions):
    """Return when a robot is in each of its cells: a move lasts as its direction does, all else one step."""
    ends = [0]
    for action in actions:
        ends.append(ends[-1] + (1 if action >= JUMP else int(plan.scenario.duration_of_direction[action])))
    return ends


@given(walks())
def test_robots_that_stray(plan):
    check(plan)


def test_robots_that_jump():
    scenario = Scenario(Area("hexagonal", np.zeros((3, 4), dtype=bool)), [(3, 2)], [(0, 0), (1, 1), (2, 2)])
    actions = [JUMP, 0, JUMP, WAIT, WAIT, JUMP, 0]
    check(Plan(scenario, np.array(actions), np.array([0, 3, 4, 7]), jumps=np.array([[0, 5], [2, 11], [5, 6]])))
