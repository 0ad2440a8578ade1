"""Paths to slots: settled, turned to another slot, given up."""

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out
from trihex.optimum.kernels.residual import OFFSET, OTHER, OWN, PLACE
from trihex.optimum.kernels.slots import AT, ENTRY, FROM, NOBODY, NODE, TRIED, VIA
from trihex.optimum.kernels.words import FLOW, SETTLED

# In place of an arc that leaves: the robot has no way on yet and is as late as can be.
PARKED = 14


@HELPER
def _settle(at, node, graph, words):
    """Settle the path of a robot up to a node; return whether it was late."""
    if words[at] & SETTLED:
        return False
    while True:
        words[at] |= SETTLED
        j = arc_in(words[at] & FLOW)
        if j == START - 1:
            return True
        at, node = at + graph.into[node, j, OFFSET], graph.into[node, j, OTHER]


@HELPER
def settle_slot(slot, goal, graph, words):
    """Settle all that arrive in a slot; return how many were late."""
    into = graph.into
    count = 0
    for j in range(into.shape[1]):
        if into[goal, j, OFFSET] == 0:
            break
        other = slot + into[goal, j, OFFSET]
        if arc_out(words[other]) == into[goal, j, PLACE]:
            count += _settle(other, into[goal, j, OTHER], graph, words)
    return count


@HELPER
def _give_up(at, node, graph, words):
    """Take the further path from a node away."""
    i = arc_out(words[at])
    while i != PARKED:
        at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]
        if node >= graph.first_goal:
            words[at] -= 1
            return
        i = arc_out(words[at])
        words[at] &= ~FLOW


@HELPER
def _join(at, node, j, graph, words):
    """Let who leaves the node before go along arc j."""
    other = at + graph.into[node, j, OFFSET]
    words[other] = (words[other] & ~15) | (graph.into[node, j, PLACE] + 1)
    if node < graph.first_goal:
        words[at] = (words[at] & ~0xF0) | (j + 1) << 4 | SETTLED


@HELPER
def turn(graph, search):
    """Let the late robot that was found go to the slot; others go on where it or they went."""
    words, log, into = search.words, search.log, graph.into
    entry = search.state[ENTRY]
    at, node, j = log[entry, AT], log[entry, NODE], log[entry, TRIED]
    other, tail = at + into[node, j, OFFSET], into[node, j, OTHER]
    _give_up(other, tail, graph, words)
    _settle(other, tail, graph, words)
    _join(at, node, j, graph, words)
    while log[entry, FROM] != NOBODY:
        via, entry = log[entry, VIA], log[entry, FROM]
        at, node = log[entry, AT], log[entry, NODE]
        if via == OWN:  # nobody passes there any more
            words[at] &= ~(FLOW | SETTLED)
        else:
            _join(at, node, via, graph, words)
    words[at] += 1
