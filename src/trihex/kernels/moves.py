"""Which moves the barriers and the corner rule leave open at each site."""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, MASK, OUT_BOOL, OUT_U16, TABLE_I32, _array

IN_TABLE_ROW = _array(types.int32, True)
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2


@njit(types.void(MASK, types.int64, types.int64, OUT_BOOL), cache=True, nogil=True)
def fill_blocked(barriers, origin, pitch, blocked):
    """Copy `barriers` (height, width) into the padded `blocked`, where the padding is blocked."""
    blocked[:] = True
    height, width = barriers.shape
    for y in range(height):
        site = origin + y * pitch
        for x in range(width):
            blocked[site + x] = barriers[y, x]


@njit(
    types.boolean(IN_BOOL, types.int64, types.int64, types.int64, IN_TABLE_ROW, types.int64),
    cache=True,
    nogil=True,
)
def _is_corner_open(blocked, site, target, vertex, ring, rule):
    """Tell whether `rule` lets a robot pass `vertex` on its way from `site` to `target`."""
    around = len(ring)
    start = 0
    while vertex + ring[start] != site:
        start += 1
    barriers_of_side = 0
    clear_sides = 0
    for step in range(1, around + 1):
        at = vertex + ring[(start + step) % around]
        if at == target or at == site:  # one side of the way round the vertex ends here
            clear_sides += barriers_of_side == 0
            if rule == NO_CUT and barriers_of_side:
                return False
            barriers_of_side = 0
        elif blocked[at]:
            barriers_of_side += 1
    return clear_sides > 0


@njit(
    types.void(
        IN_BOOL,
        types.int64,
        types.int64,
        TABLE_I32,
        TABLE_I32,
        IN_TABLE_ROW,
        types.int64,
        types.int64,
        OUT_U16,
    ),
    cache=True,
    nogil=True,
)
def fill_moves(blocked, first, last, offset, vertex, ring, edge_count, rule, moves):
    """Set bit k of ``moves[site]`` where direction k may be taken, for the sites first..last-1; 0 at barriers."""
    directions = offset.shape[1]
    moves[:] = 0
    for site in range(first, last):
        if blocked[site]:
            continue
        parity = site & 1
        bits = 0
        for k in range(directions):
            target = site + offset[parity, k]
            if blocked[target]:
                continue
            if k >= edge_count and rule != ALLOW:
                if not _is_corner_open(blocked, site, target, site + vertex[parity, k], ring, rule):
                    continue
            bits |= 1 << k
        moves[site] = bits
