"""Plan as Parquet: the columns of the CSV, for pandas, polars and all that read Arrow."""

from __future__ import annotations

import os
from collections.abc import Callable
from io import BytesIO
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import FormatError, MissingExtraError, check_choice
from trihex.files import new_file
from trihex.formats.plans.columns import columns_of, words_of_actions
from trihex.formats.plans.csv import plan_of_table
from trihex.formats.registry import PLAN_HEADER
from trihex.plans import Motion, Plan

# What a file may unpack to: rows take 48 bytes and more while they are read.
MAX_ROWS = 10**8
MAX_UNPACKED = 2**32


def write_plan_parquet(
    motion: Motion, path: str | os.PathLike[str], *, progress: Callable[[int, int], None] | None = None
) -> None:
    """Write a row for each robot and action, as in CSV: robot, step, x, y (int64), action (words), time (int64).

    Area, destinations and rules are not kept, as in CSV. Arrow writes all rows at once: no progress is told.

    Raises
    ------
    MissingExtraError
        If pyarrow is not installed.
    """
    arrow, parquet = _import_pyarrow()
    columns = columns_of(motion)
    # A word of a triangle that points south may be one of those that point north, too: each is kept once.
    distinct = list(dict.fromkeys(columns.words))
    index = np.array([distinct.index(one) for one in columns.words], dtype=np.int32)
    table = arrow.table(
        {
            "robot": columns.robot,
            "step": columns.step,
            "x": columns.x,
            "y": columns.y,
            "action": arrow.DictionaryArray.from_arrays(index[columns.word], distinct),
            "time": columns.time,
        }
    )
    # Arrow takes no path that is not UTF-8.
    with new_file(path) as part, open(part, "wb") as file:
        parquet.write_table(table, file, compression="zstd")


def parse_plan_parquet(
    content: bytes,
    path: str | os.PathLike[str],
    scenario: Scenario,
    progress: Callable[[int, int], None] | None = None,
) -> Plan:
    """Return the plan of a Parquet file with the columns of the CSV, read at once; see `parse_plan_csv`.

    Raises
    ------
    FormatError
        If the file is damaged or too large, a column is missing, or its rows make no plan.
    MissingExtraError
        If pyarrow is not installed.
    """
    arrow, parquet = _import_pyarrow()
    names = PLAN_HEADER.split(",")
    try:
        with parquet.ParquetFile(BytesIO(content)) as file:
            _check_metadata(file, path)
            columns = file.read(columns=names)
        text = columns["action"].cast(arrow.string())
        numbers = {name: columns[name].cast(arrow.int64()) for name in names if name != "action"}
    except (arrow.ArrowException, OSError, ValueError, RuntimeError) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError(f"{path}: is no whole Parquet file of a plan: {str(error).splitlines()[0]:.100}") from None
    for name in names:
        if columns[name].null_count:
            raise FormatError(f"{path}: column {name} must have a value in each row")
    words = _indexes(text, words_of_actions(scenario.area.tessellation), path)
    table = np.stack([words if name == "action" else numbers[name].to_numpy() for name in names])
    return plan_of_table(table, scenario, f"{path} (as CSV)")


def _check_metadata(file: Any, path: object) -> None:
    """Raise FormatError unless each column is there once, and not too much to unpack."""
    rows, groups = file.metadata.num_rows, file.metadata.num_row_groups
    unpacked = sum(file.metadata.row_group(group).total_byte_size for group in range(groups))
    if not (0 <= rows <= MAX_ROWS and 0 <= unpacked <= MAX_UNPACKED):
        raise FormatError(
            f"{path}: may have at most {MAX_ROWS} rows and {MAX_UNPACKED} bytes, not {rows} and {unpacked}"
        )
    names = file.schema_arrow.names
    for name in PLAN_HEADER.split(","):
        if names.count(name) != 1:
            raise FormatError(f"{path}: there must be one column {name!r}; the columns are {', '.join(names):.100}")


def _indexes(column: Any, words: list[str], path: object) -> NDArray[np.int64]:
    """Return the index in `words` of each entry of a column of text."""
    encoded = column.dictionary_encode().unify_dictionaries().combine_chunks()
    index_of_word = {word: index for index, word in reversed(list(enumerate(words)))}
    known = encoded.dictionary.to_pylist()
    for word in known:
        check_choice(f"{path}: action", word, dict.fromkeys(words), FormatError)
    index = np.array([index_of_word[word] for word in known], dtype=np.int64)
    return np.asarray(index[encoded.indices.to_numpy()])


def _import_pyarrow() -> tuple[ModuleType, ModuleType]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise MissingExtraError("Parquet needs pyarrow: pip install 'trihex[io]'") from None
    return pyarrow, pyarrow.parquet
