"""Results: the rows of a study as CSV or Parquet, written one by one."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable
from itertools import islice
from pathlib import Path
from typing import Any

from trihex.errors import MissingExtraError
from trihex.files import new_file, suffix_of
from trihex.studies.row import COLUMNS, Row

SUFFIXES = (".csv", ".parquet")
_ROWS_AT_ONCE = 10_000


def check_results(path: str | os.PathLike[str]) -> None:
    """Raise unless results can be written in the format that the suffix of `path` names."""
    if suffix_of(path, SUFFIXES, "results") == ".parquet":
        _import_pyarrow()


def write_results(rows: Iterable[Row], path: str | os.PathLike[str]) -> None:
    """Write rows as they come; the file is there when all are, and on the disk.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    try:
        with new_file(path) as part:
            if suffix_of(path, SUFFIXES, "results") == ".csv":
                _write_csv(rows, part)
            else:
                _write_parquet(rows, part)
            with open(part, "rb") as file:
                os.fsync(file.fileno())
    except OSError as error:
        error.filename = str(path)
        raise


def _write_csv(rows: Iterable[Row], path: Path) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(COLUMNS), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _write_parquet(rows: Iterable[Row], path: Path) -> None:
    arrow, parquet = _import_pyarrow()
    types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string(), bool: arrow.bool_()}
    schema = arrow.schema([(name, types[kind]) for name, kind in COLUMNS.items()])
    rows = iter(rows)
    # Arrow takes no path that is not UTF-8.
    with open(path, "wb") as file, parquet.ParquetWriter(file, schema, compression="zstd") as writer:
        while some := list(islice(rows, _ROWS_AT_ONCE)):
            writer.write_table(arrow.Table.from_pylist(some, schema))


def _import_pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise MissingExtraError("Parquet needs pyarrow: pip install 'trihex[io]'") from None
    return pyarrow, pyarrow.parquet
