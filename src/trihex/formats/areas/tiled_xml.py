"""Tiled XML: maps .tmx and tilesets .tsx as what JSON, .tmj and .tsj, would hold; what readers need of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from trihex.errors import FormatError
from trihex.formats.text import Text

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_WHOLE = ("width", "height", "firstgid", "id")
_TRUE = ("1", "true")


def tiled_from_xml(text: Text, path: object) -> dict[str, Any]:
    """Return a map or a tileset with the keys that it has in JSON.

    Raises
    ------
    FormatError
        If it is no whole XML, or would have the parser replace words of its own (entities).
    """
    from xml.etree import ElementTree

    if text.find(b"<!ENTITY") >= 0:
        raise FormatError(f"{path}: must not define entities: no map of Tiled does")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise FormatError(f"{path}: is no whole XML: {error!s:.100}") from None
    if root.tag not in ("map", "tileset"):
        raise FormatError(f"{path}: must be a <map> of Tiled, not <{root.tag:.40}>")
    if root.tag == "tileset":
        return _tileset(root, path)
    own = _attributes(root, path)
    own["infinite"] = own.get("infinite") in _TRUE
    own["tilesets"] = [_tileset(one, path) for one in root.findall("tileset")]
    own["layers"] = [_layer(one, path) for one in root.iter("layer")]
    return own


def _attributes(element: Element, path: object) -> dict[str, Any]:
    """Return attributes and properties, whole numbers as such."""
    own: dict[str, Any] = dict(element.attrib)
    for name in _WHOLE:
        if name in own:
            try:
                own[name] = int(own[name])
            except ValueError:
                raise FormatError(f"{path}: {name} must be a whole number, not {own[name]!r:.60}") from None
    own["properties"] = [
        {
            "name": one.get("name", ""),
            "value": one.get("value") in _TRUE if one.get("type") == "bool" else one.get("value"),
        }
        for one in element.findall("properties/property")
    ]
    return own


def _tileset(element: Element, path: object) -> dict[str, Any]:
    return _attributes(element, path) | {"tiles": [_attributes(tile, path) for tile in element.findall("tile")]}


def _layer(element: Element, path: object) -> dict[str, Any]:
    """Return a layer of tiles, its numbers as JSON has them: a list, or text in base64."""
    own, data = _attributes(element, path) | {"type": "tilelayer"}, element.find("data")
    if data is None:
        return own
    encoding = data.get("encoding", "")
    own["compression"] = data.get("compression", "")
    if encoding == "base64":
        return own | {"encoding": encoding, "data": data.text or ""}
    words = (data.text or "").split(",") if encoding else [tile.get("gid", "0") for tile in data.findall("tile")]
    try:
        return own | {"data": [int(word) for word in words if word.strip()]}
    except ValueError:
        raise FormatError(f"{path}: layer {own.get('name', '')!r:.60}: tiles must be whole numbers") from None
