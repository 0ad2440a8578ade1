"""Paths of robots in a flow through layers of steps."""

from typing import NamedTuple

from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_I64, OUT_U8, TABLE_I32, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_out, with_arc_out
from trihex.optimum.kernels.residual import OFFSET, TABLE


class FlowPaths(NamedTuple):
    """A flow, and where robots enter it."""

    start: IN_I64  # index of the node of each robot in step 0, or when it may go
    flow: OUT_U8  # of all nodes of all layers, see `flow_byte`
    out: TABLE  # arcs that leave each node of a layer
    cell_count: types.int64  # nodes that are cells
    first_goal: types.int64  # nodes that are no destinations


class ActionsOut(NamedTuple):
    """Where the actions of robots go."""

    first: IN_I64  # action 0 of robot r is action[first[r]]
    action: OUT_U8
    site_of_node: IN_I32
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site


PATHS, ACTIONS_OUT = declared(FlowPaths), declared(ActionsOut)


@HELPER
def _next_node(at, paths):
    return at + paths.out[at % len(paths.out), arc_out(paths.flow[at]), OFFSET]


@HELPER
def _next_place(at, paths):
    """Return the cell or destination that the robot in a cell goes to, past a lattice vertex or a gate or not."""
    head = _next_node(at, paths)
    while paths.cell_count <= head % len(paths.out) < paths.first_goal:
        head = _next_node(head, paths)
    return head


@HELPER
def _wait(at, paths):
    """Let the robot at a cell stay there."""
    nodes = len(paths.out)
    i = 0
    while paths.out[at % nodes, i, OFFSET] != nodes:
        i += 1
    paths.flow[at] = with_arc_out(paths.flow[at], i)


@kernel(types.int64(PATHS, OUT_I64))
def part_exchanges(paths, arrival):
    """Let robots that would exchange cells wait and exchange their further paths instead; return how many did.

    To be repeated until none do. Only then the `arrival` steps are right.
    """
    nodes = len(paths.out)
    parted = 0
    for robot in range(len(paths.start)):
        at = paths.start[robot]
        while at % nodes < paths.first_goal:
            head = _next_place(at, paths)
            if head % nodes < paths.cell_count and head != at + nodes:
                other = head - nodes  # where the head is one step before
                if paths.flow[other] != 0 and _next_place(other, paths) == at + nodes:
                    _wait(at, paths)
                    _wait(other, paths)
                    head = at + nodes
                    parted += 2
            at = head
        arrival[robot] = at // nodes
    return parted


@kernel(types.void(PATHS, ACTIONS_OUT))
def write_actions(paths, out):
    """Write what each robot does in each step."""
    nodes = len(paths.out)
    for robot in range(len(paths.start)):
        at, i = paths.start[robot], out.first[robot]
        while at % nodes < paths.first_goal:
            head = _next_place(at, paths)
            site, target = out.site_of_node[at % nodes], out.site_of_node[head % nodes]
            action = WAIT
            if target != site:
                action = 0  # edge moves come first, and of two moves to one place they are the cheaper
                while site + out.offset[site & 1, action] != target:
                    action += 1
            out.action[i] = action
            i += 1
            at = head
