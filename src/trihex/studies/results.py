"""Results: the rows of a study as CSV or Parquet, written one by one, and read."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Iterator
from io import StringIO
from itertools import islice
from pathlib import Path
from typing import Any

from trihex.errors import FormatError, MissingExtraError
from trihex.files import new_file, suffix_of
from trihex.formats import read_text
from trihex.studies.row import COLUMNS, Row

SUFFIXES = (".csv", ".parquet")
_ROWS_AT_ONCE = 10_000
# What columns hold: those of studies, and those that comparisons alone have.
_TYPES: dict[str, type] = {**COLUMNS, "reference": int, "is_proven": bool, "seconds": float}


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


def read_results(path: str | os.PathLike[str]) -> list[Row]:
    """Return the rows of a table that `trihex study` or `trihex compare` has written, with numbers as numbers.

    Parameters
    ----------
    path : path
        .csv or .parquet.

    Returns
    -------
    list of dict
        By the names of the columns; None where the table is empty. Columns of your own are kept as text.

    Raises
    ------
    FormatError
        If it is no such table; the message names line and column.
    OSError
        If it cannot be read.
    """
    if suffix_of(path, SUFFIXES, "results") == ".csv":
        return list(_read_csv(path))
    arrow, parquet = _import_pyarrow()
    try:
        table = parquet.read_table(path)
    except arrow.ArrowInvalid as error:
        raise FormatError(f"{path}: is no Parquet file: {' '.join(str(error).split())[:200]}") from None
    _check_columns(table.column_names, path)
    rows: list[Row] = table.to_pylist()
    return rows


def _read_csv(path: str | os.PathLike[str]) -> Iterator[Row]:
    lines = csv.reader(StringIO(read_text(path).decode(), newline=""), strict=True)
    try:
        header = next(lines)
        _check_columns(header, path)
        for values in lines:
            where = f"{path}: line {lines.line_num}"
            if len(values) != len(header):
                raise FormatError(f"{where}: there must be {len(header)} columns, as in the header, not {len(values)}")
            pairs = zip(header, values, strict=True)
            yield {name: _value_of(text, _TYPES.get(name, str), f"{where}: {name}") for name, text in pairs}
    except csv.Error as error:
        raise FormatError(f"{path}: line {lines.line_num}: is no CSV: {error}") from None


def _check_columns(names: list[str], path: str | os.PathLike[str]) -> None:
    """Raise unless the columns are those of results, in whatever order."""
    for name in ("tessellation", "planner", "total_time", "gap"):
        if name not in names:
            raise FormatError(f"{path}: is no table of a study or comparison: there is no column {name!r}")


def _value_of(text: str, kind: type, what: str) -> Any:
    if text == "":
        return None
    if kind is bool:
        if text not in ("True", "False"):
            raise FormatError(f"{what} must be True or False, not {text!r:.80}")
        return text == "True"
    try:
        return kind(text)
    except ValueError:
        rule = {int: "a whole number", float: "a number"}[kind]
        raise FormatError(f"{what} must be {rule}, not {text!r:.80}") from None


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
