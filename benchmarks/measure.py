"""Measuring: CPU times of things run by turns, their medians, and how they grow."""

import os
import platform
import time
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np


def cpu_seconds(things: Mapping[str, Callable[[], object]], repeats: int, warm_up: bool = True) -> dict[str, float]:
    """Return the median CPU time of each of `things`, run by turns so that a busy machine hinders all alike.

    CPU time of this process, all its threads: on a machine shared with others it says more than the time on the wall.
    """
    if warm_up:
        for thing in things.values():
            thing()
    times: dict[str, list[float]] = {name: [] for name in things}
    for _ in range(repeats):
        for name, thing in things.items():
            start = time.process_time()
            thing()
            times[name].append(time.process_time() - start)
    return {name: float(np.median(values)) for name, values in times.items()}


def exponent(sizes: Sequence[float], seconds: Sequence[float]) -> float:
    """Return e of the power law ``seconds ~ size ** e`` that fits best."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def machine(*packages: str) -> str:
    """Return a line on the machine and the versions of what was measured."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        model = lines[0].split(":", 1)[1].strip() if lines else model
    versions = []
    for package in ("trihex", "numpy", "numba", *packages):
        try:
            versions.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            versions.append(f"{package} not installed")
    return f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}; {', '.join(versions)}"
