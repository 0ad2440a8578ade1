"""Pixels of cells and of discs.

All three tessellations are the Voronoi cells of their centres, and the centres of two cells that share an edge are 1
apart. So a point lies in a cell iff it is at most half an edge step beyond the centre towards each edge neighbour; if
it is further, it is nearer to that neighbour. Walking to that neighbour, from the cell of the pixel before, finds the
cell of a point with about one test, knows how far the next edge is, and knows no shapes.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_U8, _array, declared, kernel

IMAGE = types.Array(types.uint8, 3, "C")
IN_F64 = _array(types.float64, True)


class Paint(NamedTuple):
    """What colour cells have."""

    colour_of_cell: types.Array(types.uint8, 2, "C", readonly=True)  # row of `rgb`, (height, width)
    rgb: types.Array(types.uint8, 2, "C", readonly=True)  # the last row is the page around the area
    weight: IN_F64  # how much a sample of each colour counts, so that a thin wall outlives a small picture


class Lattice(NamedTuple):
    """Where cells lie, in edge steps; the first axis of tables is the orientation of the cell."""

    step: types.Array(types.int64, 3, "C", readonly=True)  # what each edge move adds to (x, y)
    unit: types.Array(types.float64, 3, "C", readonly=True)  # the way to the centre that lies there
    pitch: types.int64  # orientation is the parity of y * pitch + x
    first_x: types.float64  # centre of cell (0, 0)
    first_y: types.float64


class Sampling(NamedTuple):
    """How pixels are made of points."""

    scale: types.float64  # pixels per edge step
    samples: types.int64  # points across a pixel, and down
    outline: types.float64  # points nearer to an edge than this, in edge steps, are darkened


class Spot(NamedTuple):
    """A cell and its centre."""

    x: types.int64
    y: types.int64
    centre_x: types.float64
    centre_y: types.float64


@HELPER
def _walk_to(px, py, place, lattice):
    """Return the cell in which a point lies, and how far the next edge is; the walk starts at `place`."""
    x, y, cx, cy = place.x, place.y, place.centre_x, place.centre_y
    while True:
        parity = (y * lattice.pitch + x) & 1
        dx = px - cx
        dy = py - cy
        most = -1.0
        across = 0
        for k in range(lattice.unit.shape[1]):
            along = dx * lattice.unit[parity, k, 0] + dy * lattice.unit[parity, k, 1]
            if along > most:
                most = along
                across = k
        if most <= 0.5 + 1e-9:  # each step comes nearer to the point, so the walk ends
            return Spot(x, y, cx, cy), 0.5 - most
        x += lattice.step[parity, across, 0]
        y += lattice.step[parity, across, 1]
        cx += lattice.unit[parity, across, 0]
        cy += lattice.unit[parity, across, 1]


@HELPER
def _colour_at(place, away, paint, outline):
    """Return the colour of a point `away` from the next edge, its weight, and the weight it shines with."""
    height, width = paint.colour_of_cell.shape
    inside = 0 <= place.x < width and 0 <= place.y < height
    colour = np.int64(paint.colour_of_cell[place.y, place.x]) if inside else len(paint.rgb) - 1
    share = paint.weight[colour]
    return colour, share, share * 0.82 if inside and away < outline else share


@kernel(
    types.void(declared(Paint), declared(Lattice), declared(Sampling), types.int64, types.int64, IMAGE),
    fastmath={"nnan", "ninf", "nsz"},
)
def shade(paint, lattice, sampling, first, last, out):
    """Paint pixel rows first..last-1 of `out` (height, width, 3), each pixel the weighted mean of its samples."""
    pixel = 1 / sampling.scale
    reach = 0.75 * pixel + sampling.outline  # a pixel whose middle is further from the edges has but one colour
    row = Spot(np.int64(0), np.int64(0), lattice.first_x, lattice.first_y)
    for i in range(first, last):
        place = row
        for j in range(out.shape[1]):
            place, away = _walk_to((j + 0.5) * pixel, (i + 0.5) * pixel, place, lattice)
            if j == 0:
                row = place
            many = 1 if away > reach else sampling.samples
            red, green, blue, total = 0.0, 0.0, 0.0, 0.0
            for down in range(many):
                py = (i + (down + 0.5) / many) * pixel
                for right in range(many):
                    if many > 1:
                        place, away = _walk_to((j + (right + 0.5) / many) * pixel, py, place, lattice)
                    colour, share, shine = _colour_at(place, away, paint, sampling.outline)
                    red += shine * paint.rgb[colour, 0]
                    green += shine * paint.rgb[colour, 1]
                    blue += shine * paint.rgb[colour, 2]
                    total += share
            out[i, j, 0] = np.uint8(red / total + 0.5)
            out[i, j, 1] = np.uint8(green / total + 0.5)
            out[i, j, 2] = np.uint8(blue / total + 0.5)


@kernel(types.void(IN_F64, IN_F64, types.float64, IN_U8, IMAGE))
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


@kernel(types.void(types.Array(types.uint8, 3, "C", readonly=True), IN_U8, types.Array(types.uint8, 2, "C")))
def look_up(image, index_of_colour, out):
    """Fill `out` with the palette index of each pixel; the upper 5 bits of each band are the place to look."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            key = (image[i, j, 0] >> 3) << 10 | (image[i, j, 1] >> 3) << 5 | image[i, j, 2] >> 3
            out[i, j] = index_of_colour[key]
