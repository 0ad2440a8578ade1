"""Repair: a field after one cell has changed, repaired in place, beside a field made afresh.

Cells are drawn evenly from those whose change matters: a door is a free cell in a wall between two rooms, with a
barrier on either side; a cell is any cell but the destination. Each is toggled and toggled back, both repairs count.
"""

import argparse
import time
from collections.abc import Iterator

import numpy as np

import trihex as th
from benchmarks.measure import cpu_seconds, machine
from trihex.fields import LivingField
from trihex.kernels.codes import NOT_REACHED

TESSELLATIONS = ("square", "hexagonal", "triangular")
AREAS = {"random": th.make_random_area, "rooms": th.make_rooms_area}


def doors_of(barriers: np.ndarray) -> np.ndarray:
    """Return the numbers of free cells between two barriers that lie west and east, or north and south, of them."""
    free = ~barriers[1:-1, 1:-1]
    across = barriers[1:-1, :-2] & barriers[1:-1, 2:] & ~barriers[:-2, 1:-1] & ~barriers[2:, 1:-1]
    along = barriers[:-2, 1:-1] & barriers[2:, 1:-1] & ~barriers[1:-1, :-2] & ~barriers[1:-1, 2:]
    y, x = np.nonzero(free & (across | along))
    return (y + 1) * barriers.shape[1] + x + 1


def toggles(field: LivingField, cells: np.ndarray) -> Iterator[tuple[float, int]]:
    """Toggle each of `cells` and back; yield the CPU seconds of each repair, and the cells it touched."""
    for cell in cells.tolist():
        for _ in range(2):
            name = "freed" if field.barriers.flat[cell] else "blocked"
            start = time.process_time_ns()
            repair = field.change(**{name: np.array([cell])})
            yield (time.process_time_ns() - start) / 1e9, repair.touched


def compare(kind: str, what: str, tessellation: str, corners: str, options: argparse.Namespace) -> None:
    """Print a line: a fresh field in ms, the median repair in ms, and how many times as long the fresh one takes."""
    area = AREAS[kind](tessellation, options.size, options.size, seed=1)
    free = np.flatnonzero(~area.barriers)
    middle = free[[np.argmin(np.abs(free - (area.cell_count + area.width) // 2))]]
    scenario = th.Scenario(area, middle, corners=corners)
    _ = scenario.moves
    n_scheme = th.make_n_scheme(scenario)
    fresh = cpu_seconds({"fresh": lambda: th.make_n_scheme(scenario)}, 5)["fresh"]
    field = LivingField(scenario, n_scheme.distance_of_site)
    rng = np.random.default_rng(options.seed)
    cells = doors_of(area.barriers) if what == "door" else np.setdiff1d(np.arange(area.cell_count), middle)
    reached = n_scheme.distance.flat[cells]
    cells = cells[(reached != NOT_REACHED) | area.barriers.flat[cells]]
    cells = rng.choice(cells[cells != middle[0]], size=min(options.count, cells.size), replace=False)
    seconds, touched = np.array(list(toggles(field, cells))).T
    if not np.array_equal(field.distance_of_site, n_scheme.distance_of_site):
        raise AssertionError("toggled and toggled back, the field differs")
    ratio = np.sort(fresh / seconds)
    shares = " ".join(f"{np.quantile(ratio, q):9.1f}" for q in (0.0, 0.01, 0.05, 0.25, 0.5, 0.75))
    print(
        f"{kind:7} {what:5} {tessellation:11} {corners:11} {1e3 * fresh:7.0f} {1e3 * np.median(seconds):8.3f} {shares}"
        f" {fresh / seconds.mean():8.1f} {np.median(touched):8.0f} {touched.max():9.0f}",
        flush=True,
    )


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks repair")
    parser.add_argument("--tessellations", nargs="*", default=list(TESSELLATIONS), choices=TESSELLATIONS)
    parser.add_argument("--corners", nargs="*", default=["allow", "no-cut"])
    parser.add_argument("--size", type=int, default=4096)
    parser.add_argument("--count", type=int, default=500, help="cells toggled")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    print(machine())
    print("CPU ms of a fresh field and of the median repair; the fresh one is so many times as long as the repair:")
    print(
        "area    what  tessellation corners    fresh   repair     worst        1%        5%       25%    median"
        "       75%     mean  touched      most",
        flush=True,
    )
    for tessellation in options.tessellations:
        for corners in options.corners:
            for kind, what in (("random", "cell"), ("rooms", "cell"), ("rooms", "door")):
                compare(kind, what, tessellation, corners, options)
