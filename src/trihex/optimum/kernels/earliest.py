"""Earliest arrivals, where every step costs the same: the slots of a feasible plan, exchanged for earlier ones.

A *slot* is an arrival at a destination in a step. Sets of slots that robots can fill together by paths that share no
node are the independent sets of a matroid (a gammoid, Perfect 1968), so the best set is found greedily: in order of
step, a slot is filled if it can be in addition to those filled before. All robots have a path all the time, at first
that of the plan; those to slots decided upon are *settled*, the others *late*. A search back from an open slot through
the residual graph ends at the first late path: its robot takes the slot and gives up its own, later one. If there is
none, then nothing that the search has seen will ever lead to a late path, and it is *dead*.

The nodes are those of `trihex.optimum.network`, a word each: see `words`. Nodes are opened in order of turns so far
plus label, depth first. Labels are hints where to look; only death is proven. When searches have seen many nodes,
they end so that all labels are found anew, by `turns`.
"""

from numba import types

from trihex.kernels.signatures import APART, HELPER, kernel
from trihex.optimum.kernels.flow_byte import arc_out
from trihex.optimum.kernels.residual import (
    BUDGET_SPENT,
    DONE,
    EXHAUSTED,
    FOUND,
    LABELS_OLD,
    LAYERS_FULL,
    LIST_FULL,
    OFFSET,
    OTHER,
    OWN,
)
from trihex.optimum.kernels.slot_paths import settle_slot, turn
from trihex.optimum.kernels.slots import (
    AT,
    BUDGET,
    ENTRY,
    FIRST,
    FROM,
    GOAL,
    LAST,
    LEFT,
    LIST,
    LOGGED,
    NEXT,
    NOBODY,
    NODE,
    PATIENCE,
    SERVED,
    SLOT_GRAPH,
    SLOT_SEARCH,
    SPENT,
    STEP,
    TOTAL,
    TRIED,
    TURNS,
    VIA,
)
from trihex.optimum.kernels.words import (
    DEAD,
    FLOW,
    LABEL,
    OPENED,
    SEEN,
    SETTLED,
    THIS_SEARCH,
    comes_by,
    label_of,
    seen_of,
)


@HELPER
def _open(entry, graph, search):
    """Open a node, and tell whether a late robot can come to it, by the arc `TRIED`."""
    words, log, into = search.words, search.log, graph.into
    at, node = log[entry, AT], log[entry, NODE]
    words[at] |= OPENED
    j = 0
    while into[node, j, OFFSET] != 0:
        word = words[at + into[node, j, OFFSET]]
        if word & FLOW and not word & SETTLED and not comes_by(at, node, j, graph, words):
            log[entry, TRIED] = j
            return True
        j += 1
    log[entry, TRIED] = 0
    return False


@HELPER
def _is_worth_it(word, turns, total, best):
    """Tell whether a node may lead to a late path, and was not seen with as few turns; `best` is the list under way."""
    seen = seen_of(word)
    if label_of(word) == DEAD:
        return False
    if seen == 0 or turns + 1 < seen:
        return True
    return turns + 1 == seen and not word & OPENED and total <= best


@HELPER
def _see(entry, j, graph, search):
    """Log the node before an opened one along arc j, if that is worth it; True if it is to be opened now."""
    words, log, state, into = search.words, search.log, search.state, graph.into
    at, node, turns = log[entry, AT], log[entry, NODE], log[entry, TURNS]
    other, tail, via = at + into[node, j, OFFSET], into[node, j, OTHER], j
    if into[node, j, OFFSET] == 0:  # after the last arc: back along the flow that leaves
        via, other, tail = OWN, at, node
        if node >= graph.first_goal or words[at] & FLOW == 0:
            return False
    elif comes_by(at, node, j, graph, words):
        return False
    if words[other] & FLOW:  # who passes there is to be turned back
        i = arc_out(words[other])
        other, tail, turns = other + graph.out[tail, i, OFFSET], graph.out[tail, i, OTHER], turns + 1
    word = words[other]
    total = min(turns + label_of(word), DEAD - 1)
    if not _is_worth_it(word, turns, total, state[LIST]):
        return False
    words[other] = (word & ~THIS_SEARCH) | min(turns + 1, DEAD) * SEEN
    entry_now = state[LOGGED]
    state[LOGGED] += 1
    log[entry_now, AT], log[entry_now, NODE], log[entry_now, FROM] = other, tail, entry
    log[entry_now, VIA], log[entry_now, TURNS] = via, turns
    if total <= state[LIST]:
        state[ENTRY] = entry_now
        return True
    log[entry_now, NEXT] = search.heads[total]
    search.heads[total] = entry_now
    return False


@HELPER
def _next_walk(search):
    """Begin to walk in depth from the next node of the lists; return its entry, or `NOBODY` if it is not to be."""
    log, heads, state = search.log, search.heads, search.state
    entry = heads[state[LIST]]
    heads[state[LIST]] = log[entry, NEXT]
    word = search.words[log[entry, AT]]
    if word & OPENED or seen_of(word) != min(log[entry, TURNS] + 1, DEAD):
        return NOBODY  # it has been seen again, with fewer turns
    state[FIRST] = state[ENTRY] = entry
    return entry


