"""Scenario: an area with its destinations, its robots and the rules they move by."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import Area
from trihex.areas.clearance import check_cell_size, check_rules, usual_following
from trihex.areas.door import Door, make_doors
from trihex.areas.flow import flow_from, flow_in_words
from trihex.areas.for_each_robot import for_each_robot
from trihex.areas.places import cells_from
from trihex.areas.schedule import Schedule, schedule_of
from trihex.areas.slowness import check_following, is_slower, make_slowness
from trihex.areas.standing import MOST, check_distinct, check_free, without_repeats
from trihex.areas.start_times import MOST_START_TIME
from trihex.areas.tessellation import CLOCKS
from trihex.areas.zone import Zone
from trihex.errors import ScenarioError, check_choice, check_type, check_whole
from trihex.record import Record, counted, read_only

CROSSINGS = ("forbid", "allow")
CORNERS = ("allow", "no-squeeze", "no-cut")
FOLLOWINGS = ("allow", "forbid")
_BLOCK = 1 << 24  # sites a kernel looks at in one call, even; Ctrl-C works in between


@dataclass(frozen=True, eq=False)
class Scenario(Record):
    """What is to be planned: robots that share a goal, and the rules of section 5 of the reading of the paper.

    Parameters
    ----------
    area : Area
    destinations : sequence of (x, y), or cell numbers
        Cells that absorb robots; at least one. A single place may be given as it is, ``(x, y)``.
    robots : sequence of (x, y), or cell numbers
        Start of each robot; robots are numbered in this order. Kept as cell numbers (y * width + x), int64. A robot
        that starts on a destination has arrived at step 0.
    waiting_cost : int, optional
        w_t, the cost of waiting one step, in the unit of the cost table. Default: as much as a step across an edge.
        Where the clock is "costs" it is 1 a tick.
    crossing : {"forbid", "allow"}
        Whether two robots may pass the same lattice vertex in one step.
    corners : {"allow", "no-squeeze", "no-cut"}
        When a vertex move is open: always; if one way round the vertex meets no barrier; if no barrier touches the
        vertex. What lies outside the area counts as barrier.
    destination_capacity : int, Fraction, float or str, optional
        How many robots may enter one destination in one step, or be entering it at a time. Default: any number; 1 in an
        area with a frame. A fraction such as 0.5 or "1/3" is a flow: see `Door`; so is "1.6/s", robots a second, in an
        area with a frame, if no robot is faster than 1 metre in a second.
    clock : {"steps", "costs"}, optional
        "steps": every move lasts one step. "costs": a move lasts as long as it costs, in ticks, and waiting costs 1 a
        tick, so that t_r is the tick of arrival; see `Tessellation`, whose clock is the default. In an area with a
        frame durations are those of euclidean costs.
    following : {"allow", "forbid"}, optional
        Who owns a cell while a robot moves. "allow": it owns the cell that it leaves for half of the move, then the one
        that it enters, so another may move up at once. "forbid": both for the whole move; nobody enters a cell that is
        still being left, which is safe whatever the robots' speeds. A lattice vertex is owned for the whole move.
        Default: "allow"; in an area with a frame "forbid" where that alone makes its cells large enough.
    seed : int, optional
        What drew the robots, for reports.
    start_times : sequence of int, or int, optional
        After how many steps (ticks) each robot may begin its first move, or all of them; until then it stands where it
        starts, and is in the way: people who have not reacted to the alarm yet. Kept as int64. t_r counts from step 0,
        so until then a robot waits. One that starts on a destination has arrived at step 0 all the same. Default: 0.
    doors : mapping, or sequence, optional
        Places that only so many robots enter in a step, exits or passages: flows by the names of zones, such as
        ``{"north": "1.6/s"}``, or pairs (places, flow), or what `make_doors` makes. Where a destination is one, its
        flow stands in the place of a `destination_capacity` that is a fraction; one that is whole holds as well.
    slowness : sequence of int, or int, optional
        How many times as long as those of the fastest the moves of each robot last and, so, cost; see `slowness_of`.
        A wait lasts and costs as much for all. In an area with a frame following must be "forbid" where some are
        slower, and is unless set. Kept as int64. Default: 1.

    Raises
    ------
    ScenarioError
        If a destination or robot lies outside or on a barrier, two robots share a cell, a rule does not exist, or the
        rules let robots of the frame's radius overlap.
    AreaError
        If the cells are too small for robots of the frame's radius.

    Examples
    --------
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0)])
    >>> scenario.robots, scenario.waiting_cost
    (array([0]), 10)
    """

    area: Area
    destinations: NDArray[np.int64]
    robots: NDArray[np.int64] = ()  # type: ignore[assignment]
    waiting_cost: int = None  # type: ignore[assignment]
    crossing: str = "forbid"
    corners: str = "allow"
    destination_capacity: int | Fraction | None = None
    seed: int | None = None
    clock: str = None  # type: ignore[assignment]
    following: str = None  # type: ignore[assignment]
    start_times: NDArray[np.int64] = ()  # type: ignore[assignment]
    doors: tuple[Door, ...] = ()
    slowness: NDArray[np.int64] = ()  # type: ignore[assignment]

    def __post_init__(self) -> None:
        check_type("area", self.area, Area, error=ScenarioError)
        check_choice("crossing", self.crossing, CROSSINGS, ScenarioError)
        check_choice("corners", self.corners, CORNERS, ScenarioError)
        self._set_clock()
        area = self.area
        if self.seed is not None:
            check_whole("seed", self.seed, 0, None, ScenarioError)
        if self.destination_capacity is None and area.frame is not None:
            self._set("destination_capacity", 1)
        if self.destination_capacity is not None:
            flow = flow_from("destination_capacity", self.destination_capacity, area)
            self._set("destination_capacity", int(flow) if flow.denominator == 1 else flow)
        if self.following is None:
            follows = "forbid" if area.frame is not None and is_slower(self.slowness) else None
            self._set("following", follows or usual_following(area.tessellation, area.frame))
        check_choice("following", self.following, FOLLOWINGS, ScenarioError)
        if area.frame is not None:
            check_cell_size(area.tessellation, area.frame, self.following)
            check_rules(area.tessellation, area.frame, self.crossing, self.destination_capacity)
        self._set("doors", make_doors(area, self.doors))
        for parameter, one in (("destinations", "destination"), ("robots", "robot")):
            cells = cells_from(area, getattr(self, parameter), parameter, ScenarioError)
            self._check_free(cells, one)
            self._set(parameter, read_only(np.array(cells)))
        if self.destinations.size == 0:
            raise ScenarioError("destinations must name at least one cell")
        self._set("destinations", read_only(without_repeats(self.destinations)))
        self._check_distinct()
        start_times = for_each_robot("start_times", self.start_times, self.robot_count, 0, MOST_START_TIME)
        self._set("start_times", read_only(start_times))
        longest = int(self.duration_of_direction.max())
        self._set("slowness", read_only(make_slowness(self.slowness, self.robot_count, longest)))
        if area.frame is not None and self.has_slowness:
            check_following(self.following)

    def _set_clock(self) -> None:
        """Set what costs the area has by the clock, and what waiting costs."""
        usual = self.area.tessellation.waiting_cost
        if self.clock is not None:
            check_choice("clock", self.clock, CLOCKS, ScenarioError)
            self._set("area", self.area.with_clock(self.clock))
        tessellation = self.area.tessellation
        self._set("clock", tessellation.clock)
        if self.waiting_cost is None or self.waiting_cost == usual != tessellation.waiting_cost:
            self._set("waiting_cost", tessellation.waiting_cost)
        check_whole("waiting_cost", self.waiting_cost, 0, MOST, ScenarioError)
        if self.clock == "costs" and self.waiting_cost != 1:
            raise ScenarioError(f"waiting_cost must be 1 where clock is 'costs', not {self.waiting_cost}")

    def _check_free(self, cells: NDArray[np.int64], one: str) -> None:
        check_free(self.area, cells, one)

    def _check_distinct(self) -> None:
        check_distinct(self.area, self.robots)

    def in_words(self) -> str:
        """Return the area, how many destinations and robots, and rules that are not those of the paper."""
        rules = {"waiting_cost": self.area.tessellation.waiting_cost, "crossing": "forbid", "corners": "allow"}
        rules["destination_capacity"] = None if self.area.frame is None else 1
        rules |= {"clock": "steps", "following": "allow"}
        odd = [
            f"{name}={_in_words(getattr(self, name))}" for name, usual in rules.items() if getattr(self, name) != usual
        ]
        odd += [f"door {door.in_words()}" for door in self.doors]
        if self.has_start_times:
            odd.append(f"start_times=0..{self.start_times.max()}")
        if self.has_slowness:
            odd.append(f"slowness={self.slowness.min()}..{self.slowness.max()}")
        goals = counted(self.destinations.size, "destination")
        return ", ".join([self.area.in_words(), goals, counted(self.robot_count, "robot"), *odd])

    @property
    def robot_count(self) -> int:
        """n, the number of robots."""
        return int(self.robots.size)

    @cached_property
    def has_start_times(self) -> bool:
        """Whether some robot may not begin to move at once."""
        return bool(self.start_times.any())

    @cached_property
    def has_slowness(self) -> bool:
        """Whether moves of some robot last longer than `duration_of_direction` says."""
        return bool((self.slowness > 1).any())

    @property
    def has_flows(self) -> bool:
        """Whether some cells let robots in by a flow."""
        return self.schedule.cells.size > 0

    @property
    def moves_by_steps(self) -> bool:
        """Whether planners may let all robots act in every step: time is in steps alone, and nobody waits for a time.

        Where robots wait until they may begin, or until a door opens, they are asked when it is time.
        """
        return self.is_stepwise and not self.has_start_times and not self.has_flows

    @property
    def forbids_crossing(self) -> bool:
        """Whether there are lattice vertices that two robots may not pass in one step."""
        tessellation = self.area.tessellation
        return self.crossing == "forbid" and tessellation.edge_count < tessellation.direction_count

    @property
    def first_vertex_move(self) -> int:
        """The first direction that passes a lattice vertex which others may not; their number if there is none."""
        tessellation = self.area.tessellation
        return tessellation.edge_count if self.forbids_crossing else tessellation.direction_count

    @property
    def duration_of_direction(self) -> NDArray[np.int32]:
        """How many ticks a move of the fastest lasts by direction; a wait lasts one. All 1 by the clock "steps"."""
        return self.area.tessellation.duration_of_direction

    @property
    def is_stepwise(self) -> bool:
        """Whether all moves last one step and others may move up at once: time in steps alone, as in the paper."""
        has_steps = bool((self.duration_of_direction == 1).all()) and not self.has_slowness
        return self.following == "allow" and has_steps

    @property
    def step_word(self) -> str:
        """What a step of time is called: "step", or "tick" where the clock is "costs"."""
        return "step" if self.clock == "steps" else "tick"

    @property
    def headway(self) -> int:
        """How many ticks must pass at least between two robots that go through one cell."""
        return int(self.duration_of_direction.min()) * (2 if self.following == "forbid" else 1)

    @property
    def entry_limit(self) -> int:
        """How many robots may enter one destination in a step, 0 for any number: the capacity as kernels know it.

        When they may do so `schedule` tells, where there are flows.
        """
        return ceil(self.destination_capacity or 0)

    @cached_property
    def schedule(self) -> Schedule:
        """When those cells may be entered that let robots in by a flow: doors, and destinations of such a capacity."""
        if not self.doors:
            return schedule_of((), self.destinations, self.destination_capacity, np.ones(self.destinations.size, bool))
        from trihex.areas.entries import ways_into_destinations

        entered: NDArray[np.bool_] = np.asarray((ways_into_destinations(self) >= 0).any(axis=1))
        return schedule_of(self.doors, self.destinations, self.destination_capacity, entered)

    @property
    def exit_zones(self) -> tuple[Zone, ...]:
        """The zones of the area, without those that are doors which robots only pass."""
        passed = {door.name for door in self.doors if not np.isin(door.cells, self.destinations).any()}
        return tuple(zone for zone in self.area.zones if zone.name not in passed)

    def flows_in_words(self, step_seconds: float | None = None) -> dict[str, str]:
        """Return how many robots each door lets in, by its name or the place of its first cell: a second, or a step."""
        return {
            door.name or self.area.name_of_cell(int(door.cells[0])): flow_in_words(door.flow, self.area, step_seconds)
            for door in self.doors
        }

    @property
    def corner_rule(self) -> int:
        """Place of `corners` in `CORNERS`, for kernels."""
        return CORNERS.index(self.corners)

    @cached_property
    def moves(self) -> NDArray[np.uint16]:
        """Open moves of each site: bit k is set where direction k may be taken; shape (layout.size,)."""
        from trihex.areas.kernels.moves import BLOCK, fill_moves
        from trihex.kernels.corners import CornerRule
        from trihex.kernels.signatures import given

        layout = self.area.layout
        corners = given(
            CornerRule,
            offset=layout.offset_of_direction,
            vertex=layout.vertex_of_direction,
            ring=layout.ring_of_vertex,
            edge_count=self.area.tessellation.edge_count,
            rule=self.corner_rule,
        )
        blocked = self.area.make_blocked().view(np.uint8)
        moves = np.zeros(layout.size, dtype=np.uint16)
        one_way, other_way = np.empty(BLOCK, dtype=np.uint8), np.empty(BLOCK, dtype=np.uint8)
        end = layout.origin + layout.height * layout.pitch
        for start in range(layout.origin, end, _BLOCK):
            fill_moves(blocked, start, min(start + _BLOCK, end), corners, one_way, other_way, moves)
        return read_only(moves)

    def moves_closed_by(self, corners: str) -> NDArray[np.uint16]:
        """Return the moves that a corner rule closes though they lead to free cells, bits as in `moves`.

        Examples
        --------
        >>> scenario = Scenario(Area("square", [[0, 1], [0, 0]]), destinations=[(0, 0)])
        >>> int(scenario.moves_closed_by("no-cut")[scenario.area.layout.origin]).bit_count()
        1
        """
        lone = self.with_robots(())
        closed: NDArray[np.uint16] = replace(lone, corners="allow").moves & ~replace(lone, corners=corners).moves
        return read_only(closed)

    def with_robots(self, robots: Any, seed: int | None = None) -> Scenario:
        """Return the same scenario with other robots, who may begin to move at once and are all as fast."""
        return replace(self, robots=robots, seed=seed, start_times=(), slowness=())  # type: ignore[arg-type]


def _in_words(value: Any) -> str:
    return str(value) if isinstance(value, Fraction) else repr(value)
