"""Corners: how many moves of a plan pass the corner of a barrier."""

from __future__ import annotations

from trihex.plans import Plan, count_marked_moves


def count_corner_moves(plan: Plan, corners: str = "no-cut") -> int:
    """Return how many moves of a plan a corner rule forbids, whatever the rule of its scenario.

    Parameters
    ----------
    plan : Plan
    corners : {"no-cut", "no-squeeze"}
        "no-cut": moves through a lattice vertex where a barrier stands; outside the area counts as barrier.
        "no-squeeze": those of them with a barrier on either side.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_plan
    >>> scenario = Scenario(Area("square", [[0, 1], [0, 0], [0, 0]]), [(1, 1)], [(0, 0)])
    >>> plan = make_plan(scenario, "greedy")
    >>> count_corner_moves(plan), count_corner_moves(plan, "no-squeeze")
    (1, 0)
    """
    tessellation = plan.scenario.area.tessellation
    if tessellation.edge_count == tessellation.direction_count:  # no move passes a vertex
        return 0
    return count_marked_moves(plan, plan.scenario.moves_closed_by(corners))
