"""Picture: what a record looks like, as an image or as SVG.

A maker takes a record and says what is seen (a scene); it plans nothing. Cells that are large enough show numbers,
arrows and letters, smaller ones show colours alone.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Ground, Scenario
from trihex.fields import DScheme, NScheme
from trihex.files import new_file, suffix_of
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures import marks as make, palette
from trihex.pictures.palette import BARRIER, DESTINATION, FREE, INK, MOVING, SERIES, STRANDED, UNREACHED
from trihex.pictures.png import paint, write_png
from trihex.pictures.scene import Key, Lines, Mark, Ramp, Scene, colour_rows, scale_for
from trihex.pictures.svg import svg_of
from trihex.plans import Plan, visits_of
from trihex.record import Record

PICTURE_SUFFIXES = (".png", ".svg")
ARROWS_FROM = 18.0  # pixels per edge step
PATHS_FROM = 8.0
MOST_PATHS, MOST_PATH_STEPS = 26, 10_000
_SHADES = 240


@dataclass(frozen=True, eq=False)
class Picture(Record):
    """A picture that can be saved, shown in a notebook, or taken as an array.

    Parameters
    ----------
    scene : Scene
        What it shows.
    """

    scene: Scene

    def to_array(self) -> NDArray[np.uint8]:
        """Return the pixels as RGB, shape (height, width, 3)."""
        return paint(self.scene)

    def to_svg(self) -> str:
        """Return the text of an SVG file; more than 60 000 cells are embedded as an image."""
        return svg_of(self.scene)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture to a file, .png or .svg.

        Raises
        ------
        FormatError
            If the suffix is neither.
        OSError
            If the file cannot be written.
        """
        suffix = suffix_of(path, PICTURE_SUFFIXES, "a picture")
        with new_file(path) as part:
            if suffix == ".svg":
                part.write_text(self.to_svg(), encoding="utf-8")
            else:
                write_png(self.to_array(), part)

    def _repr_png_(self) -> bytes:
        file = BytesIO()
        write_png(self.to_array(), file)
        return file.getvalue()


def picture_of_area(
    record: Area | Scenario,
    *,
    width: int | None = None,
    title: str | None = None,
    legend: bool = True,
    ground: Ground | None = None,
) -> Picture:
    """Return the picture of an area, or of a scenario: barriers, destinations, robots.

    Parameters
    ----------
    record : Area or Scenario
    width : int, optional
        Pixels across the cells. Default: what suits the area, 1600 at most.
    title : str, optional
        Default: the name of the area. An empty title leaves out the line below it, too.
    legend : bool
        Whether to explain the colours.
    ground : Ground, optional
        What stands in the world, painted onto the cells.

    Examples
    --------
    >>> picture_of_area(Area("square", [[0, 1], [0, 0]]), width=100, title="", legend=False).to_array().shape
    (100, 100, 3)
    """
    area, scale, more = _area_of(record), scale_for(_area_of(record), width), ""
    marks: list[Mark] = []
    keys: list[Key | Ramp] = _barrier_key(area, ground)
    if isinstance(record, Scenario):
        robots, more = np.arange(record.robot_count), f", {record.robot_count} robots"
        marks += make.destination_marks(record, scale) + make.robot_marks(record, robots, MOVING, scale)
        keys += [Key("cell", DESTINATION, "destination")]
        keys += [Key("disc", MOVING, "robot")] if robots.size else []
    cells, colours = make.base_cells(record, 0, 1, 2), colour_rows([FREE, _barrier_colour(ground), DESTINATION])
    scene = Scene(area, cells, colours, scale, (1, 2), tuple(marks), tuple(keys), ground=ground)
    return _titled(scene, title, "Area", more, legend)


