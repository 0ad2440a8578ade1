"""Costs: what robots pay beyond a charge for each step.

Where the clock is "costs" t_r is the tick of arrival; all bounds are bounds on arrivals then. Else a bound on *steps*
becomes one on costs so: let m be the least that a step can cost, min(w_t, cheapest move), and 0 <= u <= m. Charge u for
each step; what is left of a move is its cost less u, and of a wait w_t less u, neither negative. So t_r >= u * (steps
of r) + (least sum of what is left on a way of r), for every u alike. Where r may not begin to move before step s, it
has waited s times, and what is left of these waits is paid, too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED

_BUDGET = 2_000_000


def least_cost(n_scheme: NScheme, steps: int) -> int:
    """Return what robots must pay in all that need `steps` steps (ticks) in all."""
    scenario = n_scheme.scenario
    if scenario.clock == "costs":
        return steps
    forced = waits_before_starts(n_scheme)
    return max(
        share * steps + (scenario.waiting_cost - share) * forced + _left(n_scheme, share) for share in shares(scenario)
    )


def sum_of_distances(n_scheme: NScheme) -> int:
    """Return the sum of what the ways of the robots that can arrive cost, from their distances and their slowness."""
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots).astype(np.int64)
    return int((distance * n_scheme.scenario.slowness)[distance != NOT_REACHED].sum())


def waits_before_starts(n_scheme: NScheme) -> int:
    """Return how many steps (ticks) robots that can arrive wait in all until they may begin to move."""
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots)
    return int(n_scheme.scenario.start_times[(distance > 0) & (distance != NOT_REACHED)].sum())


def shares(scenario: Scenario) -> list[int]:
    """Return what to charge for each step, see the top of the file."""
    cost = scenario.area.tessellation.cost_of_direction
    most = int(min(scenario.waiting_cost, cost.min()))
    if (cost == cost[0]).all():
        return [most]
    # Two edge moves in place of a vertex move cost 2 e - v more and take a step more.
    dearer = {int(2 * cost.min() - other) for other in cost}
    return sorted({share for share in (most, most * 4 // 5, *dearer) if 0 < share <= most} or {most})


def _left(n_scheme: NScheme, share: int) -> int:
    """Return the sum over robots of the least sum of what is left of the costs on the way to a destination."""
    cost = n_scheme.scenario.area.tessellation.cost_of_direction
    if (cost == cost[0]).all():
        return sum_of_distances(n_scheme) * int(cost[0] - share) // int(cost[0])
    return int(_at_robots(n_scheme, left_field(n_scheme, share)).sum())


def left_field(n_scheme: NScheme, share: int) -> NDArray[np.int32]:
    """Return the least sum of what is left on the way from each site, `NOT_REACHED` where there is none."""
    from trihex.bounds.kernels import steps as kernels

    scenario = n_scheme.scenario
    layout = scenario.area.layout
    cost = scenario.area.tessellation.cost_of_direction - np.int32(share)
    least = np.full(layout.size, NOT_REACHED, dtype=np.int32)
    queue = np.empty(scenario.area.free_count + 1, dtype=np.int32)
    is_queued = np.zeros(layout.size, dtype=bool)
    state = np.array([0, scenario.destinations.size])
    queue[: state[1]] = layout.cell_to_site(scenario.destinations)
    least[queue[: state[1]]] = 0
    while state[1]:
        kernels.spread_costs(scenario.moves, layout.offset_of_direction, cost, least, queue, is_queued, state, _BUDGET)
    return least


def _at_robots(n_scheme: NScheme, field: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the values of `field` at the robots that can arrive."""
    scenario = n_scheme.scenario
    values = field[scenario.area.layout.cell_to_site(scenario.robots)].astype(np.int64)
    return np.asarray(values[values != NOT_REACHED])
