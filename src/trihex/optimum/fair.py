"""Fair prices: tolls that prove a flow to be of least cost, whatever its steps cost."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError
from trihex.memory import limit_or_default
from trihex.optimum.earliest import lay_words, make_slot_graph
from trihex.optimum.network import Network
from trihex.optimum.workspace import check_memory, start_nodes
from trihex.plans import Plan

# Bytes for each node of a layer: a word, two prices, and whether they are queued.
_BYTES_PER_NODE = 14
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the queues at first.
_LIST = 1 << 16


class FairPricing:
    """Looks for fair prices of the flow that a plan is.

    Parameters
    ----------
    network : Network
    plan : Plan
    robots : ndarray of int64
        Those who have to go; all of them arrive.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    PlanError
        If robots share a place.
    TooLargeError
        If it takes more memory than that.
    """

    def __init__(self, network: Network, plan: Plan, robots: NDArray[np.int64], memory_limit: int | None) -> None:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import fair as kernels
        from trihex.optimum.kernels.words import FLOW

        self.network, self.plan, self.limit = network, plan, limit_or_default(memory_limit)
        sites = plan.scenario.area.layout.cell_to_site(plan.scenario.robots[robots])
        self.cells = network.node_of_site[sites].astype(np.int64)
        self.layers = int(plan.arrival_step_of_robot[robots].max(initial=0)) + 1
        self._check_memory(0)
        self.start, self.graph = start_nodes(network, self.cells), make_slot_graph(network)
        words = lay_words(network, self.graph, plan, self.start, robots, self.layers)
        words &= np.uint32(FLOW)
        self._check_flow(words.reshape(self.layers, -1))
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        self.fair = given(
            kernels.FairPrices,
            capacity=plan.scenario.entry_limit,
            words=words,
            price=np.zeros(2 * words.size, dtype=np.int32),
            is_queued=np.zeros(2 * words.size, dtype=bool),
            queue=np.empty((2, max(_LIST, 8 * self.layers)), dtype=np.int64),
            state=state,
        )

    def make(self, progress: Callable[[int, int], None] | None) -> bool:
        """Look for fair prices; return whether there are any."""
        from trihex.optimum.kernels import fair as kernels
        from trihex.optimum.kernels.residual import DONE, EXHAUSTED, LIST_FULL

        robot = 0
        while robot < self.start.size:
            robot = kernels.price_paths(self.start, robot, self.graph, self.fair)
            if robot < self.start.size:
                self._lengthen()
        status = None
        while status not in (DONE, EXHAUSTED):
            status = kernels.make_fair(self.graph, self.fair, _BUDGET)
            if status == LIST_FULL:
                self._lengthen()
            if progress:
                progress(int(self.fair.state[kernels.NEXT]), int(self.fair.state.max()))
        return bool(status == DONE)

    def tolls(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return node, step in which it is passed, and toll, of all that have one."""
        from trihex.optimum.kernels.fair import ENTERING, LEAVING

        network, first = self.network, self.network.first_destination
        at = np.flatnonzero(self.fair.words)
        node = at % network.node_count
        price = self.fair.price.reshape(-1, 2)[at].astype(np.int64)
        toll = price[:, ENTERING] - np.where(node < first, price[:, LEAVING], 0)
        # Nobody can be in step 0 where somebody starts, but for himself.
        step = at // network.node_count - network.hops[node] + network.is_vertex[node]
        has_toll = (toll > 0) & (step > 0)
        return node[has_toll], step[has_toll], toll[has_toll] * network.unit

    def proven(self, toll: NDArray[np.int64], places: NDArray[np.int64]) -> int:
        """Return what no plan can be below if that many robots may pay each toll."""
        from trihex.optimum.kernels.fair import LEAVING

        price = self.fair.price.reshape(-1, 2)[self.start, LEAVING].astype(np.int64)
        pays = int((price + self.network.value[self.cells]).sum()) * self.network.unit
        return pays - int((toll * places).sum())

    def _lengthen(self) -> None:
        queue: Any = self.fair.queue
        self._check_memory(3 * queue.nbytes)
        self.fair = self.fair._replace(queue=np.concatenate([queue, np.empty_like(queue)], axis=1))

    def _check_memory(self, list_bytes: int) -> None:
        need = self.layers * self.network.node_count * _BYTES_PER_NODE + list_bytes
        check_memory(self.network, self.cells, self.layers, need, self.limit)

    def _check_flow(self, flow: NDArray[np.uint32]) -> None:
        """Raise PlanError where robots share a cell, a vertex or a slot."""
        network, plan, first = self.network, self.plan, self.network.first_destination
        limit, moves = plan.scenario.entry_limit, plan.scenario.first_vertex_move
        directions = plan.scenario.area.tessellation.direction_count
        passed = np.count_nonzero((plan.actions >= moves) & (plan.actions < directions)) if network.vertex_count else 0
        shared = np.count_nonzero(flow[:, :first]) != plan.actions.size + passed
        if shared or (limit and flow[:, first:].max(initial=0) > limit):
            raise PlanError("a certificate needs a plan without conflicts; audit_plan tells which it has")
