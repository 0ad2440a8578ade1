"""Recognise: which format a file has, by its content first and by its name where that says nothing."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

from trihex.errors import FormatError
from trihex.formats import plan_csv, starts_csv

Format = Literal["npz", "plan", "starts", "scenario", "movingai", "letters"]

_BINARY = {
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"P5": "a PGM image",
    b"\x93NUMPY": "an .npy array",
    b"%PDF": "a PDF",
    b"\x1f\x8b": "gzip",
}
_MOVINGAI_LINE = re.compile(rb"^(type|height|width)\s|^map\s*$", re.MULTILINE)
_TOML_LINE = re.compile(rb"^\s*(#|\[\[?[\w.\"' -]+\]\]?\s*(#.*)?$|[\w.\"'-]+\s*=)", re.MULTILINE)


def format_of(content: bytes, path: object) -> Format:
    """Return the format of a file that trihex reads.

    Raises
    ------
    FormatError
        If it is a well known format that trihex does not read.
    """
    if content.startswith(b"PK\x03\x04"):
        return "npz"
    for mark, kind in _BINARY.items():
        if content.startswith(mark):
            raise FormatError(f"{path}: is {kind}, which trihex cannot read; it reads .map, .txt, .toml, .csv and .npz")
    head = content[:4096].removeprefix(b"\xef\xbb\xbf")
    first = head.partition(b"\n")[0].strip().decode(errors="replace")
    suffix = Path(str(path)).suffix.lower()
    if first == plan_csv.HEADER:
        return "plan"
    if first == starts_csv.HEADER:
        return "starts"
    if _MOVINGAI_LINE.search(b"\n".join(head.split(b"\n")[:4])) or suffix == ".map":
        return "movingai"
    if _TOML_LINE.search(head) or suffix == ".toml":
        return "scenario"
    if "," in first and suffix == ".csv":
        return "starts" if first.count(",") == 1 else "plan"
    return "letters"
