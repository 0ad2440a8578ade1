"""Table: CSV text of whole numbers and words, as the plan and the starts have it."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import FormatError
from trihex.formats.text import Text

if TYPE_CHECKING:
    from trihex.formats.kernels.table_text import Spelling

# Rows read in one call of the kernel, some 10 ms: Ctrl-C works in between.
_BUDGET = 200_000


def parse_table(
    text: Text,
    path: object,
    header: str,
    words: dict[str, list[str]],
    progress: Callable[[int, int], None] | None = None,
) -> NDArray[np.int64]:
    """Return the columns below the header, shape (columns, rows); row i is line i + 2 of the file.

    Parameters
    ----------
    text : Text
        Lines end in LF or CRLF.
    path : path
        For messages.
    header : str
        The first line, names parted by commas.
    words : dict of lists
        For each column that holds words instead of whole numbers, the words; they come out as indexes.
    progress : callable, optional
        Called with (rows read, all rows).

    Raises
    ------
    FormatError
        If the header is another, or a row has too few or too many columns or something else in one of them.
    """
    from trihex.formats.kernels import table_text

    first, _, body = text.partition(b"\n")
    if first.strip() != header.encode():
        raise FormatError(f"{path}: line 1: the header must be {header!r}, not {first.strip().decode()[:80]!r}")
    names = header.split(",")
    known = [word for column in words.values() for word in column]
    spelling = spelling_of(known)
    letters = np.frombuffer(body.rstrip(b"\r\n") + b"\n" if body.strip() else b"", dtype=np.uint8)
    table = np.empty((len(names), np.count_nonzero(letters == ord("\n"))), dtype=np.int64)
    is_word = np.array([name in words for name in names])
    state = np.zeros(4, dtype=np.int64)
    while state[1] < table.shape[1]:
        wrong = table_text.parse_table(letters, is_word, spelling, _BUDGET, state, table)
        if wrong:
            _, row, column, begin = state.tolist()
            line, _, _ = body[begin:].partition(b"\n")
            _complain(f"{path}: line {row + 2}", wrong, names, column, line.decode(), known)
        if progress is not None:
            progress(int(state[1]), table.shape[1])
    return table


def _complain(where: str, wrong: int, names: list[str], column: int, line: str, words: list[str]) -> None:
    """Raise for what the kernel found, `line` being the rest of the line from the faulty column on."""
    from trihex.formats.kernels import table_text

    name, value = names[column], line.partition(",")[0].strip()[:40]
    if column == 0 and not line.strip():
        raise FormatError(f"{where}: the line is empty; there must be {len(names)} columns")
    if wrong == table_text.TOO_FEW:
        raise FormatError(f"{where}: there must be {len(names)} columns ({','.join(names)}), not {column + 1}")
    if wrong == table_text.TOO_MANY:
        count = len(names) + line.count(",")
        raise FormatError(f"{where}: there must be {len(names)} columns ({','.join(names)}), not {count}")
    if wrong == table_text.NO_NUMBER:
        raise FormatError(f"{where}: {name} must be a whole number of at most 18 digits, not {value!r}")
    near = get_close_matches(value, words, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise FormatError(f"{where}: {name} must be one of {', '.join(dict.fromkeys(words))}, not {value!r}{hint}")


def check_inside(x: NDArray[np.int64], y: NDArray[np.int64], area: Area, path: object) -> None:
    """Raise FormatError for the first line of a table whose cell (x, y) lies outside `area`."""
    outside = (x < 0) | (y < 0) | (x >= area.width) | (y >= area.height)
    if outside.any():
        row = int(np.argmax(outside))
        raise FormatError(
            f"{path}: line {row + 2}: cell ({x[row]}, {y[row]}) lies outside the area: "
            f"x is 0..{area.width - 1}, y is 0..{area.height - 1}"
        )


def spelling_of(words: list[str]) -> Spelling:
    """Return ASCII words as kernels take them."""
    from trihex.formats.kernels.table_text import Spelling
    from trihex.kernels.signatures import given

    letters = np.frombuffer("".join(words).encode(), dtype=np.uint8)
    own: Spelling = given(Spelling, letters=letters, first=np.cumsum([0, *map(len, words)], dtype=np.int64))
    return own
