"""Studies: one table whoever works, what a run costs beside its work, and 20 processes killed while they work.

python -m benchmarks studies
"""

import csv
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import psutil

import trihex as th

STUDY = Path(__file__).with_name("study_500.toml")
KILLS = 20


def without_seconds(path: Path) -> bytes:
    """Return a table as CSV without its columns of seconds."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("seconds")]
    return "\n".join(",".join(row[i] for i in kept) for row in rows).encode()


def cpu_seconds() -> float:
    """Return the CPU time of this process and of the children that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def work_in(path: Path) -> float:
    """Return the CPU time that the runs of a table report; what planners of one scenario share is counted once."""
    seen, total = set(), 0.0
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            names = ["plan", "audit"] if row["scenario"] in seen else ["area", "field", "bound", "plan", "audit"]
            total += sum(float(row[f"seconds_{name}"]) for name in names)
            seen.add(row["scenario"])
    return total


def compare_executors(folder: Path) -> bytes:
    """Print a line for each way of working, and return the table they agree on."""
    study = th.read_study(STUDY)
    few = replace(study, trials=study.trials[:100])
    th.write_study(few, folder / "few.csv", jobs=1)  # loads what the one that asks needs
    print(f"{len(study)} runs; CPU: their own work, start of the workers, and for each further run beside its work")
    print(f"{'':34} {'work':>7} {'start':>7} {'in all':>10} {'asking':>10}")
    reference = b""

    def measure(name: str, executor: Any, clock: Callable[[], float], jobs: int = 1) -> None:
        nonlocal reference
        beside, asking = [], []
        if executor is not None:  # its workers stay, so they start before they are measured
            th.write_study(few, folder / "few.csv", executor=executor)
        for some in (few, study):
            table, begin, own = folder / "table.csv", clock(), time.process_time()
            th.write_study(some, table, executor=executor, jobs=jobs)
            beside.append(clock() - begin - work_in(table))
            asking.append(time.process_time() - own)
        reference = reference or without_seconds(table)
        same = "same table" if without_seconds(table) == reference else "ANOTHER TABLE"
        more = len(study) - len(few)
        each, own_each = (1000 * (values[1] - values[0]) / more for values in (beside, asking))
        start = beside[0] - each * len(few) / 1000
        print(
            f"{name:34} {work_in(table):5.1f} s {start:5.1f} s {each:7.2f} ms {own_each:7.2f} ms   {same}", flush=True
        )

    measure("1 process of its own", None, cpu_seconds, 1)
    measure("2 processes of its own", None, cpu_seconds, 2)
    with ProcessPoolExecutor(2) as pool:
        pool.submit(int).result()
        measure("concurrent.futures, 2 processes", pool, cpu_of_all)
    with dask_cluster() as cluster:
        from trihex.studies import connected

        with connected(cluster.scheduler_address) as workers:
            measure("Dask, 2 processes", workers, cpu_of_all)
    return reference


def cpu_of_all() -> float:
    """Return the CPU time of this process and of its children that live."""
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    return sum(sum(process.cpu_times()[:2]) for process in processes)


def dask_cluster() -> object:
    """Return a Dask cluster of two processes."""
    from distributed import LocalCluster

    return LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0")


def is_worker(process: psutil.Process) -> bool:
    """Tell whether a process is one that does runs."""
    try:
        return "trihex.studies.child" in process.cmdline()
    except psutil.Error:
        return False


def kill_some(folder: Path, name: str, most: int, choose: Callable[[psutil.Process], psutil.Process | None]) -> int:
    """Do the study by the command line and kill what `choose` finds until it is done; return how many were killed."""
    kills, chance = 0, random.Random(most)
    table = folder / "killed.csv"
    words = [sys.executable, "-m", "trihex", "study", str(STUDY), "--out", str(table), "--jobs", "2"]
    while True:
        with subprocess.Popen(words, stdout=subprocess.DEVNULL) as asking:
            rows = rows_in(table) + chance.randrange(100)
            while asking.poll() is None:
                time.sleep(0.01)
                if rows_in(table) < rows or kills == most:
                    continue
                time.sleep(chance.uniform(0, 0.1))
                victim = choose(psutil.Process(asking.pid)) if asking.poll() is None else None
                if victim is not None:
                    victim.send_signal(signal.SIGKILL)
                    kills += 1
                    print(f"  {name} killed when {rows_in(table)} rows were kept", flush=True)
                    rows += chance.randrange(1, 100)
        if asking.returncode == 0:
            return kills


def rows_in(table: Path) -> int:
    """Return how many rows the journal of a table keeps."""
    journal = Path(f"{table}.journal")
    try:
        return max(0, journal.read_bytes().count(b"\n") - 1)
    except FileNotFoundError:
        return 0


def a_worker(asking: psutil.Process) -> psutil.Process | None:
    """Return one of the processes that do runs."""
    workers = [child for child in asking.children() if is_worker(child)]
    return random.choice(workers) if workers else None


def compare_kills(folder: Path, reference: bytes) -> None:
    """Kill workers, those that ask, and workers of Dask, and print whether anything was lost or doubled."""
    total = 0
    for name, share, choose in (("a worker", 7, a_worker), ("the one that asks", 7, lambda asking: asking)):
        kills = 0
        while kills < share:
            kills += kill_some(folder, name, share - kills, choose)
            same = without_seconds(folder / "killed.csv") == reference
            print(f"{name}: {kills} killed: {'same table' if same else 'ANOTHER TABLE'}", flush=True)
        total += kills
    kills = 0
    from trihex.studies import connected

    while total + kills < KILLS:
        with dask_cluster() as cluster, connected(cluster.scheduler_address) as workers:
            moments = [random.Random(kills).randrange(20, 400) for _ in range(min(2, KILLS - total - kills))]

            def kill(done: int, runs: int, moments: list[int] = moments, cluster: object = cluster) -> None:
                nonlocal kills
                if moments and done >= moments[0]:
                    moments.pop(0)
                    os.kill(random.choice(list(cluster.workers.values())).process.process._process.pid, signal.SIGKILL)
                    kills += 1

            th.write_study(STUDY, folder / "killed.csv", executor=workers, progress=kill)
        same = without_seconds(folder / "killed.csv") == reference
        print(f"a worker of Dask: {kills} killed: {'same table' if same else 'ANOTHER TABLE'}", flush=True)
    print(f"{total + kills} killed in all")


def main(options: list[str]) -> None:
    with tempfile.TemporaryDirectory() as name:
        reference = compare_executors(Path(name))
        compare_kills(Path(name), reference)
