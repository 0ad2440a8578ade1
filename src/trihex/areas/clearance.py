"""Clearance: how near two robots come to each other, and how large cells must be so that they never touch."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, sqrt

from trihex.areas.frame import Frame
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, ScenarioError

# The least distance between the centres of two robots, in edge steps, over all pairs of moves and waits that the rules
# allow to overlap, when robots move in straight lines at constant speed; where following is forbidden, whatever their
# speeds. docs/metric.md derives the numbers, tests/areas/test_clearance.py finds them again by trying all pairs.
_ALLOW = {
    ("triangular", "full"): sqrt(3 / 28),
    ("triangular", "edge"): sqrt(3 / 4),
    ("hexagonal", "full"): sqrt(1 / 4),
    ("hexagonal", "edge"): sqrt(1 / 4),
    ("square", "full"): sqrt(1 / 5),
    ("square", "edge"): sqrt(1 / 2),
}
# Where moves last as long as they cost, by tessellation and costs; edge moves are alike and come as near as in steps.
_ALLOW_IN_TICKS = {
    ("triangular", "paper"): sqrt(27 / 229),
    ("triangular", "euclidean"): sqrt(27 / 181),
    ("square", "paper"): 6 / 13,
    ("square", "euclidean"): sqrt(81 / 338),
}
_FORBID = {
    ("triangular", "full"): 1 / 2,
    ("triangular", "edge"): 1.0,
    ("hexagonal", "full"): sqrt(3 / 4),
    ("hexagonal", "edge"): sqrt(3 / 4),
    ("square", "full"): sqrt(1 / 2),
    ("square", "edge"): 1.0,
}


def least_distance(tessellation: Tessellation, crossing: str = "forbid", following: str = "allow") -> float:
    """Return how near the centres of two robots can come to each other, in edge steps.

    Where robots pass vertices, ``crossing="allow"`` lets two of them meet there, and the answer is 0. That no two enter
    one destination at a time (``destination_capacity=1``) is taken for granted.

    Examples
    --------
    >>> least_distance(Tessellation("hexagonal"))
    0.5
    >>> least_distance(Tessellation("square"), crossing="allow")
    0.0
    >>> least_distance(Tessellation("square", "edge"), following="forbid")
    1.0
    """
    passes_vertices = tessellation.edge_count < tessellation.direction_count
    if crossing == "allow" and passes_vertices:
        return 0.0
    if following == "forbid":
        return _FORBID[tessellation.name, tessellation.neighbourhood]
    if tessellation.clock == "costs" and passes_vertices:
        return _ALLOW_IN_TICKS[tessellation.name, tessellation.costs]
    return _ALLOW[tessellation.name, tessellation.neighbourhood]


def least_cell_size(tessellation: Tessellation, robot_radius: float, following: str = "allow") -> float:
    """Return the least edge step, in the unit of `robot_radius`, at which robots never overlap; crossing is forbidden.

    Examples
    --------
    >>> least_cell_size(Tessellation("hexagonal"), 0.15)
    0.6
    >>> round(least_cell_size(Tessellation("hexagonal"), 0.15, "forbid"), 4)
    0.3464
    """
    return 2.0 * robot_radius / least_distance(tessellation, following=following)


def _fits(tessellation: Tessellation, frame: Frame, following: str) -> bool:
    """Tell whether cells are large enough; at the least size robots just touch."""
    return frame.cell_size >= least_cell_size(tessellation, frame.robot_radius, following) * (1 - 1e-9)


def usual_following(tessellation: Tessellation, frame: Frame | None) -> str:
    """Return "allow", or "forbid" where that alone makes the cells of the frame large enough for its robots."""
    if frame is None or _fits(tessellation, frame, "allow") or not _fits(tessellation, frame, "forbid"):
        return "allow"
    return "forbid"


def check_cell_size(tessellation: Tessellation, frame: Frame, following: str) -> None:
    """Raise AreaError if two robots that keep to the rules would overlap; the message names all least sizes."""
    if _fits(tessellation, frame, following):
        return
    radius, cells = frame.robot_radius, f"{tessellation.name} cells"
    if tessellation.neighbourhood == "edge" and tessellation.name != "hexagonal":
        cells += " with edge moves only"
    least, forbidden = (_round_up(least_cell_size(tessellation, radius, rule)) for rule in ("allow", "forbid"))
    near = least_distance(tessellation, following=following)
    raise AreaError(
        f"cell_size must be at least {least} metres ({forbidden} where following is 'forbid') on {cells} for two "
        f"robots of radius {radius:g} to pass each other (they come as near as {near:.4g} of it), not "
        f"{frame.cell_size:g}; at that size the radius may be at most {_round_down(frame.cell_size * near / 2)}"
    )


def check_rules(
    tessellation: Tessellation, frame: Frame, crossing: str, destination_capacity: int | Fraction | None
) -> None:
    """Raise ScenarioError if the rules let robots that have a radius overlap."""
    if frame.robot_radius == 0:
        return
    if least_distance(tessellation, crossing) == 0:
        raise ScenarioError(
            f"crossing must be 'forbid' for robots of radius {frame.robot_radius:g}, not {crossing!r}: "
            "two that pass one vertex meet there"
        )
    if destination_capacity is None or destination_capacity > 1:
        raise ScenarioError(
            f"destination_capacity must be 1 for robots of radius {frame.robot_radius:g}, not "
            f"{destination_capacity}: those that enter together meet there; name more destinations instead"
        )


def _round_up(metres: float) -> str:
    return f"{ceil(metres * 1e4 * (1 - 1e-9)) / 1e4:.4f}".rstrip("0").rstrip(".")


def _round_down(metres: float) -> str:
    return f"{int(metres * 1e4 * (1 + 1e-9)) / 1e4:.4f}".rstrip("0").rstrip(".")
