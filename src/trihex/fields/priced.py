"""Priced: distances to some destinations alone, each of which has a price beside the way there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields.fresh import make_directions
from trihex.fields.settling import needs_moves, settle
from trihex.fields.wave import renew_directions
from trihex.kernels.codes import NOT_REACHED


class PricedField:
    """Makes distances to destinations that have prices, one field after the other on the same area.

    No way leads through a destination: whoever enters one has arrived.

    Parameters
    ----------
    scenario : Scenario
    is_reached : bool array, shape (layout.size,)
        Where somebody who can arrive at a destination can stand.
    """

    def __init__(self, scenario: Scenario, is_reached: NDArray[np.bool_]) -> None:
        self.scenario = scenario
        layout, cost = scenario.area.layout, scenario.area.tessellation.cost_of_direction
        self.goals = layout.cell_to_site(scenario.destinations)
        self._blank = np.where(is_reached, np.int32(NOT_REACHED), np.int32(-1))
        self._blank[self.goals] = -1
        self._distance = np.empty_like(self._blank)  # one for all fields: pages that are new take longest
        self._moves = scenario.moves if needs_moves(scenario.area.tessellation, scenario.corners) else None
        #: Of each destination and direction the site from where a move leads in, and what that costs.
        k = np.arange(cost.size)
        self._site = self.goals[:, None] + layout.offset_of_direction[(self.goals & 1)[:, None], k]
        is_open = (scenario.moves[self.goals][:, None] >> k & 1).astype(bool) & (self._blank[self._site] >= 0)
        self._cost = np.where(is_open, cost, NOT_REACHED).astype(np.int64)

    def entries(self, group: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return from how many sites moves lead into the destinations of each group."""
        row, column = np.nonzero(self._cost < NOT_REACHED)
        pairs = np.unique(np.stack([group[row], self._site[row, column]]), axis=1)
        return np.bincount(pairs[0], minlength=int(group.max()) + 1)

    def spread(
        self, chosen: NDArray[np.int64], prices: NDArray[np.int64], horizon: int = NOT_REACHED
    ) -> tuple[NDArray[np.int32], int]:
        """Return the distance of each site to the chosen destinations, prices added, and how far they are known.

        They are below 0 at destinations and where nobody can go, and are overwritten by the next field.

        Parameters
        ----------
        chosen : ndarray of int64
            Numbers of destinations.
        prices : ndarray of int64
            What each of them costs beside the way.
        horizon : int
            How far distances are asked for.
        """
        value = self._cost[chosen] + prices[:, None]
        site, value = self._site[chosen][self._cost[chosen] < NOT_REACHED], value[self._cost[chosen] < NOT_REACHED]
        distance = self._distance
        np.copyto(distance, self._blank)
        np.minimum.at(distance, site, value.astype(np.int32))
        site = np.unique(site).astype(np.int32)
        known = settle(
            distance, self.scenario.area.layout, self._moves, site, distance[site], lambda end: end > horizon
        )
        return distance, known

    def directions(self, prices: NDArray[np.int64]) -> tuple[NDArray[np.int32], NDArray[np.uint16]]:
        """Return distances to all destinations at their prices, and the best directions of each site.

        Distances are the prices at destinations, and `NOT_REACHED` where nobody can go.
        """
        from trihex.fields.kernels import front as kernels

        distance, _ = self.spread(np.arange(self.goals.size), prices)
        distance = distance.copy()
        kernels.finish(distance, NOT_REACHED)
        distance[self.goals] = prices
        moves = None if self.scenario.corners == "allow" else self.scenario.moves
        directions = make_directions(distance, self.scenario.area.layout, moves)
        # Prices of neighbours may differ by more than a move, which directions take for granted.
        renew_directions(self.scenario, self.goals, self.scenario.moves, distance, directions)
        directions[self.goals] = 0
        return distance, directions
