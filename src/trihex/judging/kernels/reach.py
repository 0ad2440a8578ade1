"""Reach: from where a lone robot gets to a destination."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.judging.kernels.law import ALLOW, LAW, is_blocked, is_corner_closed
from trihex.kernels.signatures import HELPER, IN_I32, OUT_I32, OUT_I64, OUT_U8, declared, kernel

# Marks of sites.
UNKNOWN, CLOSED, OPEN = 0, 1, 2
# Entries of `state`: which start is next; where in the queue the region under way begins, is looked from, and ends;
# whether it has a destination.
NEXT, FIRST, HEAD, TAIL, IS_OPEN = range(5)


class Flood(NamedTuple):
    """What has been searched so far."""

    mark: OUT_U8  # of each site: `UNKNOWN`; `CLOSED`, or `OPEN` once a destination is known to be connected with it
    queue: OUT_I32  # the sites found, one region after the other
    state: OUT_I64


FLOOD = declared(Flood)


@HELPER
def _add(site, search):
    search.mark[site] = CLOSED
    search.queue[search.state[TAIL]] = site
    search.state[TAIL] += 1


@HELPER
def _look_around(site, place, law, search):
    """Add the neighbours of a site that are not marked yet."""
    for k in range(law.offset.shape[1]):
        target = site + law.offset[site & 1, k]
        if is_blocked(place[target]) or search.mark[target] != UNKNOWN:
            continue
        if k >= law.edge_count and law.corner_rule != ALLOW:
            if is_corner_closed(site, target, site + law.vertex[site & 1, k], place, law):
                continue
        _add(target, search)


@kernel(types.void(IN_I32, IN_I32, LAW, FLOOD, types.int64))
def flood(start, place, law, search, budget):
    """Mark all that is connected with each site of `start`: `CLOSED`, or `OPEN` if a destination is among it.

    Goes on where the last call left off, for at most `budget` sites. A move is open both ways or not at all.
    """
    mark, queue, state = search
    while state[NEXT] < len(start) and budget > 0:
        if state[HEAD] == state[TAIL]:
            site = np.int64(start[state[NEXT]])
            if mark[site] != UNKNOWN:
                state[NEXT] += 1
                continue
            state[FIRST] = state[TAIL]
            state[IS_OPEN] = 0
            _add(site, search)
        site = np.int64(queue[state[HEAD]])
        state[HEAD] += 1
        budget -= 1
        state[IS_OPEN] |= place[site] < 0
        _look_around(site, place, law, search)
        if state[HEAD] == state[TAIL] and state[IS_OPEN]:
            for i in range(state[FIRST], state[TAIL]):
                mark[queue[i]] = OPEN
