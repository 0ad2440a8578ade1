"""Slots: the branches of a forest of shortest ways, and who is how far up them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.fields import DScheme
from trihex.planners.crowd import make_ways, regions_of

# Slots beyond the robot of a branch that is farthest at first, for those that detours bring there.
_SPARE = 40


class Slots:
    """Branches and slots of a scenario, see `trihex.planners.kernels.slots`.

    Parameters
    ----------
    d_scheme : DScheme
        Whose first best directions are the forest.
    is_literal : bool
        One region, and slots for all branches. Otherwise only those branches have slots of their own in which robots
        start; all others of a region share some.
    """

    def __init__(self, d_scheme: DScheme, is_literal: bool) -> None:
        scenario = d_scheme.n_scheme.scenario
        self.n_scheme, self.is_literal = d_scheme.n_scheme, is_literal
        self.ways = make_ways(scenario)
        self.layout, self.tessellation = scenario.area.layout, scenario.area.tessellation
        self.directions = d_scheme.directions_of_site
        region = regions_of(scenario, at_once=is_literal)
        order = np.argsort(region, kind="stable")
        self.destinations = self.layout.cell_to_site(scenario.destinations[order])
        #: Destinations by region: those of region r have the numbers from first_end[r] to first_end[r + 1].
        self.first_end = np.append(0, np.cumsum(np.bincount(region))).astype(np.int64)
        self.slot_of_site = np.zeros(self.layout.size, dtype=np.int32)
        self.slot_of_site[self.destinations] = -1 - np.arange(order.size)

    def find_regions(self, starts: NDArray[np.int32]) -> NDArray[np.int64]:
        """Lay slots for robots that start at these sites, and return their regions."""
        from trihex.planners.kernels import slots as kernels

        many = self.tessellation.direction_count
        number = np.full(self.layout.size, -1, dtype=np.int32)
        number[self.destinations] = np.arange(self.destinations.size)
        branch = np.empty(starts.size, dtype=np.int32)
        kernels.find_branches(starts, self.directions, self.ways, number, np.zeros_like(number), branch)
        own = np.arange(self.destinations.size * many) if self.is_literal else np.unique(branch)
        region_of_end = np.repeat(np.arange(self.first_end.size - 1), np.diff(self.first_end))
        first = np.append(0, np.cumsum(np.bincount(region_of_end[own // many], minlength=self.first_end.size - 1)))
        #: Branches by region, the last of each region for all that have no slots of their own.
        self.first_branch = (first + np.arange(first.size)).astype(np.int64)
        self.branch_of_end = np.repeat(self.first_branch[1:] - 1, np.diff(self.first_end) * many).astype(np.int32)
        self.branch_of_end[own] = np.arange(own.size) + region_of_end[own // many]
        depth = np.full(self.first_branch[-1], _SPARE, dtype=np.int64)
        steps = self.n_scheme.distance_of_site[starts] // int(self.tessellation.cost_of_direction.min())
        np.maximum.at(depth, self.branch_of_end[branch], steps + _SPARE)
        if self.is_literal:
            depth[:] = depth.max()
        self.first_slot = np.append(1, 1 + np.cumsum(depth))
        self.branch_of_slot = np.append(-1, np.repeat(np.arange(depth.size), depth)).astype(np.int32)
        #: Of each branch where its lines end, and the last slot that holds a robot, kept by the kernel `weigh`; of each
        #: slot how many robots are in it, and how many one finds there.
        self.lined_end = self.first_slot.copy()
        self.highest = np.zeros(self.first_slot.size, dtype=np.int64)
        room = self.first_slot[-1] + 1
        self.line, self.count = np.zeros(room, dtype=np.int32), np.zeros(room, dtype=np.int32)
        self.count += np.bincount(self.find_slots(starts), minlength=room).astype(np.int32)
        return np.asarray(region_of_end[branch // many], dtype=np.int64)

    def find_slots(self, sites: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the slots of some sites, after `find_regions`."""
        from trihex.planners.kernels import slots as kernels

        kernels.find_slots(sites, self.ways, *self.for_kernels())
        return self.slot_of_site[sites]

    def for_kernels(self) -> tuple[Any, Any]:
        """Return `Sites` and `Slots` as kernels know them, after `find_regions`."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels import slots as kernels

        sites = given(
            kernels.Sites,
            distance=self.n_scheme.distance_of_site,
            moves=self.n_scheme.scenario.moves,
            best=self.directions,
            slot=self.slot_of_site,
        )
        slots = given(
            kernels.Slots,
            branch_of_end=self.branch_of_end,
            first_slot=self.first_slot,
            branch_of_slot=self.branch_of_slot,
            count=self.count,
            line=self.line,
            highest=self.highest,
            lined_end=self.lined_end,
            first_branch_of_region=self.first_branch,
            first_end_of_region=self.first_end,
        )
        return sites, slots
