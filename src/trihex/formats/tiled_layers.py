"""Tiled layers: fields and plans as maps that the editor Tiled opens, with a picture of their tiles beside each."""

from __future__ import annotations

import json
import os
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import FormatError, check_type
from trihex.fields import DScheme, NScheme
from trihex.files import new_file, read_bytes, suffix_of
from trihex.formats.areas.tiled import layout_of, tiled_of
from trihex.formats.areas.tiled_layout import TiledLayout
from trihex.formats.recognise import format_of
from trihex.formats.text import check_text
from trihex.formats.tile_sheet import COLUMNS, Tile, TileSheet
from trihex.kernels.codes import NOT_REACHED
from trihex.plans import Plan

_MAX_TILES = 20_000
_COLOURS = {"barriers": (60, 60, 60), "destinations": (40, 150, 70), "robots": (200, 60, 50)}
_NEAR, _FAR, _PLAIN = (250, 244, 220), (70, 110, 160), (235, 235, 235)


def write_tiled(
    record: NScheme | DScheme | Plan, path: str | os.PathLike[str], *, like: str | os.PathLike[str] | None = None
) -> None:
    """Write a field or a plan as a map ``.tmj`` for Tiled, and beside it the picture of its tiles, ``.tiles.png``.

    Parameters
    ----------
    record : NScheme, DScheme or Plan
        Layers of an N-scheme are ``n_scheme``, whose tiles have a property ``distance``, and ``barriers``; of a
        D-scheme ``d_scheme``, with the property ``directions``; of a plan ``paths``, a line for each robot, ``robots``
        where they start, ``destinations`` and ``barriers``.
    path : path
    like : path, optional
        A map of Tiled, from which the area was read: tiles then lie as in it. Other files are not looked at. Default:
        hexagons of stagger axis x, index odd, whose tile (x, y) is cell (x, y).

    Raises
    ------
    FormatError
        If the cells are triangles, the field has more than 20 000 different distances, or `like` has another size.
    """
    check_type("record", record, NScheme, DScheme, Plan)
    suffix_of(path, (".tmj",), "layers for Tiled")
    scenario = record.n_scheme.scenario if isinstance(record, DScheme) else record.scenario
    if scenario.area.tessellation.name == "triangular":
        raise FormatError(f"{path}: Tiled knows squares and hexagons, no triangles")
    sheet = TileSheet(_layout_like(like, scenario, path))
    if isinstance(record, NScheme):
        layers = [_distances(record, sheet, path)]
    elif isinstance(record, DScheme):
        layers = [_directions(record, sheet)]
    else:
        layers = [_marked("robots", scenario.robots, scenario, sheet)]
    layers += [
        _marked("destinations", scenario.destinations, scenario, sheet),
        _marked("barriers", np.flatnonzero(scenario.area.barriers), scenario, sheet),
        *([_paths(record, sheet)] if isinstance(record, Plan) else []),
    ]
    picture = Path(path).with_suffix(".tiles.png")
    tiled = _map(layers, sheet, scenario, picture.name)
    with new_file(path) as part, new_file(picture) as drawn:
        part.write_text(json.dumps(tiled) + "\n", encoding="ascii")
        sheet.draw(drawn)


def _layout_like(like: str | os.PathLike[str] | None, scenario: Scenario, path: object) -> TiledLayout:
    """Return how the tiles of `like` lie if it is a map of Tiled, else how cells do."""
    area = scenario.area
    own = TiledLayout("x" if area.tessellation.name == "hexagonal" else "")
    if like is None:
        return own
    content = read_bytes(like)
    if format_of(content, like) != "tiled":
        return own
    layout = layout_of(tiled_of(check_text(content, like), like), like)
    front = area.barriers[:, : int(layout.is_even)]
    if layout.shape != area.tessellation.name or not front.all() or area.width <= layout.is_even:
        raise FormatError(f"{path}: {like} must be the map from which the area was read")
    return layout


def _layer(name: str, of_cell: NDArray[np.int64], sheet: TileSheet) -> dict[str, Any]:
    """Return a layer with a number for each cell, 0 for none."""
    tiles = sheet.layout.tiles_of(of_cell)
    size = {"height": tiles.shape[0], "width": tiles.shape[1]}
    return {"data": tiles.reshape(-1).tolist(), **size, "name": name, "type": "tilelayer"} | _SHOWN


_SHOWN = {"opacity": 1, "visible": True, "x": 0, "y": 0}


def _marked(name: str, cells: NDArray[np.int64], scenario: Scenario, sheet: TileSheet) -> dict[str, Any]:
    first = sheet.add([Tile(_COLOURS[name], name.removesuffix("s"), True)])
    numbers = np.zeros(scenario.area.cell_count, dtype=np.int64)
    numbers[cells] = first
    return _layer(name, numbers.reshape(scenario.area.barriers.shape), sheet)


