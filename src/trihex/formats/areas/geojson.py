"""GeoJSON: places as polygons in metres, with obstacles, destinations and robots."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

from trihex.areas import Zone, import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import AreaError, FormatError, check_choice
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.polygons import Drawn, Place, checked_parts, draft_of_place
from trihex.formats.draft import Draft
from trihex.formats.text import Text

KINDS = ("free", "obstacle", "destination", "robot")
_TYPES = ("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon", "GeometryCollection")


def parse_geojson(text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers what the file draws, and its destinations and robots if it has some.

    Coordinates are metres, x to the east and y to the north. The property ``kind`` of a feature tells what it is: free
    (the default of polygons), obstacle, destination or robot (points). All that is not free is occupied. The property
    ``name`` of a destination becomes that of a zone.

    Raises
    ------
    FormatError
        If the file is no GeoJSON, a geometry is invalid, or nothing is free.
    MissingExtraError
        If shapely is not installed.
    """
    import_shapely()
    try:
        document = json.loads(text)
    except RecursionError:
        raise FormatError(f"{path}: is nested too deeply") from None
    except ValueError as error:
        raise FormatError(f"{path}: is no JSON: {error}") from None
    parts: dict[str, list[Drawn]] = {kind: [] for kind in KINDS}
    for where, geometry, kind, name in _features(document, str(path)):
        leaves = [_shape(leaf, kind, where) for leaf in _leaves(geometry, where)]
        drawn = [one for leaf in leaves for one in checked_parts(where, leaf, name)]
        if kind in ("destination", "robot") and (not drawn or any(one.shape.is_empty for one in drawn)):
            raise FormatError(f"{where}: a {kind} must have coordinates; it has none")
        parts[kind or "free"] += [one for one in drawn if not one.shape.is_empty]
    return draft_of_place(Place(path, **parts), options, progress)


def _features(document: Any, path: str) -> Iterator[tuple[str, Any, str | None, str]]:
    """Yield where it stands, geometry, kind and name of each feature; only destinations have names."""
    if not isinstance(document, dict):
        raise FormatError(f"{path}: GeoJSON must be an object, not {type(document).__name__}")
    features = document.get("features") if document.get("type") == "FeatureCollection" else [document]
    if not isinstance(features, list):
        raise FormatError(f"{path}: features must be a list, not {type(features).__name__}")
    for number, feature in enumerate(features):
        where = f"{path}: feature {number}"
        if not isinstance(feature, dict):
            raise FormatError(f"{where}: must be an object, not {feature!r:.40}")
        if feature.get("type") != "Feature":
            yield where, feature, None, ""
            continue
        properties = feature.get("properties")
        properties = properties if isinstance(properties, dict) else {}
        kind = properties.get("kind")
        if kind is not None:
            check_choice(f"{where}: kind", kind, KINDS, FormatError)
        nothing = {"type": "GeometryCollection", "geometries": []}
        name = _name_of(properties, where) if kind == "destination" else ""
        yield where, nothing if feature.get("geometry") is None else feature["geometry"], kind, name


def _name_of(properties: dict[str, Any], where: str) -> str:
    """Return the name that a feature has, "" if it has none."""
    name = properties.get("name")
    if name is None or name == "":
        return ""
    try:
        return Zone(str(name) if isinstance(name, int) else name, ()).name  # type: ignore[arg-type]
    except AreaError as error:
        raise FormatError(f"{where}: {error}") from None


def _leaves(geometry: Any, where: str) -> Iterator[dict[str, Any]]:
    """Yield the geometries that are no collections."""
    waiting = [geometry]
    while waiting:
        one = waiting.pop()
        if not isinstance(one, dict):
            raise FormatError(f"{where}: a geometry must be an object, not {one!r:.40}")
        if one.get("type") == "GeometryCollection" and isinstance(one.get("geometries"), list):
            waiting += one["geometries"][::-1]
        else:
            check_choice(f"{where}: type", one.get("type"), _TYPES, FormatError)
            yield one


def _shape(leaf: dict[str, Any], kind: str | None, where: str) -> Any:
    """Return the geometry of shapely, if its kind may have it; GEOS looks at the coordinates itself."""
    import shapely

    is_area = leaf["type"].endswith("Polygon")
    if kind is None and not is_area:
        raise FormatError(f"{where}: a {leaf['type']} must have the property kind: one of {', '.join(KINDS)}")
    own = kind or "free"
    if (own == "free" and not is_area) or (own == "robot" and not leaf["type"].endswith("Point")):
        must = "a polygon" if own == "free" else "a point"
        raise FormatError(f"{where}: what is {own!r} must be {must}, not a {leaf['type']}")
    try:
        return shapely.from_geojson(json.dumps({"type": leaf["type"], "coordinates": leaf.get("coordinates")}))
    except (shapely.errors.ShapelyError, ValueError, RecursionError) as error:
        reason = "coordinates must be finite numbers in lists as deep as its type asks for"
        if "closed linestring" in str(error):
            reason = "a ring must end where it begins"
        elif str(error).startswith("IllegalArgumentException: "):
            reason = str(error).partition(": ")[2]
        raise FormatError(f"{where}: is no {leaf['type']}: {reason}") from None
