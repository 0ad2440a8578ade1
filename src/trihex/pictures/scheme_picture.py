"""Scheme picture: how far each cell is from a destination, and which moves are the best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import check_type
from trihex.fields import DScheme, NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures import marks as make, palette
from trihex.pictures.legend import barrier_keys, colours_of, unreached_keys
from trihex.pictures.palette import BARRIER, DESTINATION, FREE, INK, UNREACHED
from trihex.pictures.picture import Picture, titled
from trihex.pictures.scene import Key, Lines, Mark, Ramp, Scene, colour_rows, scale_for

ARROWS_FROM = 18.0  # pixels per edge step
_SHADES = 240


def picture_of_n_scheme(
    n_scheme: NScheme, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of an N-scheme: the distance of each cell as colour, and as number where it fits.

    The parameters are those of `picture_of_area`.
    """
    check_type("n_scheme", n_scheme, NScheme)
    area = n_scheme.scenario.area
    scene = _scene_of_distances(n_scheme.scenario, n_scheme.distance, scale_for(area, width))
    return titled(scene, title, "N-scheme", f", costs {area.tessellation.costs}", legend)


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
    check_type("scenario", scenario, Scenario)
    distance = np.where(scenario.area.barriers, NOT_REACHED, states)
    scene = _scene_of_distances(scenario, distance, scale_for(scenario.area, width), far)
    return titled(scene, title, f"Generation {number}", f", costs {scenario.area.tessellation.costs}", legend)


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
        Ramp(colours_of(shades), "distance", "0", str(far)),
        Key("cell", DESTINATION, "destination"),
        *barrier_keys(area),
        *unreached_keys((cells == _SHADES + 2).any()),
    ]
    return Scene(area, cells, colours, scale, (_SHADES, _SHADES + 1), tuple(marks), tuple(keys))


def picture_of_d_scheme(
    d_scheme: DScheme, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of a D-scheme: arrows along all best moves, or their mean as colour where cells are small.

    The parameters are those of `picture_of_area`.
    """
    check_type("d_scheme", d_scheme, DScheme)
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
    keys += [Key("cell", DESTINATION, "destination"), *barrier_keys(area)]
    keys += unreached_keys((cells == first + 2).any())
    colours = np.vstack([shades, colour_rows([BARRIER, DESTINATION, UNREACHED])])
    scene = Scene(area, cells, colours, scale, (first, first + 1), tuple(marks), tuple(keys))
    return titled(scene, title, "D-scheme", "", legend)