@HELPER
def _look(graph, search):
    """Search back for a late path; `ENTRY` is then the node it comes to, by the arc `TRIED`."""
    words, log, heads, state = search.words, search.log, search.heads, search.state
    while state[BUDGET] > 0:
        state[BUDGET] -= 1
        if state[LOGGED] + graph.into.shape[1] > len(log):
            return LIST_FULL
        if state[SPENT] > 0 and state[SPENT] + state[LOGGED] > state[PATIENCE]:
            return LABELS_OLD
        entry = state[ENTRY]
        if entry == NOBODY:
            while state[LIST] < DEAD and heads[state[LIST]] == NOBODY:
                state[LIST] += 1
            if state[LIST] == DEAD:
                return EXHAUSTED
            entry = _next_walk(search)
            if entry == NOBODY:
                continue
        if words[log[entry, AT]] & OPENED == 0 and _open(entry, graph, search):
            return FOUND
        while log[entry, TRIED] < LEFT:
            j = log[entry, TRIED]
            log[entry, TRIED] = LEFT if graph.into[log[entry, NODE], j, OFFSET] == 0 else j + 1
            if _see(entry, j, graph, search):
                break
        else:
            state[ENTRY] = log[entry, FROM] if entry != state[FIRST] else NOBODY
    return BUDGET_SPENT


@HELPER
def _close(found, search):
    """End the search. What was left in vain on the way to nothing takes a turn more than the path that was found."""
    words, log, state = search.words, search.log, search.state
    if found:
        entry = state[ENTRY]
        while entry != NOBODY:
            log[entry, TRIED] = 0
            entry = log[entry, FROM]
    for entry in range(state[LOGGED] - 1, -1, -1):  # the last of a node is the one that counts
        at = log[entry, AT]
        word = words[at]
        if seen_of(word) == 0:
            continue
        least = DEAD
        if found:
            least = 0
            if word & OPENED:
                least = min(state[LIST] - log[entry, TURNS] + (log[entry, TRIED] == LEFT), DEAD - 1)
        words[at] = max(word & DEAD * LABEL, least * LABEL) | (word & ~(DEAD * LABEL | THIS_SEARCH))
    state[SPENT] += state[LOGGED]
    state[LOGGED] = 0


@HELPER
def _forget(search):
    """End a search before it has found anything; it is made anew with better labels."""
    for entry in range(search.state[LOGGED]):
        search.words[search.log[entry, AT]] &= ~THIS_SEARCH
    search.state[LOGGED] = 0


@APART
def _next_step(graph, search):
    """Settle who arrives in the next step, and begin with its first slot."""
    state, size = search.state, len(graph.out)
    state[STEP] += 1
    state[GOAL] = graph.first_goal
    for goal in range(graph.first_goal, size):
        settled = settle_slot(state[STEP] * size + goal, goal, graph, search.words)
        state[SERVED] += settled
        state[TOTAL] += settled * state[STEP]


@HELPER
def _next_slot(graph, search):
    """Begin a search from the slot under way, or go on to the next one."""
    words, log, heads, state = search.words, search.log, search.heads, search.state
    size, goal = len(graph.out), state[GOAL]
    if goal == size:
        _next_step(graph, search)
        return
    if state[STEP] < len(search.most) and state[SERVED] >= search.most[state[STEP]]:
        state[GOAL] = size
        return
    slot = state[STEP] * size + goal
    label = label_of(words[slot])
    if label == DEAD or words[slot] & FLOW >= graph.room[goal - graph.first_goal]:
        state[GOAL] += 1
        return
    for turns in range(len(heads)):
        heads[turns] = NOBODY
    heads[label] = 0
    log[0, AT], log[0, NODE], log[0, FROM], log[0, TURNS], log[0, NEXT] = slot, goal, NOBODY, 0, NOBODY
    words[slot] |= SEEN
    state[LOGGED], state[LIST], state[ENTRY] = 1, label, NOBODY


@kernel(types.int64(SLOT_GRAPH, SLOT_SEARCH, types.int64, types.int64))
def fill_slots(graph, search, robots, budget):
    """Fill the slots until all robots are settled, room or new labels are needed or `budget` nodes were looked at."""
    state = search.state
    state[BUDGET] = budget
    while state[SERVED] < robots:
        if state[BUDGET] <= 0:
            return BUDGET_SPENT
        if state[LOGGED] == 0:
            state[BUDGET] -= 1
            if state[GOAL] == len(graph.out) and state[STEP] == state[LAST]:
                return LAYERS_FULL
            _next_slot(graph, search)
            continue
        status = _look(graph, search)
        if status == LABELS_OLD:
            _forget(search)
        if status == LABELS_OLD or status == BUDGET_SPENT or status == LIST_FULL:
            return status
        if status == FOUND:
            turn(graph, search)
            state[SERVED] += 1
            state[TOTAL] += state[STEP]
        else:
            state[GOAL] += 1
        _close(status == FOUND, search)
    return DONE
