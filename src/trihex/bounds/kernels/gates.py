"""What lies around a gate: other gates, robots and destinations, on ways that pass no other gate."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.bounds.kernels.nodes import NODE_GRAPH
from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, OUT_I32, OUT_I64, declared, kernel

# Entries of `count`: gates and robots found; the steps to a destination that is no gate (-1: none near).
GATES, ROBOTS, OUT = range(3)


class Landmarks(NamedTuple):
    """What a search looks for, at each node."""

    is_special: IN_BOOL  # whether a gate, a robot or a destination is there: at most nodes this one look is enough
    gate_of_node: IN_I32  # which gate it is, -1: none
    robot_at: IN_I32  # which robot is there, -1: none


class Surroundings(NamedTuple):
    """What a search has found, and what it needs."""

    near_gate: OUT_I32
    gate_steps: OUT_I32  # from the gate under way to each of them
    near_robot: OUT_I32
    robot_steps: OUT_I32  # likewise
    count: OUT_I64
    steps: OUT_I32  # of each node; -1 at all of them before and after
    queue: OUT_I32  # nodes


LANDMARKS, SURROUNDINGS = declared(Landmarks), declared(Surroundings)


@HELPER
def _is_end(gate, node, is_destination, landmarks, found):
    """Note what is at a special node; return whether ways end here: at another gate, or a destination."""
    steps, count = found.steps[node], found.count
    its_gate = landmarks.gate_of_node[node]
    is_start = steps == 0 and (gate < 0 or its_gate == gate)
    if its_gate >= 0 and not is_start:
        found.near_gate[count[GATES]] = its_gate
        found.gate_steps[count[GATES]] = steps
        count[GATES] += 1
        return True
    if node < len(is_destination) and is_destination[node] and not is_start:
        if count[OUT] < 0:
            count[OUT] = steps
        return True
    if landmarks.robot_at[node] >= 0:
        found.near_robot[count[ROBOTS]] = landmarks.robot_at[node]
        found.robot_steps[count[ROBOTS]] = steps
        count[ROBOTS] += 1
    return False


@HELPER
def _enter(gate, node, steps, tail, gate_of_node, found):
    """Put a node into the queue unless it has been there or belongs to the gate under way; return the new tail."""
    if found.steps[node] >= 0 or (gate >= 0 and gate_of_node[node] == gate):
        return tail
    found.steps[node] = steps
    found.queue[tail] = node
    return tail + 1


@HELPER
def _go_on(gate, site, tail, graph, gate_of_node, found):
    """Enter the nodes to which moves from a site lead, of lattice vertices only gates; return the new tail."""
    steps = found.steps[site] + 1
    bits = graph.moves[site]
    # Two loops: one that asks at each move whether it passes a vertex takes 10 % longer.
    for k in range(graph.first_vertex_move):
        if bits >> k & 1:
            tail = _enter(gate, site + graph.offset[site & 1, k], steps, tail, gate_of_node, found)
    for k in range(graph.first_vertex_move, graph.offset.shape[1]):
        if bits >> k & 1:
            node = len(graph.moves) + site + graph.vertex[site & 1, k]
            if gate_of_node[node] < 0:
                node = site + graph.offset[site & 1, k]
            tail = _enter(gate, node, steps, tail, gate_of_node, found)
    return tail


@kernel(types.void(types.int64, IN_I32, NODE_GRAPH, LANDMARKS, SURROUNDINGS))
def look_around(gate, starts, graph, landmarks, found):
    """Search in breadth around `gate` (-1: around destinations) from the sites `starts`.

    It passes neither other gates nor destinations.
    """
    count, queue = found.count, found.queue
    count[GATES] = count[ROBOTS] = 0
    count[OUT] = -1
    head = tail = np.int64(0)
    for site in starts:
        found.steps[site] = 0
        queue[tail] = site
        tail += 1
    while head < tail:
        node = np.int64(queue[head])
        head += 1
        if landmarks.is_special[node] and _is_end(gate, node, graph.is_destination, landmarks, found):
            continue
        tail = _go_on(gate, node, tail, graph, landmarks.gate_of_node, found)
    for i in range(tail):
        found.steps[queue[i]] = -1
