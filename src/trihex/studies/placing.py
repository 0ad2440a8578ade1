"""Placing: destinations and robots put by words, such as centre or west, where no cells are given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, make_regions, random_robots
from trihex.errors import ScenarioError
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED

SIDES = ("west", "east", "north", "south")
# "file": those that the file of the area names.
DESTINATION_PLACES = ("centre", *SIDES, "random", "file")
ROBOT_PLACEMENTS = ("uniform", *SIDES, "far")


def place_destinations(area: Area, place: str, count: int, seed: int) -> NDArray[np.int64]:
    """Return the numbers of `count` cells of the largest region of `area`.

    ``centre``: those nearest to the centre of the area. A side: those nearest to points that part it evenly.
    ``random``: drawn by `seed`.

    Raises
    ------
    ScenarioError
        If there are fewer cells.
    """
    cells = np.flatnonzero(make_regions(area).region_of_cell.reshape(-1) == 0)
    if count > cells.size:
        raise ScenarioError(f"destinations must be at most the number of connected cells, {cells.size}, not {count}")
    if place == "random":
        # The robots are drawn by the same seed, so this must be another sequence.
        return np.random.default_rng([seed, 1]).choice(cells, size=count, replace=False).astype(np.int64)
    x, y = area.tessellation.centre_of_cell(*area.cell_to_xy(cells))
    width, height = area.tessellation.extent(area.height, area.width)
    if place == "centre":
        away = (x - width / 2) ** 2 + (y - height / 2) ** 2
        return np.asarray(cells[np.argsort(away, kind="stable")[:count]])
    chosen: list[int] = []
    for share in (np.arange(count) + 0.5) / count:
        px = {"west": 0.0, "east": width}.get(place, share * width)
        py = {"north": 0.0, "south": height}.get(place, share * height)
        away = (x - px) ** 2 + (y - py) ** 2
        away[chosen] = np.inf
        chosen.append(int(np.argmin(away)))
    return np.asarray(cells[chosen])


def place_robots(n_scheme: NScheme, count: int, placement: str, seed: int) -> NDArray[np.int64]:
    """Return the numbers of `count` cells that reach a destination, drawn by `seed`: anywhere, or in half of the area.

    Anywhere, they are those that `trihex plan --robots COUNT --seed SEED` draws. ``far``: those farthest from the
    destinations, whatever the seed.

    Raises
    ------
    ScenarioError
        If there are fewer cells.
    """
    scenario = n_scheme.scenario
    area = scenario.area
    apart = np.flatnonzero(n_scheme.distance.reshape(-1) == NOT_REACHED)
    avoid = np.union1d(apart, scenario.destinations)
    if placement == "uniform":
        if count > area.cell_count - avoid.size:
            avoid = scenario.destinations
        return random_robots(area, count, seed, avoid=avoid)
    if placement == "far":
        cells = np.setdiff1d(np.arange(area.cell_count), avoid)
        if count > cells.size:
            raise ScenarioError(
                f"robots must be at most the number of cells that reach a destination, {cells.size}, not {count}"
            )
        return np.asarray(cells[np.argsort(-n_scheme.distance.reshape(-1)[cells], kind="stable")[:count]])
    x, y = area.tessellation.centre_of_cell(*area.cell_to_xy(np.arange(area.cell_count)))
    width, height = area.tessellation.extent(area.height, area.width)
    is_chosen = {"west": x < width / 2, "east": x > width / 2, "north": y < height / 2, "south": y > height / 2}
    return random_robots(area, count, seed, avoid=np.union1d(avoid, np.flatnonzero(~is_chosen[placement])))
