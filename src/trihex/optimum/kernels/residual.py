"""The residual graph through layers of steps: arcs, flow, bounds, logs; what searches share.

Every node takes one unit of flow. A node that carries flow is entered against it and left against it: whoever enters
goes back to where the flow came from.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import IN_I64, OUT_I32, OUT_I64, OUT_U8, declared

# What a search ends with.
BUDGET_SPENT = 0  # it is to go on
LIST_FULL = 1  # its log needs room
FOUND = 2  # a path
EXHAUSTED = 3  # there is none of this cost
DONE = 4  # all robots have their paths
LAYERS_FULL = 5  # the layers need room
LEVELS_FULL = 6  # a path costs more than bounds can hold
LABELS_OLD = 7  # labels are to be found anew

# Entries of the state of a search.
LOGGED = 0  # entries in its log
CURRENT = 1  # list under way
BASE = 2  # cost that the first list of those for a cost stands for
SEARCH_STATE_SIZE = 3

# Entries of the state of the whole.
LEVEL = 0  # cost of the robot under way beyond its value, or NONE
SERVED = 1  # robots with a path
TOTAL = 2  # sum of the costs of their paths
SPENT = 3  # nodes visited for the robot under way
VISITS = 4  # nodes visited for all robots
STATE_SIZE = 5

# Columns of the log of a search.
AT = 0  # index of the node visited: layer * nodes in a layer + node
NODE = 1  # node
COST = 2  # cost beyond the value so far
FROM = 3  # entry from which it was visited, NONE for a root
VIA = 4  # place of the arc by which it was visited among those of the node it was visited from, or `OWN`
TURNS = 5  # flows turned back
NEXT = 6  # next entry of the same list
LOG_COLUMNS = 7

# Columns of the tables of arcs: see `trihex.optimum.network`.
OFFSET = 0  # what to add to the index to get the other node, 0: no more arcs
REDUCED = 1  # reduced cost
PLACE = 2  # place among the arcs of the other node
EXTRA = 3  # cost beyond `base` a step
OTHER = 4  # the other node
ROWS = 5  # how many layers on it is

MOST_LEVEL = 1 << 23
# Layers beyond that of a node that its neighbours may lie in.
SPARE_ROWS = 4
# Lists of the searches by A*: one for each number of flows turned back, then one for each higher cost.
TURN_LISTS, LISTS = 512, 4096
# Place of the arc from the entered to the left side of the same node.
OWN = 14
# Bounds: MARK + entry while a node is visited and not done with.
MARK = 1 << 30
NONE = -1

TABLE = types.Array(types.int32, 3, "C", readonly=True)
LOG = types.Array(types.int64, 2, "C")


class Layer(NamedTuple):
    """Arcs of one layer, as in `trihex.optimum.network`, and what holds for all."""

    out: TABLE  # arcs that leave each node, in descending order of reduced cost
    into: TABLE  # arcs that enter each node, likewise
    first_goal: types.int64  # nodes that are no destinations
    capacity: types.int64  # how many robots get into a destination in a step


class FlowNodes(NamedTuple):
    """Flow and bounds of all nodes of all layers."""

    flow: OUT_U8  # see `flow_byte`
    ahead: OUT_I32  # least cost to a destination less the value in the network, and turns: see `single`


class FlowSearch(NamedTuple):
    """What a search has visited and is to visit."""

    log: LOG  # its entries, with the columns above
    state: OUT_I64
    heads: OUT_I64  # first entry of each list of what is to be visited, or NONE


class FlowEnds(NamedTuple):
    """Where robots start."""

    start: IN_I64  # index of the node of each robot, in ascending order of value
    value: IN_I64  # least cost of each robot if there were no others


LAYER, NODES, SEARCH, ENDS = declared(Layer), declared(FlowNodes), declared(FlowSearch), declared(FlowEnds)
