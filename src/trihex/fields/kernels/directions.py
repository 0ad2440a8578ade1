"""Fields of directions: which moves attain the distance of each site.

Directions are told from the distances modulo 2^15, their *rests*, in 16 bits: two neighbours that a move joins differ
by no more than its cost, at most 2000. So a vector instruction compares twice as many sites, and each distance is read
from memory once.
"""

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.signatures import HELPER, IN_I32, IN_U16, OUT_U16, TABLE_I32, kernel

BLOCK = 4096  # even; what is known of a block of sites and its neighbours stays in the cache
REST = np.uint16(2**15 - 1)
NOWHERE = np.uint16(2**15)  # at sites that are not reached; no distance has this bit
_U = np.uint64  # unsigned indices are not looked at whether they count from the end, which would forbid vectors


@intrinsic
def _or_if(typingctx, bits, condition, more):
    """Return ``bits | more`` if `condition`, else `bits`, in 16 bits; written with ``|`` it becomes one of 64 bits."""

    def generate(context, builder, signature, arguments):
        bits, condition, more = arguments
        return builder.or_(bits, builder.select(condition, more, ir.Constant(more.type, 0)))

    return types.uint16(types.uint16, types.boolean, types.uint16), generate


@HELPER
def _fold(distance, first, rests, at, size):
    """Fill `rests` from `at` on with the rests of the distances from `first` on, or `NOWHERE`."""
    for i in range(size):
        here = distance[_U(first + i)]
        rest = np.uint16(here) & REST
        rests[_U(at + i)] = NOWHERE if here == np.int32(NOT_REACHED) else rest


@HELPER
def _add_four(rests, reach, offset, step, k, directions, start, size):
    """Set the bits of the directions k..k+3 for sites of any orientation."""
    here, there0, there1 = _U(reach), _U(reach + offset[0, k]), _U(reach + offset[0, k + 1])
    there2, there3 = _U(reach + offset[0, k + 2]), _U(reach + offset[0, k + 3])
    bit0, bit1, bit2, bit3 = np.uint16(1 << k), np.uint16(2 << k), np.uint16(4 << k), np.uint16(8 << k)
    for j in range(size):
        i = _U(j)
        rest = rests[here + i]
        wanted = np.uint16(rest - step) & REST
        found = bit0 if wanted == rests[there0 + i] else np.uint16(0)
        found = _or_if(found, wanted == rests[there1 + i], bit1)
        found = _or_if(found, wanted == rests[there2 + i], bit2)
        found = _or_if(found, wanted == rests[there3 + i], bit3)
        directions[_U(start) + i] = _or_if(directions[_U(start) + i], rest != NOWHERE, found)


@HELPER
def _add_three(rests, reach, offset, step, k, is_odd, directions, start, size):
    """Set the bits of the directions k..k+2 for sites of two orientations."""
    here = _U(reach)
    even0, odd0 = _U(reach + offset[0, k]), _U(reach + offset[1, k])
    even1, odd1 = _U(reach + offset[0, k + 1]), _U(reach + offset[1, k + 1])
    even2, odd2 = _U(reach + offset[0, k + 2]), _U(reach + offset[1, k + 2])
    bit0, bit1, bit2 = np.uint16(1 << k), np.uint16(2 << k), np.uint16(4 << k)
    for j in range(size):
        i = _U(j)
        rest = rests[here + i]
        wanted = np.uint16(rest - step) & REST
        # Both are looked up and one is taken: a choice between two addresses would be a gather, rest as fast.
        even = bit0 if wanted == rests[even0 + i] else np.uint16(0)
        even = _or_if(even, wanted == rests[even1 + i], bit1)
        even = _or_if(even, wanted == rests[even2 + i], bit2)
        odd = bit0 if wanted == rests[odd0 + i] else np.uint16(0)
        odd = _or_if(odd, wanted == rests[odd1 + i], bit1)
        odd = _or_if(odd, wanted == rests[odd2 + i], bit2)
        found = odd if is_odd[i] else even
        directions[_U(start) + i] = _or_if(directions[_U(start) + i], rest != NOWHERE, found)


@HELPER
def _directions_together(offset):
    """Return of how many directions the bits are set at once: 4 where all cells have one orientation, or else 3."""
    for k in range(offset.shape[1]):
        if offset[0, k] != offset[1, k]:
            return 3
    return 4


@kernel(types.void(IN_I32, TABLE_I32, IN_I32, types.int64, types.int64, IN_U16, OUT_U16, OUT_U16))
def fill_directions(distance, offset, cost, first, last, is_odd, rests, directions):
    """Set bit k of ``directions[site]`` where direction k attains the distance of the site; first..last-1, first even.

    Where a corner rule closes a move, its bit means nothing. Directions of equal cost follow one another in threes, or
    in fours where all cells have one orientation, which is so for all neighbourhoods. `rests` is room for the rests
    of a block and of the sites before and behind it that a move reaches.
    """
    reach = (len(rests) - BLOCK) // 2
    together = _directions_together(offset)
    # Of the next block only the end is new.
    _fold(distance, first - reach, rests, 0, 2 * reach)
    for start in range(first, last, BLOCK):
        size = min(BLOCK, last - start)
        _fold(distance, start + reach, rests, 2 * reach, size)
        for i in range(size):
            directions[_U(start + i)] = 0
        for k in range(0, len(cost), together):
            step = np.uint16(cost[k])
            if together == 4:
                _add_four(rests, reach, offset, step, k, directions, start, size)
            else:
                _add_three(rests, reach, offset, step, k, is_odd, directions, start, size)
        for i in range(2 * reach):
            rests[_U(i)] = rests[_U(BLOCK + i)]
