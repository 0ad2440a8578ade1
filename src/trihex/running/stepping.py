"""Stepping: one move of each robot, down the distance or by the least Fcost, whatever changes before the next."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import LivingField
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
    fleet : Fleet
        Whose claims it keeps to.
    planner : str
        "greedy", or any other for the least Fcost.
    aside : str
        One of `ASIDE`.
    """

    def __init__(self, scenario: Scenario, field: LivingField, fleet: Fleet, planner: str, aside: str) -> None:
        from trihex.kernels.signatures import given
        from trihex.running.kernels.lines import Forest, LivingWays, WaitingLines
        from trihex.running.kernels.stepping import FCOST, GREEDY

        layout, tessellation = scenario.area.layout, scenario.area.tessellation
        self._looks_at_lines = planner != "greedy"
        claims, shortest = fleet.claims, int(scenario.duration_of_direction.min())
        self._headway = scenario.headway // shortest
        self._rules = {
            "mode": FCOST if self._looks_at_lines else GREEDY,
            "aside": ASIDE.index(aside),
            "patience": int(scenario.waiting_cost) * scenario.headway,
            "price": int(scenario.waiting_cost) * shortest,
            "headway": self._headway,
            "first_vertex_move": scenario.first_vertex_move,
            "entry_limit": claims.limit,
            "is_timed": int(claims.is_timed),
            "follows": int(claims.follows),
        }
        self._ways = given(
            LivingWays,
            distance=field.distance_of_site,
            moves=field.moves,
            offset=layout.offset_of_direction,
            vertex=layout.vertex_of_direction,
            cost=tessellation.cost_of_direction,
        )
        stamps = [np.zeros(layout.size, dtype=np.int32) for _ in range(4)]
        self._forest, self._led = Forest(1, *stamps[:3]), stamps[3]
        nothing = np.empty(0, dtype=np.int64)
        self._no_lines = WaitingLines(nothing, nothing, 0)

    def note_change(self) -> None:
        """Forget what follows from the field: it has changed."""
        self._forest = self._forest._replace(version=self._forest.version + 1)

    def forget_steps(self) -> None:
        """Forget who has led in which step: the number of the next one may be any."""
        self._led[:] = 0

    def step(
        self, order: NDArray[np.int32], lined: NDArray[np.integer], fleet: Fleet, captain: int = -1
    ) -> NDArray[np.uint8]:
        """Move the robots of `order`, who are asked in this order, and return the action of each of the fleet.

        `lined` are the robots that make up the lines; the `captain` waits where it cannot come nearer.
        """
        from trihex.running.kernels.stepping import Held, StepRules, Walkers, act

        action, claims = fleet.idle_actions(), fleet.claims
        lines = self._lines_at(fleet.site[lined]) if self._looks_at_lines else self._no_lines
        rules = StepRules(tick=fleet.tick, captain=captain, **self._rules)
        walkers = Walkers(fleet.site, fleet.came_from, action, fleet.occupied, fleet.due, fleet.heading, fleet.enters)
        doors = claims.let_in, claims.let_in_at, claims.doors
        held = Held(claims.duration, claims.left_until, claims.passed_until, claims.entered_until, *doors, self._led)
        act(order, rules, self._ways, self._forest, lines, walkers, held)
        return action

    def _lines_at(self, sites: NDArray[np.int32]) -> Any:
        """Return how long the line is in each slot in which robots stand."""
        from trihex.running.kernels.lines import WaitingLines, find_slots, line_up

        slots, slot_of_line, line = np.empty((3, sites.size), dtype=np.int64)
        find_slots(sites, self._ways, self._forest, slots)
        slots.sort()
        return WaitingLines(slot_of_line, line, line_up(slots, self._headway, slot_of_line, line))
