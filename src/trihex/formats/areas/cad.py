"""CAD: what the model space of a DXF file draws, as lines and polygons in metres on named layers."""

from __future__ import annotations

import logging
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.errors import FormatError, MissingExtraError, check_choice

# In metres, by the names that people give; by the numbers of $INSUNITS.
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
_UNIT_OF_NUMBER = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 7: "km", 10: "yd"}
_CURVES = {"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"}
_SOLIDS = {"SOLID", "TRACE", "HATCH"}
_MADE_OF_OTHERS = {"INSERT", "MLINE"}
_WORDS = {"TEXT", "MTEXT"}
# What a small file may claim: blocks of blocks of blocks.
_MOST_ENTITIES, _MOST_POINTS, _DEEPEST = 200_000, 2_000_000, 16
_SAGITTA = 0.01  # metres between a curve and its chords, or this share of its size:
_SHARE = 1e-6
_MOST_METRES = 1e9


class Piece(NamedTuple):
    """What one entity draws: points in metres, shape (n, 2), whether they close, whether what is inside is filled."""

    points: NDArray[np.float64]
    is_closed: bool = False
    is_filled: bool = False


class Words(NamedTuple):
    """Text and where it stands, in metres."""

    text: str
    x: float
    y: float


@dataclass
class Drawing:
    """What a file draws, by the names of its layers.

    Attributes
    ----------
    pieces, words : dict of lists
    unknown : Counter of (layer, kind)
        Entities that are not understood.
    unit : str or None
        That of the file, None if it names none.
    """

    pieces: dict[str, list[Piece]] = field(default_factory=lambda: defaultdict(list))
    words: dict[str, list[Words]] = field(default_factory=lambda: defaultdict(list))
    unknown: Counter[tuple[str, str]] = field(default_factory=Counter)
    unit: str | None = None

    @property
    def layers(self) -> list[str]:
        """All layers that hold something, in alphabetical order."""
        return sorted({*self.pieces, *self.words, *(layer for layer, _ in self.unknown)})


def read_drawing(content: bytes, path: object, unit: str | None = None) -> Drawing:
    """Return what a DXF file draws.

    Parameters
    ----------
    content : bytes
    path : path
        For messages.
    unit : str, optional
        One of `UNITS`. Default: what the file says; metres, to be told by the caller, where it says nothing.

    Raises
    ------
    FormatError
        If the file is damaged or draws too much.
    MissingExtraError
        If ezdxf is not installed.
    """
    try:
        from ezdxf import recover
        from ezdxf.document import Drawing as Document
        from ezdxf.lldxf.tagger import binary_tags_loader
    except ImportError:
        raise MissingExtraError("DXF needs ezdxf: pip install 'trihex[cad]'") from None
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # what it repairs it would print
    if unit is not None:
        check_choice(f"{path}: unit", unit, UNITS, FormatError)
    try:
        if content.startswith(b"AutoCAD Binary DXF"):
            document = Document.load(binary_tags_loader(content, errors="ignore"))
        else:
            document, _ = recover.read(BytesIO(content), errors="ignore")
        drawing = Drawing(unit=_UNIT_OF_NUMBER.get(document.units))
        scale = UNITS[unit or drawing.unit or "m"]
        points = 0
        if (count := _count(document, document.modelspace(), {}, 0)) > _MOST_ENTITIES:
            raise FormatError(
                f"{path}: may draw at most {_MOST_ENTITIES} entities, those of blocks counted each time that they are "
                f"used, not {count}"
            )
        for entity, layer in _entities(document.modelspace()):
            points += _take(entity, layer, scale, drawing)
            if points > _MOST_POINTS:
                raise FormatError(f"{path}: may draw at most {_MOST_POINTS} points")
    except (FormatError, MemoryError):
        raise
    except RecursionError:
        raise FormatError(f"{path}: is nested too deeply") from None
    except Exception as error:  # ezdxf raises whatever it stumbles on in damaged files
        raise FormatError(f"{path}: is no whole DXF: {str(error) or type(error).__name__:.120}") from None
    for layer in [layer for layer, own in drawing.pieces.items() if not own]:
        del drawing.pieces[layer]
    return drawing


def _count(document: Any, space: Any, count_of_block: dict[str, int], depth: int) -> int:
    """Return how many entities there are when all blocks are in place, before that is done."""
    if depth > _DEEPEST:
        raise RecursionError
    count = 0
    for entity in space:
        count += 1
        if entity.dxftype() != "INSERT" or (block := document.blocks.get(entity.dxf.name)) is None:
            continue
        name = entity.dxf.name.lower()
        if name not in count_of_block:
            count_of_block[name] = _count(document, block, count_of_block, depth + 1)
        count += max(1, entity.mcount) * count_of_block[name]
    return count


def _entities(space: Any) -> Iterator[tuple[Any, str]]:
    """Yield the entities of the model space and their layers; in place of blocks what they are made of."""
    waiting = [(entity, entity.dxf.layer) for entity in list(space)[::-1]]
    while waiting:
        entity, layer = waiting.pop()
        if entity.dxftype() not in _MADE_OF_OTHERS:
            yield entity, layer
            continue
        if entity.dxftype() == "INSERT" and entity.mcount > 1:
            waiting += [(one, layer) for one in entity.multi_insert()]
            continue
        # What a block draws on layer 0 is on the layer of the block.
        parts = list(entity.virtual_entities())
        waiting += [(one, layer if one.dxf.layer == "0" else one.dxf.layer) for one in parts[::-1]]


def _take(entity: Any, layer: str, scale: float, drawing: Drawing) -> int:
    """Add what an entity draws to a drawing; return how many points that took."""
    from ezdxf import path as paths

    kind = entity.dxftype()
    if kind in _WORDS:
        text = entity.plain_text() if kind == "MTEXT" else entity.dxf.text
        x, y = entity.dxf.insert.x * scale, entity.dxf.insert.y * scale
        if abs(x) <= _MOST_METRES and abs(y) <= _MOST_METRES:  # not so for nan
            drawing.words[layer].append(Words(" ".join(text.split()), x, y))
        return 1
    if kind not in _CURVES | _SOLIDS:
        drawing.unknown[layer, kind] += 1
        return 0
    count = 0
    found = paths.from_hatch(entity) if kind == "HATCH" else [paths.make_path(entity)]
    for path in found:
        for part in path.sub_paths():
            vertices = _flat(part, scale)
            count += len(vertices)
            if len(vertices) < 2 or not (np.abs(vertices) <= _MOST_METRES).all():  # not so for nan
                drawing.unknown[layer, f"{kind} without a length"] += 1
                continue
            # Corners that meet within a millimetre were meant to meet.
            is_closed = len(vertices) > 3 and bool(np.hypot(*(vertices[0] - vertices[-1])) < 1e-3)
            if is_closed:
                vertices[-1] = vertices[0]
            drawing.pieces[layer].append(Piece(vertices, is_closed, kind in _SOLIDS and is_closed))
    return count


def _flat(part: Any, scale: float) -> NDArray[np.float64]:
    """Return the points of a path in metres, curves as chords; none if it is too large for any place.

    (Curves of 1e30 metres would have chords without end.)
    """
    control = np.array([v.xyz for v in part.control_vertices()]).reshape(-1, 3) * scale
    if not (np.abs(control) <= _MOST_METRES).all():  # not so for nan
        return np.empty((0, 2))
    sagitta = max(_SAGITTA, _SHARE * float(np.ptp(control, axis=0).max(initial=0)))
    chords = [(v.x, v.y) for v in part.flattening(sagitta / scale, segments=4)]
    return np.array(chords).reshape(-1, 2) * scale
