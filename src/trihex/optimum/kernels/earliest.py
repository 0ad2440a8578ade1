"""Earliest arrivals, where every step costs the same: the slots of a feasible plan, exchanged for earlier ones.

A *slot* is an arrival at a destination in a step. Sets of slots that robots can fill together by paths that share no
node are the independent sets of a matroid (a gammoid, Perfect 1968), so the best set is found greedily: in order of
step, a slot is filled if it can be in addition to those filled before. All robots have a path all the time, at first
that of the plan; those to slots decided upon are *settled*, the others *late*. A search back from an open slot through
the residual graph ends at the first late path: its robot takes the slot and gives up its own, later one. If there is
none, then nothing that the search has seen will ever lead to a late path, and it is *dead*.

The nodes are those of `trihex.optimum.network`, one word each: flow, as in `residual`; label, the
least number of flows turned back from a late path to here, as far as known, or `DEAD`; the same number from the slot
(`SEEN` at 0) and whether the node was opened, in the search under way; whether it is settled. Nodes are opened in
order of turns so far plus label, depth first. Labels are hints where to look; only death is proven.
"""

from numba import njit, types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U8, OUT_I64, TABLE_I32, UNCOUNTED
from trihex.optimum.kernels.residual import (
    BUDGET_SPENT,
    DONE,
    EXHAUSTED,
    FOUND,
    LIST_FULL,
    OFFSET,
    OTHER,
    OWN,
    PLACE,
    START,
    TABLE,
)

# Parts of a word.
FLOW, LABEL, SEEN, SETTLED, OPENED = 0xFF, 1 << 8, 1 << 16, 1 << 24, 1 << 25
DEAD = 255
THIS_SEARCH = OPENED | FLOW * SEEN
# Columns of the log: index and node; entry it was seen from and by which arc; turns; the arc that is tried next or
# `LEFT`, when there is none, but until it is opened the next entry of its list.
AT, NODE, FROM, VIA, TURNS, TRIED = range(6)
NEXT = TRIED
LEFT = 255
NONE = (1 << 32) - 1
# Places in the state: slot under way; robots settled and the sum of their steps; length of the log (0: no search),
# list, first entry of the walk, entry under way; how many nodes may still be looked at.
STEP, GOAL, SERVED, TOTAL, LOGGED, LIST, FIRST, ENTRY, BUDGET = range(9)
STATE_SIZE = 9

WORDS = types.Array(types.uint32, 1, "C")
LOG = types.Array(types.uint32, 2, "C")


@njit(nogil=True, **UNCOUNTED)
def _arc_to(node, target, out):
    """Return the place of the arc to a node, -1 if there is none."""
    for i in range(out.shape[1]):
        if out[node, i, OFFSET] == 0:
            break
        if out[node, i, OTHER] == target:
            return i
    return -1


@njit(nogil=True, **UNCOUNTED)
def _go(at, node, i, out, first_goal, words):
    """Let a robot go along an arc; return where it is then."""
    words[at] = (words[at] & 0xF0) | (i + 1)
    head = at + out[node, i, OFFSET]
    if out[node, i, OTHER] >= first_goal:
        words[head] += 1
    else:
        words[head] = (out[node, i, PLACE] + 1) << 4
    return head


