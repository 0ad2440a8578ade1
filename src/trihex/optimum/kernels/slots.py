"""What the exchange of slots works on: graph, words, log, lists, state."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import IN_I64, OUT_I64, declared
from trihex.optimum.kernels.residual import TABLE
from trihex.optimum.kernels.words import WORDS

# Columns of the log.
AT = 0  # index of the node seen: layer * nodes in a layer + node
NODE = 1  # node
FROM = 2  # entry it was seen from, `NOBODY` for the slot
VIA = 3  # place of the arc it was seen by among those into the node it was seen from, or `OWN`
TURNS = 4  # flows turned back on the way
TRIED = 5  # the arc that is tried next, or `LEFT`
NEXT = TRIED  # until it is opened: next entry of its list
LOG_COLUMNS = 6
# There is no arc left to try.
LEFT = 255
# No entry.
NOBODY = (1 << 32) - 1

# Entries of the state.
STEP = 0  # step of the slot under way
GOAL = 1  # its destination; the number of nodes: go on to the next step
SERVED = 2  # robots settled
TOTAL = 3  # sum of their steps
LOGGED = 4  # entries in the log, 0: no search is under way
LIST = 5  # list under way: of nodes with so many turns so far and to come
FIRST = 6  # first entry of the walk in depth under way
ENTRY = 7  # its entry under way, or `NOBODY`; at the end the node that the late path comes to, by the arc `TRIED`
BUDGET = 8  # nodes that may still be looked at
LAST = 9  # after this step it ends, whoever is not served
SPENT = 10  # entries of the searches since all labels were found anew
PATIENCE = 11  # after so many they are to be
STATE_SIZE = 12
# As patience: labels are never found anew.
TIRELESS = 1 << 62

LOG = types.Array(types.uint32, 2, "C")


class SlotGraph(NamedTuple):
    """Arcs of one layer, as in `trihex.optimum.network`, and what holds for all."""

    out: TABLE  # arcs that leave each node
    into: TABLE  # arcs that enter each node
    cell_count: types.int64  # nodes that are cells
    first_goal: types.int64  # nodes that are no destinations
    room: IN_I64  # how many robots get into each destination in a step


class SlotSearch(NamedTuple):
    """The nodes, and the search under way."""

    words: WORDS  # of all nodes of all layers
    log: LOG  # what it has seen, with the columns above
    heads: OUT_I64  # first entry of the list for each number of turns, or `NOBODY`
    state: OUT_I64  # with the entries above
    most: IN_I64  # no more robots arrive by each step, as far as that is known: of as many steps as it is long


SLOT_GRAPH, SLOT_SEARCH = declared(SlotGraph), declared(SlotSearch)
