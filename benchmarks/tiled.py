"""Tiled fields: an area larger than memory, its time and memory, and how the in-memory kernel does beside it.

`python -m benchmarks tiled` takes 8192 cells a side; with ``--side 32768`` 5.4 GB of disk in ``--folder``, and minutes.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import trihex as th
from benchmarks.measure import machine
from trihex.kernels.codes import NOT_REACHED

WORK = """
import json, resource, sys, time
sys.path[:] = json.loads(sys.argv[2])
arguments = json.loads(sys.argv[1])
import numpy as np, trihex as th
from trihex.fields.tiled import make_tiled_field
th.make_n_scheme(th.Scenario(th.Area("hexagonal", [[0, 0]]), [0]))  # kernels are loaded
begin = time.process_time()
if arguments["tiled"]:
    field = make_tiled_field(arguments["area"], arguments["destinations"], arguments["out"], side=arguments["tile"])
    visits = field.visit_count
else:
    scenario = th.Scenario(th.Area("hexagonal", np.load(arguments["area"])), arguments["destinations"])
    th.make_n_scheme(scenario)
    begin = time.process_time()
    n_scheme = th.make_n_scheme(scenario)
    visits = 1
took = time.process_time() - begin
used = resource.getrusage(resource.RUSAGE_SELF)
if not arguments["tiled"]:
    np.save(arguments["out"], n_scheme.distance)
print(json.dumps([took, used.ru_maxrss / 2**20, visits]))
"""


def make_area(path: Path, side: int) -> tuple[int, int]:
    """Write a random area, 20 % barriers, row by row of tiles; return a free cell near its middle."""
    cells = np.lib.format.open_memmap(path, mode="w+", dtype=np.uint8, shape=(side, side))
    random = np.random.default_rng(1)
    for row in range(0, side, 512):
        cells[row : row + 512] = random.integers(0, 256, (min(512, side - row), side), dtype=np.uint8) < 51
    middle = side // 2
    return middle + int(np.argmin(cells[middle, middle:])), middle


def run(arguments: dict[str, object]) -> tuple[float, float, float, int]:
    """Return CPU seconds, seconds of the whole process, GiB and visits of one field, in a process of its own."""
    begin = time.perf_counter()
    words = [sys.executable, "-c", WORK, json.dumps(arguments), json.dumps(sys.path)]
    seconds, memory, visits = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    return seconds, time.perf_counter() - begin, memory, visits


def check(area: Path, out: Path, windows: int) -> int:
    """Raise unless each cell of windows all over is one move beyond its nearest neighbour; return the cells checked."""
    barriers, field = np.load(area, mmap_mode="r"), np.load(out, mmap_mode="r")
    side, checked = len(field), 0
    random = np.random.default_rng(2)
    steps = th.Tessellation("hexagonal").step_of_direction
    for _ in range(windows):
        y, x = (int(start) // 2 * 2 for start in random.integers(2, side - 512, 2))
        here = field[y : y + 510, x : x + 510].astype(np.int64)
        near = np.full(here.shape, NOT_REACHED, dtype=np.int64)
        for o in (0, 1):
            for dx, dy in steps[o].tolist():
                there = field[y + dy : y + dy + 510, x + dx : x + dx + 510]
                near[:, o::2] = np.minimum(near[:, o::2], there[:, o::2])
        is_free = barriers[y : y + 510, x : x + 510] == 0
        want = np.where(near < NOT_REACHED, near + 10, NOT_REACHED)
        if not np.array_equal(here[is_free & (here > 0)], want[is_free & (here > 0)]):
            raise AssertionError(f"the field is wrong somewhere between {x, y} and {x + 510, y + 510}")
        if (here[~is_free] != NOT_REACHED).any():
            raise AssertionError("a barrier has a distance")
        checked += here.size
    return checked


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks tiled", description=__doc__)
    parser.add_argument("--side", type=int, default=8192)
    parser.add_argument("--tile", type=int, default=2048)
    parser.add_argument("--folder", type=Path, help="where the files are made and removed")
    chosen = parser.parse_args(options)
    print(machine())
    with tempfile.TemporaryDirectory(dir=chosen.folder) as folder:
        rates = {}
        for side, is_tiled in dict.fromkeys([(8192, False), (8192, True), (chosen.side, True)]):
            area, out = Path(folder) / f"{side}.npy", Path(folder) / f"field-{side}-{is_tiled}.npy"
            start = make_area(area, side)
            seconds, wall, memory, visits = run(
                {"area": str(area), "destinations": [start], "out": str(out), "tiled": is_tiled, "tile": chosen.tile}
            )
            rates[side, is_tiled] = side * side * 0.8 / seconds / 1e6
            print(
                f"{side} x {side}, {'in tiles' if is_tiled else 'in memory'}: {seconds:.1f} s of CPU, {wall:.1f} s, "
                f"{rates[side, is_tiled]:.1f} million free cells a second, {memory:.2f} GiB at most, {visits} visits, "
                f"{check(area, out, 64)} cells checked",
                flush=True,
            )
            if side == 8192 and is_tiled:
                other = Path(folder) / "field-8192-False.npy"
                print("equal to the field in memory:", np.array_equal(np.load(out), np.load(other)), flush=True)
            if side != 8192:
                os.unlink(area)
                os.unlink(out)
        print(f"in tiles / in memory: {rates[chosen.side, True] / rates[8192, False]:.2f} of the speed")
