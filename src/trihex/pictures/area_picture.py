"""Area picture: barriers, destinations and robots before anything is planned."""

from __future__ import annotations

import numpy as np

from trihex.areas import Area, Ground, Scenario
from trihex.errors import check_type
from trihex.pictures import marks as make
from trihex.pictures.legend import barrier_colour, barrier_keys
from trihex.pictures.palette import DESTINATION, FREE, MOVING
from trihex.pictures.picture import Picture, titled
from trihex.pictures.scene import Key, Mark, Ramp, Scene, colour_rows, scale_for


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
        What stands in the world, painted onto the cells; that of the area is `area.ground`.

    Examples
    --------
    >>> picture_of_area(Area("square", [[0, 1], [0, 0]]), width=100, title="", legend=False).to_array().shape
    (100, 100, 3)
    """
    check_type("record", record, Area, Scenario)
    area, scale, more = _area_of(record), scale_for(_area_of(record), width), ""
    marks: list[Mark] = []
    keys: list[Key | Ramp] = barrier_keys(area, ground)
    if isinstance(record, Scenario):
        robots, more = np.arange(record.robot_count), f", {record.robot_count} robots"
        marks += make.destination_marks(record, scale) + make.robot_marks(record, robots, MOVING, scale)
        keys += [Key("cell", DESTINATION, "destination")]
        keys += [Key("disc", MOVING, "robot")] if robots.size else []
    cells, colours = make.base_cells(record, 0, 1, 2), colour_rows([FREE, barrier_colour(ground), DESTINATION])
    scene = Scene(area, cells, colours, scale, (1, 2), tuple(marks), tuple(keys), ground=ground)
    return titled(scene, title, "Area", more, legend)


def _area_of(record: Area | Scenario) -> Area:
    return record if isinstance(record, Area) else record.area
