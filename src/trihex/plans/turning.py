"""Turning: by how much robots change their heading from one move to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.errors import check_type
from trihex.plans.plan import Plan, actions_of
from trihex.plans.rows import blocks_of
from trihex.record import read_only


def turning_of_robot(plan: Plan) -> NDArray[np.float64]:
    """Return by how many degrees each robot turns in all, from move to move, shape (robots,).

    A wait is no turn, nor is the way that a robot looked before its first move.

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.plans.plan import plan_from_lists
    >>> scenario = Scenario(Area("square", [[0, 0], [0, 0]]), destinations=[(1, 1)], robots=[(0, 0)])
    >>> names = scenario.area.tessellation.direction_names[0]
    >>> turning_of_robot(plan_from_lists(scenario, [[names.index("E"), 255, names.index("S")]])).tolist()
    [90.0]
    """
    from trihex.plans.kernels import replay as kernels

    check_type("plan", plan, Plan)
    area = plan.scenario.area
    start, actions = area.layout.cell_to_site(plan.scenario.robots), actions_of(plan)
    turned = np.zeros(start.size)
    for robot, last in blocks_of(plan):
        kernels.sum_turns(start, actions, robot, last, area.tessellation.heading_of_direction, turned)
    return read_only(turned)
