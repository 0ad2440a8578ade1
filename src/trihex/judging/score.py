"""Score: a crowd that was recorded, beside the best that is possible from where its persons began."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Claim, Scenario, least_advance, nearest_free_cell, seconds_per_step
from trihex.bounds import arrivals_bound
from trihex.errors import FormatError, ScenarioError, check_number, check_type
from trihex.judging.reach import is_reachable
from trihex.plans import Trajectories, exits_among
from trihex.record import Record, read_only

# Cells that whoever begins or ends somewhere in a cell may gain at both ends, in edge steps.
_SLACK = 3.0


@dataclass(frozen=True, eq=False)
class Score(Record):
    """When persons arrived, and when the i-th of them can have arrived at best, in seconds.

    The bound takes for granted that nobody is faster than `speed`; that a cell has room for one person; that the cells
    know all ways; and that no more than `flow` persons leave in a second, if that is told. Whoever queues does so at
    nested least cuts (`trihex.bounds.arrivals_bound`), as wide as their cells; a move takes the least time that it can
    take in the direction in which moves lead least far, and three cells are given for where in a cell one begins and
    ends.

    Parameters
    ----------
    trajectories : Trajectories
    scenario : Scenario
        Area, destinations, and the cells in which persons began.
    speed : float
        Metres in a second.
    flow : float or None
        Persons in a second, through all exits together; None where some exit lets out any number.
    flows : dict
        Persons in a second by the names of exits that are doors with a flow; of those that are none together,
        ``elsewhere``, if that is told.
    arrived : bool array, shape (persons,)
        Whether each left: it is gone before the last frame, or is at a destination in it.
    seconds : float64 array, shape (persons,)
        When each was seen last.
    earliest : float64 array
        Ascending: when the i-th to arrive, whoever it is, arrives at best.
    exit_of_person : int64 array, shape (persons,)
        The number of the exit nearest to where each was seen last, -1 if it did not leave.
    lost : float64 array, shape (height, width)
        Seconds lost in each cell: those in which persons were there, less what they need for the way that they made.
    """

    trajectories: Trajectories
    scenario: Scenario
    speed: float
    flow: float | None
    flows: dict[str, float]
    arrived: NDArray[np.bool_]
    seconds: NDArray[np.float64]
    earliest: NDArray[np.float64]
    exit_of_person: NDArray[np.int64]
    lost: NDArray[np.float64]

    def __post_init__(self) -> None:
        for name in ("arrived", "seconds", "earliest", "exit_of_person", "lost"):
            self._set(name, read_only(getattr(self, name)))

    def in_words(self) -> str:
        """Return the trajectories, how many left, and the gap."""
        gap = "no gap" if self.gap is None else f"gap {100 * self.gap:.1f} %"
        return f"{self.trajectories.in_words()}, {np.count_nonzero(self.arrived)} arrived, {gap}"

    @cached_property
    def arrivals(self) -> NDArray[np.float64]:
        """When persons arrived, ascending, in seconds."""
        return read_only(np.sort(self.seconds[self.arrived]))

    @property
    def first_beyond(self) -> float | None:
        """The first time at which more have arrived than the bound allows, None if there is none.

        There is one only if something that is taken for granted is not so.
        """
        early = np.flatnonzero(self.arrivals < self.earliest[: self.arrivals.size] - 1e-9)
        return float(self.arrivals[early[0]]) if early.size else None

    @property
    def is_within(self) -> bool:
        """Whether at no time more have arrived than the bound allows."""
        return self.first_beyond is None

    @property
    def gap(self) -> float | None:
        """How much later than the bound persons arrived in the mean: 1.0 is twice as late; None if none did."""
        best = self.earliest[: self.arrivals.size]
        return float(self.arrivals.mean() / best.mean() - 1) if best.size and best.mean() > 0 else None

    @cached_property
    def exits(self) -> dict[str, int]:
        """How many left by each exit, by its name or the place of its first cell."""
        groups = exits_among(self.scenario.area, self.scenario.destinations)
        return {own.name: int(np.sum(self.exit_of_person == number)) for number, own in enumerate(groups)}

    def as_dict(self) -> dict[str, Any]:
        """Return the numbers: plain ones, strings and None, ready for JSON."""
        arrivals, best = self.arrivals, self.earliest
        return {
            "trajectories": self.trajectories.name,
            "area": self.scenario.area.name,
            "persons": self.trajectories.person_count,
            "arrived": int(arrivals.size),
            "last_arrival_seconds": float(arrivals[-1]) if arrivals.size else None,
            "mean_arrival_seconds": float(arrivals.mean()) if arrivals.size else None,
            "least_last_seconds": float(best[arrivals.size - 1]) if arrivals.size and self.is_within else None,
            "least_mean_seconds": float(best[: arrivals.size].mean()) if arrivals.size else None,
            "gap": self.gap,
            "within_bound": self.is_within,
            "exits": self.exits,
            "seconds_lost": float(self.lost.sum()),
            "speed": self.speed,
            "flow": None if self.flow is None else round(self.flow, 9),
            "flows": {name: round(flow, 9) for name, flow in self.flows.items()},
            "cell_size": self.scenario.area.metres.cell_size,
        }


def make_score(
    trajectories: Trajectories, scenario: Scenario, *, speed: float | None = None, flow: float | None = None
) -> Score:
    """Return the score of a crowd.

    Parameters
    ----------
    trajectories : Trajectories
    scenario : Scenario
        Area in metres and destinations; its robots are not looked at.
    speed : float, optional
        Metres in a second. Default: the greatest of anyone.
    flow : float, optional
        Persons in a second through all exits together, but for those that are doors of the scenario, which tell it
        themselves: in steps of robots of 1 metre in a second, as `Scenario` takes them. Default: one in each cell of an
        exit for each move. Doors inside are as wide as their cells.

    Raises
    ------
    FormatError
        If two persons are in one cell in some frame: cells must be small enough for one person each; or if somebody
        cannot reach a destination.
    AreaError
        If the area has no frame, or somebody is outside.
    """
    check_type("trajectories", trajectories, Trajectories)
    check_type("scenario", scenario, Scenario)
    area, frame = scenario.area, scenario.area.metres
    for name, value in (("speed", speed), ("flow", flow)):
        if value is not None:
            check_number(name, value, 1e-9, 1e9, ScenarioError)
    speed = trajectories.greatest_speed if speed is None else float(speed)
    if speed <= 0:
        raise FormatError(f"{trajectories.name}: nobody moves, so a speed must be told")
    cell = area.metres_to_cell(trajectories.x, trajectories.y)
    _check_room(trajectories, scenario, cell)
    starts, moved = _starts(trajectories, scenario, cell)
    # A move counts as a step, and persons may follow at once, whatever the rules for robots are.
    law = {"crossing": scenario.crossing, "corners": scenario.corners, "following": "allow"}
    claim = Claim(area.with_clock("steps"), scenario.destinations, starts, **law)  # type: ignore[arg-type]
    stuck = np.flatnonzero(~is_reachable(claim, starts))
    if stuck.size:
        where = area.place_of_cell(int(starts[stuck[0]]))
        raise FormatError(f"{trajectories.name}: person {stuck[0]} cannot reach a destination from {where}")
    unit = frame.cell_size / speed
    least = arrivals_bound(claim).steps * (least_advance(area.tessellation) * unit) - (_SLACK * unit + moved / speed)
    earliest = np.maximum(least, 0.0)
    flows, is_limited = _flows(scenario, flow)
    if is_limited:
        there = np.count_nonzero(np.isin(starts, scenario.destinations))  # they are out, and first in the bound
        earliest[there:] = _let_out(earliest[there:], list(flows.values()))
    seconds = trajectories.frame[trajectories.last_row] / trajectories.frame_rate
    arrived, exits = _ends(trajectories, scenario, cell)
    lost = _lost(trajectories, scenario, cell, speed)
    total = sum(flows.values()) if is_limited else None
    return Score(trajectories, claim, speed, total, flows, arrived, seconds, earliest, exits, lost)


def _flows(scenario: Scenario, elsewhere: float | None) -> tuple[dict[str, float], bool]:
    """Return how many leave in a second by each exit that has a flow and by all others, and whether that is all."""
    area, step, flows = scenario.area, seconds_per_step(scenario.area), {}
    is_free = np.ones(scenario.destinations.size, dtype=bool)
    for door in scenario.doors:
        is_own = np.isin(scenario.destinations, door.cells)
        if is_own.any():
            flows[door.name or area.name_of_cell(int(door.cells[0]))] = float(door.flow) / step
            is_free &= ~is_own
    if elsewhere is not None and not is_free.any():
        raise ScenarioError(f"flow is of exits without a capacity, and all have one, so {elsewhere:g} cannot be told")
    if elsewhere is not None:
        flows["elsewhere"] = float(elsewhere)
    return flows, elsewhere is not None or not is_free.any()


def _let_out(earliest: NDArray[np.float64], flows: list[float]) -> NDArray[np.float64]:
    """Delay ascending times so that in no stretch of time more leave than all exits let out in it.

    An exit of flow f lets out 1 + f * T at most in any stretch of T seconds, so n persons more than those before them
    need the n-th of the times 0, 1 / f, 2 / f, ... of all exits. Whoever comes as m-th does so at ``earliest[m]`` at
    best, and all after him no earlier.
    """
    count = earliest.size
    slots = np.sort(np.concatenate([np.arange(count) / flow for flow in flows]))[:count]
    delayed = earliest.copy()
    for first in range(count):
        np.maximum(delayed[first:], earliest[first] + slots[: count - first], out=delayed[first:])
    return delayed


def _check_room(trajectories: Trajectories, scenario: Scenario, cell: NDArray[np.int64]) -> None:
    """Raise FormatError if two persons are in one cell that is no destination in some frame."""
    inside = np.flatnonzero(~np.isin(cell, scenario.destinations))
    order = inside[np.lexsort((cell[inside], trajectories.frame[inside]))]
    pairs = np.flatnonzero((np.diff(trajectories.frame[order]) == 0) & (np.diff(cell[order]) == 0))
    if not pairs.size:
        return
    gaps = np.hypot(*(np.diff(own[order])[pairs] for own in (trajectories.x, trajectories.y)))
    one, other = order[pairs[np.argmin(gaps)]], order[pairs[np.argmin(gaps)] + 1]
    corners = scenario.area.tessellation.polygon_of_cell(np.array([2]), np.array([2]))[0]
    across = float(np.max(np.linalg.norm(corners[:, None] - corners[None], axis=-1)))
    area, persons = scenario.area, [int(trajectories.person[row]) for row in (one, other)]
    fits, seconds = np.floor(1000 * gaps.min() / across) / 1000, trajectories.frame[one] / trajectories.frame_rate
    raise FormatError(
        f"{trajectories.name}: the crowd is denser than the cells: persons {persons[0]} and {persons[1]} are both in "
        f"{area.place_of_cell(int(cell[one]))} after {seconds:g} s; cell_size must "
        f"be at most {fits:g} metres, not {area.metres.cell_size:g}"
    )


def _starts(trajectories: Trajectories, scenario: Scenario, cell: NDArray[np.int64]) -> tuple[NDArray[np.int64], float]:
    """Return the cell in which each person began, or the free one nearest to it, and how far that is at most."""
    area, rows = scenario.area, trajectories.first_row
    starts, farthest = cell[rows].copy(), 0.0
    for person in np.flatnonzero(area.is_barrier(starts)).tolist():
        x, y = float(trajectories.x[rows[person]]), float(trajectories.y[rows[person]])
        px, py = (float(number) for number in area.metres.metres_to_point(x, y))
        near = nearest_free_cell(area.tessellation, area.barriers, px, py)
        if near is None:
            raise ScenarioError("no cell of the area is free")
        starts[person] = area.xy_to_cell(*near)
        to_x, to_y = area.cell_to_metres(starts[person])
        farthest = max(farthest, float(np.hypot(to_x - x, to_y - y)))
    return starts, farthest


def _ends(
    trajectories: Trajectories, scenario: Scenario, cell: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Return who left, and by which exit."""
    last = trajectories.last_row
    is_gone = trajectories.frame[last] < trajectories.frame.max()
    arrived = is_gone | np.isin(cell[last], scenario.destinations)
    groups = exits_among(scenario.area, scenario.destinations)
    distances = []
    for own in groups:
        x, y = scenario.area.cell_to_metres(own.cells)
        away = np.hypot(trajectories.x[last][:, None] - x, trajectories.y[last][:, None] - y)
        distances.append(away.min(axis=1))
    return arrived, np.where(arrived, np.argmin(np.stack(distances), axis=0), -1)


def _lost(trajectories: Trajectories, scenario: Scenario, cell: NDArray[np.int64], speed: float) -> NDArray[np.float64]:
    """Return the seconds lost in each cell: between two frames, those beyond what the way takes at full speed."""
    same = np.diff(trajectories.person) == 0
    took = np.diff(trajectories.frame)[same] / trajectories.frame_rate
    gone = np.hypot(np.diff(trajectories.x), np.diff(trajectories.y))[same]
    lost = np.maximum(took - gone / speed, 0.0)
    area = scenario.area
    flat = np.bincount(cell[:-1][same], weights=lost, minlength=area.cell_count)
    return np.asarray(flat.reshape(area.height, area.width))
