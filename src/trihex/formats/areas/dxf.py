"""DXF: floor plans drawn in CAD; walls, exits and rooms by the names of their layers."""

from __future__ import annotations

import os
from fnmatch import fnmatchcase
from typing import Any

import numpy as np

from trihex.areas import import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.files import read_bytes
from trihex.formats.areas.cad import UNITS, Drawing, Piece, read_drawing
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.polygons import Drawn, Place, checked_parts, draft_of_place
from trihex.formats.draft import Draft

ROLES = ("walls", "exits", "rooms")
# Layers that are taken unless they are named.
_USUAL = {"walls": "*wall*", "exits": "*exit*", "rooms": "*room*"}
_THINNEST = 0.002  # metres: a wall of no thickness is still a wall
_FARTHEST_NAME = 3.0  # metres from an exit to its name


def parse_dxf(content: bytes, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers what walls enclose, or rooms, with exits as destinations.

    Free is what lies in rooms where these are drawn, else what walls and exits close off from the outside of the plan.
    An exit is a line or closed line, or several; text beside it on its layer is its name.

    Raises
    ------
    FormatError
        If the file is damaged, names no unit, has no such layers, or walls enclose nothing.
    MissingExtraError
        If ezdxf or shapely is not installed.
    """
    shapely = import_shapely()
    drawing = read_drawing(content, path, options.unit)
    if options.unit is None and drawing.unit is None:
        raise FormatError(f"{path}: names no unit of length; say which it is, one of {', '.join(UNITS)} (--unit)")
    layers = _layers_of(drawing, options, path)
    walls = [_body(piece, options.wall_thickness) for layer in layers["walls"] for piece in drawing.pieces[layer]]
    wall = shapely.union_all([body for body in walls if not body.is_empty])
    exits = _exits(drawing, layers["exits"], path)
    rooms = [_polygon(piece) for layer in layers["rooms"] for piece in drawing.pieces[layer] if piece.is_closed]
    if rooms:
        free = shapely.difference(shapely.union_all(rooms), wall)
    else:
        free = _enclosed(wall, [one.shape for one in exits])
    parts = [part for part in shapely.get_parts(free) if part.geom_type == "Polygon" and part.area > 1e-6]
    if not parts:
        raise FormatError(
            f"{path}: walls enclose no place: exits close openings (--exits LAYER), or name a layer of rooms (--rooms "
            f"LAYER); walls are {', '.join(layers['walls']) or 'none'}"
        )
    drawn = checked_parts([Drawn(str(path), part) for part in parts])
    draft = draft_of_place(Place(path, drawn, [], exits, []), options, progress)
    return draft.with_notes(_notes(drawing, layers))


def read_layers(path: str | os.PathLike[str], options: AreaOptions) -> list[dict[str, Any]]:
    """Return a row for each layer of a DXF file: what it is taken for, how much is drawn on it and what is not read."""
    drawing = read_drawing(read_bytes(path), path, options.unit)
    layers = _layers_of(drawing, options, path, must_exist=False)
    rows = []
    for layer in drawing.layers:
        roles = [role for role in ROLES if layer in layers[role]]
        pieces = drawing.pieces.get(layer, [])
        points = np.concatenate([piece.points for piece in pieces]) if pieces else np.empty((0, 2))
        size = " x ".join(f"{length:.4g}" for length in np.ptp(points, axis=0)) if pieces else "-"
        unknown = [f"{count} {kind}" for (own, kind), count in sorted(drawing.unknown.items()) if own == layer]
        rows.append(
            {
                "layer": layer,
                "taken for": " and ".join(roles) or "-",
                "lines": len(pieces),
                "closed": sum(piece.is_closed for piece in pieces),
                "texts": len(drawing.words.get(layer, [])),
                f"size in {options.unit or drawing.unit or 'unnamed units'}, as metres": size,
                "not understood": ", ".join(unknown) or "-",
            }
        )
    return rows


def _layers_of(
    drawing: Drawing, options: AreaOptions, path: object, *, must_exist: bool = True
) -> dict[str, list[str]]:
    """Return the layers of each role; where nothing is named walls are on all that are left."""
    found: dict[str, list[str]] = {}
    for role in ROLES:
        given = getattr(options, role)
        patterns = [part.strip().lower() for part in (given or _USUAL[role]).split(",")]
        found[role] = [layer for layer in drawing.layers if any(fnmatchcase(layer.lower(), own) for own in patterns)]
        if given and not found[role] and must_exist:
            names = ", ".join(drawing.layers[:20]) + (", ..." if len(drawing.layers) > 20 else "")
            raise FormatError(
                f"{path}: {role} must be on layers of the file, {names or 'which has none'}; not {given!r:.80}"
            )
    if options.walls is None and not found["walls"]:
        found["walls"] = [layer for layer in drawing.pieces if layer not in found["exits"] + found["rooms"]]
    return found


def _body(piece: Piece, thickness: float) -> Any:
    """Return what a line of a wall fills."""
    import shapely

    if piece.is_filled:
        return _polygon(piece)
    line = shapely.linestrings(piece.points)
    return shapely.buffer(line, max(thickness, _THINNEST) / 2, cap_style="square", join_style="mitre", mitre_limit=2)


def _polygon(piece: Piece) -> Any:
    """Return what a closed line encloses."""
    import shapely

    return shapely.buffer(shapely.polygons(piece.points), 0)


def _exits(drawing: Drawing, layers: list[str], path: object) -> list[Drawn]:
    """Return the exits, each with the text that stands nearest to it, if that is near."""
    import shapely

    exits = []
    for layer in layers:
        shapes = [
            _polygon(piece) if piece.is_closed else shapely.linestrings(piece.points) for piece in drawing.pieces[layer]
        ]
        words = drawing.words.get(layer, [])
        for number, shape in enumerate(shapes):
            away = shapely.distance(shape, shapely.points([(x, y) for _, x, y in words])) if words else np.empty(0)
            nearest = int(np.argmin(away)) if away.size else -1
            name = words[nearest].text[:200] if nearest >= 0 and away[nearest] <= _FARTHEST_NAME else ""
            exits.append(Drawn(f"{path}: exit {number} of layer {layer}", shape, name))
    return [one for one in checked_parts(exits) if not one.shape.is_empty]


def _enclosed(wall: Any, exits: list[Any]) -> Any:
    """Return what walls and exits close off from the outside."""
    import shapely

    closing = shapely.union_all([wall, *(shapely.buffer(one, _THINNEST / 2, cap_style="square") for one in exits)])
    if closing.is_empty:
        return closing
    west, south, east, north = closing.bounds
    border = shapely.box(west - 1, south - 1, east + 1, north + 1)
    parts = shapely.get_parts(shapely.difference(border, closing))
    return shapely.union_all(parts[~shapely.intersects(parts, border.exterior)])


def _notes(drawing: Drawing, layers: dict[str, list[str]]) -> list[str]:
    """Return what was taken for what, and what on those layers is not understood."""
    taken = [f"{role} from {', '.join(layers[role])}" for role in ROLES if layers[role]]
    used = {layer for own in layers.values() for layer in own}
    unknown = [
        f"{count} {kind} on {layer}" for (layer, kind), count in sorted(drawing.unknown.items()) if layer in used
    ]
    open_rooms = sum(not piece.is_closed for layer in layers["rooms"] for piece in drawing.pieces.get(layer, []))
    unknown += [f"{open_rooms} lines of rooms that do not close"] if open_rooms else []
    return [f"took {'; '.join(taken)}", *([f"not understood: {', '.join(unknown)}"] if unknown else [])]
