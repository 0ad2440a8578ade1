"""MovingAI: areas as `.map` files of the benchmark collection at movingai.com."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trihex.areas import MAX_CELLS, Area
from trihex.areas.coverage import Progress
from trihex.errors import FormatError, check_choice
from trihex.files import new_file
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.rows import framed, parse_rows, refuse_frame
from trihex.formats.draft import Draft
from trihex.formats.text import Text

TYPES = ("octile", "tile", "octile_unicost", "hex")
# The collection's own letters. E and S, stations in warehouse maps and swamp elsewhere, can be entered as well.
FREE, BARRIER = b".GSE", b"@OTW"
_KIND_OF_LETTER = np.full(256, 255, dtype=np.uint8)
_KIND_OF_LETTER[list(FREE)] = 0
_KIND_OF_LETTER[list(BARRIER)] = 1
_KNOWN = f"{' '.join(FREE.decode())} (free) and {' '.join(BARRIER.decode())} (barriers)"


def parse_movingai(
    text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None = None
) -> Draft:
    """Return the area of a `.map` file, read at once.

    Raises
    ------
    FormatError
        If the header is wrong, rows are missing or ragged, or a letter is unknown.
    """
    area = Area(options.tessellation, _parse_barriers(text, path), Path(path).stem)
    return framed(Draft(area), options, path)


def _parse_barriers(content: Text, path: object) -> NDArray[np.bool_]:
    """Return the barriers, shape (height, width)."""
    height, width, begin = _parse_header(content, path)
    if height * width > MAX_CELLS or height * width > len(content) - begin:
        raise FormatError(
            f"{path}: truncated: height {height} and width {width} promise {height * width} cells (at most "
            f"{MAX_CELLS}), but the rows take only {len(content) - begin} bytes"
        )
    rows = content[begin:].rstrip(b"\r\n").count(b"\n") + 1
    if rows != height:
        raise FormatError(f"{path}: {'truncated: ' * (rows < height)}height is {height}, but there are {rows} rows")
    return parse_rows(content[begin:], path, _KIND_OF_LETTER, _KNOWN, width=width).astype(bool)


def _parse_header(content: bytes, path: object) -> tuple[int, int, int]:
    """Return height, width and where the rows begin."""
    sizes: dict[str, int] = {}
    has_type = False
    begin = 0
    for line_number in range(1, 5):
        end = content.find(b"\n", begin)
        end = len(content) if end < 0 else end
        line = content[begin:end].decode(errors="replace").strip()
        begin = min(end + 1, len(content))
        key, _, value = line.partition(" ")
        value = value.strip()
        if line == "map" and has_type and len(sizes) == 2:
            return sizes["height"], sizes["width"], begin
        if key == "type" and not has_type:
            check_choice(f"{path}: line {line_number}: type", value, TYPES, FormatError)
            has_type = True
        elif key in ("height", "width") and key not in sizes:
            if not (value.isdecimal() and value.isascii() and int(value[:12]) >= 1 and len(value) <= 10):
                raise FormatError(
                    f"{path}: line {line_number}: {key} must be a whole number from 1, not {value[:40]!r}"
                )
            sizes[key] = int(value)
        else:
            expected = [*(["type"] * (not has_type)), *(k for k in ("height", "width") if k not in sizes)] or ["map"]
            raise FormatError(
                f"{path}: line {line_number}: wrong header: expected {' or '.join(expected)}, not {line[:40]!r}"
            )
    raise FormatError(f"{path}: wrong header: it must be type, height, width, map, a line each")


def write_movingai(area: Area, path: str | os.PathLike[str]) -> None:
    """Write the barriers of `area`; the tessellation is not kept, for the format knows none.

    Raises
    ------
    FormatError
        If the area has a frame.
    """
    refuse_frame(area.frame, path)
    rows = np.where(area.barriers, ord("@"), ord(".")).astype(np.uint8)
    lines = np.concatenate([rows, np.full((area.height, 1), ord("\n"), dtype=np.uint8)], axis=1)
    header = f"type octile\nheight {area.height}\nwidth {area.width}\nmap\n"
    with new_file(path) as part:
        part.write_bytes(header.encode() + lines.tobytes())
