"""The residual graph through layers of steps: arcs, flow, bounds, logs; what all searches share.

Every node takes one unit of flow. A node that carries flow is entered against it and left against it: whoever enters
goes back to where the flow came from. So searches ahead keep only nodes that they leave, and the search back only nodes
that it enters.

All prune by a lower bound that each node keeps: ``since``, the cost from a robot without path to the node, less `base`
a step; ``ahead``, the cost from the node to a destination, less its value in the network. A node is visited while its
*slack*, what the path may still cost beyond that, is not below its bound. Neither cost ever falls as robots get their
paths, so a bound may be raised as soon as a node is known to lead nowhere.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, declared

# What a search ends with.
BUDGET_SPENT = 0  # it is to go on
LIST_FULL = 1  # its log needs room
FOUND = 2  # a path
EXHAUSTED = 3  # there is none of this cost
DONE = 4  # all robots have their paths
LAYERS_FULL = 5  # the layers need room
LEVELS_FULL = 6  # a path costs more than bounds can hold

# Entries of the state of a search.
LOGGED = 0  # entries in its log
CURRENT = 1  # entry under way, or NONE; by A*: list under way
ROOT = 2  # robot to begin from next; search back: whether it has begun; one after another: `BASE` of `single`
SHORT = 3  # least amount by which the slack of a visit fell short of a bound
LAST = 4  # entry of the robot found; search back only
SEARCH_STATE_SIZE = 5

# Entries of the state of the whole.
LEVEL = 0  # cost that paths may have now; one after another: cost of the robot under way beyond its value, or NONE
SERVED = 1  # robots with a path
TOTAL = 2  # sum of the costs of their paths
TURN = 3  # which search is under way, see `levels`
QUOTA = 4  # nodes that it may visit before the other goes on
LAYERS = 5  # layers that have been opened
OPEN_GOALS = 6  # entries of `Ends.goals`
SPENT = 7  # nodes visited in this call; one after another: for the robot under way
FIRST_ROBOT = 8  # robots before this one have their paths
LAST_ROBOT = 9  # robots from this one on cost more than the level
AGE = 10  # nodes visited since `Ends.away` was filled
SERVED_THEN = 11  # robots that had a path when it was
SIDE = 12  # which search found the last path
VISITS = 13  # one after another: nodes visited for all robots
STATE_SIZE = 14

# Columns of the log of a search.
AT = 0  # index of the node visited: layer * nodes in a layer + node
NODE = 1  # node
ROW = 2  # layer; search back only
SLACK = 3  # what the path may still cost beyond the bound that the network gives
FROM = 4  # entry from which it was visited, NONE for a root
VIA = 5  # place of the arc by which it was visited among those of the node it was visited from, or `OWN`
TRIED = 6  # places of the arcs that have been tried, as bits
LOW = 7  # first entry that is known to be reached from here
LOG_COLUMNS = 8
# In the searches by A* in place of the last two.
TURNS = TRIED  # flows turned back on the way
NEXT = LOW  # next entry of the same list

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
DEAD = MARK - 1
FAR_AWAY = 1 << 20
NONE = -1

TABLE = types.Array(types.int32, 3, "C", readonly=True)
LOG = types.Array(types.int64, 2, "C")


class Layer(NamedTuple):
    """Arcs of one layer, as in `trihex.optimum.network`, and what holds for all."""

    out: TABLE  # arcs that leave each node, in descending order of reduced cost
    into: TABLE  # arcs that enter each node, likewise
    hops: IN_I32  # least number of steps to a destination
    order: IN_I32  # nodes so that arcs within a layer go forward
    is_vertex: IN_BOOL  # whether each node is a lattice vertex
    first_goal: types.int64  # nodes that are no destinations
    capacity: types.int64  # how many robots get into a destination in a step
    base: types.int64  # what each step costs at least
    grain: types.int64  # what slacks are multiples of


class FlowNodes(NamedTuple):
    """Flow and bounds of all nodes of all layers."""

    flow: OUT_U8  # see `flow_byte`
    since: OUT_I32  # least cost from a robot without path less `base` a step, and turns: see `back`
    ahead: OUT_I32  # least cost to a destination less the value in the network; one after another and turns


class FlowSearch(NamedTuple):
    """What a search has visited and is to visit."""

    log: LOG  # its entries, with the columns above
    state: OUT_I64
    heads: OUT_I64  # by A*: first entry of each list of what is to be visited, or NONE


class FlowEnds(NamedTuple):
    """Where robots start and may arrive."""

    start: IN_I64  # index of the node of each robot, in ascending order of value
    value: IN_I64  # least cost of each robot if there were no others
    lacks: OUT_U8  # whether a robot without path starts in each node
    goals: OUT_I64  # indices of destinations that are open
    away: OUT_I32  # steps from the nearest robot without path to each node, some time ago: a hint where to look
    queue: OUT_I32  # scratch for that


LAYER, NODES, SEARCH, ENDS = declared(Layer), declared(FlowNodes), declared(FlowSearch), declared(FlowEnds)
