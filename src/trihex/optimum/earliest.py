"""Earliest arrivals: the flow of least cost where every step costs the same, from a plan at hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.memory import limit_or_default
from trihex.optimum.flow import Flow, check_memory
from trihex.optimum.network import Network
from trihex.plans import Plan

# Bytes for each node of a layer: a word, and its flow in the end.
_BYTES_PER_NODE = 5
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the log of a search at first.
_LOG = 1 << 12


def make_earliest_flow(
    network: Network,
    cells: NDArray[np.int64],
    robots: NDArray[np.int64],
    plan: Plan,
    *,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Flow:
    """Find paths of least total cost for robots that start in `cells`, nodes of a network of equal steps.

    Parameters
    ----------
    network : Network
    cells, robots : ndarray of int64
        Node where each robot starts, and its number in the plan.
    plan : Plan
        Any in which all of them arrive; the nearer to the optimum, the less is left to do.
    progress : callable, optional
        Called with (robots that arrive in the least step they can, robots).
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    TooLargeError
        If the layers would take more than `memory_limit`.
    """
    from trihex.optimum.kernels import earliest as kernels
    from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, LIST_FULL

    size = network.node_count
    layers = int(plan.arrival_step_of_robot[robots].max(initial=0)) + 1
    limit = limit_or_default(memory_limit)
    check_memory(network, cells, layers, layers * size * _BYTES_PER_NODE, limit)
    words = np.zeros(layers * size, dtype=np.uint32)
    start = network.hops[cells].astype(np.int64) * size + cells
    layout = network.scenario.area.layout
    shape = network.cell_count, network.first_destination
    assert kernels.lay_plan(
        *(start, plan.first_action[robots], plan.actions),
        *(network.site_of_node, network.node_of_site, layout.offset_of_direction, network.out_arcs, *shape, words),
    ), "the network has all moves of the plan"
    kernels.bury_starts(network.hops, network.is_vertex, words)
    log = np.empty((_LOG, 6), dtype=np.uint32)
    heads = np.empty(kernels.DEAD, dtype=np.int64)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.GOAL] = size
    status = BUDGET_SPENT
    while status != DONE:
        if status == LIST_FULL:
            check_memory(network, cells, layers, layers * size * _BYTES_PER_NODE + 3 * log.nbytes, limit)
            log = np.concatenate([log, np.empty_like(log)])
        status = kernels.fill_slots(
            *(network.out_arcs, network.in_arcs, network.first_destination, network.room),
            *(cells.size, words, log, heads, state, _BUDGET),
        )
        if progress:
            progress(int(state[kernels.SERVED]), cells.size)
    return Flow(network, start, words.astype(np.uint8), int(state[kernels.TOTAL]) * network.unit)
