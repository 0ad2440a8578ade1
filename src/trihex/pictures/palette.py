"""Palette: the colours of pictures, told apart by colour-blind readers too.

The colours of things follow Okabe & Ito (2008), the ramps ColorBrewer's YlGnBu and OrRd, which are safe for the common
kinds of colour blindness and grow darker all the way, so that they survive a grey printer.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Colour: TypeAlias = tuple[int, int, int]

PAGE: Colour = (255, 255, 255)
INK: Colour = (32, 33, 36)
FREE: Colour = (244, 244, 240)
BARRIER: Colour = (58, 61, 66)
# Where the picture shows what stands in the world, barriers are only where robots do not fit.
GROUND: Colour = BARRIER
TIGHT: Colour = (196, 199, 204)
DESTINATION: Colour = (0, 158, 115)
UNREACHED: Colour = (188, 186, 190)
# Robots, by the sets of the paper (section 2.1.1): filled, waiting, final; and those that never arrive.
MOVING: Colour = (0, 114, 178)
WAITING: Colour = (240, 150, 0)
FINAL: Colour = (238, 160, 214)
STRANDED: Colour = (10, 10, 10)

# Colours to tell lines or bars apart, in this order; none of them is that of destinations or barriers.
SERIES: tuple[Colour, ...] = (
    (0, 114, 178),
    (213, 94, 0),
    (204, 121, 167),
    (86, 180, 233),
    (196, 154, 0),
    (90, 60, 150),
    (130, 130, 130),
)

# Near to far. It stops short of the dark end, so that no distance looks like a barrier.
_DISTANCE = [(255, 255, 204), (199, 233, 180), (127, 205, 187), (65, 182, 196), (29, 145, 192), (34, 94, 168)]
_VISITS = [(254, 232, 200), (253, 212, 158), (253, 187, 132), (252, 141, 89), (227, 74, 51), (160, 0, 0)]
# Round the compass, clockwise from north: light, blue, purple, red; opposite directions differ in more than hue.
_COMPASS = [(240, 230, 205), (95, 170, 225), (92, 66, 160), (214, 92, 60), (240, 230, 205)]


def _ramp(anchors: list[Colour], count: int) -> NDArray[np.uint8]:
    """Return `count` colours evenly spaced along `anchors`, shape (count, 3)."""
    at = np.linspace(0, len(anchors) - 1, count)
    bands = [np.interp(at, np.arange(len(anchors)), [colour[band] for colour in anchors]) for band in range(3)]
    return np.round(np.stack(bands, axis=-1)).astype(np.uint8)


def distance_ramp(count: int) -> NDArray[np.uint8]:
    """Return the colours of distances, near to far, shape (count, 3)."""
    return _ramp(_DISTANCE, count)


def visits_ramp(count: int) -> NDArray[np.uint8]:
    """Return the colours of numbers of visits, few to many, shape (count, 3)."""
    return _ramp(_VISITS, count)


def compass_ramp(count: int) -> NDArray[np.uint8]:
    """Return the colours of `count` directions, clockwise from north, shape (count, 3)."""
    return _ramp(_COMPASS, count + 1)[:-1]


def is_light(colour: Colour) -> bool:
    """Tell whether dark letters read better than white ones on a colour."""
    return 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2] > 140
