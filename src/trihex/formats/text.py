"""Text: bytes that are known to be UTF-8; parsers of text take it and need not look again."""

from __future__ import annotations

import os
from typing import NewType

from trihex.errors import FormatError
from trihex.files import MAX_BYTES, read_bytes

# Bytes, not str: a table or a map of a gigabyte is read as it is.
Text = NewType("Text", bytes)


def check_text(content: bytes, path: str | os.PathLike[str], most_bytes: int = MAX_BYTES) -> Text:
    """Return UTF-8 text of at most so many bytes, without a byte order mark, or raise FormatError."""
    if len(content) > most_bytes:
        raise FormatError(f"{path}: must be at most {most_bytes} bytes long, not {len(content)}")
    if not content.isascii():
        try:
            content.decode("utf-8")
        except UnicodeDecodeError as error:
            byte = f"byte 0x{content[error.start]:02x} at position {error.start}"
            raise FormatError(f"{path}: must be UTF-8 text; {byte} is none") from None
    return Text(content.removeprefix(b"\xef\xbb\xbf"))


def read_text(path: str | os.PathLike[str], most_bytes: int = MAX_BYTES) -> Text:
    """Return the text of a file of at most so many bytes.

    Raises
    ------
    FormatError
        If it is larger, empty, or no UTF-8.
    OSError
        If it cannot be read.
    """
    return check_text(read_bytes(path, most_bytes), path)
