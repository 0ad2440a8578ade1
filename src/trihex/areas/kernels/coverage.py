"""Which cells a raster of occupied squares makes barriers."""

from math import floor

from numba import njit, types

from trihex.kernels.signatures import IN_I64, MASK, OUT_BOOL

_F64 = types.float64
_IN_F64 = types.Array(_F64, 1, "C", readonly=True)
_STAR = types.Array(_F64, 3, "C", readonly=True)


@njit(types.boolean(_F64, _F64, _F64, _F64, _F64, _F64, _F64, _F64), cache=True, nogil=True)
def _is_crossed(ax, ay, bx, by, west, north, east, south):
    """Tell whether the segment a-b meets the box (Liang and Barsky's clipping)."""
    enter, leave = 0.0, 1.0
    for start, way, low, high in ((ax, bx - ax, west, east), (ay, by - ay, north, south)):
        if way == 0.0:
            if start < low or start > high:
                return False
        else:
            one, other = (low - start) / way, (high - start) / way
            enter = max(enter, min(one, other))
            leave = min(leave, max(one, other))
    return enter <= leave


@njit(_F64(_F64, _F64, _F64, _F64, _F64, _F64), cache=True, nogil=True)
def _square_to_box(x, y, west, north, east, south):
    """Return the squared distance of a point to a box."""
    dx = max(west - x, 0.0, x - east)
    dy = max(north - y, 0.0, y - south)
    return dx * dx + dy * dy


@njit(_F64(_F64, _F64, _F64, _F64, _F64, _F64), cache=True, nogil=True)
def _square_to_segment(x, y, ax, ay, bx, by):
    """Return the squared distance of a point to the segment a-b, which has a length."""
    wx, wy = bx - ax, by - ay
    along = min(1.0, max(0.0, ((x - ax) * wx + (y - ay) * wy) / (wx * wx + wy * wy)))
    dx, dy = ax + along * wx - x, ay + along * wy - y
    return dx * dx + dy * dy


@njit(types.boolean(_F64, _F64, _F64, _F64, _F64, _F64, _F64, _F64, _F64), cache=True, nogil=True)
def _is_near(ax, ay, bx, by, west, north, east, south, limit):
    """Tell whether the squared distance between the segment a-b and the box is at most `limit`.

    Two convex shapes that do not meet are nearest at a corner of one of them.
    """
    return (
        _square_to_box(ax, ay, west, north, east, south) <= limit
        or _square_to_box(bx, by, west, north, east, south) <= limit
        or _square_to_segment(west, north, ax, ay, bx, by) <= limit
        or _square_to_segment(east, north, ax, ay, bx, by) <= limit
        or _square_to_segment(west, south, ax, ay, bx, by) <= limit
        or _square_to_segment(east, south, ax, ay, bx, by) <= limit
        or _is_crossed(ax, ay, bx, by, west, north, east, south)
    )


@njit(
    types.void(MASK, _F64, _F64, types.boolean, _IN_F64, _IN_F64, IN_I64, _STAR, OUT_BOOL),
    cache=True,
    nogil=True,
)
def fill_covered(occupied, pixel, radius, is_outside_occupied, centre_x, centre_y, orientation, star, covered):
    """Tell for each cell whether an occupied square lies within `radius` of one of its arms.

    Lengths are in edge steps from the north-west corner of the raster, whose squares are `pixel` wide; ``star[o, k]``
    is the end of arm k, relative to the centre of a cell of orientation o.
    """
    rows, columns = occupied.shape
    arms = star.shape[1]
    limit = radius * radius
    for cell in range(covered.size):
        x, y = centre_x[cell], centre_y[cell]
        own = star[orientation[cell]]
        west = east = x
        north = south = y
        for k in range(arms):
            west, east = min(west, x + own[k, 0]), max(east, x + own[k, 0])
            north, south = min(north, y + own[k, 1]), max(south, y + own[k, 1])
        west, east, north, south = west - radius, east + radius, north - radius, south + radius
        # The raster is convex: if the ends of all arms are deep enough inside, so are the arms.
        if is_outside_occupied and (west <= 0.0 or north <= 0.0 or east >= columns * pixel or south >= rows * pixel):
            covered[cell] = True
            continue
        covered[cell] = False
        for row in range(max(0, floor(north / pixel)), min(rows - 1, floor(south / pixel)) + 1):
            for column in range(max(0, floor(west / pixel)), min(columns - 1, floor(east / pixel)) + 1):
                if not occupied[row, column]:
                    continue
                left, top = column * pixel, row * pixel
                for k in range(arms):
                    if _is_near(x, y, x + own[k, 0], y + own[k, 1], left, top, left + pixel, top + pixel, limit):
                        covered[cell] = True
                        break
                if covered[cell]:
                    break
            if covered[cell]:
                break
