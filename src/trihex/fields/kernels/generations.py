"""Generations of a field: how many times the synchronous automaton must update before each distance is right."""

from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32

AT, TAIL, GENERATION_END, GENERATION, STATE_SIZE = 0, 1, 2, 3, 4


@njit(
    types.void(IN_I32, IN_U16, TABLE_I32, IN_I32, OUT_BOOL, OUT_I32, OUT_I64, types.int64),
    cache=True,
    nogil=True,
)
def count_generations(distance, moves, offset, cost, is_seen, queue, state, budget):
    """Go on with a search in breadth over the moves that attain distances, at most `budget` sites.

    A cell becomes right in generation g if g moves are the fewest with which a path attains its distance.
    """
    stop = min(state[TAIL], state[AT] + budget)
    while state[AT] < stop:
        if state[AT] == state[GENERATION_END]:
            state[GENERATION_END] = state[TAIL]
            state[GENERATION] += 1
        site = queue[state[AT]]
        state[AT] += 1
        bits = moves[site]
        for k in range(len(cost)):
            target = site + offset[site & 1, k]
            if bits >> k & 1 and distance[target] == distance[site] + cost[k] and not is_seen[target]:
                is_seen[target] = True
                queue[state[TAIL]] = target
                state[TAIL] += 1
