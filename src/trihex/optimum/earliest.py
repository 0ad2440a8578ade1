"""Earliest arrivals: the flow of least cost where every step costs the same, from a plan at hand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError
from trihex.memory import limit_or_default
from trihex.optimum.doors import find_shut_nodes
from trihex.optimum.flow import Flow
from trihex.optimum.network import Network
from trihex.optimum.workspace import check_memory, held_nodes, start_nodes
from trihex.plans import Plan

# Bytes for each node of a layer: a word, and its flow in the end.
_BYTES_PER_NODE = 5
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the log of a search at first.
_LOG = 1 << 12
# Labels are found anew when searches have seen so many nodes, and so many times those that got a label last time.
_PATIENCE, _SHARE = 1 << 20, 1
# They are found for so many steps beyond that of the slot under way.
_AHEAD = 4


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
    PlanError
        If the plan takes a move that the network has not.
    """
    from trihex.optimum.kernels.earliest import fill_slots
    from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, LABELS_OLD, LIST_FULL
    from trihex.optimum.kernels.slots import SERVED, TOTAL
    from trihex.optimum.kernels.words import DEAD, LABEL

    size = network.node_count
    layers = int(plan.arrival_step_of_robot[robots].max(initial=0)) + 1
    limit = limit_or_default(memory_limit)

    def take(more: int) -> None:
        check_memory(network, cells, layers, layers * size * _BYTES_PER_NODE + more, limit)

    take(0)
    graph = make_slot_graph(network)
    start = start_nodes(network, cells)
    words = lay_words(network, graph, plan, start, robots, layers)
    words[held_nodes(network, cells)] = DEAD * LABEL
    shut = find_shut_nodes(network, network.room, 0, layers)
    words[shut.gates] = DEAD * LABEL
    words[shut.slots] += shut.missing.astype(np.uint32)
    search = _make_search(network, words)
    status = BUDGET_SPENT
    while status != DONE:
        if status == LIST_FULL:
            take(3 * search.log.nbytes)
            search = search._replace(log=_longer(search.log))
        elif status == LABELS_OLD:
            _find_labels(graph, search, take)
        status = fill_slots(graph, search, cells.size, _BUDGET)
        if progress:
            progress(int(search.state[SERVED]), cells.size)
    steps = int(search.state[TOTAL]) - int(network.start_time[cells].sum())
    return Flow(network, start, search.words.astype(np.uint8), steps * network.unit)


def make_slot_graph(network: Network) -> Any:
    """Return the arcs of the network, for kernels."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels.slots import SlotGraph

    return given(
        SlotGraph,
        out=network.out_arcs,
        into=network.in_arcs,
        cell_count=network.cell_count,
        first_goal=network.first_destination,
        room=network.room,
    )


def lay_words(
    network: Network, graph: Any, plan: Plan, start: NDArray[np.int64], robots: NDArray[np.int64], layers: int
) -> NDArray[np.uint32]:
    """Return the words of all nodes as the plan leaves them."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import laid as kernels

    words = np.zeros(layers * network.node_count, dtype=np.uint32)
    laid = given(
        kernels.LaidPlan,
        start=start,
        first_action=plan.first_action[robots] + plan.scenario.start_times[robots],
        action=plan.actions,
        site_of_node=network.site_of_node,
        node_of_site=network.node_of_site,
        offset=network.scenario.area.layout.offset_of_direction,
    )
    if not kernels.lay_plan(laid, graph, words):
        raise PlanError("plan takes a move that is not open, or goes where no destination can be reached")
    kernels.bury_starts(network.hops, network.is_vertex, words)
    return words


def _make_search(network: Network, words: NDArray[np.uint32]) -> Any:
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import slots as kernels
    from trihex.optimum.kernels.words import DEAD

    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.GOAL], state[kernels.LAST] = network.node_count, words.size // network.node_count - 1
    state[kernels.PATIENCE] = _PATIENCE
    return given(
        kernels.SlotSearch,
        words=words,
        log=np.empty((_LOG, kernels.LOG_COLUMNS), dtype=np.uint32),
        heads=np.empty(DEAD, dtype=np.int64),
        state=state,
        most=np.empty(0, dtype=np.int64),
    )


def _find_labels(graph: Any, search: Any, take: Callable[[int], None]) -> None:
    """Find all labels anew, and let searches see about as many nodes before it is done again."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import slots, turns as kernels
    from trihex.optimum.kernels.residual import DONE, LIST_FULL

    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.ROWS] = min(search.state[slots.STEP] + _AHEAD, search.state[slots.LAST]) + 1
    room = 2 * graph.out.shape[0] * graph.out.shape[1]
    stack, queue = np.empty(room, dtype=np.int64), np.empty(room, dtype=np.int64)
    status = None
    while status != DONE:
        turning = given(kernels.Turning, words=search.words, stack=stack, queue=queue, state=state)
        status = kernels.find_turns(graph, turning, _BUDGET)
        if status == LIST_FULL:
            take(search.log.nbytes + 3 * (stack.nbytes + queue.nbytes))
            stack, queue = _longer(stack), _longer(queue)
    search.state[slots.SPENT] = 0
    search.state[slots.PATIENCE] = max(_PATIENCE, _SHARE * state[kernels.LABELLED])


def _longer(array: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate([array, np.empty_like(array)])
