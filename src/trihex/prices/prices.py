"""Prices: what opening each wall saves and closing each choke costs, and the best next door."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import seconds_per_step
from trihex.errors import PlanError, check_choice, check_type
from trihex.plans import Plan
from trihex.record import Record, counted, read_only

#: What a cell is priced as.
KINDS = ("barrier", "choke", "door")


@dataclass(frozen=True, eq=False)
class Prices(Record):
    """What each wall and each door costs all robots together, a row for each.

    A *barrier*: the time saved if that cell alone were open. A *choke*, a free cell: the time lost if that cell alone
    were closed. A *door*: the time saved if that barrier were a destination as well; there is one row at most, that
    of the barrier which saves most, or might.

    Parameters
    ----------
    plan : Plan
        The plan that is the best as it is.
    kind : ndarray of str, shape (rows,)
    cell : ndarray of int64
    price : ndarray of int64
        In units of time, as t_r. Where it is not proven: at least so much. 0 where other robots can arrive than now.
    most : ndarray of int64
        What the price is at most, the price itself where that is proven, -1 where nothing is known. Of a door: what any
        other door saves at most.
    robots : ndarray of int64
        How many robots more can arrive; below 0: how many less. Then there is no price, as the sums of time are those
        of different robots. A cell in which a robot starts cuts off that one at least.
    proven : ndarray of bool
        Whether the price is exact; of a door also that there is no better one.
    """

    plan: Plan
    kind: NDArray[np.str_]
    cell: NDArray[np.int64]
    price: NDArray[np.int64]
    most: NDArray[np.int64]
    robots: NDArray[np.int64]
    proven: NDArray[np.bool_]

    def __post_init__(self) -> None:
        check_type("plan", self.plan, Plan)
        self._set("kind", read_only(np.asarray(self.kind, dtype="<U7")))
        for name in ("cell", "price", "most", "robots"):
            self._set(name, read_only(np.asarray(getattr(self, name), dtype=np.int64)))
        self._set("proven", read_only(np.asarray(self.proven, dtype=np.bool_)))

    @property
    def is_complete(self) -> bool:
        """Whether all is proven."""
        return bool(self.proven.all())

    @property
    def has_equal_steps(self) -> bool:
        """Whether every step costs the same, so that times are multiples of steps."""
        scenario = self.plan.scenario
        costs = scenario.area.tessellation.cost_of_direction
        return bool(scenario.is_stepwise and (costs == scenario.waiting_cost).all())

    @property
    def best_door(self) -> tuple[int, int] | None:
        """The cell (x, y) that saves most as a destination; None if none saves anything, or it is not asked for."""
        rows = np.flatnonzero((self.kind == "door") & (self.price > 0))
        if not rows.size:
            return None
        x, y = self.plan.scenario.area.cell_to_xy(self.cell[rows[0]])
        return int(x), int(y)

    def price_of_cell(self, kind: str) -> NDArray[np.int64]:
        """Return the prices of a kind as an array [y, x], -1 where there is none."""
        check_choice("kind", kind, KINDS, PlanError)
        area = self.plan.scenario.area
        prices = np.full(area.cell_count, -1, dtype=np.int64)
        rows = (self.kind == kind) & (self.robots == 0)
        prices[self.cell[rows]] = self.price[rows]
        return read_only(prices.reshape(area.height, area.width))

    def seconds_per_unit(self, speed: float = 1.0) -> float | None:
        """Return how many seconds a unit of time is in an area with a frame; None in others, or if steps differ."""
        scenario = self.plan.scenario
        if scenario.area.frame is None or not self.has_equal_steps:
            return None
        return seconds_per_step(scenario.area, speed) / scenario.waiting_cost

    def told(self, price: int, speed: float = 1.0) -> str:
        """Return a price in words: "3 min 20 s" where units of time are seconds, else how many units."""
        factor = self.seconds_per_unit(speed)
        if factor is None:
            return f"{price} units of time"
        if price * factor < 60:
            return f"{price * factor:.3g} s"
        minutes, seconds = divmod(round(price * factor), 60)
        hours, minutes = divmod(minutes, 60)
        return f"{hours} h {minutes} min" if hours else f"{minutes} min {seconds} s"

    def rows(self, speed: float = 1.0) -> list[dict[str, Any]]:
        """Return a row of plain values for each price; seconds only where there are any."""
        x, y = self.plan.scenario.area.cell_to_xy(self.cell)
        factor = self.seconds_per_unit(speed)
        rows = []
        for i, kind in enumerate(self.kind.tolist()):
            is_priced = self.robots[i] == 0
            row = {"x": int(x[i]), "y": int(y[i]), "kind": kind, "price": int(self.price[i]) if is_priced else None}
            if factor is not None:
                row["seconds"] = round(int(self.price[i]) * factor, 6) if is_priced else None
            most = int(self.most[i]) if is_priced and self.most[i] >= 0 else None
            rows.append(row | {"robots": int(self.robots[i]), "proven": bool(self.proven[i]), "most": most})
        return rows

    def in_words(self) -> str:
        """Return how many prices there are, and how many are proven."""
        open_rows = int((~self.proven).sum())
        proven = "all proven" if not open_rows else f"{open_rows} not proven"
        return f"{counted(self.cell.size, 'price')}, {proven}, for {self.plan.in_words()}"
