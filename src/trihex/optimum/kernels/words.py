"""The word of a node, 32 bits, where slots are exchanged.

31      `OPENED`: the search under way has opened it
30      `SETTLED`: whoever passes goes to a slot decided upon
29..19  `SEEN`: flows turned back from the slot under way to here, plus 1; 0: not seen
18..8   `LABEL`: least number of flows turned back from a late path to here, as far as known, or `DEAD`
7..0   flow, as in `flow_byte`
"""

from numba import types

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import arc_in, arc_out
from trihex.optimum.kernels.residual import OFFSET, PLACE

FLOW = 0xFF
LABEL, SEEN = 1 << 8, 1 << 19
SETTLED, OPENED = 1 << 30, 1 << 31
# Of labels: no late path ever comes here. Also more turns than are counted: with 100 000 robots
# paths turn back hundreds, and searches that count only 254 wander.
DEAD = 2047
# What is forgotten when a search ends.
THIS_SEARCH = OPENED | DEAD * SEEN

WORDS = types.Array(types.uint32, 1, "C")


@HELPER
def label_of(word):
    """Return the least number of flows turned back from a late path, or `DEAD`."""
    return word // LABEL & DEAD


@HELPER
def seen_of(word):
    """Return the number of flows turned back from the slot, plus 1, or 0."""
    return word // SEEN & DEAD


@HELPER
def comes_by(at, node, j, graph, words):
    """Tell whether the flow into a node comes along arc j."""
    if node < graph.first_goal:
        return arc_in(words[at] & FLOW) == j
    return arc_out(words[at + graph.into[node, j, OFFSET]]) == graph.into[node, j, PLACE]
