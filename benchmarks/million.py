"""A million robots: generated area, plan, audit and picture by the command line, with time, memory and sizes.

`python -m benchmarks million` takes minutes; `--side 512 --robots 20000 --destinations 20` a few seconds. With
`--clock costs` moves last as long as they cost, with `--following forbid` nobody enters a cell that is being left.
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


def run(words: list[str], folder: Path) -> None:
    """Run a trihex command in `folder`; print what it says, its time and the most memory that it held."""
    begin = time.perf_counter()
    process = subprocess.Popen([sys.executable, "-m", "trihex", *words], cwd=folder)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    seconds = used.ru_utime + used.ru_stime
    shown = " ".join(words[:18]) + (" ..." if len(words) > 18 else "")
    print(
        f"    {seconds:.1f} s of CPU, {time.perf_counter() - begin:.1f} s, {used.ru_maxrss / 2**20:.2f} GiB, "
        f"status {process.returncode}: trihex {shown}",
        flush=True,
    )


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks million", description=__doc__)
    parser.add_argument("--side", type=int, default=4096)
    parser.add_argument("--robots", type=int, default=1_000_000)
    parser.add_argument("--destinations", type=int, default=1000)
    parser.add_argument("--planner", default="fcost")
    parser.add_argument("--tessellation", default="hexagonal")
    parser.add_argument("--clock", default="steps")
    parser.add_argument("--following", default="allow")
    parser.add_argument("--folder", type=Path, help="where the files stay; else they are removed")
    chosen = parser.parse_args(options)
    print(machine())
    with tempfile.TemporaryDirectory() as temporary:
        folder = chosen.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        size = f"{chosen.side},{chosen.side}"
        run(["generate", "random", "--size", size, "--density", "0.2", "--seed", "1", "--out", "area.map"], folder)
        area = th.read_area(folder / "area.map", chosen.tessellation)
        free = np.flatnonzero(~area.barriers)
        reached = th.make_n_scheme(th.Scenario(area, [int(free[free.size // 2])])).distance.reshape(-1) != NOT_REACHED
        exits = np.random.default_rng(1).choice(np.flatnonzero(reached), chosen.destinations, replace=False)
        x, y = area.cell_to_xy(exits)
        places = [word for place in zip(x, y, strict=True) for word in ("--destination", f"{place[0]},{place[1]}")]
        words = ["plan", "area.map", "--tessellation", chosen.tessellation, "--planner", chosen.planner]
        words += ["--clock", chosen.clock, "--following", chosen.following]
        words += ["--robots", str(chosen.robots), "--seed", "1", "--out", "plan.npz", "--picture", "plan.png"]
        run([*words, "--summary", "report.json", *places], folder)
        run(["check", "plan.npz"], folder)
        report = json.loads((folder / "report.json").read_text())
        told = ("arrived", "steps", "total_time", "lower_bound", "gap", "conflicts")
        print("    " + ", ".join(f"{name} {report[name]}" for name in told))
        for path in sorted(folder.iterdir()):
            print(f"    {path.name}: {path.stat().st_size / 1e6:.1f} MB")
