"""Rows: text as a rectangle of letters, one letter a cell."""

from __future__ import annotations

from dataclasses import replace
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Frame
from trihex.errors import FormatError
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft


def parse_rows(
    content: bytes, path: object, kind_of_letter: NDArray[np.uint8], hint: str, *, width: int = 0
) -> NDArray[np.uint8]:
    """Return the kinds of the letters, shape (height, width), of UTF-8 `content`.

    Parameters
    ----------
    content : bytes
        Lines that end in LF or CRLF; empty lines at the end do not count.
    path : path
        For messages.
    kind_of_letter : uint8 array, shape (256,)
        What each letter stands for; 255 for unknown ones.
    hint : str
        The known letters, for messages.
    width : int, optional
        Length of each row. Default: that of the first.

    Raises
    ------
    FormatError
        If the rows are ragged, or a letter is unknown.
    """
    content = content.rstrip(b"\r\n").replace(b"\r\n", b"\n") + b"\n"
    width = width or content.find(b"\n")
    if width and len(content) % (width + 1) == 0:
        lines = np.frombuffer(content, dtype=np.uint8).reshape(-1, width + 1)
        kinds = kind_of_letter[lines[:, :width]]
        if kinds.max() < 255 and (lines[:, width] == ord("\n")).all():
            return kinds
    _complain(content, path, kind_of_letter, hint, width)


def _complain(content: bytes, path: object, kind_of_letter: NDArray[np.uint8], hint: str, width: int) -> NoReturn:
    """Raise for the first row that has an unknown letter or the wrong length."""
    known = bytes(np.flatnonzero(kind_of_letter < 255).astype(np.uint8))
    for y, line in enumerate(content.splitlines()):
        if len(line) == width > 0 and not line.translate(None, known):
            continue
        row = line.decode()
        for x, letter in enumerate(row):
            if ord(letter) >= 128 or kind_of_letter[ord(letter)] == 255:
                raise FormatError(f"{path}: row {y}, column {x}: unknown letter {letter!r}; known are {hint}")
        if len(row) != width or width == 0:
            raise FormatError(f"{path}: ragged rows: row {y} has {len(row)} letters, it must have {width or 'some'}")
    raise FormatError(f"{path}: ragged rows")  # not reached: some row is wrong, or the caller would not ask


def framed(draft: Draft, options: AreaOptions, path: object) -> Draft:
    """Return a draft of one cell for each letter with a frame, if the options say how large a cell is.

    Raises
    ------
    FormatError
        If they have a radius of robots: there are no walls to keep away from.
    """
    if options.reach:
        raise FormatError(f"{path}: has one cell for each letter; robot_radius needs a place with walls in metres")
    if options.cell_size is None:
        return draft
    return replace(draft, area=replace(draft.area, frame=Frame(options.cell_size)))


def refuse_frame(frame: Frame | None, path: object) -> None:
    """Raise FormatError if there is a frame, for formats that have one cell for each letter or pixel."""
    if frame is not None:
        raise FormatError(
            f"{path}: the area lies in the world in metres, which this format cannot carry; write a scenario (.toml)"
        )
