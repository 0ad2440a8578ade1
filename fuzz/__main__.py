"""Run the readers on damaged files: ``python -m fuzz --count 200000``.

The work is done in a second process with a limit of memory, which tells before each file which one it is. If it dies,
hangs or needs too much, that file is kept in the folder of findings, and the work goes on with the next one.
"""

from __future__ import annotations

import argparse
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

# Of one file: CPU seconds and memory beyond what was in use; the clock of a busy machine may show six times as much.
SECONDS, MEGABYTES, ADDRESS_SPACE = 20.0, 1000, 6 << 30


def work(first: int, last: int, options: argparse.Namespace) -> None:
    """Read the damaged files first..last-1; print the number of each before it is read, and what is wrong with it."""
    from fuzz.mutations import mutate
    from fuzz.seeds import make_seeds
    from fuzz.targets import TARGETS, fault_of

    folder: Path = options.folder
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    seeds = make_seeds()
    names = [name for name in TARGETS if options.only in name]
    for name in ("house.pgm", "house.yaml"):
        (folder / name).write_bytes(seeds[name])
    for name in names:  # compile and import all that is needed, so that no damaged file is charged with it
        fault = fault_of(TARGETS[name], _put(folder, name, seeds[name]))
        if fault:
            raise SystemExit(f"the seed {name} is at fault: {fault}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in range(first, last):
        random = Random(f"{options.seed}/{number}")
        name = names[number % len(names)]
        path = _put(folder, name, mutate(seeds[name], random, list(seeds.values())))
        print(f"at {number} {name}", flush=True)
        begin = time.process_time()
        fault = fault_of(TARGETS[name], path)
        took, used = time.process_time() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        if fault is None and took > SECONDS:
            fault = f"{took:.1f} s of work"
        if fault is None and used - peak > MEGABYTES * 1024:
            fault = f"{(used - peak) // 1024} MB of memory"
        peak = max(peak, used)
        if fault is None and (left := {one.name for one in folder.iterdir()} - {"house.pgm", "house.yaml", path.name}):
            fault = f"files left behind: {left}"
        if fault:
            print(f"fault {number} {fault!r}", flush=True)
            keep(options, number, name)


def _put(folder: Path, name: str, content: bytes) -> Path:
    path = folder / ("bad" + Path(name).suffix)
    path.write_bytes(content)
    for other in folder.glob("bad*"):
        if other != path:
            other.unlink()
    return path


def main() -> None:
    """Start workers until all files have been read."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="part of the name of a seed")
    parser.add_argument("--findings", type=Path, default=Path("fuzz/findings"))
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        work(*options.work, options)
        return
    first, faults, begin = 0, 0, time.monotonic()
    while first < options.count:
        with TemporaryDirectory() as folder:
            first, found = _watch(first, options, Path(folder))
        faults += found
        print(f"{first} files, {faults} at fault, {time.monotonic() - begin:.0f} s", flush=True)
    sys.exit(1 if faults else 0)


def _watch(first: int, options: argparse.Namespace, folder: Path) -> tuple[int, int]:
    """Run one worker; return the number of the next file and how many were at fault."""
    last = min(options.count, first + 20_000)
    command = [sys.executable, "-W", "error", "-X", "faulthandler", "-m", "fuzz", "--work", str(first), str(last)]
    command += ["--seed", str(options.seed), "--only", options.only, "--folder", str(folder)]
    command += ["--findings", str(options.findings)]
    worker = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    at, name, faults = first - 1, "", 0

    def give_up(*_: object) -> None:
        worker.kill()

    signal.signal(signal.SIGALRM, give_up)
    signal.alarm(120)  # the seeds
    assert worker.stdout is not None
    for line in worker.stdout:
        word, number, rest = line.rstrip("\n").split(" ", 2)
        if word == "at":
            at, name = int(number), rest
            signal.alarm(int(6 * SECONDS))
        else:
            faults += 1
            print(f"file {number} ({name}): {rest[:3000]}", flush=True)
    signal.alarm(0)
    if worker.wait() == 0:
        return last, faults
    if at < first:
        raise SystemExit("the worker does not start")
    print(f"file {at} ({name}): the worker ended with {worker.returncode}", flush=True)
    options.folder = folder
    keep(options, at, name)
    return at + 1, faults + 1


def keep(options: argparse.Namespace, number: int, name: str) -> None:
    """Copy the file that was read last to the findings."""
    options.findings.mkdir(parents=True, exist_ok=True)
    for path in options.folder.glob("bad*"):
        (options.findings / f"{number}-{name}").write_bytes(path.read_bytes())


if __name__ == "__main__":
    main()
