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
    steps: OUT_I32  # of each node, in ticks; -1 at all of them before and after
    queue: OUT_I32  # nodes, a line for each duration of moves: each of them is in order of steps
    when: OUT_I32  # steps of each of them; a node that was reached sooner since stands in another line, too
    head: OUT_I64  # the first of each line
    tail: OUT_I64  # and its end
    detour: types.int64  # sites are left out where the way is so much longer than that to the nearest destination


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
def _enter(gate, node, steps, line, graph, gate_of_node, found):
    """Put a node into a line, unless it has been reached as soon, is too far or belongs to the gate under way."""
    if 0 <= found.steps[node] <= steps or (gate >= 0 and gate_of_node[node] == gate):
        return
    if node < len(graph.steps) and steps - graph.steps[node] > found.detour:
        return
    found.steps[node] = steps
    tail = found.tail[line]
    found.queue[tail] = node
    found.when[tail] = steps
    found.tail[line] = tail + 1


@HELPER
def _nearest_line(found):
    """Return the line whose first node is the nearest, -1 if all are empty."""
    best, least = np.int64(-1), np.int64(0)
    for line in range(len(found.head)):
        head = found.head[line]
        if head < found.tail[line] and (best < 0 or found.when[head] < least):
            best, least = np.int64(line), np.int64(found.when[head])
    return best


@HELPER
def _go_on(gate, site, graph, gate_of_node, found):
    """Enter the nodes to which moves from a site lead, of lattice vertices only gates."""
    steps = found.steps[site]
    bits = graph.moves[site]
    # Two loops: one that asks at each move whether it passes a vertex takes 10 % longer.
    for k in range(graph.first_vertex_move):
        if bits >> k & 1:
            node = site + graph.offset[site & 1, k]
            _enter(gate, node, steps + graph.duration[k], graph.line[k], graph, gate_of_node, found)
    for k in range(graph.first_vertex_move, graph.offset.shape[1]):
        if bits >> k & 1:
            node, line = len(graph.moves) + site + graph.vertex[site & 1, k], graph.vertex_line
            duration = graph.vertex_duration
            if gate_of_node[node] < 0:
                node, line, duration = site + graph.offset[site & 1, k], np.int64(graph.line[k]), graph.duration[k]
            _enter(gate, node, steps + duration, line, graph, gate_of_node, found)


@kernel(types.void(types.int64, IN_I32, NODE_GRAPH, LANDMARKS, SURROUNDINGS))
def look_around(gate, starts, graph, landmarks, found):
    """Search around `gate` (-1: around destinations) from the sites `starts`, the nearest first.

    It passes neither other gates nor destinations.
    """
    count, queue = found.count, found.queue
    count[GATES] = count[ROBOTS] = 0
    count[OUT] = -1
    for line in range(len(found.head)):
        found.head[line] = found.tail[line] = line * len(found.steps)
    for site in starts:
        _enter(np.int64(-1), site, np.int32(0), np.int64(0), graph, landmarks.gate_of_node, found)
    line = _nearest_line(found)
    while line >= 0:
        head = found.head[line]
        found.head[line] = head + 1
        node = np.int64(queue[head])
        if found.steps[node] == found.when[head] and not (
            landmarks.is_special[node] and _is_end(gate, node, graph.is_destination, landmarks, found)
        ):
            _go_on(gate, node, graph, landmarks.gate_of_node, found)
        line = _nearest_line(found)
    for line in range(len(found.head)):
        for i in range(line * len(found.steps), found.tail[line]):
            found.steps[queue[i]] = -1
