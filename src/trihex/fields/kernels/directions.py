"""Fields of directions: which moves attain the distance of each site.

Directions are told from half the distances modulo 2^15, in 16 bits: costs are even, and two neighbours that a move
joins differ by no more than its cost, at most 2000. So a vector instruction compares twice as many sites, and each
distance is read from memory once.
"""

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.signatures import IN_I32, OUT_U16, TABLE_I32

BLOCK = 4096  # even; what is known of a block of sites and its neighbours stays in the cache
HALF = np.uint16(2**15 - 1)
NOWHERE = np.uint16(2**15)  # at sites that are not reached; no distance has this bit


@intrinsic
def _or_if(typingctx, bits, condition, more):
    """Return ``bits | more`` if `condition`, else `bits`, in 16 bits; written with ``|`` it becomes one of 64 bits."""

    def generate(context, builder, signature, arguments):
        bits, condition, more = arguments
        return builder.or_(bits, builder.select(condition, more, ir.Constant(more.type, 0)))

    return types.uint16(types.uint16, types.boolean, types.uint16), generate


@njit(nogil=True)
def _halve(distance, halves):
    """Fill `halves` with half of each distance, or `NOWHERE`."""
    for i in range(len(halves)):
        half = np.uint16(distance[i] >> 1) & HALF
        halves[i] = NOWHERE if distance[i] == np.int32(NOT_REACHED) else half


@njit(nogil=True)
def _seen(halves, at, size, offset):
    return halves[at + offset : at + offset + size]


@njit(nogil=True)
def _add_four(halves, at, offset, step, k, bits):
    """Set the bits of the directions k..k+3 for sites of any orientation; the halves of the sites begin at `at`."""
    size = len(bits)
    here = _seen(halves, at, size, 0)
    there0, there1 = _seen(halves, at, size, offset[0, k]), _seen(halves, at, size, offset[0, k + 1])
    there2, there3 = _seen(halves, at, size, offset[0, k + 2]), _seen(halves, at, size, offset[0, k + 3])
    bit0, bit1, bit2, bit3 = np.uint16(1 << k), np.uint16(2 << k), np.uint16(4 << k), np.uint16(8 << k)
    for i in range(size):
        half = here[i]
        wanted = np.uint16(half - step) & HALF
        found = bit0 if wanted == there0[i] else np.uint16(0)
        found = _or_if(found, wanted == there1[i], bit1)
        found = _or_if(found, wanted == there2[i], bit2)
        found = _or_if(found, wanted == there3[i], bit3)
        bits[i] = _or_if(bits[i], half != NOWHERE, found)


@njit(nogil=True)
def _add_three(halves, at, offset, step, k, is_odd, bits):
    """Set the bits of the directions k..k+2 for sites of two orientations."""
    size = len(bits)
    here = _seen(halves, at, size, 0)
    even0, odd0 = _seen(halves, at, size, offset[0, k]), _seen(halves, at, size, offset[1, k])
    even1, odd1 = _seen(halves, at, size, offset[0, k + 1]), _seen(halves, at, size, offset[1, k + 1])
    even2, odd2 = _seen(halves, at, size, offset[0, k + 2]), _seen(halves, at, size, offset[1, k + 2])
    bit0, bit1, bit2 = np.uint16(1 << k), np.uint16(2 << k), np.uint16(4 << k)
    for i in range(size):
        half = here[i]
        wanted = np.uint16(half - step) & HALF
        # Both are looked up and one is taken: a choice between two addresses would be a gather, half as fast.
        even = bit0 if wanted == even0[i] else np.uint16(0)
        even = _or_if(even, wanted == even1[i], bit1)
        even = _or_if(even, wanted == even2[i], bit2)
        odd = bit0 if wanted == odd0[i] else np.uint16(0)
        odd = _or_if(odd, wanted == odd1[i], bit1)
        odd = _or_if(odd, wanted == odd2[i], bit2)
        found = odd if is_odd[i] else even
        bits[i] = _or_if(bits[i], half != NOWHERE, found)


@njit(types.void(IN_I32, TABLE_I32, IN_I32, types.int64, types.int64, OUT_U16), cache=True, nogil=True)
def fill_directions(distance, offset, cost, first, last, directions):
    """Set bit k of ``directions[site]`` where direction k attains the distance of the site; first..last-1, first even.

    Where a corner rule closes a move, its bit means nothing. Directions of equal cost follow one another in threes, or
    in fours where all cells have one orientation, which is so for all neighbourhoods.
    """
    reach = np.int64(0)
    together = 4
    for k in range(len(cost)):
        reach = max(reach, abs(np.int64(offset[0, k])), abs(np.int64(offset[1, k])))
        if offset[0, k] != offset[1, k]:
            together = 3
    is_odd = np.zeros(BLOCK, dtype=np.uint16)
    is_odd[1::2] = 1
    # Halves of the sites from `reach` before the block to `reach` after it: of the next block only the end is new.
    halves = np.empty(BLOCK + 2 * reach, dtype=np.uint16)
    _halve(distance[first - reach : first + reach], halves[: 2 * reach])
    for start in range(first, last, BLOCK):
        size = min(BLOCK, last - start)
        _halve(distance[start + reach : start + reach + size], halves[2 * reach : 2 * reach + size])
        bits = directions[start : start + size]
        bits[:] = 0
        for k in range(0, len(cost), together):
            step = np.uint16(cost[k] >> 1)
            if together == 4:
                _add_four(halves, reach, offset, step, k, bits)
            else:
                _add_three(halves, reach, offset, step, k, is_odd, bits)
        for i in range(2 * reach):
            halves[i] = halves[BLOCK + i]
