"""Prices of nodes: what a robot there has to pay, beyond the value of the node, on its way through the residual graph.

A node that carries flow has two sides. Whoever *enters* it goes back to where its flow came from; whoever has been
turned back to it *leaves* it by another arc, or goes back further. A node that is free has only the side that is
entered. Prices are *fair*: no residual arc costs less than the difference of the prices at its ends, so nobody can go
to a destination for less than the price where he is, and whoever goes along arcs that cost just the difference, *tight*
ones, goes at the least cost. A side is numbered ``2 * index + ENTERING`` or ``LEAVING``.
"""

from typing import NamedTuple

from trihex.kernels.signatures import HELPER, IN_I64, OUT_I32, OUT_I64, OUT_U8, declared
from trihex.optimum.kernels.residual import LOG, Layer

ENTERING, LEAVING = 0, 1
# The word of a side: its price, less the rise so far if it rises, shifted by `BITS`; whether it rises; whether a walk
# has seen it since prices last rose; and of the side that is entered, whether it is *wanted*, that is, a path may end
# there, and whether the node carries flow, unless it is a destination.
RISES, SEEN, WANTED, PASSED, BITS = 1, 2, 4, 8, 4
# More than any way costs.
NEVER = 1 << 26

# Entries of the state.
SERVED = 0  # robots with a path
TOTAL = 1  # sum of the costs of their paths beyond their values
RISE = 2  # by how much prices have risen, where they rise
LISTED = 3  # entries of the list of sides that rise
NEXT = 4  # entry of the list that is looked at next
FILED = 5  # entries that have been filed
FREE = 6  # first of the filed entries that are free again, or NONE
ARRIVALS = 7  # arcs to wanted sides that have become tight
MARKED = 8  # sides that walks have seen since prices last rose
VAIN = 9  # arrivals for which a walk was in vain
BEFORE = 10  # robots that had a path before these walks
UNTIL = 11  # the rise after which what rises is found anew, as nothing has been filed for later ones
AHEAD = 12  # for how many units to come sides are filed: few if what rises has to be found anew soon in any case
ANEW = 13  # robots that had a path when what rises was found anew
IS_EAGER = 14  # 1 where few robots are left, so that one goes as soon as it can, and what rises is then found anew
STATE_SIZE = 15


class PricedNodes(NamedTuple):
    """Flow and words of all nodes of all layers."""

    flow: OUT_U8  # see `flow_byte`
    entering: OUT_I32
    leaving: OUT_I32  # of those only that carry flow


class PricedSearch(NamedTuple):
    """What rises, what is to rise, and what a search has seen."""

    start: IN_I64  # index of the node of each robot in step 0
    sides: OUT_I64  # list of sides that have begun to rise
    filed: LOG  # what will be tight later, each with the next one of that time, or NONE
    heads: OUT_I64  # first of those filed for each rise, modulo its length, or NONE
    arrivals: OUT_I64  # arcs to wanted sides, index * `ARCS` + place
    vain: OUT_I64  # those for which a walk was in vain; as long as the list of all
    stack: LOG  # the walk in depth: side, arc that is tried next, arc by which it leads on
    seen: OUT_I64  # what walks have seen; as long as the stack
    state: OUT_I64  # with the entries above


ARCS = 16
GRAPH, NODES, SEARCH = declared(Layer), declared(PricedNodes), declared(PricedSearch)


@HELPER
def price_of(word, rise):
    """Return the price that a word stands for."""
    return (word >> BITS) + (rise if word & RISES else 0)


@HELPER
def word_of(side, nodes):
    """Return the word of a side."""
    return nodes.leaving[side >> 1] if side & LEAVING else nodes.entering[side >> 1]


@HELPER
def put_word(side, word, nodes):
    """Set the word of a side."""
    if side & LEAVING:
        nodes.leaving[side >> 1] = word
    else:
        nodes.entering[side >> 1] = word