def _distances(n_scheme: NScheme, sheet: TileSheet, path: object) -> dict[str, Any]:
    reached = n_scheme.distance != NOT_REACHED
    values, rank = np.unique(n_scheme.distance[reached], return_inverse=True)
    if values.size > _MAX_TILES:
        raise FormatError(f"{path}: may have at most {_MAX_TILES} different distances, not {values.size}")
    tiles = []
    for distance in values.tolist():
        share = distance / max(1, n_scheme.farthest)
        colour = tuple(round(a + share * (b - a)) for a, b in zip(_NEAR, _FAR, strict=True))
        tiles.append(Tile(colour, "distance", distance))
    numbers = np.zeros(n_scheme.distance.shape, dtype=np.int64)
    numbers[reached] = sheet.add(tiles) + rank
    return _layer("n_scheme", numbers, sheet)


def _directions(d_scheme: DScheme, sheet: TileSheet) -> dict[str, Any]:
    """Return a layer whose tiles name directions as one sees them on the map, which may have x and y swapped."""
    vectors = d_scheme.n_scheme.scenario.area.tessellation.unit_vector_of_direction[0]  # those of both orientations
    if sheet.layout.axis == "y":
        vectors = vectors[:, ::-1]
    names = [
        "N" * (south < -0.1) + "S" * (south > 0.1) + "W" * (east < -0.1) + "E" * (east > 0.1)
        for east, south in vectors.tolist()
    ]
    values, rank = np.unique(d_scheme.directions, return_inverse=True)
    tiles = []
    for bits in values.tolist():
        own = [k for k in range(len(names)) if bits >> k & 1]
        ways = tuple((float(vectors[k, 0]), float(vectors[k, 1])) for k in own)
        tiles.append(Tile(_PLAIN, "directions", " ".join(names[k] for k in own), ways))
    numbers = sheet.add(tiles) + rank.reshape(d_scheme.directions.shape)
    return _layer("d_scheme", np.where(d_scheme.directions > 0, numbers, 0), sheet)


def _paths(plan: Plan, sheet: TileSheet) -> dict[str, Any]:
    """Return a layer with a line for each robot from where it starts to where it ends."""
    area, arrivals = plan.scenario.area, plan.arrival_step_of_robot.tolist()
    objects = []
    for robot in range(plan.scenario.robot_count):
        cells = np.array([cell for cell, _ in groupby(plan.cells_of_robot(robot).tolist())])
        x, y = area.cell_to_xy(cells)
        x = x - sheet.layout.is_even
        column, row = (y, x) if sheet.layout.axis == "y" else (x, y)
        points = sheet.middle_of(column, row)
        line = [{"x": east, "y": south} for east, south in (points - points[0]).tolist()]
        shape: dict[str, Any] = {"polyline": line} if len(line) > 1 else {"point": True}
        objects.append(
            {
                "id": robot + 1,
                "name": f"robot {robot}",
                "type": "robot",
                "x": float(points[0, 0]),
                "y": float(points[0, 1]),
                "properties": [{"name": "arrival", "type": "int", "value": arrivals[robot]}],
            }
            | {"height": 0, "rotation": 0, "visible": True, "width": 0}
            | shape
        )
    return {"draworder": "index", "name": "paths", "objects": objects, "type": "objectgroup"} | _SHOWN


def _map(layers: list[dict[str, Any]], sheet: TileSheet, scenario: Scenario, picture: str) -> dict[str, Any]:
    """Return the map with its layers and its tileset."""
    wide, high, side = sheet.size
    rows, columns = sheet.layout.tiles_of(scenario.area.barriers).shape
    kinds = {True: "bool", False: "int"}
    tiles = [
        {
            "id": number,
            "properties": [
                {
                    "name": tile.name,
                    "type": "string" if isinstance(tile.value, str) else kinds[isinstance(tile.value, bool)],
                    "value": tile.value,
                }
            ],
        }
        for number, tile in enumerate(sheet.tiles)
    ]
    tileset = {"columns": COLUMNS, "firstgid": 1, "image": picture, "imagewidth": wide * COLUMNS}
    tileset |= {"imageheight": high * -(-len(tiles) // COLUMNS), "margin": 0, "name": "trihex", "spacing": 0}
    tileset |= {"tilecount": len(tiles), "tileheight": high, "tilewidth": wide, "tiles": tiles}
    own: dict[str, Any] = {"compressionlevel": -1, "height": rows, "infinite": False}
    if sheet.layout.axis:
        index = "even" if sheet.layout.is_even else "odd"
        own |= {"hexsidelength": side, "staggeraxis": sheet.layout.axis, "staggerindex": index}
    return own | {
        "layers": [layer | {"id": number} for number, layer in enumerate(layers, start=1)],
        "nextlayerid": len(layers) + 1,
        "nextobjectid": scenario.robot_count + 1,
        "orientation": "hexagonal" if sheet.layout.axis else "orthogonal",
        "renderorder": "right-down",
        "tiledversion": "1.10.2",
        "tileheight": high,
        "tilesets": [tileset],
        "tilewidth": wide,
        "type": "map",
        "version": "1.10",
        "width": columns,
    }
