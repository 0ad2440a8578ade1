"""Open graph: the cells of an area in each step as if nothing were barrier, where every step costs the same."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario


class OpenGraph:
    """Arcs from each step to the next; node i in step s has the index ``s * node_count + i``.

    Nodes are the cells, barriers among them, then the destinations, and last a door, into which no arc leads until
    `set_door` says from where. The tables of arcs are as in `trihex.optimum.network`, but without costs; the last arc
    of a cell, beyond those of most neighbours, is that to the door.

    Parameters
    ----------
    scenario : Scenario
        Where all steps cost the same.
    nearness : ndarray of int64
        Of each cell to a destination, to look at arcs in a good order.
    """

    def __init__(self, scenario: Scenario, nearness: NDArray[np.int64]) -> None:
        area, count = scenario.area, scenario.area.cell_count
        self.scenario = scenario
        is_goal = np.zeros(count, dtype=bool)
        is_goal[scenario.destinations] = True
        self.cell_of_node = np.concatenate([np.flatnonzero(~is_goal), np.flatnonzero(is_goal)])
        self.node_of_cell = np.empty(count, dtype=np.int64)
        self.node_of_cell[self.cell_of_node] = np.arange(count)
        self.node_count, self.door = count + 1, count
        self.first_goal = count - scenario.destinations.size
        self.is_barrier = np.append(area.barriers.reshape(-1)[self.cell_of_node], True)
        self._most = area.tessellation.direction_count + 1
        self.out, self.into = self._tables(nearness)
        arcs = np.count_nonzero(self.into[self.first_goal :, :, 0], axis=1)
        self.room = np.minimum(arcs, scenario.entry_limit or arcs).astype(np.int64)

    def _tables(self, nearness: NDArray[np.int64]) -> NDArray[np.int32]:
        from trihex.optimum.kernels.residual import OFFSET, OTHER, PLACE

        tail_cell, head_cell = _moves(self.scenario.area)
        tail, head = self.node_of_cell[tail_cell], self.node_of_cell[head_cell]
        leaves, gain = tail < self.first_goal, nearness[head_cell] - nearness[tail_cell]
        tail, head, gain = tail[leaves], head[leaves], gain[leaves]
        place_out, place_in = _places(tail, -gain), _places(head, -gain)
        out, into = tables = np.zeros((2, self.node_count, self._most + 2, 6), dtype=np.int32)
        for table, one, other, place, back in (
            (out, tail, head, place_out, place_in),
            (into, head, tail, place_in, place_out),
        ):
            sign = 1 if table is out else -1
            table[one, place, OFFSET] = sign * self.node_count + other - one
            table[one, place, PLACE], table[one, place, OTHER] = back, other
        node = np.arange(self.first_goal)
        out[node, self._most, OFFSET] = self.node_count + self.door - node
        out[node, self._most, OTHER] = self.door
        return tables

    def set_door(self, node: int | None) -> None:
        """Let a barrier be the door as well, so that its neighbours have ways into it; None: no node."""
        from trihex.optimum.kernels.residual import OFFSET, OTHER, PLACE

        self.into[self.door], self.room[-1] = 0, 0
        if node is None:
            return
        others = self.into[node, :, OTHER][self.into[node, :, OFFSET] != 0]
        others = others[~self.is_barrier[others]]
        arcs = self.into[self.door, : others.size]
        arcs[:, OFFSET], arcs[:, PLACE] = others - self.door - self.node_count, self._most
        arcs[:, OTHER] = others
        self.room[-1] = min(others.size, self.scenario.entry_limit or others.size)

    @cached_property
    def for_kernels(self) -> Any:
        """The same for kernels."""
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels.slots import SlotGraph

        first = self.first_goal
        return given(SlotGraph, out=self.out, into=self.into, cell_count=first, first_goal=first, room=self.room)


def _moves(area: Area) -> NDArray[np.int64]:
    """Return tail and head of all moves between cells, barriers or not, and of waiting."""
    bare = Scenario(Area(area.tessellation, np.zeros(area.barriers.shape, dtype=bool)), np.array([0]))
    layout, cells = bare.area.layout, np.arange(area.cell_count)
    sites = layout.cell_to_site(cells).astype(np.int64)
    pairs = [np.stack([cells, cells])]
    for k in range(area.tessellation.direction_count):
        own = sites[(bare.moves[sites] >> k & 1).astype(bool)]
        pairs.append(
            np.stack([layout.site_to_cell(own), layout.site_to_cell(own + layout.offset_of_direction[own & 1, k])])
        )
    return np.concatenate(pairs, axis=1).astype(np.int64)


def _places(node: NDArray[np.int64], order: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the place of each arc among those of its node, in ascending order of `order`."""
    by_node = np.lexsort((order, node))
    counts = np.bincount(node)
    place = np.empty_like(node)
    place[by_node] = np.arange(node.size) - np.repeat(np.cumsum(counts) - counts, counts)
    return place
