"""Sheet: where the cells, words and legend of a scene lie on the page, in pixels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil
from typing import Any

from trihex.pictures.palette import INK, Colour
from trihex.pictures.scene import Bar, Entry, Key, Ramp, Scene

MARGIN, TITLE_SIZE, TEXT_SIZE = 14, 19, 14
TITLE_ROW, TEXT_ROW, LEGEND_ROW = 25, 20, 22
RAMP_WIDTH = 110
# A picture of a few cells is still wide enough for a title.
LEAST_WIDTH = 300


@dataclass(frozen=True)
class Words:
    """Words on the page, vertically centred on y; x is their left end or, if `is_centred`, their middle."""

    x: float
    y: float
    words: str
    size: float
    colour: Colour = INK
    is_centred: bool = False


@dataclass(frozen=True)
class Sheet:
    """Where the parts of a picture lie on its page.

    The cells are at `body` (x, y) and take `body_width` by `body_height`; each symbol of the legend is centred on its
    (x, y), each ramp begins at its (x, y), each bar, too, and is so many pixels long. `words` holds all words, among
    them `subtitle` where that is one line.
    """

    width: int
    height: int
    body: tuple[int, int]
    body_width: int
    body_height: int
    words: tuple[Words, ...]
    subtitle_at: tuple[float, float]
    symbols: tuple[tuple[float, float, Key], ...]
    ramps: tuple[tuple[float, float, Ramp], ...]
    bars: tuple[tuple[float, float, int], ...]


@lru_cache(maxsize=32)
def font_of(size: float) -> Any:
    """Return Pillow's own font at `size` pixels."""
    from PIL import ImageFont

    return ImageFont.load_default(size)


def width_of(words: str, size: float) -> float:
    """Return the width to keep for words: readers of SVG take fonts that are up to a sixth wider than Pillow's."""
    return 1.17 * float(font_of(size).getlength(words))


def wrap(words: str, size: float, width: float) -> list[str]:
    """Break words into lines; a word too long for a line is cut."""
    lines: list[str] = []
    for word in words.split():
        while width_of(word, size) > width and len(word) > 4:
            word = word[:-4] + "..."
        joined = f"{lines[-1]} {word}" if lines else word
        if lines and width_of(joined, size) <= width:
            lines[-1] = joined
        else:
            lines.append(word)
    return lines


def arrange(scene: Scene) -> Sheet:
    """Return where the parts of `scene` lie: title and subtitle, below them the cells, below them the legend."""
    across, down = scene.area.tessellation.extent(scene.area.height, scene.area.width)
    body_width, body_height = max(1, round(across * scene.scale)), max(1, round(down * scene.scale))
    has_words = bool(scene.title or scene.subtitle or scene.legend)
    margin = MARGIN if has_words else 0
    # A page is as wide as its widest entry: it cannot be broken, and cells may be a narrow column.
    widest = ceil(max((_width_of_entry(entry, scene) for entry in scene.legend), default=0.0))
    width = max(body_width + 2 * margin, LEAST_WIDTH if has_words else 0, widest + 2 * margin)
    words, y = [], float(margin)
    for line in wrap(scene.title, TITLE_SIZE, width - 2 * margin):
        words.append(Words(margin, y + TITLE_ROW / 2, line, TITLE_SIZE))
        y += TITLE_ROW
    subtitle_at = (float(margin), y + TEXT_ROW / 2)
    for line in wrap(scene.subtitle, TEXT_SIZE, width - 2 * margin):
        words.append(Words(margin, y + TEXT_ROW / 2, line, TEXT_SIZE))
        y += TEXT_ROW
    body = ((width - body_width) // 2, round(y + (8 if words else 0)))
    bottom = float(body[1] + body_height)
    symbols, ramps, bars = [], [], []
    if scene.legend:
        bottom += 10
        places, rows = _places(scene, float(margin), float(width - margin))
        for entry, x, row in places:
            middle = bottom + (row + 0.5) * LEGEND_ROW
            if isinstance(entry, Key):
                symbols.append((x + 7, middle, entry))
                words.append(Words(x + 20, middle, entry.words, TEXT_SIZE))
                continue
            if isinstance(entry, Bar):
                long = _pixels_of(entry, scene)
                bars.append((x, middle, long))
                words.append(Words(x + long + 8, middle, entry.words, TEXT_SIZE))
                continue
            for text, gap in ((entry.words, 4), (entry.low, 3)):
                words.append(Words(x, middle, text, TEXT_SIZE))
                x += width_of(text, TEXT_SIZE) + gap
            ramps.append((x, middle, entry))
            words.append(Words(x + RAMP_WIDTH + 5, middle, entry.high, TEXT_SIZE))
        bottom += rows * LEGEND_ROW
    height = round(bottom) + margin
    legend = (tuple(symbols), tuple(ramps), tuple(bars))
    return Sheet(width, height, body, body_width, body_height, tuple(words), subtitle_at, *legend)


def _pixels_of(bar: Bar, scene: Scene) -> int:
    return max(1, round(bar.length * scene.scale))


def _width_of_entry(entry: Entry, scene: Scene) -> float:
    if isinstance(entry, Key):
        return 20 + width_of(entry.words, TEXT_SIZE)
    if isinstance(entry, Bar):
        return _pixels_of(entry, scene) + 8 + width_of(entry.words, TEXT_SIZE)
    return RAMP_WIDTH + 20 + sum(width_of(text, TEXT_SIZE) for text in (entry.words, entry.low, entry.high))


def _places(scene: Scene, left: float, right: float) -> tuple[list[tuple[Entry, float, int]], int]:
    """Return the x and the row of each entry of a legend, and the number of rows."""
    places, x, row = [], left, 0
    for entry in scene.legend:
        needed = _width_of_entry(entry, scene)
        if x > left and x + needed > right:
            x, row = left, row + 1
        places.append((entry, x, row))
        x += needed + 20
    return places, row + 1
