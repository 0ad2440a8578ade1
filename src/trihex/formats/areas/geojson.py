"""GeoJSON: places as polygons in metres, with obstacles, destinations and robots."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any, NamedTuple

from trihex.areas import Zone, check_flow, import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import AreaError, FormatError, ScenarioError, check_choice
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.polygons import Drawn, Place, checked_parts, draft_of_place
from trihex.formats.draft import Draft
from trihex.formats.text import Text

KINDS = ("free", "obstacle", "destination", "robot", "door")
_TYPES = ("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon", "GeometryCollection")


class _Leaf(NamedTuple):
    """A geometry that is no collection, as read, where in the file it stands, and what it is called and lets in."""

    geometry: dict[str, Any]
    where: str
    name: str
    capacity: Any


def parse_geojson(text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers what the file draws, and its destinations and robots if it has some.

    Coordinates are metres, x to the east and y to the north. The property ``kind`` of a feature tells what it is: free
    (the default of polygons), obstacle, destination, robot (points) or door. All that is not free is occupied. The
    property ``name`` of a destination or door becomes that of a zone, and ``capacity`` is how many robots it lets in.

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
    leaves: dict[str, list[_Leaf]] = {kind: [] for kind in KINDS}
    for where, geometry, kind, name, capacity in _features(document, str(path)):
        own = [_Leaf(leaf, where, name, capacity) for leaf in _geometries(geometry, where)]
        for leaf in own:
            _check_kind(leaf, kind)
        if kind in ("destination", "robot", "door") and not own:
            raise FormatError(f"{where}: a {kind} must have coordinates; it has none")
        leaves[kind or "free"] += own
    parts = {kind: _drawn(own, kind) for kind, own in leaves.items()}
    return draft_of_place(Place(path, **parts), options, progress)


def _features(document: Any, path: str) -> Iterator[tuple[str, Any, str | None, str, Any]]:
    """Yield where it stands, geometry, kind, name and capacity of each feature; the last two of exits and doors."""
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
            yield where, feature, None, "", None
            continue
        properties = feature.get("properties")
        properties = properties if isinstance(properties, dict) else {}
        kind = properties.get("kind")
        if kind is not None:
            check_choice(f"{where}: kind", kind, KINDS, FormatError)
        nothing = {"type": "GeometryCollection", "geometries": []}
        geometry = nothing if feature.get("geometry") is None else feature["geometry"]
        if kind in ("destination", "door"):
            yield where, geometry, kind, _name_of(properties, where), _capacity_of(properties, kind, where)
        else:
            yield where, geometry, kind, "", None


def _capacity_of(properties: dict[str, Any], kind: str, where: str) -> Any:
    """Return the capacity that a feature has, None if it has none; a door must have one."""
    capacity = properties.get("capacity")
    if capacity is None and kind == "door":
        raise FormatError(f"{where}: a door must have the property capacity, what it lets in, such as '1.6/s'")
    if capacity is not None:
        try:
            check_flow("capacity", capacity)
        except ScenarioError as error:
            raise FormatError(f"{where}: {error}") from None
    return capacity


def _name_of(properties: dict[str, Any], where: str) -> str:
    """Return the name that a feature has, "" if it has none."""
    name = properties.get("name")
    if name is None or name == "":
        return ""
    try:
        return Zone(str(name) if isinstance(name, int) else name, ()).name  # type: ignore[arg-type]
    except AreaError as error:
        raise FormatError(f"{where}: {error}") from None


def _geometries(geometry: Any, where: str) -> Iterator[dict[str, Any]]:
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


def _check_kind(leaf: _Leaf, kind: str | None) -> None:
    """Raise FormatError if what is drawn cannot be of the kind."""
    type_ = leaf.geometry["type"]
    is_area = type_.endswith("Polygon")
    if kind is None and not is_area:
        raise FormatError(f"{leaf.where}: a {type_} must have the property kind: one of {', '.join(KINDS)}")
    own = kind or "free"
    if (own == "free" and not is_area) or (own == "robot" and not type_.endswith("Point")):
        must = "a polygon" if own == "free" else "a point"
        raise FormatError(f"{leaf.where}: what is {own!r} must be {must}, not a {type_}")


def _drawn(leaves: list[_Leaf], kind: str) -> list[Drawn]:
    """Return the points, lines and polygons of geometries of a kind, without those that are empty."""
    import shapely

    try:  # all at once takes half the time
        shapes = shapely.from_geojson([_text(leaf) for leaf in leaves])
    except (shapely.errors.ShapelyError, ValueError, RecursionError):  # of which one, and why
        shapes = [_shape(leaf) for leaf in leaves]
    whole = [
        Drawn(leaf.where, shape, leaf.name, (leaf.where, leaf.capacity))
        for leaf, shape in zip(leaves, shapes, strict=True)
    ]
    parts = checked_parts(whole)
    if kind in ("destination", "robot", "door"):
        for one in (*whole, *parts):
            if one.shape.is_empty:
                raise FormatError(f"{one.where}: a {kind} must have coordinates; it has none")
    return [one for one in parts if not one.shape.is_empty]


def _text(leaf: _Leaf) -> str:
    return json.dumps({"type": leaf.geometry["type"], "coordinates": leaf.geometry.get("coordinates")})


def _shape(leaf: _Leaf) -> Any:
    """Return the geometry of shapely; GEOS looks at the coordinates itself."""
    import shapely

    try:
        return shapely.from_geojson(_text(leaf))
    except (shapely.errors.ShapelyError, ValueError, RecursionError) as error:
        reason = "coordinates must be finite numbers in lists as deep as its type asks for"
        if "closed linestring" in str(error):
            reason = "a ring must end where it begins"
        elif str(error).startswith("IllegalArgumentException: "):
            reason = str(error).partition(": ")[2]
        raise FormatError(f"{leaf.where}: is no {leaf.geometry['type']}: {reason}") from None
