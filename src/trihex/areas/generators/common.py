"""What all generators ask of their parameters, and the name that they give an area."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import MAX_CELLS, Area
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, check_whole


def begin_area(
    tessellation: Tessellation | str, height: int, width: int, seed: int
) -> tuple[Tessellation, np.random.Generator]:
    """Return the tessellation and what draws random numbers, or raise AreaError."""
    if isinstance(tessellation, str):
        tessellation = Tessellation(tessellation)
    check_whole("height", height, 1, None, AreaError)
    check_whole("width", width, 1, None, AreaError)
    if height * width > MAX_CELLS:
        raise AreaError(f"an area may have at most {MAX_CELLS} cells, not {width} x {height}")
    check_whole("seed", seed, 0, None, AreaError)
    return tessellation, np.random.default_rng(seed)


def check_share(parameter: str, value: object) -> None:
    """Raise AreaError unless `value` is a number from 0 to 1."""
    number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    if not number or not 0 <= float(value) <= 1:  # type: ignore[arg-type]
        raise AreaError(f"{parameter} must be a number from 0 to 1, not {value!r}")


def check_some_free(barriers: NDArray[np.bool_], density: float, seed: int) -> None:
    """Raise AreaError if all cells are barriers."""
    if barriers.all():
        height, width = barriers.shape
        raise AreaError(f"density must leave a free cell; {density} leaves none of {width} x {height} with seed {seed}")


def named_area(kind: str, tessellation: Tessellation, barriers: NDArray[np.bool_], seed: int) -> Area:
    """Return the area, named by its kind, its size (x before y, as everywhere) and its seed."""
    height, width = barriers.shape
    return Area(tessellation, barriers, f"{kind} {width} x {height}, seed {seed}")
