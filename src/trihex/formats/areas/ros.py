"""ROS: maps of `map_server`, a YAML file that names an image and says where it lies in the world."""

from __future__ import annotations

import os
import re
from difflib import get_close_matches
from math import cos, isfinite, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trihex.areas import RasterGround
from trihex.areas.coverage import Progress
from trihex.errors import FormatError, check_choice
from trihex.files import read_bytes
from trihex.formats.areas.image import Pixels, read_pixels
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft
from trihex.formats.text import Text

MODES = ("trinary", "scale", "raw")
_REQUIRED = ("image", "resolution", "origin")
_KEYS = (*_REQUIRED, "occupied_thresh", "free_thresh", "negate", "mode")
# A quoted key needs no blank after its colon, as in JSON.
_LINE = re.compile(r"(?P<quote>[\"']?)(?P<key>[A-Za-z_]\w*)(?P=quote)\s*:(?:(?:\s+|(?<=[\"']:))(?P<value>.*))?$")
_FLOW = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'|(?:^|(?<=\s))#[^\n]*|[\[\]{},]|\s+|[^\s\[\]{},\"']+|.")


def parse_ros(text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers a ROS map, and the map as its ground, as nav2's map_server understands it.

    With p = (255 - grey) / 255, or grey / 255 if negated, a pixel is occupied if p > occupied_thresh, free if
    p < free_thresh, and unknown otherwise. In mode trinary, the opacity of an image that has such a channel counts as a
    fourth colour. In mode scale, transparent pixels are unknown, and so is what lies between the thresholds; in mode
    raw, a grey of 0 to 100 is the occupancy in per cent.

    Raises
    ------
    FormatError
        If a key is missing or wrong, or the image cannot be read.
    OSError
        If the image cannot be read.
    """
    entries = parse_yaml(text.decode(), path)
    resolution = _number(entries, "resolution", path)
    if not 1e-9 <= resolution <= 1e9:
        raise FormatError(f"{path}: resolution must be between 1e-9 and 1e9 metres, not {resolution:g}")
    west, south, yaw = _origin(entries, path)
    image = Path(path).parent / _text(entries, "image", path)
    pixels = read_pixels(read_bytes(image), image)
    width, height = pixels.grey.shape[1] * resolution, pixels.grey.shape[0] * resolution
    covering = options.covering_of(path, f"a ROS map ({width:g} by {height:g} metres)", width, height)
    occupied, free = _states(entries, pixels, path)
    ground = RasterGround(
        occupied if options.unknown == "free" else ~free,
        resolution,
        # The origin is the lower left corner; y grows to the north in the world, rows to the south in the image.
        (west - height * sin(yaw), south + height * cos(yaw)),
        yaw,
        options.unknown == "barrier",
        shown=occupied,
    )
    return Draft(options.area_of(ground, covering, Path(path).stem, progress))


def _states(
    entries: dict[str, str | list[str]], pixels: Pixels, path: object
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which pixels are occupied and which free."""
    mode = check_choice(f"{path}: mode", _text(entries, "mode", path, "trinary").lower(), MODES, FormatError)
    over = _number(entries, "occupied_thresh", path, 0.65)
    under = _number(entries, "free_thresh", path, 0.196)
    if not 0 <= under <= over <= 1:
        raise FormatError(
            f"{path}: thresholds must be 0 <= free_thresh <= occupied_thresh <= 1, not {under:g} and {over:g}"
        )
    negate = _text(entries, "negate", path, "0").lower()
    if negate not in ("0", "1", "true", "false", "yes", "no"):
        raise FormatError(f"{path}: negate must be 0 or 1, not {negate!r:.60}")
    # By grey level: there are but 256.
    level = np.arange(256)
    share = level / 255 if negate in ("1", "true", "yes") else (255 - level) / 255
    if mode == "raw":
        share = level / 100
    is_occupied, is_free = share > over, share < under
    if mode == "raw":
        is_occupied[101:] = is_free[101:] = False
    grey, alpha = pixels
    if alpha is not None and mode == "trinary":
        # As map_server does: opacity counts as a fourth colour, so that transparent white is unknown.
        grey = np.round(0.75 * grey + 0.25 * alpha).astype(np.uint8)
    occupied, free = is_occupied[grey], is_free[grey]
    if alpha is not None and mode == "scale":
        occupied, free = occupied & (alpha == 255), free & (alpha == 255)
    return occupied, free


def parse_yaml(text: str, path: object) -> dict[str, str | list[str]]:
    """Return the keys of a flat YAML file, a line each or all in { }, with a text or a list of texts each.

    A YAML library reads ten times as much, and `no`, `010` and `1e3` as something else than they look.
    """
    entries: dict[str, str | list[str]] = {}
    key = ""
    for number, line in enumerate(_lines_of(text), start=1):
        bare = line.strip()
        if not bare or bare[0] in "#%" or bare in ("---", "..."):
            continue
        items = entries.get(key)
        if bare.startswith("- ") and isinstance(items, list):
            items.append(_scalar(bare[2:]))
            continue
        found = _LINE.match(bare)
        if not found:
            raise FormatError(f"{path}: line {number}: must be 'key: value', not {bare!r:.60}")
        key, value = found["key"], (found["value"] or "").strip()
        if key in entries:
            raise FormatError(f"{path}: line {number}: {key} is there twice")
        entries[key] = _scalar(value)
        if value.startswith("["):
            inner, bracket, _ = value[1:].partition("]")
            if not bracket:
                raise FormatError(f"{path}: line {number}: the list of {key} must end with ] on the same line")
            entries[key] = [_scalar(part) for part in inner.split(",")]
        elif entries[key] == "":
            entries[key] = []  # a list may follow, an item each line
    for name in _REQUIRED:
        if name not in entries:
            near = get_close_matches(name, [own for own in entries if own not in _KEYS], n=1)
            hint = f"; is it {near[0]!r}?" if near else ""
            raise FormatError(f"{path}: a ROS map must have the key {name!r}{hint}")
    return entries


def _lines_of(text: str) -> list[str]:
    """Return the lines of a file; of one in { }, as JSON has it, an entry each."""
    if not re.match(r"(?:\s+|#.*\n|---\s)*\{", text):
        return text.splitlines()
    entries: list[list[str]] = [[]]
    depth = 0
    for found in _FLOW.finditer(text):
        token = found[0]
        depth += (token in "[{") - (token in "]}")
        if token == "," and depth == 1:
            entries.append([])
        elif not (token in "{}" or token.startswith(("#", "---"))):
            entries[-1].append(" " if token.isspace() else token)
    return ["".join(entry) for entry in entries]


def _scalar(value: str) -> str:
    """Return a value without quotes and comment."""
    value = value.strip()
    if value[:1] in ('"', "'") and value.find(value[0], 1) > 0:
        return value[1 : value.find(value[0], 1)]
    return re.sub(r"(^|\s)#.*$", "", value).strip()


def _text(entries: dict[str, str | list[str]], key: str, path: object, default: str = "") -> str:
    value = entries.get(key, default)
    if isinstance(value, list) or not value or "\0" in value:
        raise FormatError(f"{path}: {key} must be one value, not {value!r:.60}")
    return value


def _number(entries: dict[str, str | list[str]], key: str, path: object, default: float | None = None) -> float:
    if default is not None and key not in entries:
        return default
    return _float(_text(entries, key, path), key, path)


def _float(value: str, key: str, path: object) -> float:
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        raise FormatError(f"{path}: {key} must be a number, not {value!r:.60}")
    return number


def _origin(entries: dict[str, str | list[str]], path: object) -> tuple[float, float, float]:
    """Return x and y of the lower left corner, and yaw."""
    values = entries["origin"]
    if not isinstance(values, list) or len(values) not in (2, 3):
        raise FormatError(f"{path}: origin must be a list [x, y, yaw], not {values!r:.60}")
    x, y, yaw = (_float(value, "origin", path) for value in [*values, "0"][:3])
    return x, y, yaw
