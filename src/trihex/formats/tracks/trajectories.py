"""Trajectories: what persons did, as JuPedSim writes it (sqlite) or as text that PedPy reads."""

from __future__ import annotations

import os
import re
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trihex.errors import FormatError
from trihex.files import read_bytes
from trihex.formats.text import Text, check_text
from trihex.plans import Trajectories

MAX_ROWS = 50_000_000
MAX_TEXT = 2**30
_HEAD = b"SQLite format 3\0"
_LARGEST = 1e9


def read_trajectories(path: str | os.PathLike[str]) -> Trajectories:
    """Return the trajectories of a file.

    ``.sqlite`` of JuPedSim, version 1 or 2, as `write_waypoints` writes it, too; or text with a line
    ``# framerate: 25`` and rows ``id frame x y``, in metres, parted by blanks or tabs; further columns are left alone.

    Raises
    ------
    FormatError
        If the file is none of these, holds no one, or numbers that are none.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    is_sqlite = content.startswith(_HEAD)
    rate, table = _from_sqlite(content, path) if is_sqlite else _from_text(check_text(content, path, MAX_TEXT), path)
    if not 1e-6 <= rate <= 1e6:
        raise FormatError(f"{path}: the frame rate must be 1e-06 to 1e+06 frames a second, not {rate:g}")
    if len(table) == 0:
        raise FormatError(f"{path}: there must be at least one person")
    if not (np.abs(table) <= _LARGEST).all():
        raise FormatError(f"{path}: all numbers must be at most {_LARGEST:g}")
    numbers = table[:, :2]
    if (numbers != np.rint(numbers)).any():
        raise FormatError(f"{path}: persons and frames must be whole numbers")
    order = np.lexsort((table[:, 1], table[:, 0]))
    table = table[order]
    same = np.flatnonzero((table[1:, :2] == table[:-1, :2]).all(axis=1))
    if same.size:
        person, frame = table[same[0], :2].astype(np.int64).tolist()
        raise FormatError(f"{path}: person {person} must have one place in frame {frame}, not two")
    frames = table[:, 1].astype(np.int64)
    _, person = np.unique(table[:, 0], return_inverse=True)
    return Trajectories(Path(path).name, float(rate), person, frames - frames.min(), table[:, 2], table[:, 3])


def _from_sqlite(content: bytes, path: object) -> tuple[float, NDArray[np.float64]]:
    try:
        with closing(sqlite3.connect(":memory:")) as connection:
            connection.deserialize(content)
            (rate,) = connection.execute("SELECT value FROM metadata WHERE key = 'fps'").fetchone()
            (rows,) = connection.execute("SELECT count(*) FROM trajectory_data").fetchone()
            if rows > MAX_ROWS:
                raise FormatError(f"{path}: may have at most {MAX_ROWS} rows, not {rows}")
            found = connection.execute("SELECT id, frame, pos_x, pos_y FROM trajectory_data").fetchall()
            return float(rate), np.array(found, dtype=np.float64).reshape(-1, 4)
    except (sqlite3.Error, TypeError, ValueError, OverflowError) as error:
        raise FormatError(f"{path}: is no file of trajectories of JuPedSim: {str(error)[:100]}") from None


def _from_text(checked: Text, path: object) -> tuple[float, NDArray[np.float64]]:
    text = checked.decode()
    told = re.search(r"^#.*framerate:?\s*([0-9.eE+]+)", text, re.MULTILINE)
    if told is None:
        raise FormatError(f"{path}: must be an sqlite file of JuPedSim, or text with a line '# framerate: N'")
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            rows.append([float(value) for value in line.split()[:4]])
        except ValueError:
            raise FormatError(f"{path}: line {number}: must be id, frame, x and y, not {line.strip()[:40]!r}") from None
        if len(rows[-1]) < 4:
            raise FormatError(f"{path}: line {number}: must be id, frame, x and y, not {line.strip()[:40]!r}")
    try:
        rate = float(told[1])
    except ValueError:
        rate = 0.0
    return rate, np.array(rows, dtype=np.float64).reshape(-1, 4)
