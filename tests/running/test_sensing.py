"""Sensor: what is seen, against lines drawn through polygons with shapely."""

import numpy as np
import pytest
import shapely

import trihex as th
from trihex.running import Sensor, Trial


def mask_of(area, cell):
    """Return where the one cell is."""
    mask = np.zeros(area.barriers.shape, dtype=bool)
    mask[cell[1], cell[0]] = True
    return mask


def seen_from(area, cell, sensor):
    """Return the cells, as (x, y), that a robot which stands at `cell` has seen before its first move."""
    far = (0, 0) if cell != (0, 0) else (area.width - 1, area.height - 1)
    trial = Trial(
        th.Scenario(th.Area(area.tessellation, area.barriers & ~mask_of(area, far)), [far], [cell]), sensor=sensor
    )
    trial.step()
    y, x = np.nonzero(trial.record().known_since >= 0)
    return set(zip(x.tolist(), y.tolist(), strict=True))


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
@pytest.mark.parametrize("radius", [0, 1, 2.5, 4])
def test_all_within_the_radius_and_all_neighbours_are_seen(name, radius):
    tessellation = th.Tessellation(name)
    area = th.Area(tessellation, np.zeros((13, 15), dtype=bool))
    y, x = np.mgrid[:13, :15]
    centre_x, centre_y = tessellation.centre_of_cell(x, y)
    for cell in ((7, 6), (6, 6), (1, 1), (14, 12)):
        here = tessellation.centre_of_cell(*cell)
        near = np.hypot(centre_x - here[0], centre_y - here[1]) <= max(radius, 0) + 1e-6
        side = int(tessellation.orientation_of_cell(*cell))
        for dx, dy in tessellation.step_of_direction[side].tolist():
            if 0 <= cell[0] + dx < 15 and 0 <= cell[1] + dy < 13:
                near[cell[1] + dy, cell[0] + dx] = True
        want = set(zip(x[near].tolist(), y[near].tolist(), strict=True))
        assert seen_from(area, cell, Sensor(tessellation, radius)) == want


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_barriers_hide_what_lies_behind_them(name):
    rng, tessellation = np.random.default_rng(5), th.Tessellation(name)
    hidden = visible = 0
    for _ in range(6):
        barriers = rng.random((11, 13)) < 0.15
        barriers[5, 6] = False
        area, sensor = th.Area(tessellation, barriers), Sensor(tessellation, 5, line_of_sight=True)
        seen = seen_from(area, (6, 5), sensor)
        everything = seen_from(area, (6, 5), Sensor(tessellation, 5))
        walls = {(x, y): shapely.Polygon(tessellation.polygon_of_cell(x, y)) for y, x in np.argwhere(barriers).tolist()}
        cores = {at: wall.buffer(-0.02) for at, wall in walls.items()}  # a line along an edge passes no wall for sure
        here, side = tessellation.centre_of_cell(6, 5), int(tessellation.orientation_of_cell(6, 5))
        near = {(6 + dx, 5 + dy) for dx, dy in tessellation.step_of_direction[side].tolist()}
        for cell in everything - near - {(6, 5)}:
            line = shapely.LineString([here, tessellation.centre_of_cell(*cell)])
            inside = sum(line.intersection(core).length for at, core in cores.items() if at != cell)
            if inside > 0.3:
                assert cell not in seen
                hidden += 1
            elif inside < 1e-9 and all(line.distance(wall) > 1e-9 for at, wall in walls.items() if at != cell):
                assert cell in seen
                visible += 1
        assert seen <= everything
    assert hidden > 30 and visible > 100


def test_a_radius_that_is_none_is_refused():
    for wrong in (-1, 101, "far", True, float("nan")):
        with pytest.raises(th.ScenarioError, match="sensing radius must be a number from 0 to 100"):
            Sensor(th.Tessellation("square"), wrong)
