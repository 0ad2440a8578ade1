"""Tiled: maps of the editor at mapeditor.org, .tmj and .tmx, of squares or hexagons."""

from __future__ import annotations

import os
import zlib
from base64 import b64decode
from bisect import bisect_right
from collections.abc import Iterator
from json import loads
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import MAX_CELLS, Area, Tessellation
from trihex.areas.coverage import Progress
from trihex.errors import FormatError, check_choice
from trihex.files import read_bytes
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.rows import framed
from trihex.formats.areas.tiled_layout import TiledLayout
from trihex.formats.areas.tiled_xml import tiled_from_xml
from trihex.formats.draft import Draft
from trihex.formats.text import Text, check_text

# A layer is one of barriers by its name, in small or capital letters, or by its property `barrier`; where there is none
# a tile is by one of its own properties.
BARRIER_LAYERS = ("barriers", "walls", "collision", "obstacles")
BARRIER_PROPERTIES = ("barrier", "collides", "solid")
_MAX_TILESET = 2**26
_TURNED = 0xF0000000  # bits of a number that say how its tile is turned


def parse_tiled(
    text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None = None
) -> Draft:
    """Return the area of a map, with destinations and robots where it has such layers; the rule is in docs/formats.md.

    Raises
    ------
    FormatError
        If it is no map of squares or hexagons with an end, or nothing in it says what is a barrier.
    OSError
        If a tileset of its own file cannot be read.
    """
    tiled = tiled_of(text, path)
    layout, shape = layout_of(tiled, path), _size_of(tiled, path)
    layers = list(_tile_layers(tiled, path))
    barriers = np.zeros(shape, dtype=bool)
    if named := [layer for layer in layers if _is_of_barriers(layer)]:
        for layer in named:
            barriers |= _numbers_of(layer, shape, path) != 0
    elif numbers := _barrier_tiles(tiled, path):
        for layer in layers:
            barriers |= np.isin(_numbers_of(layer, shape, path), numbers)
    else:
        names = ", ".join(repr(_name_of(layer)) for layer in layers)
        raise FormatError(
            f"{path}: nothing says which tiles are barriers: call a layer {BARRIER_LAYERS[0]!r}, or give tiles the "
            f"property {BARRIER_PROPERTIES[0]!r} (true); layers are {names or 'none':.200}"
        )
    tessellation = Tessellation(layout.shape, options.tessellation.neighbourhood, options.tessellation.costs)
    area = Area(tessellation, layout.cells_of(barriers, True), Path(path).stem)
    places: dict[str, Any] = {
        kind: _cells_marked([layer for layer in layers if _name_of(layer).lower() == kind], layout, shape, path)
        for kind in ("destinations", "robots")
    }
    draft = Draft(area, **places).with_notes([layout.note] if layout.note else [])
    return framed(draft, options, path)


def tiled_of(text: Text, path: object) -> dict[str, Any]:
    """Return a map or a tileset as JSON has it, whichever it is written in."""
    if text.lstrip().startswith(b"<"):
        return tiled_from_xml(text, path)
    try:
        tiled = loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{path}: is no whole JSON: {error!s:.100}") from None
    if not isinstance(tiled, dict):
        raise FormatError(f"{path}: must be an object in JSON, not {type(tiled).__name__}")
    return tiled


def layout_of(tiled: dict[str, Any], path: object) -> TiledLayout:
    """Return how the tiles of a map lie, else raise FormatError."""
    check_choice(f"{path}: orientation", tiled.get("orientation"), ("orthogonal", "hexagonal"), FormatError)
    if tiled.get("infinite"):
        raise FormatError(f"{path}: must have an end: take the tick from 'Infinite' in the properties of the map")
    if tiled["orientation"] == "orthogonal":
        return TiledLayout()
    axis = check_choice(f"{path}: staggeraxis", tiled.get("staggeraxis", "y"), ("x", "y"), FormatError)
    index = check_choice(f"{path}: staggerindex", tiled.get("staggerindex", "odd"), ("odd", "even"), FormatError)
    return TiledLayout(axis, index == "even")


def _size_of(tiled: dict[str, Any], path: object) -> tuple[int, int]:
    """Return the numbers of rows and columns."""
    sizes = [tiled.get("height"), tiled.get("width")]
    if not all(type(size) is int and 0 < size <= MAX_CELLS for size in sizes) or sizes[0] * sizes[1] > MAX_CELLS:  # type: ignore[operator]
        raise FormatError(
            f"{path}: width and height must be whole numbers from 1, not {sizes[1]!r:.40}, {sizes[0]!r:.40}"
        )
    return sizes[0], sizes[1]  # type: ignore[return-value]


def _tile_layers(tiled: dict[str, Any], path: object) -> Iterator[dict[str, Any]]:
    """Yield the layers of tiles, also those in groups, in the order of the file."""
    waiting = [tiled.get("layers")]
    while waiting:
        layers = waiting.pop()
        if not isinstance(layers, list) or not all(isinstance(layer, dict) for layer in layers):
            raise FormatError(f"{path}: layers must be a list of objects")
        yield from (layer for layer in layers if layer.get("type") == "tilelayer")
        waiting += [layer.get("layers") for layer in reversed(layers) if layer.get("type") == "group"]


