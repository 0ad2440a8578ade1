"""Walks over a plan, against robots followed one by one in Python."""

import numpy as np
from hypothesis import given

from tests.formats.strategies import walks
from trihex import Area, Plan, Scenario
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import cells_of_rows, follow, visits_of


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
    area, layout = plan.scenario.area, plan.scenario.area.layout
    own = list(ways(plan))
    visits = np.zeros(area.cell_count, dtype=int)
    for cells, actions in own:
        np.add.at(visits, [cells[0], *(to for to, action in zip(cells[1:], actions, strict=True) if action != WAIT)], 1)
    np.testing.assert_array_equal(visits_of(plan), visits.reshape(area.height, area.width))

    first_row = np.cumsum([0, *(len(cells) for cells, _ in own)])
    np.testing.assert_array_equal(cells_of_rows(plan, first_row), [cell for cells, _ in own for cell in cells])

    site, half = layout.cell_to_site(plan.scenario.robots), plan.steps // 2
    for step, next_step in ((0, half), (half, plan.steps)):
        if next_step > step:
            follow(plan, step, next_step, site)
        expected = [cells[min(next_step, len(cells) - 1)] for cells, _ in own]
        np.testing.assert_array_equal(layout.site_to_cell(site), expected)


@given(walks())
def test_robots_that_stray(plan):
    check(plan)


def test_robots_that_jump():
    scenario = Scenario(Area("hexagonal", np.zeros((3, 4), dtype=bool)), [(3, 2)], [(0, 0), (1, 1), (2, 2)])
    actions = [JUMP, 0, JUMP, WAIT, WAIT, JUMP, 0]
    check(Plan(scenario, np.array(actions), np.array([0, 3, 4, 7]), jumps=np.array([[0, 5], [2, 11], [5, 6]])))
