"""Field as .npy: the distance or the directions of each cell, [y, x], as `numpy.load` reads it."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.files import new_file


def write_field(values: NDArray[Any], path: str | os.PathLike[str]) -> None:
    """Write an array of shape (height, width), such as ``NScheme.distance`` or ``DScheme.directions``."""
    with new_file(path) as part, open(part, "wb") as file:
        np.save(file, np.ascontiguousarray(values), allow_pickle=False)
