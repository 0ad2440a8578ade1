"""Legend: entries that several pictures have, and their colours."""

from __future__ import annotations

from math import floor, log10

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Ground
from trihex.pictures import palette
from trihex.pictures.palette import BARRIER, UNREACHED, Colour
from trihex.pictures.scene import Bar, Key, Ramp

# Of the scale, in pixels: a bar is as long as a round length can be within this.
_MOST_BAR, _LEAST_BAR = 120.0, 24.0


def barrier_colour(ground: Ground | None) -> Colour:
    """Return the colour of barriers, which are lighter where the picture shows what stands in the world."""
    return BARRIER if ground is None else palette.TIGHT


def barrier_keys(area: Area, ground: Ground | None = None) -> list[Key | Ramp]:
    """Return what barriers are, if there are some, and what stands in the world."""
    keys: list[Key | Ramp] = []
    if area.free_count < area.cell_count:
        keys.append(Key("cell", barrier_colour(ground), "barrier" if ground is None else "no room"))
    return keys if ground is None else [Key("cell", palette.GROUND, "occupied"), *keys]


def unreached_keys(is_needed: bool | np.bool_) -> list[Key | Ramp]:
    """Return what cells are that cannot be reached, if there are some."""
    return [Key("cell", UNREACHED, "not reached")] if is_needed else []


def colours_of(shades: NDArray[np.uint8]) -> tuple[Colour, ...]:
    """Return the shades as the legend takes them."""
    return tuple(tuple(shade) for shade in shades.tolist())


def scale_bars(area: Area, scale: float) -> list[Bar]:
    """Return the scale of a picture, 1, 2 or 5 of a power of ten metres, if the area lies in the world."""
    if area.frame is None:
        return []
    across, _ = area.tessellation.extent(area.height, area.width)
    most = max(_LEAST_BAR, min(_MOST_BAR, across * scale / 2)) / scale * area.frame.cell_size
    power = floor(log10(most))
    digit = next(digit for digit in (5, 2, 1) if digit <= most / 10.0**power * (1 + 1e-9) or digit == 1)
    metres = float(f"{digit}e{power}")
    words = f"{metres / 1000:g} km" if metres >= 1000 else f"{metres:g} m"
    return [Bar(metres / area.frame.cell_size, words)]
