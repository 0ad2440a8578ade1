"""Generations of a field: how many times the synchronous automaton must update before each distance is right."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import IN_I32, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32, declared, kernel

# What `state` holds: which entry of the queue is read, where it ends, where the generation being read ends, its number.
AT, TAIL, GENERATION_END, GENERATION, STATE_SIZE = 0, 1, 2, 3, 4


class SettledField(NamedTuple):
    """Distances that are right, and the moves that lead to them."""

    distance: IN_I32
    moves: IN_U16  # open moves of each site
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    cost: IN_I32  # of each direction


class BreadthSearch(NamedTuple):
    """A search over the moves that attain distances."""

    state: OUT_I64  # see above
    queue: OUT_I32  # room for all free cells
    is_seen: OUT_BOOL


@kernel(types.void(declared(SettledField), declared(BreadthSearch), types.int64))
def count_generations(field, search, budget):
    """Go on with a search in breadth over the moves that attain distances, at most `budget` sites.

    A cell becomes right in generation g if g moves are the fewest with which a path attains its distance.
    """
    state, distance = search.state, field.distance
    stop = min(state[TAIL], state[AT] + budget)
    while state[AT] < stop:
        if state[AT] == state[GENERATION_END]:
            state[GENERATION_END] = state[TAIL]
            state[GENERATION] += 1
        site = search.queue[state[AT]]
        state[AT] += 1
        bits = field.moves[site]
        for k in range(len(field.cost)):
            target = site + field.offset[site & 1, k]
            is_attained = distance[target] == distance[site] + field.cost[k]
            if bits >> k & 1 and is_attained and not search.is_seen[target]:
                search.is_seen[target] = True
                search.queue[state[TAIL]] = target
                state[TAIL] += 1