def _name_of(layer: dict[str, Any]) -> str:
    return str(layer.get("name", ""))


def _properties_of(owner: dict[str, Any]) -> dict[str, Any]:
    """Return custom properties by name; what is none is left out."""
    properties = owner.get("properties")
    given = properties if isinstance(properties, list) else []
    return {str(one.get("name")).lower(): one.get("value") for one in given if isinstance(one, dict)}


def _is_of_barriers(layer: dict[str, Any]) -> bool:
    return _name_of(layer).lower() in BARRIER_LAYERS or _properties_of(layer).get("barrier") is True


def _barrier_tiles(tiled: dict[str, Any], path: str | os.PathLike[str]) -> list[int]:
    """Return the numbers of the tiles that a property of theirs makes barriers."""
    tilesets = tiled.get("tilesets", [])
    if not isinstance(tilesets, list) or not all(
        isinstance(one, dict) and type(one.get("firstgid")) is int and 0 < one["firstgid"] < 2**28 for one in tilesets
    ):
        raise FormatError(f"{path}: tilesets must be a list of objects, each with a firstgid from 1")
    firsts = sorted(one["firstgid"] for one in tilesets)
    numbers = []
    for tileset in tilesets:
        first, source = tileset["firstgid"], tileset.get("source")
        following = bisect_right(firsts, first)
        end = firsts[following] if following < len(firsts) else 2**28
        if source is not None:
            tileset = _read_tileset(source, path)
        tiles = tileset.get("tiles", [])
        for tile in tiles if isinstance(tiles, list) else []:
            if not isinstance(tile, dict) or type(tile.get("id")) is not int:
                raise FormatError(f"{path}: each tile of a tileset must have an id, a whole number")
            own = _properties_of(tile)
            if any(own.get(name) is True for name in BARRIER_PROPERTIES) and 0 <= tile["id"] < end - first:
                numbers.append(first + tile["id"])
    return numbers


def _read_tileset(source: object, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tileset of a file of its own, named from where the map is."""
    if not isinstance(source, str) or not source or "\0" in source:
        raise FormatError(f"{path}: source of a tileset must be the path of a file, not {source!r:.60}")
    place = Path(path).parent / source
    return tiled_of(check_text(read_bytes(place, _MAX_TILESET), place, _MAX_TILESET), place)


def _numbers_of(layer: dict[str, Any], shape: tuple[int, int], path: object) -> NDArray[np.int64]:
    """Return the number of the tile in each place of a layer, 0 where none is; shape (rows, columns)."""
    where, count, data = f"{path}: layer {_name_of(layer)!r:.60}", shape[0] * shape[1], layer.get("data")
    if isinstance(data, str):
        numbers = np.frombuffer(_unpacked(layer, data, 4 * count, where), dtype="<u4").astype(np.int64)
    else:
        if not isinstance(data, list) or len(data) != count or not all(type(number) is int for number in data):
            found = f"{len(data)} of what there is" if isinstance(data, list) else type(data).__name__
            raise FormatError(f"{where} must hold {count} whole numbers, {shape[1]} x {shape[0]}, not {found}")
        try:
            numbers = np.array(data, dtype=np.int64)
        except OverflowError:
            raise FormatError(f"{where}: numbers of tiles must have at most 32 bits") from None
    return (numbers & ~_TURNED).reshape(shape)


def _unpacked(layer: dict[str, Any], data: str, size: int, where: str) -> bytes:
    """Return the bytes of a layer in base64; never more than it must have."""
    packing = layer.get("compression") or ""
    check_choice(f"{where}: compression", packing, ("", "zlib", "gzip"), FormatError)
    try:
        raw = b64decode("".join(data.split()), validate=True)
        if packing:
            raw = zlib.decompressobj(47).decompress(raw, size + 1)  # 47: zlib or gzip, as its head says
    except (ValueError, zlib.error) as error:
        raise FormatError(f"{where} is damaged: {error!s:.80}") from None
    if len(raw) != size:
        raise FormatError(
            f"{where} must hold {size} bytes, four for each tile, not {'more' if len(raw) > size else len(raw)}"
        )
    return raw


def _cells_marked(
    layers: list[dict[str, Any]], layout: TiledLayout, shape: tuple[int, int], path: object
) -> NDArray[np.int64] | None:
    """Return the numbers of the cells with any tile in layers, row by row of the map; None without such a layer."""
    if not layers:
        return None
    marked = np.zeros(shape, dtype=bool)
    for layer in layers:
        marked |= _numbers_of(layer, shape, path) != 0
    rows, columns = layout.cells_of(marked, False).shape
    cells = layout.tiles_of(np.arange(rows * columns).reshape(rows, columns))
    found = cells[marked]
    return found if found.size else None
