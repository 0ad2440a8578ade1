"""Claims: what robots own while they are under way, beside the cells in which they stand or which they enter.

Tick t is half tick 2t. Who leaves a cell owns it until a half tick, who passes a lattice vertex owns that until a tick,
who enters a destination has a place in it until a half tick. Where all moves last one step and robots follow at once,
nothing is owned from one step to the next but by `passed_until` and `entered_until`, which the stepper asks within one.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario

# Ticks ahead for which it is kept how many come in by a door: more than any move lasts.
DOOR_TICKS = 64


class Claims:
    """What is claimed, by site; by place of a destination for entries.

    Parameters
    ----------
    scenario : Scenario

    Attributes
    ----------
    left_until : int32 array
        For each cell the half tick until which somebody owns it who leaves it.
    passed_until : int32 array
        For each lattice vertex the tick until which somebody passes it.
    entered_until : int32 array
        For each place of each destination the half tick until which somebody enters it. A site has `limit` places.
    """

    def __init__(self, scenario: Scenario) -> None:
        layout = scenario.area.layout
        self.duration, self.is_timed = scenario.duration_of_direction, not scenario.is_stepwise
        self.follows = scenario.following == "allow"
        #: How many may enter a destination at a time, 0 for any number: no more can than there are directions.
        self.limit = scenario.entry_limit if scenario.entry_limit < self.duration.size else 0
        self._first_vertex_move, self._vertex = scenario.first_vertex_move, layout.vertex_of_direction
        self.left_until, self.passed_until = np.zeros((2, layout.size), dtype=np.int32)
        self.entered_until = np.zeros(max(1, layout.size * self.limit), dtype=np.int32)
        #: Doors as kernels know them; of each `DOOR_TICKS` counts of robots that come in, and in which ticks these are.
        self.doors = scenario.schedule.for_kernels(layout)
        self.let_in, self.let_in_at = np.zeros((2, scenario.schedule.cells.size * DOOR_TICKS), dtype=np.int32)

    def left_at(self, heading: NDArray[np.uint8], due: NDArray[np.int32]) -> NDArray[np.int64]:
        """Return the half ticks until which robots own the cells that they leave by moves that end at ticks `due`."""
        duration = self.duration[np.minimum(heading, self.duration.size - 1)]
        return np.asarray(2 * due.astype(np.int64) - duration * self.follows)

    def take(self, here: NDArray[np.int32], heading: NDArray[np.uint8], due: NDArray[np.int32]) -> None:
        """Claim the cells that robots leave, and the lattice vertices that they pass, by moves that end at `due`."""
        self.left_until[here] = self.left_at(heading, due)
        passing = heading >= self._first_vertex_move
        here, heading = here[passing], heading[passing]
        self.passed_until[here + self._vertex[here & 1, heading]] = due[passing]

    def enter(self, site: int, due: int) -> None:
        """Claim a place in a destination: the one that is free first; and note who comes in by a door."""
        if self.doors.number.size > 1 and (door := int(self.doors.number[site])):
            at = (door - 1) * DOOR_TICKS + due % DOOR_TICKS
            self.let_in[at] = self.let_in[at] * (self.let_in_at[at] == due) + 1
            self.let_in_at[at] = due
        if self.limit:
            places = self.entered_until[site * self.limit : (site + 1) * self.limit]
            places[places.argmin()] = 2 * due

    def release(self, here: int, heading: int, site: int, due: int, *, is_leaving: bool, enters: bool) -> None:
        """Take back what `take` and `enter` claimed for one robot that is under way."""
        if is_leaving:
            self.left_until[here] = 0
        if heading >= self._first_vertex_move:
            self.passed_until[here + self._vertex[here & 1, heading]] = 0
        if enters and self.limit:
            places = self.entered_until[site * self.limit : (site + 1) * self.limit]
            places[np.flatnonzero(places == 2 * due)[:1]] = 0

    def clear(self) -> None:
        """Forget all claims."""
        for claims in (self.left_until, self.passed_until, self.entered_until, self.let_in, self.let_in_at):
            claims[:] = 0
