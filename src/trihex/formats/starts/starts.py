"""Starts: where the robots of a file begin, whichever format it has."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import check_type
from trihex.files import read_bytes
from trihex.formats.recognise import format_of
from trihex.formats.registry import FORMATS
from trihex.formats.starts.csv import parse_slowness, parse_start_times
from trihex.formats.text import check_text


def read_starts(path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the cell numbers of robots, in the order of a file.

    Parameters
    ----------
    path : path
        CSV with the header `x,y` of cells or `x_metres,y_metres` of points in the world, or a MovingAI ``.scen``, of
        which only the starts are read. For columns `start` and `slowness` see `read_start_times` and `read_slowness`.
    area : Area

    Raises
    ------
    FormatError
        If a line is not of the form, or a place lies outside `area`.
    AreaError
        If places are given in metres and the area has no frame.
    OSError
        If the file cannot be read.
    """
    check_type("area", area, Area)
    content = read_bytes(path)
    form = FORMATS[format_of(content, path)]
    if form.holds != "starts":
        form = FORMATS["starts"]  # it will tell what is wrong
    cells: NDArray[np.int64] = form.parse(content, path, area)
    return cells


def read_start_times(path: str | os.PathLike[str]) -> NDArray[np.float64] | None:
    """Return when the robots of a file begin to move, or None if it does not tell.

    `start_times_of` makes steps of them: they are seconds in an area with a frame, and else steps.

    Parameters
    ----------
    path : path
        What `read_starts` takes; CSV tells it in a third column, `start`.

    Raises
    ------
    FormatError
        If the column holds something else than numbers from 0 on.
    OSError
        If the file cannot be read.
    """
    content = read_bytes(path)
    return parse_start_times(check_text(content, path), path) if format_of(content, path) == "starts" else None


def read_slowness(path: str | os.PathLike[str]) -> NDArray[np.int64] | NDArray[np.float64] | None:
    """Return the slowness of the robots of a file, or their speeds; None if it tells neither.

    Slowness is whole, as `Scenario` takes it; speeds are float64, in metres a second in an area with a frame, and
    `slowness_of` makes slowness of them.

    Parameters
    ----------
    path : path
        What `read_starts` takes; CSV tells it in its last column, `slowness` or `speed`.

    Raises
    ------
    FormatError
        If the column holds something else than whole numbers from 1 on, or speeds above 0.
    OSError
        If the file cannot be read.
    """
    content = read_bytes(path)
    return parse_slowness(check_text(content, path), path) if format_of(content, path) == "starts" else None
