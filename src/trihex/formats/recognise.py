"""Recognise: which format a file has, by its content first and by its name where that says nothing."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

from trihex.errors import FormatError
from trihex.formats.plans import csv as plan_csv
from trihex.formats.starts import csv as starts_csv

Format = Literal[
    "npz", "parquet", "plan", "starts", "scen", "scenario", "movingai", "ros", "image", "geojson", "wkt", "letters"
]

# The formats as messages call them.
NAME_OF_FORMAT: dict[Format, str] = {
    "npz": "a plan (.npz)",
    "parquet": "a plan (.parquet)",
    "plan": "a plan (.csv)",
    "starts": "starts (.csv)",
    "scen": "starts (.scen)",
    "scenario": "a scenario (.toml)",
    "movingai": "a MovingAI map",
    "ros": "a ROS map",
    "image": "an image",
    "geojson": "GeoJSON",
    "wkt": "WKT",
    "letters": "letters",
}
_IMAGE = re.compile(rb"\x89PNG|\xff\xd8\xff|GIF8|BM.{4}\0\0\0\0|P[1-6]\s", re.DOTALL)
_BINARY = {
    b"\x93NUMPY": "an .npy array",
    b"%PDF": "a PDF",
    b"\x1f\x8b": "gzip",
}
_MOVINGAI_LINE = re.compile(rb"^(type|height|width)\s|^map\s*$", re.MULTILINE)
_ROS_LINE = re.compile(rb"^\s*(image|resolution|origin|negate|occupied_thresh|free_thresh)\s*:", re.MULTILINE)
_WKT = re.compile(rb"\s*(MULTI)?(POINT|LINESTRING|POLYGON)\b|\s*GEOMETRYCOLLECTION\b", re.IGNORECASE)
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
    if content.startswith(b"PAR1"):
        return "parquet"
    if _IMAGE.match(content):
        return "image"
    for mark, kind in _BINARY.items():
        if content.startswith(mark):
            raise FormatError(f"{path}: is {kind}, which trihex cannot read")
    head = content[:4096].removeprefix(b"\xef\xbb\xbf")
    first = head.partition(b"\n")[0].strip().decode(errors="replace")
    suffix = Path(str(path)).suffix.lower()
    if first == plan_csv.HEADER:
        return "plan"
    if first in (starts_csv.HEADER, starts_csv.HEADER_IN_METRES):
        return "starts"
    if _MOVINGAI_LINE.search(b"\n".join(head.split(b"\n")[:4])) or suffix == ".map":
        return "movingai"
    if first.split()[:1] == ["version"] or suffix == ".scen":
        return "scen"
    if head.lstrip()[:1] == b"{" or suffix in (".geojson", ".json"):
        return "geojson"
    if _WKT.match(head) or suffix == ".wkt":
        return "wkt"
    if _ROS_LINE.search(head) or suffix in (".yaml", ".yml"):
        return "ros"
    if _TOML_LINE.search(head) or suffix == ".toml":
        return "scenario"
    if "," in first and suffix == ".csv":
        return "starts" if first.count(",") == 1 else "plan"
    return "letters"