@njit(
    types.boolean(IN_I64, IN_I64, IN_U8, IN_I32, IN_I32, TABLE_I32, TABLE, types.int64, types.int64, WORDS),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def lay_plan(start, first_action, actions, site_of_node, node_of_site, offset, out, cell_count, first_goal, words):
    """Write the paths of a plan into the words of the nodes; False if it takes a move that there is not."""
    size = len(out)
    for robot in range(len(start)):
        at, node, k = start[robot], start[robot] % size, first_action[robot]
        words[at] = START << 4
        while node < first_goal:
            site = site_of_node[node]
            target = node if actions[k] == WAIT else node_of_site[site + offset[site & 1, actions[k]]]
            k += 1
            i = _arc_to(node, target, out)
            if i < 0:  # through a lattice vertex
                for i in range(out.shape[1]):
                    vertex = out[node, i, OTHER]
                    if out[node, i, OFFSET] == 0:
                        return False
                    if cell_count <= vertex < first_goal and _arc_to(vertex, target, out) >= 0:
                        break
                at, node = _go(at, node, i, out, first_goal, words), out[node, i, OTHER]
                i = _arc_to(node, target, out)
            at, node = _go(at, node, i, out, first_goal, words), target
    return True


@njit(types.void(IN_I32, IN_BOOL, WORDS), cache=True, nogil=True, **UNCOUNTED)
def bury_starts(hops, is_vertex, words):
    """Label dead, after `lay_plan`, where nobody can be: in a cell in step 0 but for the robots, and before that."""
    size = len(hops)
    for row in range(len(words) // size):
        buried = 0
        for node in range(size):
            at = row * size + node
            if hops[node] > row or (hops[node] == row and not is_vertex[node] and words[at] == 0):
                words[at] = DEAD * LABEL
                buried += 1
        if buried == 0:
            break


@njit(nogil=True, **UNCOUNTED)
def _settle(at, node, into, words):
    """Settle the path of a robot up to a node; return whether it was late."""
    if words[at] & SETTLED:
        return False
    while True:
        words[at] |= SETTLED
        j = ((words[at] & FLOW) >> 4) - 1
        if j == START - 1:
            return True
        at, node = at + into[node, j, OFFSET], into[node, j, OTHER]


@njit(nogil=True, **UNCOUNTED)
def _settle_slot(slot, goal, into, words):
    """Settle all that arrive in a slot; return how many were late."""
    count = 0
    for j in range(into.shape[1]):
        if into[goal, j, OFFSET] == 0:
            break
        other = slot + into[goal, j, OFFSET]
        if (words[other] & 15) - 1 == into[goal, j, PLACE]:
            count += _settle(other, into[goal, j, OTHER], into, words)
    return count


@njit(nogil=True, **UNCOUNTED)
def _comes(at, node, j, into, first_goal, words):
    """Tell whether the flow into a node comes along arc j."""
    if node < first_goal:
        return ((words[at] & FLOW) >> 4) - 1 == j
    return (words[at + into[node, j, OFFSET]] & 15) - 1 == into[node, j, PLACE]


@njit(nogil=True, **UNCOUNTED)
def _open(entry, into, first_goal, words, log):
    """Open a node, and tell whether a late robot can come to it, by the arc `TRIED`."""
    at, node = log[entry, AT], log[entry, NODE]
    words[at] |= OPENED
    j = 0
    while into[node, j, OFFSET] != 0:
        word = words[at + into[node, j, OFFSET]]
        if word & FLOW and not word & SETTLED and not _comes(at, node, j, into, first_goal, words):
            log[entry, TRIED] = j
            return True
        j += 1
    log[entry, TRIED] = 0
    return False


@njit(nogil=True, **UNCOUNTED)
def _see(entry, j, out, into, first_goal, words, log, heads, state):
    """Log the node before an opened one along arc j, if that is worth it; True if it is to be opened now."""
    at, node, turns = log[entry, AT], log[entry, NODE], log[entry, TURNS]
    other, tail, via = at + into[node, j, OFFSET], into[node, j, OTHER], j
    if into[node, j, OFFSET] == 0:  # after the last arc: back along the flow that leaves
        via, other, tail = OWN, at, node
        if node >= first_goal or words[at] & FLOW == 0:
            return False
    elif _comes(at, node, j, into, first_goal, words):
        return False
    flow = words[other] & FLOW
    if flow != 0:
        i = (flow & 15) - 1
        other, tail, turns = other + out[tail, i, OFFSET], out[tail, i, OTHER], turns + 1
    word = words[other]
    label, seen = word // LABEL & DEAD, word // SEEN & FLOW
    total = min(turns + label, DEAD - 1)
    if label == DEAD or (
        seen != 0 and (turns + 1 > seen or (turns + 1 == seen and (word & OPENED or total > state[LIST])))
    ):
        return False
    words[other] = (word & ~THIS_SEARCH) | min(turns + 1, DEAD) * SEEN
    entry_now = state[LOGGED]
    state[LOGGED] += 1
    log[entry_now, AT], log[entry_now, NODE], log[entry_now, FROM] = other, tail, entry
    log[entry_now, VIA], log[entry_now, TURNS] = via, turns
    if total <= state[LIST]:
        state[ENTRY] = entry_now
        return True
    log[entry_now, NEXT] = heads[total]
    heads[total] = entry_now
    return False


@njit(nogil=True, **UNCOUNTED)
def _look(out, into, first_goal, words, log, heads, state):
    """Search back for a late path; `ENTRY` is then the node it comes to, by the arc `TRIED`."""
    while state[BUDGET] > 0:
        state[BUDGET] -= 1
        if state[LOGGED] + into.shape[1] > len(log):
            return LIST_FULL
        entry = state[ENTRY]
        if entry == NONE:
            while state[LIST] < DEAD and heads[state[LIST]] == NONE:
                state[LIST] += 1
            if state[LIST] == DEAD:
                return EXHAUSTED
            entry = heads[state[LIST]]
            heads[state[LIST]] = log[entry, NEXT]
            word = words[log[entry, AT]]
            if word & OPENED or word // SEEN & FLOW != min(log[entry, TURNS] + 1, DEAD):
                continue  # it has been seen again, with fewer turns
            state[FIRST] = state[ENTRY] = entry
        if words[log[entry, AT]] & OPENED == 0 and _open(entry, into, first_goal, words, log):
            return FOUND
        while log[entry, TRIED] < LEFT:
            j = log[entry, TRIED]
            log[entry, TRIED] = LEFT if into[log[entry, NODE], j, OFFSET] == 0 else j + 1
            if _see(entry, j, out, into, first_goal, words, log, heads, state):
                break
        else:
            state[ENTRY] = log[entry, FROM] if entry != state[FIRST] else NONE
    return BUDGET_SPENT


@njit(nogil=True, **UNCOUNTED)
def _close(found, words, log, state):
    """End the search. What was left in vain on the way to nothing takes a turn more than the path that was found."""
    if found:
        entry = state[ENTRY]
        while entry != NONE:
            log[entry, TRIED] = 0
            entry = log[entry, FROM]
    for entry in range(state[LOGGED] - 1, -1, -1):  # the last of a node is the one that counts
        at = log[entry, AT]
        word = words[at]
        if word // SEEN & FLOW == 0:
            continue
        least = DEAD
        if found:
            least = 0
            if word & OPENED:
                least = min(state[LIST] - log[entry, TURNS] + (log[entry, TRIED] == LEFT), DEAD - 1)
        words[at] = max(word & DEAD * LABEL, least * LABEL) | (word & ~(DEAD * LABEL | THIS_SEARCH))
    state[LOGGED] = 0


@njit(nogil=True, **UNCOUNTED)
def _give_up(at, node, out, first_goal, words):
    """Take the further path from a node away."""
    i = (words[at] & 15) - 1
    while True:
        at, node = at + out[node, i, OFFSET], out[node, i, OTHER]
        if node >= first_goal:
            words[at] -= 1
            return
        i = (words[at] & 15) - 1
        words[at] &= ~FLOW


@njit(nogil=True, **UNCOUNTED)
def _join(at, node, j, into, first_goal, words):
    """Let who leaves the node before go along arc j."""
    other = at + into[node, j, OFFSET]
    words[other] = (words[other] & ~15) | (into[node, j, PLACE] + 1)
    if node < first_goal:
        words[at] = (words[at] & ~0xF0) | (j + 1) << 4 | SETTLED


@njit(nogil=True, **UNCOUNTED)
def _turn(out, into, first_goal, words, log, state):
    """Let the late robot that was found go to the slot; others go on where it or they went."""
    entry = state[ENTRY]
    at, node, j = log[entry, AT], log[entry, NODE], log[entry, TRIED]
    other, tail = at + into[node, j, OFFSET], into[node, j, OTHER]
    _give_up(other, tail, out, first_goal, words)
    _settle(other, tail, into, words)
    _join(at, node, j, into, first_goal, words)
    while log[entry, FROM] != NONE:
        via, entry = log[entry, VIA], log[entry, FROM]
        at, node = log[entry, AT], log[entry, NODE]
        if via == OWN:  # nobody passes there any more
            words[at] &= ~(FLOW | SETTLED)
        else:
            _join(at, node, via, into, first_goal, words)
    words[at] += 1


@njit(nogil=True, **UNCOUNTED)
def _next_slot(size, into, first_goal, room, words, log, heads, state):
    """Begin a search from the slot under way, or go on to the next one."""
    goal = state[GOAL]
    slot = state[STEP] * size + goal
    if goal == size:
        state[STEP] += 1
        state[GOAL] = first_goal
        for other in range(first_goal, size):
            settled = _settle_slot(state[STEP] * size + other, other, into, words)
            state[SERVED] += settled
            state[TOTAL] += settled * state[STEP]
        return
    label = words[slot] // LABEL & DEAD
    if label == DEAD or words[slot] & FLOW >= room[goal - first_goal]:
        state[GOAL] += 1
        return
    heads[:] = NONE
    heads[label] = 0
    log[0, AT], log[0, NODE], log[0, FROM], log[0, TURNS], log[0, NEXT] = slot, goal, NONE, 0, NONE
    words[slot] |= SEEN
    state[LOGGED], state[LIST], state[ENTRY] = 1, label, NONE


@njit(
    types.int64(*(TABLE, TABLE, types.int64, IN_I64, types.int64), *(WORDS, LOG, OUT_I64, OUT_I64, types.int64)),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def fill_slots(out, into, first_goal, room, robots, words, log, heads, state, budget):
    """Fill the slots until all robots are settled, room is needed or some `budget` nodes were looked at.

    `room` tells how many get into each destination in a step.
    """
    size = len(out)
    state[BUDGET] = budget
    while state[SERVED] < robots:
        if state[BUDGET] <= 0:
            return BUDGET_SPENT
        if state[LOGGED] == 0:
            state[BUDGET] -= 1
            _next_slot(size, into, first_goal, room, words, log, heads, state)
            continue
        status = _look(out, into, first_goal, words, log, heads, state)
        if status == BUDGET_SPENT or status == LIST_FULL:
            return status
        if status == FOUND:
            _turn(out, into, first_goal, words, log, state)
            state[SERVED] += 1
            state[TOTAL] += state[STEP]
        else:
            state[GOAL] += 1
        _close(status == FOUND, words, log, state)
    return DONE
