"""Meetings: where robots would come together if each went its shortest way."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.bounds.kernels.nodes import NODE_GRAPH, node_ahead
from trihex.kernels.signatures import HELPER, IN_I32, OUT_BOOL, OUT_I32, OUT_I64, declared, kernel


class Pedestrians(NamedTuple):
    """Robots without regard to each other, and what they leave behind."""

    site: OUT_I32  # of each robot
    moving: OUT_BOOL  # of each robot: whether it has not arrived
    seen: OUT_I64  # of each node: the last step in which it was passed
    meetings: OUT_I64  # of each node: how often it was passed by more robots than the first of a step


PEDESTRIANS = declared(Pedestrians)


@HELPER
def _choose(robot, step, here, graph):
    """Return a direction of a shortest way; ties are broken by a hash of robot and step."""
    best, least = np.int64(-1), np.int64(0)
    most = graph.steps[here]
    for k in range(graph.offset.shape[1]):
        if graph.moves[here] >> k & 1 and graph.steps[here + graph.offset[here & 1, k]] + graph.duration[k] <= most:
            lot = (robot * 40503 + step * 30011 + k * 9973) * 2654435761 >> 16 & 65535
            if best < 0 or lot < least:
                best, least = np.int64(k), np.int64(lot)
    return best


@HELPER
def _pass(node, step, pedestrians):
    """Count who passes a node after another in one step."""
    pedestrians.meetings[node] += pedestrians.seen[node] == step
    pedestrians.seen[node] = step


@HELPER
def _move(robot, step, graph, pedestrians):
    """Move a robot one step on."""
    here = np.int64(pedestrians.site[robot])
    k = _choose(robot, step, here, graph)
    target = here + graph.offset[here & 1, k]
    pedestrians.site[robot] = target
    if k >= graph.first_vertex_move:
        _pass(node_ahead(here, k, graph), step, pedestrians)
    pedestrians.moving[robot] = graph.steps[target] > 0
    if pedestrians.moving[robot]:
        _pass(target, step, pedestrians)


@kernel(types.void(IN_I32, NODE_GRAPH, PEDESTRIANS))
def count_meetings(start, graph, pedestrians):
    """Count at each node how often robots meet that all go their shortest ways from the sites `start`."""
    for r in range(len(start)):
        pedestrians.site[r] = start[r]
        pedestrians.moving[r] = graph.steps[start[r]] > 0
    step = 0
    some_move = True
    while some_move:
        some_move = False
        step += 1
        for r in range(len(start)):
            if pedestrians.moving[r]:
                some_move = True
                _move(r, step, graph, pedestrians)
