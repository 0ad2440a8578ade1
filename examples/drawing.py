"""Drawing: pictures side by side on one sheet of SVG, and cells with words in them."""

import re
import sys
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

import trihex as th
from trihex.kernels.codes import WAIT
from trihex.pictures.palette import BARRIER, FREE, INK, MOVING, PAGE, SERIES, Colour
from trihex.pictures.scene import Discs, Key, Lines, Mark, Scene, Texts, ink_on

FIGURES = Path(__file__).parent.parent / "docs" / "figures"


def bare(picture: th.Picture, title: str = "") -> th.Picture:
    """Return the picture with a title alone: no line below it, no legend."""
    return th.Picture(replace(picture.scene, title=title, subtitle="", legend=()))


def side_by_side(pictures: Iterable[th.Picture], columns: int, gap: int = 4) -> str:
    """Return one sheet of SVG with the pictures in rows of `columns`."""
    rows, row = [], []
    for picture in pictures:
        row.append(picture.to_svg())
        if len(row) == columns:
            rows, row = [*rows, row], []
    rows += [row] if row else []
    parts, top, right = [], 0, 0
    for row in rows:
        left, bottom = 0, top
        for text in row:
            wide, high = (int(side) for side in re.findall(r'(?:width|height)="(\d+)"', text)[:2])
            parts.append(text.replace("<svg ", f'<svg x="{left}" y="{top}" ', 1))
            left, bottom = left + wide + gap, max(bottom, top + high)
        top, right = bottom + gap, max(right, left)
    size = f'width="{right - gap}" height="{top - gap}" viewBox="0 0 {right - gap} {top - gap}"'
    page = f'<rect width="100%" height="100%" fill="#{bytes(PAGE).hex()}"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n{page}\n' + "".join(parts) + "</svg>\n"


def in_a_row(pictures: Iterable[th.Picture], gap: int = 4) -> Image.Image:
    """Return one image with the pictures side by side, their lower edges level."""
    images = [picture.to_array() for picture in pictures]
    high = max(image.shape[0] for image in images)
    sides = [((high - image.shape[0], 0), (0, gap), (0, 0)) for image in images]
    page = np.hstack([np.pad(image, side, constant_values=255) for image, side in zip(images, sides, strict=True)])
    return Image.fromarray(page).quantize(255, dither=Image.Dither.NONE)


def picture_of_step(plan: th.Plan, step: int, breaking: Collection[int], words: str, width: int = 420) -> th.Picture:
    """Return a picture of the robots before a step and of their moves in it; those `breaking` a rule are red."""
    scenario, area = plan.scenario, plan.scenario.area
    scene = th.picture_of_area(scenario.with_robots([]), width=width).scene
    marks, red = list(scene.marks), SERIES[1]
    cells = list(plan.cells_by_step())[step - 1]
    for robot in np.flatnonzero(cells >= 0).tolist():
        colour = red if robot in breaking else MOVING
        x, y = area.tessellation.centre_of_cell(*area.cell_to_xy(cells[[robot]]))
        first, end = plan.first_action[robot : robot + 2]
        action = plan.actions[first + step - 1] if first + step <= end else WAIT
        if action != WAIT:
            way = area.tessellation.step_of_direction[0, action]  # of squares
            here, side = np.array([x[0], y[0]]), 0.1 * np.array([-way[1], way[0]])
            tip, neck = here + 0.76 * way, here + 0.66 * way
            marks.append(Lines((np.array([here, tip, neck + side, tip, neck - side]),), 5.0, colour))
        marks += [Discs(x, y, 0.27, colour), Texts(x, y, (str(robot),), round(0.34 * scene.scale), PAGE)]
    legend = (*scene.legend, Key("disc", MOVING, "robot"), Key("disc", red, "breaks a rule"))
    return th.Picture(replace(scene, marks=tuple(marks), title=f"Step {step}", subtitle=words, legend=legend))


def labelled(
    area: th.Area,
    words: Mapping[tuple[int, int], str],
    colours: Mapping[tuple[int, int], Colour],
    *,
    title: str = "",
    scale: float = 56.0,
    size: float = 17.0,
) -> th.Picture:
    """Return a picture of an area with words in some of its cells, and colours of their own for some."""
    palette = [FREE, BARRIER, *dict.fromkeys(colours.values())]
    colour_of_cell = np.where(area.barriers, np.uint8(1), np.uint8(0))
    for (x, y), colour in colours.items():
        colour_of_cell[y, x] = palette.index(colour, 2)
    marks: list[Mark] = []
    for (x, y), word in words.items():
        ink = ink_on(colours[x, y]) if (x, y) in colours else INK
        cx, cy = area.tessellation.centre_of_cell([x], [y])
        marks.append(Texts(cx, cy, (word,), size, ink))
    rows = np.array(palette, dtype=np.uint8)
    return th.Picture(Scene(area, colour_of_cell, rows, scale, marks=tuple(marks), title=title))


def save(folder: str | Path, figures: Mapping[str, str | th.Picture]) -> list[Path]:
    """Write figures (text of SVG, or pictures) to files by their names, and return the paths."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, figure in figures.items():
        path = folder / name
        if isinstance(figure, str):
            path.write_text(figure, encoding="utf-8")
        else:
            figure.save(path)
        paths.append(path)
    return paths


def folder_from_arguments() -> Path:
    """Return the folder named on the command line, or that of the figures of the documentation."""
    return Path(sys.argv[1]) if len(sys.argv) > 1 else FIGURES
