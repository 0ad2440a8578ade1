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
from pathlib import Path

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
    """Return the CPU time that the runs of a table report."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        return sum(float(value) for row in rows for name, value in row.items() if name.startswith("seconds") and value)


def tell(name: str, table: Path, cpu: float, own: float, reference: bytes) -> None:
    """Print what a way of working cost beside the work, and whether its table is that of the others."""
    work, runs = work_in(table), reference.count(b"\n")
    same = "same table" if without_seconds(table) == reference else "ANOTHER TABLE"
    beside, asking = 1000 * (cpu - work) / runs, 1000 * own / runs
    print(f"{name:34} {work:6.1f} {cpu:6.1f} {beside:10.2f} {asking:10.2f}   {same}", flush=True)


def compare_executors(folder: Path) -> bytes:
    """Print a line for each way of working, and return the table they agree on."""
    study = th.read_study(STUDY)
    print(f"{len(study)} runs; CPU seconds; ms of CPU a run beside its work: in all, of the one that asks")
    print(f"{'':34} {'work':>6} {'all':>6} {'all':>10} {'asking':>10}")
    table, reference = folder / "pool.csv", b""
    for jobs in (1, 2):
        begin, own = cpu_seconds(), time.process_time()
        th.write_study(study, table, jobs=jobs)
        reference = reference or without_seconds(table)
        tell(f"processes of its own, {jobs}", table, cpu_seconds() - begin, time.process_time() - own, reference)
    begin, own = cpu_seconds(), time.process_time()
    with ProcessPoolExecutor(2) as pool:
        th.write_study(study, folder / "futures.csv", executor=pool)
    asking = time.process_time() - own
    tell("concurrent.futures, 2 processes", folder / "futures.csv", cpu_seconds() - begin, asking, reference)
    with dask_cluster() as cluster:
        from trihex.studies.cluster import connected

        with connected(cluster.scheduler_address) as workers:
            processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
            begin, own = all_of(processes), time.process_time()
            th.write_study(study, folder / "dask.csv", executor=workers)
            asking = time.process_time() - own
            tell("Dask, 2 processes", folder / "dask.csv", all_of(processes) - begin, asking, reference)
    return reference


def all_of(processes: list[psutil.Process]) -> float:
    """Return the CPU time of processes that run."""
    return sum(sum(process.cpu_times()[:2]) for process in processes)


def dask_cluster() -> object:
    """Return a Dask cluster of two processes."""
    from distributed import LocalCluster

    return LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)


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
    from trihex.studies.cluster import connected

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
