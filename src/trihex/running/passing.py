"""Passing order: in which order robots pass each cell, lattice vertex and destination, so that late ones do no harm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import check_as_fast
from trihex.errors import PlanError, check_number, check_type, check_whole
from trihex.kernels.codes import JUMP, LATE, WAIT
from trihex.plans import Plan, in_turn
from trihex.record import Record, read_only
from trihex.running.follower import Follower
from trihex.running.run import ARRIVED, GOING, Run

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PassingOrder(Record):
    """What must come before what, if robots are to do the moves of a plan at other times than it says.

    Moves are numbered robot by robot, waits left out. A robot may make its next move as soon as

    - the robot that is in the cell before it leaves it in the same step or has left it,
    - the robot that passes the lattice vertex before it has passed it in an earlier step,
    - a destination of capacity c has taken the robot that enters it c places earlier, in an earlier step.

    Everything that must come first is earlier in the plan, or in the same step of it. So whoever is first in the plan
    of those not done can always move: no delay makes robots collide, or wait for each other for ever. Nobody moves
    before its start time.

    Where moves last several ticks or nobody follows before a cell is left, a robot begins its next move when the move
    that leaves the cell, that which passes the vertex and that which enters the same place of the destination before it
    are over, or, where following is allowed, when they have begun and will leave the cell or place no later than it
    comes. The middles of these moves come no later in the plan; so of all moves that have not begun that of the
    earliest middle can begin, alone or, where several are equal, in a ring whose moves last alike.

    Parameters
    ----------
    plan : Plan
    first_move : int64 array, shape (robots + 1,)
        Robot r has the moves ``first_move[r]`` to ``first_move[r + 1]``.
    action_of_move : uint8 array
    leaves_before, vertex_before, entry_before : int64 arrays
        For each move the one that must come before it by each of these rules, -1 if there is none.
    """

    plan: Plan
    first_move: Ints
    action_of_move: NDArray[np.uint8]
    leaves_before: Ints
    vertex_before: Ints
    entry_before: Ints

    @property
    def duration_of_move(self) -> NDArray[np.int32]:
        """How many ticks each move lasts."""
        return self.plan.scenario.duration_of_direction[self.action_of_move]

    @cached_property
    def robot_of_move(self) -> Ints:
        """Who makes each move."""
        return read_only(np.repeat(np.arange(self.first_move.size - 1), np.diff(self.first_move)))

    @cached_property
    def enters_after(self) -> Ints:
        """For each move the one that enters the cell that it leaves, -1 if there is none."""
        after = np.full(self.leaves_before.size, -1, dtype=np.int64)
        has = np.flatnonzero(self.leaves_before >= 0)
        after[self.leaves_before[has]] = has
        return read_only(after)

    def follow(self) -> Follower:
        """Return what tells robots step by step who may move."""
        return Follower(self)

    def run(self, *, delay: float = 0.0, seed: int = 0, most_steps: int = 1_000_000) -> Run:
        """Return the run in which robots keep to the order, each late in a step by chance.

        Parameters
        ----------
        delay : float
            The chance to be late, below 1.
        seed : int
        most_steps : int

        Examples
        --------
        >>> from trihex import Area, Scenario, make_plan
        >>> scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0]]), destinations=[(3, 0)], robots=[(0, 0), (1, 0)])
        >>> order = make_passing_order(make_plan(scenario))
        >>> order.run().steps, order.run(delay=0.5, seed=1).steps
        (3, 10)
        """
        check_number("delay", delay, 0, 1, PlanError, below=True)
        check_whole("seed", seed, 0, None, PlanError)
        check_whole("most_steps", most_steps, 0, None, PlanError)
        follower = self.follow()
        rows: list[NDArray[np.uint8]] = []
        robots = self.plan.scenario.robot_count
        while not follower.is_over and len(rows) < most_steps:
            late = (
                np.random.default_rng([seed, len(rows) + 1]).random(robots) < delay if delay else np.zeros(robots, bool)
            )
            is_going = follower.is_going
            row = follower.step(np.flatnonzero(late))
            row[late & is_going & (row == WAIT)] = LATE
            rows.append(row)
        actions = np.array(rows, dtype=np.uint8).reshape(len(rows), robots)
        return self._record(actions, follower, delay, seed)

    def _record(self, actions: NDArray[np.uint8], follower: Follower, delay: float, seed: int) -> Run:
        plan, robots = self.plan, self.plan.scenario.robot_count
        arrived = plan.arrived & ~follower.is_going
        is_move = (actions != WAIT) & (actions != LATE)
        last = np.where(is_move.any(axis=0), len(actions) - np.argmax(is_move[::-1], axis=0), 0) if len(actions) else 0
        stays = np.full(robots, -1, dtype=np.int64)
        return Run(
            plan.scenario,
            plan.planner,
            None,
            delay,
            seed,
            (),
            plan.scenario.robots,
            np.zeros(robots, dtype=np.int64),
            np.where(arrived, last, stays),
            np.where(arrived, np.uint8(ARRIVED), np.uint8(GOING)),
            actions,
            np.zeros(plan.scenario.area.barriers.shape, dtype=np.int32),
            np.where(plan.arrived, stays, 0),
            np.zeros((len(actions), 2), dtype=np.int64),
        )


def make_passing_order(plan: Plan) -> PassingOrder:
    """Return the order in which robots pass each cell, lattice vertex and destination in a plan.

    Parameters
    ----------
    plan : Plan
        A safe one.

    Raises
    ------
    PlanError
        If two robots own one cell, pass one vertex, or exchange cells at a time, a robot jumps, or robots in a ring
        would turn by moves that last differently: delayed, they would wait for each other for ever.
    """
    check_type("plan", plan, Plan)
    check_as_fast(plan.scenario, "an order of passing")
    if (plan.actions == JUMP).any():
        raise PlanError("a plan in which robots jump has no order of passing")
    scenario, capacity = plan.scenario, plan.scenario.entry_limit
    if scenario.has_flows:
        raise PlanError("an order of passing tells who goes first, not when: doors must have no flow")
    first_move, begin, there, passed = _moves_of(plan)
    lasts = scenario.duration_of_direction[plan.actions[plan.actions != WAIT]].astype(np.int64)
    # Half ticks: from when to when a move passes its vertex, and its robot owns its target and then the cell it leaves.
    follows = int(scenario.following == "allow")
    middle, end = 2 * begin + follows * lasts, 2 * (begin + lasts)
    is_entry = np.isin(there, scenario.area.layout.cell_to_site(scenario.destinations))
    vertex, entry = np.full(begin.size, -1, dtype=np.int64), np.full(begin.size, -1, dtype=np.int64)
    _take_turns(np.flatnonzero(passed >= 0), passed, (2 * begin, end), 1, "pass one lattice vertex", vertex)
    if capacity:
        words = f"are more than {capacity} to enter a destination"
        _take_turns(np.flatnonzero(is_entry), there, (middle, end), capacity, words, entry)
    leaves = _leaves_before(plan, first_move, (middle, end - follows * lasts), there, is_entry)
    _check_rings(leaves, middle, lasts)
    return PassingOrder(
        plan,
        read_only(first_move),
        read_only(plan.actions[plan.actions != WAIT]),
        read_only(leaves),
        read_only(vertex),
        read_only(entry),
    )


def _moves_of(plan: Plan) -> tuple[Ints, Ints, NDArray[np.int32], NDArray[np.int32]]:
    """Return the first move of each robot, of each move its first tick, the site it leads to, the vertex passed.

    The vertex is -1 where the move passes none that others may not pass at the same time.
    """
    from trihex.kernels.actions import Actions
    from trihex.kernels.signatures import given
    from trihex.running.kernels.passing import PlanMoves, lay_out

    scenario, layout = plan.scenario, plan.scenario.area.layout
    first_move = np.concatenate([[0], np.cumsum(plan.actions != WAIT)])[plan.first_action]
    count = int(first_move[-1])
    actions = given(
        Actions,
        action=plan.actions,
        first=plan.first_action,
        offset=layout.offset_of_direction,
        jump_at=np.empty(0, dtype=np.int64),
        jump_to=np.empty(0, dtype=np.int32),
        slowness=scenario.slowness.astype(np.int32),
    )
    moves = given(
        PlanMoves,
        first=first_move,
        begin=np.empty(count, dtype=np.int64),
        there=np.empty(count, dtype=np.int32),
        passed=np.empty(count, dtype=np.int32),
    )
    start = layout.cell_to_site(scenario.robots)
    ways = layout.vertex_of_direction, scenario.first_vertex_move, plan.duration_of_action
    lay_out(start, actions, *ways, moves)
    return first_move, moves.begin, moves.there, moves.passed


def _take_turns(
    moves: Ints, place: NDArray[np.int32], times: tuple[Ints, Ints], apart: int, words: str, before: Ints
) -> None:
    """Let each of `moves` come after the one that must have gone from its place; so many may be there at a time.

    `times` tell from which half tick each is there, and before which.
    """
    since, until = times
    is_free, later, earlier = in_turn(since[moves], until[moves], place[moves], apart)
    later, earlier = moves[later], moves[earlier]
    _refuse(since[later[~is_free]], words)
    before[later] = earlier


def _refuse(half_ticks: Ints, words: str) -> None:
    """Raise PlanError if there are half ticks at which robots do what they must not."""
    if half_ticks.size:
        raise PlanError(f"the order of a plan needs a safe one; in step {half_ticks[0] // 2 + 1} robots {words}")


def _leaves_before(
    plan: Plan, first_move: Ints, times: tuple[Ints, Ints], there: NDArray[np.int32], is_entry: NDArray[np.bool_]
) -> Ints:
    """Return for each move the one that leaves the cell that it enters.

    `times` tell from which half tick a robot owns what each move enters, and before which what it leaves.
    """
    (since_of, until_of), moves, stays = times, there.size, np.arange(plan.scenario.robot_count)
    # Visits: one at each start, one by each move but those into destinations; each ends with the next move, if any.
    by = np.flatnonzero(~is_entry)
    on_exit = np.isin(plan.scenario.robots, plan.scenario.destinations)
    stays = stays[~on_exit]
    site = np.concatenate([plan.scenario.area.layout.cell_to_site(plan.scenario.robots)[stays], there[by]])
    since = np.concatenate([np.full(stays.size, -1, dtype=np.int64), since_of[by]])
    enters = np.concatenate([np.full(stays.size, -1, dtype=np.int64), by])
    robot = np.searchsorted(first_move, by, side="right") - 1
    leaves = np.concatenate([first_move[stays], by + 1])
    leaves[leaves == first_move[np.concatenate([stays, robot]) + 1]] = -1  # who has no move left stays
    until = np.where(leaves >= 0, until_of[leaves] if moves else 0, np.iinfo(np.int64).max)
    is_free, later, earlier = in_turn(since, until, site)
    _refuse(since[later[~is_free]], "share a cell")
    before = np.full(moves, -1, dtype=np.int64)
    before[enters[later]] = leaves[earlier]
    has = np.flatnonzero(before >= 0)
    _refuse(since_of[has[before[before[has]] == has]], "exchange cells")
    return before


def _check_rings(leaves: Ints, middle: Ints, lasts: Ints) -> None:
    """Raise PlanError if robots in a ring turn by moves of one middle that last differently."""
    has = np.flatnonzero(leaves >= 0)
    is_tie = has[(middle[leaves[has]] == middle[has])]
    next_of = dict(zip(is_tie.tolist(), leaves[is_tie].tolist(), strict=True))
    for move in is_tie[lasts[leaves[is_tie]] != lasts[is_tie]].tolist():
        at: int | None = next_of.get(move)
        while at is not None and at != move:
            at = next_of.pop(at, None)
        if at == move:
            raise PlanError("a plan has no order of passing in which robots in a ring make moves that last differently")