def picture_of_n_scheme(
    n_scheme: NScheme, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of an N-scheme: the distance of each cell as colour, and as number where it fits.

    The parameters are those of `picture_of_area`.
    """
    area = n_scheme.scenario.area
    scene = _scene_of_distances(n_scheme.scenario, n_scheme.distance, scale_for(area, width))
    return _titled(scene, title, "N-scheme", f", costs {area.tessellation.costs}", legend)


def picture_of_generation(
    scenario: Scenario,
    states: NDArray[np.integer],
    number: int,
    *,
    far: int | None = None,
    width: int | None = None,
    title: str | None = None,
    legend: bool = True,
) -> Picture:
    """Return the picture of a generation of the distance rule, as `picture_of_n_scheme` draws the last one.

    Parameters
    ----------
    scenario : Scenario
    states : array of integers, shape (height, width)
        As `trihex.fields.automaton.distance_generations` yields them.
    number : int
        Number of the generation.
    far : int, optional
        The distance at which the colours end, for one scale over all generations. Default: the largest distance.
    width, title, legend
        As for `picture_of_area`.
    """
    distance = np.where(scenario.area.barriers, NOT_REACHED, states)
    scene = _scene_of_distances(scenario, distance, scale_for(scenario.area, width), far)
    return _titled(scene, title, f"Generation {number}", f", costs {scenario.area.tessellation.costs}", legend)


def _scene_of_distances(
    scenario: Scenario, distance: NDArray[np.integer], scale: float, far: int | None = None
) -> Scene:
    area, shades = scenario.area, palette.distance_ramp(_SHADES)
    is_reached = distance != NOT_REACHED
    if far is None:
        far = int(distance.max(initial=0, where=is_reached))
    far = max(1, far)
    cells = make.base_cells(scenario, _SHADES + 2, _SHADES, _SHADES + 1)
    is_shaded = is_reached & (distance > 0)
    cells[is_shaded] = np.minimum(np.rint(distance[is_shaded] * ((_SHADES - 1) / far)), _SHADES - 1)
    colours = np.vstack([shades, colour_rows([BARRIER, DESTINATION, UNREACHED])])
    marks = make.number_marks(area, distance, cells, colours, scale)
    marks = [*make.destination_marks(scenario, scale, letters=not marks), *marks]
    keys: list[Key | Ramp] = [
        Ramp(_samples(shades), "distance", "0", str(far)),
        Key("cell", DESTINATION, "destination"),
        *_barrier_key(area),
        *_unreached_key((cells == _SHADES + 2).any()),
    ]
    return Scene(area, cells, colours, scale, (_SHADES, _SHADES + 1), tuple(marks), tuple(keys))


def picture_of_d_scheme(
    d_scheme: DScheme, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of a D-scheme: arrows along all best moves, or their mean as colour where cells are small.

    The parameters are those of `picture_of_area`.
    """
    scenario = d_scheme.n_scheme.scenario
    area, directions = scenario.area, d_scheme.directions
    scale = scale_for(area, width)
    has_arrows = scale >= ARROWS_FROM
    shades = colour_rows([FREE]) if has_arrows else palette.compass_ramp(_SHADES)
    first = len(shades)
    cells = make.base_cells(scenario, first + 2, first, first + 1)
    is_shaded = directions > 0
    cells[is_shaded] = 0 if has_arrows else make.compass_of(area, directions, first)[is_shaded]
    marks: list[Mark] = make.destination_marks(scenario, scale)
    keys: list[Key | Ramp] = []
    if has_arrows:
        marks.append(Lines(make.arrow_paths(area, directions), max(1.2, 0.035 * scale), INK))
        keys.append(Key("line", INK, "best moves"))
    else:
        for number, name in enumerate(("N", "NE", "E", "SE", "S", "SW", "W", "NW")):
            keys.append(Key("cell", tuple(shades[number * _SHADES // 8].tolist()), name))
    keys += [Key("cell", DESTINATION, "destination"), *_barrier_key(area)]
    keys += _unreached_key((cells == first + 2).any())
    colours = np.vstack([shades, colour_rows([BARRIER, DESTINATION, UNREACHED])])
    scene = Scene(area, cells, colours, scale, (first, first + 1), tuple(marks), tuple(keys))
    return _titled(scene, title, "D-scheme", "", legend)


def picture_of_plan(
    plan: Plan,
    *,
    width: int | None = None,
    title: str | None = None,
    legend: bool = True,
    paths: bool | None = None,
    ground: Ground | None = None,
    crop: bool = False,
) -> Picture:
    """Return the picture of a plan: the paths of its robots, or how often each cell is visited.

    Parameters
    ----------
    plan : Plan
    width, title, legend, ground
        As for `picture_of_area`.
    paths : bool, optional
        Whether to draw a line for each robot, not the visits. Default: if there are 26 at most and cells are large.
    crop : bool
        Whether to show only the part of the area that holds free cells, if that is less than half of it.
    """
    whole = plan.scenario.area
    if crop:
        plan, ground = _cropped(plan, ground)
    scenario, area = plan.scenario, plan.scenario.area
    scale = scale_for(area, width)
    if paths is None:
        paths = scenario.robot_count <= MOST_PATHS and plan.steps <= MOST_PATH_STEPS and scale >= PATHS_FROM
    arrived, stranded = np.flatnonzero(plan.arrived), np.flatnonzero(~plan.arrived)
    shades = palette.visits_ramp(_SHADES)
    first = _SHADES
    cells = make.base_cells(scenario, first, first + 1, first + 2)
    keys: list[Key | Ramp] = [*_barrier_key(area, ground), Key("cell", DESTINATION, "destination")]
    marks: list[Mark] = make.destination_marks(scenario, scale)
    if paths:
        for robot, path in enumerate(make.robot_paths(plan)):
            colour = SERIES[robot % len(SERIES)] if plan.arrived[robot] else STRANDED
            marks.append(Lines((path,), max(2.0, 0.06 * scale), colour))
            marks += make.robot_marks(scenario, np.array([robot]), colour, scale)
        keys += [Key("disc", MOVING, "robot and its path")] if arrived.size else []
    else:
        visits = visits_of(plan)
        most = max(1, int(visits[cells == first].max(initial=0)))
        is_shaded = (visits > 0) & (cells == first)
        cells[is_shaded] = np.rint(np.log(visits[is_shaded]) * ((_SHADES - 1) / max(np.log(most), 1e-9)))
        starts = arrived if make.leave_room(scenario, scale) else arrived[:0]
        marks += make.robot_marks(scenario, starts, MOVING, scale) + make.robot_marks(
            scenario, stranded, STRANDED, scale
        )
        keys += [Key("disc", MOVING, "start")] if starts.size else []
        keys += [Ramp(_samples(shades), "visits (log)", "1", str(most))] if is_shaded.any() else []
    keys += [Key("disc", STRANDED, "never arrives")] if stranded.size else []
    colours = np.vstack([shades, colour_rows([FREE, _barrier_colour(ground), DESTINATION])])
    bold = (*range(first), first + 1, first + 2)
    scene = Scene(area, cells, colours, scale, bold, tuple(marks), tuple(keys), ground=ground)
    part = "" if area is whole else f" of {whole.width} x {whole.height}"
    more = f"{part}, {arrived.size} of {scenario.robot_count} robots arrive"
    more += f", {plan.steps} steps, total time {plan.total_time}"
    return _titled(scene, title, f"Plan ({plan.planner})" if plan.planner else "Plan", more, legend)


def _cropped(plan: Plan, ground: Ground | None) -> tuple[Plan, Ground | None]:
    """Return the plan and the ground on the box around all free cells, two cells wider, if it is less than half."""
    scenario, area = plan.scenario, plan.scenario.area
    rows, columns = (np.flatnonzero(~area.barriers.all(axis=axis)) for axis in (1, 0))
    if plan.jumps.size or rows.size == 0:
        return plan, ground
    # Even steps leave the orientation of cells as it is.
    top, left = (max(0, (int(first[0]) - 2) // 2 * 2) for first in (rows, columns))
    barriers = area.barriers[top : rows[-1] + 3, left : columns[-1] + 3]
    if 2 * barriers.size > area.cell_count:
        return plan, ground
    x, y = (
        float(end - start)
        for end, start in zip(
            area.tessellation.centre_of_cell(left, top), area.tessellation.centre_of_cell(0, 0), strict=True
        )
    )
    part = Area(area.tessellation, barriers, area.name)
    destinations, robots = (
        np.stack(area.cell_to_xy(cells), axis=-1) - (left, top) for cells in (scenario.destinations, scenario.robots)
    )
    moved = Scenario(part, destinations, robots, waiting_cost=scenario.waiting_cost)
    if ground is not None:
        ground = replace(ground, corner=(ground.corner[0] + x, ground.corner[1] + y))
    return Plan(moved, plan.actions, plan.first_action, plan.planner, plan.optimal), ground


def _area_of(record: Area | Scenario) -> Area:
    return record if isinstance(record, Area) else record.area


def _barrier_colour(ground: Ground | None) -> palette.Colour:
    return BARRIER if ground is None else palette.TIGHT


def _barrier_key(area: Area, ground: Ground | None = None) -> list[Key | Ramp]:
    keys: list[Key | Ramp] = []
    if area.free_count < area.cell_count:
        keys.append(Key("cell", _barrier_colour(ground), "barrier" if ground is None else "no room"))
    return keys if ground is None else [Key("cell", palette.GROUND, "occupied"), *keys]


def _unreached_key(is_needed: bool | np.bool_) -> list[Key | Ramp]:
    return [Key("cell", UNREACHED, "not reached")] if is_needed else []


def _samples(shades: NDArray[np.uint8]) -> tuple[palette.Colour, ...]:
    """Return the shades as the legend takes them."""
    return tuple(tuple(shade) for shade in shades.tolist())


def _titled(scene: Scene, title: str | None, what: str, more: str, legend: bool) -> Picture:
    """Return the picture of `scene` with `title`, or with a title that says what it is, and with its legend or not."""
    area = scene.area
    if title is None:
        title = f"{what} of {area.name}" if area.name and what != "Area" else area.name or what
    edge = ", edge neighbours" if area.tessellation.neighbourhood == "edge" else ""
    subtitle = f"{area.tessellation.name}, {area.width} x {area.height} cells{edge}{more}"
    return Picture(
        replace(scene, title=title, subtitle=subtitle if title else "", legend=scene.legend if legend else ())
    )
