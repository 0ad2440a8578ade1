"""Radius: what robots of one radius do on cells as small as each rule allows: ``python -m examples.studies.radius``.

Writes `radius.csv`, a row for each kind of cells, clock and rule, place and seed:

- ``door``: 120 robots stand before a door; `flow` is how many pass in a second, between the first and the last tenth.
- ``hall``: 60 robots, at the same places whatever the cells, leave the halls of the other studies by three exits of 1
  metre radius; `mean` and `last` are seconds.
- ``floor``: 12 rooms with doors of one width at places that the seed draws; `share` is the area of the cells that are
  connected with the exit, over what a disc of that radius can reach.

Robots go 1 metre a second at most. Where there is no way to an exit the numbers are 0 or empty.
"""

import csv
import random
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from examples.studies.grounds import GROUNDS, HEIGHT, WALL, WIDTH, Ring, box, text_of

import trihex as th
from trihex.areas import least_cell_size
from trihex.kernels.codes import NOT_REACHED

RADIUS, SEEDS = 0.15, 10
KINDS = [("triangular", "full"), ("triangular", "edge"), ("hexagonal", "full"), ("square", "full"), ("square", "edge")]
DOORS, WIDTHS = (1.0, 1.5, 2.0, 3.0), (0.6, 0.8, 1.0, 1.4)
AREA_OF_CELL = {"triangular": 0.75 * 3**0.5, "hexagonal": 0.5 * 3**0.5, "square": 1.0}
BEFORE_DOOR, IN_HALL = 120, 60
FARTHEST = (
    2.5  # metres from a robot's place to its cell; beyond, that part of the hall cannot be reached on these cells
)
COLUMNS = (
    "what", "place", "seed", "tessellation", "neighbourhood", "clock", "following", "cell_size", "robots", "flow",
    "mean", "last", "gap", "conflicts", "share",
)  # fmt: skip

Row = dict[str, object]


def rules() -> Iterator[tuple[th.Tessellation, str]]:
    """Yield all cells with their clocks and rules; where all moves last as long there is one clock."""
    for name, neighbourhood in KINDS:
        is_uneven = neighbourhood == "full" and name != "hexagonal"
        for clock in ("steps", "costs") if is_uneven else ("steps",):
            for following in ("allow", "forbid"):
                yield th.Tessellation(name, neighbourhood, "euclidean", clock=clock), following


def door_ground(width: float, seed: int) -> list[Ring]:
    """Return a wall across the hall at 16 metres, with one door that the seed puts somewhere near its middle."""
    south = round(random.Random(seed).uniform(0.4, 0.6) * HEIGHT - width / 2, 3)
    return [box(16, 0.05, WALL, south - 0.05), box(16, south + width, WALL, HEIGHT - 0.05 - south - width)]


def rooms_ground(width: float, seed: int) -> list[Ring]:
    """Return the walls of 4 by 3 rooms; each has a door to the east and one to the north, somewhere."""
    chance, rings = random.Random(seed), []

    def wall(at: float, begin: float, end: float, *, upright: bool) -> None:
        door = chance.uniform(begin + 0.5, end - 0.5 - width)
        for low, high in ((begin, door), (door + width, end)):
            sides = (at, low, WALL, high - low) if upright else (low, at, high - low, WALL)
            rings.append(box(*(round(side, 3) for side in sides)))

    for column in range(4):
        for row in range(3):
            west, south = column * 6.0, row * 6.0
            if column < 3:
                wall(west + 6 - WALL / 2, south + WALL / 2 + 0.01, south + 6 - WALL / 2 - 0.01, upright=True)
            if row < 2:
                wall(south + 6 - WALL / 2, west + WALL / 2 + 0.01, west + 6 - WALL / 2 - 0.01, upright=False)
    return rings


def area_of(rings: list[Ring], tessellation: th.Tessellation, following: str) -> th.Area:
    """Return the hall with its walls on cells as small as the rules allow."""
    size = round(least_cell_size(tessellation, RADIUS, following) * 1.0001, 5)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hall.wkt"
        path.write_text(text_of(rings))
        return th.read_area(path, tessellation, cell_size=size, robot_radius=RADIUS, align="shift")


