"""Legend: entries that several pictures have, and their colours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Ground
from trihex.pictures import palette
from trihex.pictures.palette import BARRIER, UNREACHED, Colour
from trihex.pictures.scene import Key, Ramp


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
