"""Stepping: one move of each robot, down the distance or by the least Fcost, whatever changes before the next."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import LivingField
from trihex.kernels.codes import WAIT
from trihex.running.fleet import Fleet

STEPPERS = ("greedy", "fcost")
ASIDE = ("never", "worth", "always")


class Stepper:
    """What decides the moves of a fleet step by step, and what it keeps from one step to the next.

    Parameters
    ----------
    scenario : Scenario
        For its rules.
    field : LivingField
        Of the world as known.
    planner : str
        "greedy", or any other for the least Fcost.
    aside : str
        One of `ASIDE`.
    """

    def __init__(self, scenario: Scenario, field: LivingField, planner: str, aside: str) -> None:
        from trihex.kernels.signatures import given
        from trihex.running.kernels.lines import Forest, LivingWays, WaitingLines
        from trihex.running.kernels.stepping import FCOST, GREEDY, StepTraffic

        layout, tessellation = scenario.area.layout, scenario.area.tessellation
        self._looks_at_lines = planner != "greedy"
        self._rules = {
            "mode": FCOST if self._looks_at_lines else GREEDY,
            "aside": ASIDE.index(aside),
            "waiting_cost": int(scenario.waiting_cost),
            "first_vertex_move": scenario.first_vertex_move,
            "entry_limit": scenario.entry_limit,
        }
        self._ways = given(
            LivingWays,
            distance=field.distance_of_site,
            moves=field.moves,
            offset=layout.offset_of_direction,
            vertex=layout.vertex_of_direction,
            cost=tessellation.cost_of_direction,
        )
        stamps = [np.zeros(layout.size, dtype=np.int32) for _ in range(6)]
        self._forest, self._traffic = Forest(1, *stamps[:3]), StepTraffic(*stamps[3:])
        nothing = np.empty(0, dtype=np.int64)
        self._no_lines = WaitingLines(nothing, nothing, 0)

    def note_change(self) -> None:
        """Forget what follows from the field: it has changed."""
        self._forest = self._forest._replace(version=self._forest.version + 1)

    def forget_steps(self) -> None:
        """Forget what has happened in which step: the number of the next one may be any."""
        self._traffic.passed[:] = 0
        self._traffic.entered_step[:] = 0

    def step(self, number: int, order: NDArray[np.int32], fleet: Fleet) -> NDArray[np.uint8]:
        """Move the robots of `order`, who are asked in this order, and return the action of each of the fleet."""
        from trihex.running.kernels.stepping import StepRules, Walkers, act

        action = np.full(fleet.size, WAIT, dtype=np.uint8)
        lines = self._lines_at(fleet.site[order]) if self._looks_at_lines else self._no_lines
        walkers = Walkers(fleet.site, fleet.came_from, action, fleet.occupied)
        act(order, StepRules(step=number, **self._rules), self._ways, self._forest, lines, walkers, self._traffic)
        return action

    def _lines_at(self, sites: NDArray[np.int32]) -> Any:
        """Return how long the line is in each slot in which robots stand."""
        from trihex.running.kernels.lines import WaitingLines, find_slots, line_up

        slots, slot_of_line, line = np.empty((3, sites.size), dtype=np.int64)
        find_slots(sites, self._ways, self._forest, slots)
        slots.sort()
        return WaitingLines(slot_of_line, line, line_up(slots, slot_of_line, line))
