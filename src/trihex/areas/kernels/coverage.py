"""Which cells a raster of occupied squares makes barriers."""

from math import floor
from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I64, MASK, OUT_BOOL, declared, kernel

_F64 = types.float64
_IN_F64 = types.Array(_F64, 1, "C", readonly=True)
_STAR = types.Array(_F64, 3, "C", readonly=True)


class Raster(NamedTuple):
    """Squares of which some are occupied; lengths are in edge steps from their north-west corner."""

    occupied: MASK  # (rows, columns)
    square: _F64  # width of a square
    is_outside_occupied: types.boolean


class CellStars(NamedTuple):
    """Cells as stars, whose arms reach half way to the neighbours."""

    x: _IN_F64  # of their centres
    y: _IN_F64
    orientation: IN_I64
    arm: _STAR  # [o, k]: end of arm k relative to the centre of a cell of orientation o


class Box(NamedTuple):
    """A rectangle."""

    west: _F64
    north: _F64
    east: _F64
    south: _F64


class Arm(NamedTuple):
    """A segment from a to b, which has a length."""

    ax: _F64
    ay: _F64
    bx: _F64
    by: _F64


@HELPER
def _is_crossed(arm, box):
    """Tell whether an arm meets the box (Liang and Barsky's clipping)."""
    enter, leave = 0.0, 1.0
    for start, way, low, high in (
        (arm.ax, arm.bx - arm.ax, box.west, box.east),
        (arm.ay, arm.by - arm.ay, box.north, box.south),
    ):
        if way == 0.0:
            if start < low or start > high:
                return False
        else:
            one, other = (low - start) / way, (high - start) / way
            enter = max(enter, min(one, other))
            leave = min(leave, max(one, other))
    return enter <= leave


@HELPER
def _square_to_box(x, y, box):
    """Return the squared distance of a point to a box."""
    dx = max(box.west - x, 0.0, x - box.east)
    dy = max(box.north - y, 0.0, y - box.south)
    return dx * dx + dy * dy


@HELPER
def _square_to_arm(x, y, arm):
    """Return the squared distance of a point to an arm."""
    wx, wy = arm.bx - arm.ax, arm.by - arm.ay
    along = min(1.0, max(0.0, ((x - arm.ax) * wx + (y - arm.ay) * wy) / (wx * wx + wy * wy)))
    dx, dy = arm.ax + along * wx - x, arm.ay + along * wy - y
    return dx * dx + dy * dy


@HELPER
def _is_near(arm, box, limit):
    """Tell whether the squared distance between an arm and the box is at most `limit`.

    Two convex shapes that do not meet are nearest at a corner of one of them.
    """
    return (
        _square_to_box(arm.ax, arm.ay, box) <= limit
        or _square_to_box(arm.bx, arm.by, box) <= limit
        or _square_to_arm(box.west, box.north, arm) <= limit
        or _square_to_arm(box.east, box.north, arm) <= limit
        or _square_to_arm(box.west, box.south, arm) <= limit
        or _square_to_arm(box.east, box.south, arm) <= limit
        or _is_crossed(arm, box)
    )


@HELPER
def _reach_of_star(cell, radius, stars):
    """Return the box that holds all points within `radius` of the arms of a cell."""
    x, y, o = stars.x[cell], stars.y[cell], stars.orientation[cell]
    west = east = x
    north = south = y
    for k in range(stars.arm.shape[1]):
        end_x, end_y = x + stars.arm[o, k, 0], y + stars.arm[o, k, 1]
        west, east = min(west, end_x), max(east, end_x)
        north, south = min(north, end_y), max(south, end_y)
    return Box(west - radius, north - radius, east + radius, south + radius)


@HELPER
def _is_any_arm_near(cell, stars, box, limit):
    """Tell whether the squared distance between the arms of a cell and the box is at most `limit`."""
    x, y, o = stars.x[cell], stars.y[cell], stars.orientation[cell]
    for k in range(stars.arm.shape[1]):
        arm = Arm(x, y, x + stars.arm[o, k, 0], y + stars.arm[o, k, 1])
        if _is_near(arm, box, limit):
            return True
    return False


@HELPER
def _is_touched(cell, reach, raster, stars, limit):
    """Tell whether an occupied square within `reach` of a cell is near enough to one of its arms."""
    rows, columns = raster.occupied.shape
    square = raster.square
    for row in range(max(0, floor(reach.north / square)), min(rows - 1, floor(reach.south / square)) + 1):
        for column in range(max(0, floor(reach.west / square)), min(columns - 1, floor(reach.east / square)) + 1):
            if raster.occupied[row, column]:
                left, top = column * square, row * square
                if _is_any_arm_near(cell, stars, Box(left, top, left + square, top + square), limit):
                    return True
    return False


@kernel(types.void(declared(Raster), declared(CellStars), _F64, OUT_BOOL))
def fill_covered(raster, stars, radius, covered):
    """Tell for each cell whether an occupied square lies within `radius` of one of its arms."""
    rows, columns = raster.occupied.shape
    width, height = columns * raster.square, rows * raster.square
    for cell in range(covered.size):
        reach = _reach_of_star(cell, radius, stars)
        # The raster is convex: if the ends of all arms are deep enough inside, so are the arms.
        leaves = reach.west <= 0.0 or reach.north <= 0.0 or reach.east >= width or reach.south >= height
        if raster.is_outside_occupied and leaves:
            covered[cell] = True
        else:
            covered[cell] = _is_touched(cell, reach, raster, stars, radius * radius)
