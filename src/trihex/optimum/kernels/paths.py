"""Paths of robots in a flow through layers of steps."""

from numba import njit, types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I64, OUT_U8, TABLE_I32
from trihex.optimum.kernels.residual import TABLE


@njit(types.int64(types.int64, TABLE, IN_U8), cache=True, nogil=True)
def _next(at, out_arcs, flow):
    return at + out_arcs[at % len(out_arcs), (flow[at] & 15) - 1, 0]


@njit(types.void(types.int64, TABLE, OUT_U8), cache=True, nogil=True)
def _wait(at, out_arcs, flow):
    """Let the robot at a cell stay there."""
    nodes = len(out_arcs)
    i = 0
    while out_arcs[at % nodes, i, 0] != nodes:
        i += 1
    flow[at] = (flow[at] & 0xF0) | (i + 1)


@njit(types.int64(IN_I64, types.int64, types.int64, TABLE, OUT_U8, OUT_I64), cache=True, nogil=True)
def part_exchanges(start_of_robot, cell_count, first_goal, out_arcs, flow, arrival):
    """Let robots that would exchange cells wait and exchange their further paths instead; return how many did.

    To be repeated until none do. Only then the `arrival` steps are right.
    """
    nodes = len(out_arcs)
    parted = 0
    for robot in range(len(start_of_robot)):
        at = start_of_robot[robot]
        while at % nodes < first_goal:
            head = _next(at, out_arcs, flow)
            if at % nodes < cell_count and head % nodes < cell_count and head != at + nodes:
                other = head - nodes  # where the head is one step before
                if flow[other] != 0 and _next(other, out_arcs, flow) == at + nodes:
                    _wait(at, out_arcs, flow)
                    _wait(other, out_arcs, flow)
                    head = at + nodes
                    parted += 2
            at = head
        arrival[robot] = at // nodes
    return parted


@njit(
    types.void(IN_I64, types.int64, types.int64, TABLE, IN_U8, IN_I32, TABLE_I32, IN_I64, OUT_U8),
    cache=True,
    nogil=True,
)
def write_actions(start_of_robot, cell_count, first_goal, out_arcs, flow, site_of_node, offset, first_action, actions):
    """Write what each robot does in each step; its first action goes to ``actions[first_action[robot]]``."""
    nodes = len(out_arcs)
    for robot in range(len(start_of_robot)):
        at = start_of_robot[robot]
        i = first_action[robot]
        while at % nodes < first_goal:
            head = _next(at, out_arcs, flow)
            if cell_count <= head % nodes < first_goal:  # a lattice vertex
                head = _next(head, out_arcs, flow)
            site = site_of_node[at % nodes]
            target = site_of_node[head % nodes]
            action = WAIT
            if target != site:
                action = 0  # edge moves come first, and of two moves to one place they are the cheaper
                while site + offset[site & 1, action] != target:
                    action += 1
            actions[i] = action
            i += 1
            at = head
