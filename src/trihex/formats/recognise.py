"""Recognise: which format a file has, by its content first and by its name where that says nothing."""

from __future__ import annotations

from pathlib import Path

from trihex.errors import FormatError
from trihex.formats.registry import FORMATS

_UNREADABLE = {
    b"\x93NUMPY": "an .npy array",
    b"%PDF": "a PDF",
    b"\x1f\x8b": "gzip",
}


def format_of(content: bytes, path: object) -> str:
    """Return the name of the format of a file, a key of `FORMATS`.

    Raises
    ------
    FormatError
        If it is a well known format that trihex does not read.
    """
    for mark, kind in _UNREADABLE.items():
        if content.startswith(mark):
            raise FormatError(f"{path}: is {kind}, which trihex cannot read")
    binary = content[:4096]
    text = binary.removeprefix(b"\xef\xbb\xbf")
    suffix = Path(str(path)).suffix.lower()
    for name, form in FORMATS.items():
        if suffix in form.suffixes or form.is_format_of(text if form.is_text else binary):
            return name
    first = text.partition(b"\n")[0].lstrip()
    commas = first.count(b",")
    if suffix == ".csv" and commas:  # with a wrong header, of which the parser will tell
        return "starts" if commas == 1 or first.startswith((b"x,", b"x_")) else "plan"
    return "letters"
