"""Catchments: which cells lead to which exit, so that nobody waits at one while another is free."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import DScheme, PricedField
from trihex.kernels.codes import NOT_REACHED
from trihex.planners.crowd import Crowd, make_ways
from trihex.planners.lanes import Lanes, make_lanes, price_of_waiting
from trihex.record import read_only

# Destinations no more than so many columns and rows apart are one exit: robots choose between them on the spot.
_NEAR = 3
# Prices change by so many edge steps, one after the other; so often in each.
_STEPS, _ROUNDS = (8, 4, 2, 1), 10
# An exit lets a robot pass at least every so many steps.
_SLOWEST = 16
# So many robots are asked at most: of larger crowds every second one, or every third, ..., each for all of them.
_MOST_ASKED = 10_000
# After so many robots in turn that get no lane nobody behind them in the catchment is tried.
_PATIENCE = 20


def exits_of(scenario: Scenario) -> NDArray[np.int64]:
    """Return the exit, from 0 without gaps, to which each destination belongs: those that are near each other."""
    y, x = scenario.destinations // scenario.area.width, scenario.destinations % scenario.area.width
    is_near = np.maximum(np.abs(x[:, None] - x), np.abs(y[:, None] - y)) <= _NEAR
    exit, before = np.arange(x.size), np.empty(0, dtype=np.int64)
    while not np.array_equal(exit, before):
        before, exit = exit, np.where(is_near, exit, x.size).min(axis=1)
    return np.unique(exit, return_inverse=True)[1].reshape(-1).astype(np.int64)


class Catchments:
    """Which cells lead to which exit.

    By distance alone robots wait at one exit while another is free. So each exit gets a *price*, and robots go where
    price and distance together are least. An exit is taken to let one robot pass after the other, so often that those
    of its catchment would have arrived when they did in a plan; prices are changed, exit by exit, as long as robots
    would arrive sooner by that, all together. Of a large crowd every second one, or every third, ..., is asked for all:
    an exit then lets one of those pass every so often, as many times less often.

    Parameters
    ----------
    d_scheme : DScheme
    crowd : Crowd
        Of a plan by it, in which all have arrived.
    """

    def __init__(self, d_scheme: DScheme, crowd: Crowd) -> None:
        self.n_scheme, scenario = d_scheme.n_scheme, d_scheme.n_scheme.scenario
        n_scheme = self.n_scheme
        self.exit = exits_of(scenario)
        self._field = PricedField(scenario, n_scheme.distance_of_site != NOT_REACHED)
        self._starts = scenario.area.layout.cell_to_site(scenario.robots[crowd.robot[1:]])
        self._each = -(-self._starts.size // _MOST_ASKED)  # for how many robots one is asked
        self._asked = self._starts[:: self._each].copy()
        self._edge = int(scenario.area.tessellation.cost_of_direction[0])
        cost = scenario.area.tessellation.cost_of_direction
        #: What a step costs a robot that goes on.
        self._step = int(cost.min() + cost.max()) // 2
        arrival = crowd.arrival[1:]
        wait = (arrival * self._step - n_scheme.distance_of_site[self._starts]).max()
        own = self._catchment_of_site(self._asked, d_scheme.directions_of_site)[self._asked]
        self._offers = self._make_offers(own, max(int(wait), self._edge))
        self._shares = self._make_shares(arrival[:: self._each])

    def _catchment_of_site(self, sites: NDArray[np.int32], directions: NDArray[np.uint16]) -> NDArray[np.int32]:
        """Return the exit to which first best directions lead from some sites; what is on no way is -1."""
        from trihex.planners.kernels.catchments import fill_catchments

        catchment = np.full(directions.size, -1, dtype=np.int32)
        catchment[self._field.goals] = self.exit
        fill_catchments(sites, directions, make_ways(self.n_scheme.scenario), catchment)
        return catchment

    def _make_offers(self, own: NDArray[np.int32], slack: int) -> Any:
        """Return the exits that are at most so much farther than the nearest one, as kernels know them.

        Nobody is offered an exit that is farther than that from all robots of its `own`.
        """
        from trihex.kernels.signatures import given
        from trihex.planners.kernels.catchments import Offers

        near, found = self.n_scheme.distance_of_site[self._asked], []
        for exit in range(self.exit.max() + 1):
            chosen = np.flatnonzero(self.exit == exit)
            horizon = int(near[own == exit].max(initial=0)) + slack
            distance, known = self._field.spread(chosen, np.zeros(chosen.size, dtype=np.int64), horizon)
            far = distance[self._asked]
            robots = np.flatnonzero((far < known) & (far <= near + slack))
            found.append((robots, np.full(robots.size, exit), far[robots]))
        robot, of_exit, distance = map(np.concatenate, zip(*found, strict=True))
        order = np.argsort(robot, kind="stable")
        robot, of_exit, distance = robot[order], of_exit[order], distance[order]
        first = np.searchsorted(robot, np.arange(self._asked.size + 1)).astype(np.int64)
        several = np.flatnonzero(np.diff(first)[robot] > 1)  # who has one offer only takes it at any price
        count = np.bincount(of_exit[several], minlength=self.exit.max() + 1)
        return given(
            Offers,
            first=first,
            exit=of_exit.astype(np.int32),
            distance=distance.astype(np.int64),
            steps=np.maximum(1, (distance + self._step // 2) // self._step).astype(np.int32),
            robot=robot.astype(np.int32),
            first_of_exit=np.append(0, np.cumsum(count)).astype(np.int64),
            of_exit=several[np.argsort(of_exit[several], kind="stable")].astype(np.int64),
        )

    def _make_shares(self, arrival: NDArray[np.int64]) -> Any:
        """Return who goes where without prices, and how often each exit lets somebody pass, as kernels know it."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels import catchments as kernels

        offers, count = self._offers, int(self.exit.max()) + 1
        nearest = np.lexsort((offers.exit, offers.distance, offers.robot))[offers.first[:-1]]
        shares = given(
            kernels.Shares,
            price=np.zeros(count, dtype=np.int64),
            gap=np.zeros(count, dtype=np.int64),
            time=np.zeros(count, dtype=np.int64),
            chosen=nearest.astype(np.int64),
            count=np.zeros((count, int(offers.steps.max()) + 1), dtype=np.int32),
            moved=np.empty(self._asked.size, dtype=np.int64),
            touched=np.empty(count, dtype=np.int64),
            is_touched=np.zeros(count, dtype=np.int32),
            waiting_cost=price_of_waiting(self.n_scheme.scenario),
        )
        np.add.at(shares.count, (offers.exit[nearest], offers.steps[nearest]), 1)
        wanted = np.zeros(count, dtype=np.int64)
        np.add.at(wanted, offers.exit[nearest], kernels.PARTS * arrival)
        least = self._each * kernels.PARTS // np.maximum(1, self._field.entries(self.exit))
        kernels.find_gaps(wanted, least, self._each * _SLOWEST * kernels.PARTS, shares)
        return shares

    def find_prices(self) -> NDArray[np.int64]:
        """Return the price of each destination, 0 where it is least."""
        from trihex.planners.kernels import catchments as kernels

        for step in _STEPS:
            for _ in range(_ROUNDS):
                if not kernels.change_prices(step * self._edge, self._offers, self._shares):
                    break
        price = self._shares.price - self._shares.price.min()
        return np.asarray(price[self.exit])

    def make_lanes(self, most_visits: int) -> tuple[Lanes, int]:
        """Return lanes, each within a catchment, and what robots are told to pay for exits beside their ways."""
        price = self.find_prices()
        distance, directions = self._field.directions(price)
        catchment = self._catchment_of_site(np.flatnonzero(directions).astype(np.int32), directions)
        priced = replace(self.n_scheme, distance_of_site=read_only(distance))
        lanes = make_lanes(priced, most_visits=most_visits, catchment_of_site=catchment, patience=_PATIENCE)
        paid = np.zeros(int(self.exit.max()) + 1, dtype=np.int64)
        paid[self.exit] = price
        return lanes, int(paid[catchment[self._starts]].sum())
