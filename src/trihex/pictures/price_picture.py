"""Price picture: walls by what they cost, chokes by what they are worth, and where the next door had better be."""

from __future__ import annotations

import numpy as np

from trihex.errors import check_type
from trihex.pictures import marks as make, palette
from trihex.pictures.legend import barrier_keys, colours_of
from trihex.pictures.palette import BARRIER, DESTINATION, FREE, PAGE
from trihex.pictures.picture import Picture, titled
from trihex.pictures.scene import Discs, Key, Mark, Ramp, Scene, centres_of, colour_rows, scale_for
from trihex.prices import Prices

_SHADES = 120
_DOOR: palette.Colour = (160, 0, 160)
_CHANGES: palette.Colour = (204, 121, 167)


def picture_of_prices(
    prices: Prices, *, width: int | None = None, title: str | None = None, legend: bool = True, speed: float = 1.0
) -> Picture:
    """Return the picture of prices: barriers as dark as opening them saves, chokes as dark as closing them costs.

    Barriers that save nothing look as ever; what would change who can arrive has a colour of its own; the best next
    door is a disc.

    Parameters
    ----------
    prices : Prices
    width, title, legend
        As for `picture_of_area`.
    speed : float
        Metres in a second: a place in metres where all steps cost the same tells seconds.
    """
    check_type("prices", prices, Prices)
    scenario = prices.plan.scenario
    area, scale = scenario.area, scale_for(scenario.area, width)
    saved, lost = (prices.price_of_cell(kind).reshape(-1) for kind in ("barrier", "choke"))
    cells = make.base_cells(scenario, 2 * _SHADES, 2 * _SHADES + 1, 2 * _SHADES + 2)
    keys: list[Key | Ramp] = []
    factor = prices.seconds_per_unit(speed)
    unit, factor = ("units of time", 1.0) if factor is None else ("seconds", factor)
    ramps = (palette.visits_ramp(_SHADES), palette.distance_ramp(_SHADES))
    for values, first, shades, words in (
        (saved, 0, ramps[0], "saved if open"),
        (lost, _SHADES, ramps[1], "lost if closed"),
    ):
        most = int(values.max(initial=0))
        if most > 0:
            rows = values > 0
            cells.reshape(-1)[rows] = first + np.rint(values[rows] * ((_SHADES - 1) / most)).astype(np.int64)
            keys.append(Ramp(colours_of(shades), words, "0", f"{most * factor:.6g}"))
    changes = prices.cell[prices.robots != 0]
    if changes.size:
        cells.reshape(-1)[changes] = 2 * _SHADES + 3
        keys.append(Key("cell", _CHANGES, "changes who can arrive"))
    marks: list[Mark] = list(make.destination_marks(scenario, scale))
    door = np.flatnonzero((prices.kind == "door") & (prices.price > 0))
    if door.size:
        x, y = centres_of(area, prices.cell[door])
        marks += [Discs(x, y, 0.5, PAGE, 5.0), Discs(x, y, 0.42, _DOOR, 3.5)]
        told = prices.told(int(prices.price[door[0]]), speed)
        keys.append(Key("disc", _DOOR, f"best next door: saves {told}"))
    keys += [Key("cell", DESTINATION, "destination"), *barrier_keys(area)]
    colours = np.vstack([*ramps, colour_rows([FREE, BARRIER, DESTINATION, _CHANGES])])
    bold = (*range(2 * _SHADES), 2 * _SHADES + 1, 2 * _SHADES + 2, 2 * _SHADES + 3)
    scene = Scene(area, cells, colours, scale, bold, tuple(marks), tuple(keys))
    more = f", {scenario.robot_count} robots, {unit}" + ("" if prices.is_complete else ", not all proven")
    return titled(scene, title, "Prices", more, legend)
