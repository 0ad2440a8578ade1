"""Clearance: how near two robots come to each other, and how large cells must be so that they never touch."""

from __future__ import annotations

from math import ceil, sqrt

from trihex.areas.frame import Frame
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, ScenarioError

# The least distance between the centres of two robots during a step, in edge steps, over all pairs of moves and waits
# that the rules allow to happen at once, when robots move in straight lines at constant speed. docs/metric.md derives
# the numbers, tests/areas/test_clearance.py finds them again by trying all pairs.
_LEAST_DISTANCE = {
    ("triangular", "full"): sqrt(3 / 28),
    ("triangular", "edge"): sqrt(3 / 4),
    ("hexagonal", "full"): sqrt(1 / 4),
    ("hexagonal", "edge"): sqrt(1 / 4),
    ("square", "full"): sqrt(1 / 5),
    ("square", "edge"): sqrt(1 / 2),
}


def least_distance(tessellation: Tessellation, crossing: str = "forbid") -> float:
    """Return how near the centres of two robots can come to each other, in edge steps.

    Where robots pass vertices, ``crossing="allow"`` lets two of them meet there, and the answer is 0. That no two enter
    one destination in one step (``destination_capacity=1``) is taken for granted.

    Examples
    --------
    >>> least_distance(Tessellation("hexagonal"))
    0.5
    >>> least_distance(Tessellation("square"), crossing="allow")
    0.0
    """
    if crossing == "allow" and tessellation.edge_count < tessellation.direction_count:
        return 0.0
    return _LEAST_DISTANCE[tessellation.name, tessellation.neighbourhood]


def least_cell_size(tessellation: Tessellation, robot_radius: float) -> float:
    """Return the least edge step, in the unit of `robot_radius`, at which robots never overlap; crossing is forbidden.

    Examples
    --------
    >>> least_cell_size(Tessellation("hexagonal"), 0.15)
    0.6
    """
    return 2.0 * robot_radius / least_distance(tessellation)


def check_cell_size(tessellation: Tessellation, frame: Frame) -> None:
    """Raise AreaError if two robots that keep to the rules would overlap; at the least size they just touch."""
    least = least_cell_size(tessellation, frame.robot_radius)
    if frame.cell_size < least * (1 - 1e-9):
        cells = f"{tessellation.name} cells"
        if tessellation.neighbourhood == "edge" and tessellation.name != "hexagonal":
            cells += " with edge moves only"
        near = least_distance(tessellation)
        raise AreaError(
            f"cell_size must be at least {_round_up(least)} metres on {cells} for two robots of radius "
            f"{frame.robot_radius:g} to pass each other (they come as near as {near:.4g} of it), not "
            f"{frame.cell_size:g}; at that size the radius may be at most {_round_down(frame.cell_size * near / 2)}"
        )


def check_rules(tessellation: Tessellation, frame: Frame, crossing: str, destination_capacity: int | None) -> None:
    """Raise ScenarioError if the rules let robots that have a radius overlap."""
    if frame.robot_radius == 0:
        return
    if least_distance(tessellation, crossing) == 0:
        raise ScenarioError(
            f"crossing must be 'forbid' for robots of radius {frame.robot_radius:g}, not {crossing!r}: "
            "two that pass one vertex meet there"
        )
    if destination_capacity != 1:
        raise ScenarioError(
            f"destination_capacity must be 1 for robots of radius {frame.robot_radius:g}, not "
            f"{destination_capacity}: those that enter together meet there; name more destinations instead"
        )


def _round_up(metres: float) -> str:
    return f"{ceil(metres * 1e4 * (1 - 1e-9)) / 1e4:.4f}".rstrip("0").rstrip(".")


def _round_down(metres: float) -> str:
    return f"{int(metres * 1e4 * (1 + 1e-9)) / 1e4:.4f}".rstrip("0").rstrip(".")