def places_of(area: th.Area) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the numbers of the free cells and where their centres are, in metres."""
    free = np.flatnonzero(~area.barriers.reshape(-1))
    x, y = area.cell_to_metres(free)
    return free, x, y


def times_of(scenario: th.Scenario) -> tuple[np.ndarray, Row]:
    """Return when robots arrive, in seconds and sorted, by a plan of fcost, and what else the row says of it."""
    n_scheme = th.make_n_scheme(scenario)
    plan = th.make_plan(scenario, "fcost", n_scheme=n_scheme)
    report = th.make_report(plan, n_scheme=n_scheme)
    seconds = scenario.area.tessellation.longest_tick * scenario.area.metres.cell_size
    times = np.sort(plan.arrival_step_of_robot * seconds)
    assert plan.arrived.all()
    told = {"mean": times.mean(), "last": times[-1], "gap": report.gap, "conflicts": report.audit.conflict_count}
    return times, {"robots": times.size, **told}


def at_door(area: th.Area, following: str, seed: int) -> Row:
    """Return the row of the robots nearest to a door, on four fifths of the cells, that go through it."""
    free, x, _ = places_of(area)
    empty = th.Scenario(area, free[x > 16 + WALL], following=following)
    distance = th.make_n_scheme(empty).distance.reshape(-1)
    before = free[(x < 16) & (distance[free] != NOT_REACHED)]
    if before.size < BEFORE_DOOR / 0.8:
        return {"robots": 0, "flow": 0.0}
    drawn = np.random.default_rng(seed).permutation(before)[: int(0.8 * before.size)]
    times, told = times_of(empty.with_robots(drawn[np.argsort(distance[drawn], kind="stable")[:BEFORE_DOOR]], seed))
    first, last = times.size // 10, times.size * 9 // 10
    return {**told, "flow": (last - first) / (times[last] - times[first])}


def in_hall(area: th.Area, following: str, seed: int) -> Row:
    """Return the row of robots that leave a hall; each stands on the cell nearest to its place."""
    free, x, y = places_of(area)
    exits = [np.hypot(x - WIDTH, y - HEIGHT * part) for part in (1 / 6, 1 / 2, 5 / 6)]
    inside = [away <= max(1.0, away.min()) for away in exits]
    empty = th.Scenario(area, free[np.any(inside, axis=0)], following=following)
    distance = th.make_n_scheme(empty).distance.reshape(-1)[free]
    chance, starts, is_left = np.random.default_rng(seed), [], (distance != NOT_REACHED) & (distance > 0)
    for px, py in chance.uniform((0.5, 0.5), (WIDTH - 3, HEIGHT - 0.5), (IN_HALL, 2)):
        away = np.where(is_left, np.hypot(x - px, y - py), np.inf)
        nearest = int(np.argmin(away))
        if away[nearest] > FARTHEST:
            return {"robots": 0}
        starts.append(free[nearest])
        is_left[nearest] = False
    return times_of(empty.with_robots(starts, seed))[1]


def on_floor(area: th.Area, following: str, rings: list[Ring]) -> Row:
    """Return the row of the cells connected with the one nearest to the exit, in the middle of the east wall."""
    import shapely

    free, x, y = places_of(area)
    exit_ = free[[np.argmin(np.hypot(x - WIDTH, y - HEIGHT / 2))]]
    reached = int((th.make_n_scheme(th.Scenario(area, exit_, following=following)).distance != NOT_REACHED).sum())
    hall = shapely.from_wkt(text_of(rings)).buffer(-RADIUS)
    parts = shapely.get_parts(hall)
    whole = parts[np.argmin(shapely.distance(parts, shapely.Point(WIDTH, HEIGHT / 2)))].area
    square_metres = AREA_OF_CELL[area.tessellation.name] * area.metres.cell_size**2
    return {"share": reached * square_metres / whole}


def rows(seeds: Iterable[int] = range(SEEDS)) -> Iterator[Row]:
    """Yield all rows of some seeds."""
    for tessellation, following in rules():
        for seed in seeds:
            for what, place, rings in (
                *(("door", width, door_ground(width, seed)) for width in DOORS),
                *(("hall", name, rings) for name, rings in GROUNDS.items()),
                *(("floor", width, rooms_ground(width, seed)) for width in WIDTHS),
            ):
                area = area_of(rings, tessellation, following)
                row: Row = {
                    "what": what, "place": place, "seed": seed, "tessellation": tessellation.name,
                    "neighbourhood": tessellation.neighbourhood, "clock": tessellation.clock, "following": following,
                    "cell_size": area.metres.cell_size,
                }  # fmt: skip
                if what == "floor":
                    yield row | on_floor(area, following, rings)
                else:
                    yield row | (at_door if what == "door" else in_hall)(area, following, seed)


def rounded(row: Row) -> Row:
    """Return the row as the table has it."""
    return {key: round(float(value), 6) if isinstance(value, float) else value for key, value in row.items()}


def main(path: Path) -> None:
    """Write the table."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for row in rows():
            writer.writerow(rounded(row))
            file.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("radius.csv"))
