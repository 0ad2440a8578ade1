"""WKT: places as one geometry in metres; polygons are free, with holes or without, lines and points are obstacles."""

from __future__ import annotations

import os
import re

import numpy as np

from trihex.areas import import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.polygons import Place, draft_of_place
from trihex.formats.draft import Draft
from trihex.formats.text import Text

_DEEPEST = 50  # GEOS reads collections within collections by recursion


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
    text = content.decode().strip()
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
        raise FormatError(f"{path}: is no WKT: {reason:.120}") from None
    leaves = list(shapely.get_parts(shapely.force_2d(geometry)))
    while any(leaf.geom_type == "GeometryCollection" for leaf in leaves):
        leaves = list(shapely.get_parts(leaves))
    leaves = list(shapely.get_parts(leaves))
    free = [leaf for leaf in leaves if leaf.geom_type == "Polygon"]
    obstacles = [leaf for leaf in leaves if leaf.geom_type != "Polygon"]
    return draft_of_place(Place(path, free, obstacles, [], []), options, progress)
