"""TOML: bytes of a file as a dictionary, and the mistakes in it as one error."""

from __future__ import annotations

import os
import re
import tomllib
from typing import Any

from trihex.errors import FormatError
from trihex.formats.registry import MAX_TOML
from trihex.formats.text import Text, read_text

# What is not closed ends with the file or the line, so that each byte is looked at once.
_QUOTED = re.compile(
    rb""" \"{3}.*?(?:\"{3}|\Z) | '{3}.*?(?:'{3}|\Z) | "(?:\\.|[^"\\\n])*"? | '[^'\n]*'? | \#[^\n]* """,
    re.DOTALL | re.VERBOSE,
)
_DEEPEST = 50
_MOST_MISTAKES = 20


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of a TOML file.

    Raises
    ------
    FormatError
        If the file is too long, no UTF-8, nested too deeply or no TOML.
    OSError
        If it cannot be read.
    """
    return parse_toml(read_text(path, MAX_TOML), path)


def parse_toml(text: Text, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of the text of a TOML file; see `read_toml`."""
    # A key of 100 000 parts takes tomllib 6 GB and minutes, because it keeps each beginning of it.
    if b"." * _DEEPEST in re.sub(rb"[\w \t-]+", b"", _QUOTED.sub(b"", text)):
        raise FormatError(f"{path}: is nested too deeply")
    try:
        return tomllib.loads(text.decode())
    except RecursionError:
        raise FormatError(f"{path}: is nested too deeply") from None
    except ValueError as error:
        raise FormatError(f"{path}: is no TOML: {error}") from None


def complaint(path: str | os.PathLike[str], mistakes: list[str]) -> FormatError:
    """Return the error that tells of all mistakes, a line each."""
    told = mistakes[:_MOST_MISTAKES]
    if len(mistakes) > len(told):
        told.append(f"and {len(mistakes) - len(told)} more mistakes")
    return FormatError("\n".join(f"{path}: {mistake}" for mistake in told))
