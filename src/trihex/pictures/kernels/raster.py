"""Pixels of cells and of discs.

All three tessellations are the Voronoi cells of their centres, and the centres of two cells that share an edge are 1
apart. So a point lies in a cell iff it is at most half an edge step beyond the centre towards each edge neighbour; if
it is further, it is nearer to that neighbour. Walking to that neighbour, from the cell of the pixel before, finds the
cell of a point with about one test, knows how far the next edge is, and knows no shapes.
"""

import math

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import IN_U8, _array

IMAGE = types.Array(types.uint8, 3, "C")
CELLS = types.Array(types.uint8, 2, "C", readonly=True)
IN_F64 = _array(types.float64, True)
OUT_F64 = _array(types.float64, False)
UNITS = types.Array(types.float64, 3, "C", readonly=True)
STEPS = types.Array(types.int64, 3, "C", readonly=True)


@njit(nogil=True)
def _walk_to(px, py, step, unit, pitch, x, y, cx, cy):
    """Return (x, y) and centre of the cell in which the point lies, and how far the next edge is.

    The walk starts at the cell (x, y) with centre (cx, cy). `unit` (2 orientations, edges, 2) leads from a centre to
    those of the edge neighbours, `step` to their (x, y).
    """
    while True:
        parity = (y * pitch + x) & 1
        dx = px - cx
        dy = py - cy
        most = -1.0
        across = 0
        for k in range(unit.shape[1]):
            along = dx * unit[parity, k, 0] + dy * unit[parity, k, 1]
            if along > most:
                most = along
                across = k
        if most <= 0.5 + 1e-9:  # each step comes nearer to the point, so the walk ends
            return x, y, cx, cy, 0.5 - most
        x += step[parity, across, 0]
        y += step[parity, across, 1]
        cx += unit[parity, across, 0]
        cy += unit[parity, across, 1]


@njit(
    types.void(
        CELLS, CELLS, IN_F64, STEPS, UNITS, types.int64, IN_F64, types.float64, types.int64, types.float64,
        types.int64, types.int64, IMAGE,
    ),
    cache=True,
    nogil=True,
    fastmath={"nnan", "ninf", "nsz"},
)  # fmt: skip
def shade(colour_of_cell, rgb, weight, step, unit, pitch, first_centre, scale, samples, outline, first, last, out):
    """Paint pixel rows first..last-1 of `out` (height, width, 3), each pixel from samples * samples points.

    A pixel is the mean of its samples, weighted by colour, so that a thin wall outlives a small picture. Colours are
    rows of `rgb`; the last of them is that of the page around the area. Samples nearer to an edge than `outline` (in
    edge steps) are darkened. `scale` is in pixels per edge step.
    """
    height, width = colour_of_cell.shape
    page = len(rgb) - 1
    pixel = 1 / scale
    reach = 0.75 * pixel + outline  # a pixel whose middle is further from the edges has but one colour
    row_x, row_y, row_cx, row_cy = np.int64(0), np.int64(0), first_centre[0], first_centre[1]
    for i in range(first, last):
        x, y, cx, cy = row_x, row_y, row_cx, row_cy
        for j in range(out.shape[1]):
            x, y, cx, cy, away = _walk_to((j + 0.5) * pixel, (i + 0.5) * pixel, step, unit, pitch, x, y, cx, cy)
            if j == 0:
                row_x, row_y, row_cx, row_cy = x, y, cx, cy
            many = 1 if away > reach else samples
            red, green, blue, total = 0.0, 0.0, 0.0, 0.0
            for down in range(many):
                py = (i + (down + 0.5) / many) * pixel
                for right in range(many):
                    if many > 1:
                        px = (j + (right + 0.5) / many) * pixel
                        x, y, cx, cy, away = _walk_to(px, py, step, unit, pitch, x, y, cx, cy)
                    inside = 0 <= x < width and 0 <= y < height
                    colour = np.int64(colour_of_cell[y, x]) if inside else page
                    share = weight[colour]
                    shine = share * 0.82 if inside and away < outline else share
                    red += shine * rgb[colour, 0]
                    green += shine * rgb[colour, 1]
                    blue += shine * rgb[colour, 2]
                    total += share
            out[i, j, 0] = np.uint8(red / total + 0.5)
            out[i, j, 1] = np.uint8(green / total + 0.5)
            out[i, j, 2] = np.uint8(blue / total + 0.5)


@njit(types.void(IN_F64, IN_F64, types.float64, IN_U8, IMAGE), cache=True, nogil=True)
def paint_discs(x, y, radius, rgb, out):
    """Paint discs of one colour and radius (all in pixels) with soft edges onto `out` (height, width, 3)."""
    height, width = out.shape[0], out.shape[1]
    for disc in range(len(x)):
        reach = radius + 0.5
        top, bottom = max(0, int(y[disc] - reach - 0.5)), min(height, int(y[disc] + reach + 1.5))
        left, right = max(0, int(x[disc] - reach - 0.5)), min(width, int(x[disc] + reach + 1.5))
        for i in range(top, bottom):
            down = i + 0.5 - y[disc]
            for j in range(left, right):
                across = j + 0.5 - x[disc]
                cover = reach - math.sqrt(across * across + down * down)
                if cover <= 0.0:
                    continue
                cover = min(1.0, cover)
                out[i, j, 0] = np.uint8((1.0 - cover) * out[i, j, 0] + cover * rgb[0] + 0.5)
                out[i, j, 1] = np.uint8((1.0 - cover) * out[i, j, 1] + cover * rgb[1] + 0.5)
                out[i, j, 2] = np.uint8((1.0 - cover) * out[i, j, 2] + cover * rgb[2] + 0.5)


@njit(types.void(types.Array(types.uint8, 3, "C", readonly=True), IN_U8, types.Array(types.uint8, 2, "C")),
      cache=True, nogil=True)  # fmt: skip
def look_up(image, index_of_colour, out):
    """Fill `out` with the palette index of each pixel; the upper 5 bits of each band are the place to look."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            key = (image[i, j, 0] >> 3) << 10 | (image[i, j, 1] >> 3) << 5 | image[i, j, 2] >> 3
            out[i, j] = index_of_colour[key]
