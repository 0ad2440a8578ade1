"""WKT: places as one geometry in metres; polygons are free, with holes or without, lines and points are obstacles."""

from __future__ import annotations

import os
import re

import numpy as np

from trihex.areas import import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.polygons import Drawn, Place, checked_parts, draft_of_place
from trihex.formats.draft import Draft
from trihex.formats.text import Text

_DEEPEST = 50  # GEOS reads collections within collections by recursion
_SRID = re.compile(r"\A\s*SRID\s*=\s*\d{1,9}\s*;", re.IGNORECASE)  # of PostGIS; numbers are metres all the same
# Blanks are counted, or many of them take a time that grows with their square.
_BRACKET = r"\s{0,9}(?:Z|M|ZM)?\s{0,9}\(\s{0,9}"
_HINTS = {
    rf"\b(MULTIPOLYGON){_BRACKET}\(?\s{{0,9}}[-+.\d]": "a {0} has three brackets: {0} (((0 0, 9 0, 9 6, 0 0)))",
    rf"\b(POLYGON|MULTILINESTRING){_BRACKET}[-+.\d]": "a {0} has two brackets: {0} ((0 0, 9 0, 9 6, 0 0))",
    rf"\b(POINT|LINESTRING){_BRACKET}\(": "a {0} has one bracket: {0} (0 0, ...)",
    r"\)\s{0,9};?\s{0,9}((?:MULTI)?(?:POINT|LINESTRING|POLYGON))\b": "several are one GEOMETRYCOLLECTION (..., {0})",
}


def parse_wkt(content: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers what the text draws.

    Raises
    ------
    FormatError
        If the text is no WKT, a geometry is invalid, or nothing is free.
    MissingExtraError
        If shapely is not installed.
    """
    shapely = import_shapely()
    text = _SRID.sub("", content.decode(), count=1).strip()
    depth = deepest = 0
    for bracket in re.finditer(r"[()]", text):
        depth += 1 if bracket[0] == "(" else -1
        deepest = max(deepest, depth)
    if deepest > _DEEPEST:
        raise FormatError(f"{path}: is nested too deeply")
    if "\0" in text:
        raise FormatError(f"{path}: must be text; there is a zero byte in it")
    try:
        with np.errstate(all="ignore"):  # numbers that are none are found afterwards
            geometry = shapely.from_wkt(text)
    except (shapely.errors.ShapelyError, ValueError, NotImplementedError) as error:
        reason = str(error).partition(": ")[2] or str(error)
        raise FormatError(f"{path}: is no WKT: {reason:.120}{_hint(text)}") from None
    drawn = [one for one in checked_parts([Drawn(str(path), geometry)]) if not one.shape.is_empty]
    free = [one for one in drawn if one.shape.geom_type == "Polygon"]
    obstacles = [one for one in drawn if one.shape.geom_type != "Polygon"]
    return draft_of_place(Place(path, free, obstacles, [], []), options, progress)


def _hint(text: str) -> str:
    """Return what may be wrong with text that is no WKT."""
    for pattern, hint in _HINTS.items():
        if found := re.search(pattern, text, re.IGNORECASE):
            return f"; {hint.format(found[1].upper())}"
    return ""
