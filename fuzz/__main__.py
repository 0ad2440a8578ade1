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
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

# Of one file: CPU seconds and memory beyond what was in use; the clock of a busy machine may show six times as much.
SECONDS, MEGABYTES, ADDRESS_SPACE = 20.0, 1000, 6 << 30
# Shares of files: bombs take seconds each, links stand for few different things.
_BOMBS, _LINKS = 1 / 1000, 1 / 200
_REALLY = "bad-really"


def work(first: int, last: int, options: argparse.Namespace) -> None:
    """Read the damaged files first..last-1; print the number of each before it is read, and what is wrong with it."""
    from fuzz.mutations import mutate
    from fuzz.seeds import make_seeds
    from fuzz.targets import TARGETS, Outcome, outcome_of

    folder: Path = options.folder
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    seeds = make_seeds()
    names = [name for name in TARGETS if options.only in name]
    kept = {"house.pgm", "house.yaml", "yard.map"}
    for name in kept:
        (folder / name).write_bytes(seeds[name])
    for name in names:  # compile and import all that is needed, so that no damaged file is charged with it
        outcome = outcome_of(TARGETS[name], _put(folder, name, seeds[name]))
        if outcome.word != "read":
            raise SystemExit(f"the seed {name} is not read: {outcome}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in range(first, last):
        random = Random(f"{options.seed}/{number}")
        name = names[number % len(names)]
        path = _put(folder, name, mutate(seeds[name], random, list(seeds.values()), _BOMBS))
        if random.random() < _LINKS and not name.endswith(".bundle"):  # requests are no files
            _link(path, random)
        print(f"at {number} {name}", flush=True)
        begin = time.process_time()
        outcome = outcome_of(TARGETS[name], path)
        took, used = time.process_time() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        more = max(0, used - peak) // 1024
        peak = max(peak, used)
        left = {one.name for one in folder.iterdir()} - kept - {path.name, _REALLY}
        if outcome.word != "fault":
            too_much = [
                *([f"{took:.1f} s of work"] if took > SECONDS else []),
                *([f"{more} MB of memory"] if more > MEGABYTES else []),
                *([f"files left behind: {left}"] if left else []),
            ]
            outcome = Outcome("fault", ", ".join(too_much)) if too_much else outcome
        print(f"done {number} {outcome.word} {took:.3f} {more}", flush=True)
        if outcome.word == "fault":
            print(f"fault {number} {outcome.text!r}", flush=True)
            keep(options, number, name)


def _put(folder: Path, name: str, content: bytes) -> Path:
    """Write the next file, after the last one and what it left behind are gone."""
    path = folder / ("bad" + Path(name).suffix)
    for other in (*folder.glob("bad*"), *folder.glob("copy*"), *folder.glob(".trihex*")):
        other.unlink()
    path.write_bytes(content)
    return path


def _link(path: Path, random: Random) -> None:
    """Put a link in place of a file, to something that is not what it seems."""
    really = path.with_name(_REALLY)
    path.rename(really)
    places = (path, path.parent, "nowhere", really, "/dev/zero", "/dev/null", "/dev/full", "/proc/self/mem")
    path.symlink_to(place := random.choice(places))
    if place != really:
        really.unlink()


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
    first, tallies, begin = 0, defaultdict[str, Tally](Tally), time.monotonic()
    while first < options.count:
        with TemporaryDirectory() as folder:
            first = _watch(first, options, Path(folder), tallies)
        faults = sum(tally.fault for tally in tallies.values())
        print(f"{first} files, {faults} at fault, {time.monotonic() - begin:.0f} s", flush=True)
    print("\n".join(table_of(tallies)))
    sys.exit(1 if faults else 0)


@dataclass
class Tally:
    """What came of the files of one kind: how many, and the most seconds and megabytes that one took."""

    read: int = 0
    refused: int = 0
    fault: int = 0
    seconds: float = 0.0
    megabytes: int = 0


def table_of(tallies: Mapping[str, Tally]) -> list[str]:
    """Return the tallies as a table in Markdown, with their sum in the last row."""
    lines = [
        "| damaged | files | read | refused | at fault | longest, CPU s | most memory, MB |",
        "|---|---|---|---|---|---|---|",
    ]
    parts = list(tallies.values())
    total = Tally(
        *(sum(getattr(part, name) for part in parts) for name in ("read", "refused", "fault")),
        max(part.seconds for part in parts),
        max(part.megabytes for part in parts),
    )
    for name, one in [*sorted(tallies.items()), ("all", total)]:
        counts = f"{one.read + one.refused + one.fault} | {one.read} | {one.refused} | {one.fault}"
        lines.append(f"| {name} | {counts} | {one.seconds:.2f} | {one.megabytes} |")
    return lines


def _watch(first: int, options: argparse.Namespace, folder: Path, tallies: dict[str, Tally]) -> int:
    """Run one worker; add to the tallies, and return the number of the next file."""
    last = min(options.count, first + 20_000)
    command = [sys.executable, "-W", "error", "-X", "faulthandler", "-m", "fuzz", "--work", str(first), str(last)]
    command += ["--seed", str(options.seed), "--only", options.only, "--folder", str(folder)]
    command += ["--findings", str(options.findings)]
    worker = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    at, name = first - 1, ""

    def give_up(*_: object) -> None:
        worker.kill()

    signal.signal(signal.SIGALRM, give_up)
    signal.alarm(600)  # the seeds
    assert worker.stdout is not None
    for line in worker.stdout:
        word, number, rest = line.rstrip("\n").split(" ", 2)
        if word == "at":
            at, name = int(number), rest
            signal.alarm(int(12 * SECONDS))
        elif word == "done":
            outcome, seconds, megabytes = rest.split()
            tally = tallies[name]
            setattr(tally, outcome, getattr(tally, outcome) + 1)
            tally.seconds, tally.megabytes = max(tally.seconds, float(seconds)), max(tally.megabytes, int(megabytes))
        else:
            print(f"file {number} ({name}): {rest[:3000]}", flush=True)
    signal.alarm(0)
    if worker.wait() == 0:
        return last
    if at < first:
        raise SystemExit("the worker does not start")
    print(f"file {at} ({name}): the worker ended with {worker.returncode}", flush=True)
    tallies[name].fault += 1
    options.folder = folder
    keep(options, at, name)
    return at + 1


def keep(options: argparse.Namespace, number: int, name: str) -> None:
    """Copy the file that was read last to the findings."""
    options.findings.mkdir(parents=True, exist_ok=True)
    for path in options.folder.glob("bad*"):
        if path.is_symlink():
            print(f"file {number} is a link to {path.readlink()}", flush=True)
            continue
        (options.findings / f"{number}-{name}").write_bytes(path.read_bytes())


if __name__ == "__main__":
    main()
