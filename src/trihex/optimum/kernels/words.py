"""The word of a node, 32 bits, where slots are exchanged.

25      `OPENED`: the search under way has opened it
24      `SETTLED`: whoever passes goes to a slot decided upon
23..16  `SEEN`: flows turned back from the slot under way to here, plus 1; 0: not seen
15..8   `LABEL`: least number of flows turned back from a late path to here, as far as known, or `DEAD`
7..0   flow, as in `flow_byte`
"""

from numba import types

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import arc_in, arc_out
from trihex.optimum.kernels.residual import OFFSET, PLACE

FLOW = 0xFF
LABEL, SEEN = 1 << 8, 1 << 16
SETTLED, OPENED = 1 << 24, 1 << 25
# Of labels: no late path ever comes here. Also more turns than are counted.
DEAD = 255
# What is forgotten when a search ends.
THIS_SEARCH = OPENED | 0xFF * SEEN

WORDS = types.Array(types.uint32, 1, "C")


@HELPER
def label_of(word):
    """Return the least number of flows turned back from a late path, or `DEAD`."""
    return word // LABEL & 0xFF


@HELPER
def seen_of(word):
    """Return the number of flows turned back from the slot, plus 1, or 0."""
    return word // SEEN & 0xFF


@HELPER
def comes_by(at, node, j, graph, words):
    """Tell whether the flow into a node comes along arc j."""
    if node < graph.first_goal:
        return arc_in(words[at] & FLOW) == j
    return arc_out(words[at + graph.into[node, j, OFFSET]]) == graph.into[node, j, PLACE]
