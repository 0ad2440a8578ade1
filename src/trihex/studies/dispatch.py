"""Dispatch: all runs of a study done by some executor, kept as they come, in the order of the study."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from queue import SimpleQueue
from typing import Any, Protocol

from trihex.errors import StudyError, check_many
from trihex.files import check_output
from trihex.studies.journal import Journal
from trihex.studies.results import check_results, write_results
from trihex.studies.row import COLUMNS, Case, Row, blank_row
from trihex.studies.study import Study, make_study, read_study
from trihex.studies.worker import LIVES, Limits, close_workers, run_cases

Progress = Callable[[int, int], None]
# Groups of runs that each worker has at a time, so that none waits, and how many workers there are if nobody tells.
_IN_FLIGHT = 3
_WORKERS = 256
# Short runs are given to a worker together, as many as take about this long: a task of Dask costs some 10 ms of CPU.
_SECONDS_AT_ONCE = 0.3
_LARGEST_GROUP = 200
_ROWS_AT_ONCE = 1000


class Executor(Protocol):
    """Whatever has the `submit` of `concurrent.futures.Executor`, whose futures tell when they are done."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Any:
        """Return a future with `add_done_callback` and `result`."""
        ...


@dataclass(frozen=True)
class Outcome:
    """What came of a study: how many runs there are, how many of them failed or made an unsafe plan."""

    runs: int
    failed: int
    unsafe: int


def run_study(
    table: Study | str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    *,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Do all runs of a study and return their rows, in its order whoever did them when.

    Parameters
    ----------
    table : Study, path of a study file, or iterable of mapping
        For the latter see `make_study`: a mapping for each run.
    executor : executor, optional
        Of `concurrent.futures`, Dask (a `Client`), Ray, MPI, joblib's loky: what has `submit`. Default: this thread.
    progress : callable, optional
        Called with (runs done, all runs).

    Returns
    -------
    list of dict
        With the keys of `trihex.studies.row.COLUMNS`. A run that fails is a row with its `error`.

    Raises
    ------
    StudyError
        If there is a mistake in the table, or the executor breaks.

    Examples
    --------
    >>> area = {"generator": "rooms", "size": [24, 16]}
    >>> rows = run_study([{"area": area, "robots": 20, "seed": seed, "planner": "greedy"} for seed in range(3)])
    >>> [(row["run"], row["seed"], row["arrived"], row["error"]) for row in rows]
    [(0, 0, 20, None), (1, 1, 20, None), (2, 2, 20, None)]
    """
    study = _study_from(table)
    rows: dict[int, Row] = {}
    for some in _done(study, iter(range(len(study))), executor, apart=False):
        rows |= {row["run"]: row for row in some}
        if progress is not None:
            progress(len(rows), len(study))
    return [rows[run] for run in range(len(study))]


def write_study(
    table: Study | str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    path: str | os.PathLike[str],
    *,
    executor: Executor | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Do all runs of a study and write their rows as CSV or Parquet; after a death, go on where it was.

    Until the table is whole the rows are in a journal beside it, ``PATH.journal``: the same call again does only the
    runs that are missing there.

    Parameters
    ----------
    table, progress : see `run_study`
    path : path
        Of the table, ``.csv`` or ``.parquet``.
    executor : executor, optional
        See `run_study`.
    jobs : int, optional
        Without an executor: how many processes work. Default: one for each core.

    Raises
    ------
    StudyError
        If there is a mistake in the table, the executor breaks, or the journal belongs to another study.
    OSError
        If journal or table cannot be written; what was done before is in the journal.
    """
    check_results(path)
    check_output(path)
    study = _study_from(table)
    failed = unsafe = 0

    def counted(rows: Iterable[Row]) -> Iterator[Row]:
        nonlocal failed, unsafe
        for row in rows:
            failed += row["error"] is not None
            unsafe += bool(row["conflicts"])
            yield row

    with Journal(path, study) as journal:
        if progress is not None:
            progress(journal.done_count, len(study))
        todo = (run for run in range(len(study)) if not journal.is_done[run])
        with _processes(jobs) if executor is None else _given(executor) as workers:
            for rows in _done(study, todo, workers, apart=executor is None):
                journal.append(rows)
                if progress is not None:
                    progress(journal.done_count, len(study))
        write_results(counted(journal.rows()), path)
        journal.remove()
    return Outcome(len(study), failed, unsafe)


def _study_from(table: Study | str | os.PathLike[str] | Iterable[Mapping[str, Any]]) -> Study:
    if isinstance(table, Study):
        return table
    if isinstance(table, str | os.PathLike):
        return read_study(table)
    check_many("table", table, Mapping, "a study, the path of a study file, or a list of runs")
    return make_study(table)


@contextmanager
def _processes(jobs: int | None) -> Iterator[Executor]:
    """Yield threads, each of which has a process of its own do its runs."""
    count = jobs or len(os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else range(os.cpu_count() or 1))
    pool = ThreadPoolExecutor(count, thread_name_prefix="trihex-study")
    try:
        yield pool
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        close_workers()
        pool.shutdown()


@contextmanager
def _given(executor: Executor) -> Iterator[Executor]:
    yield executor


@dataclass
class _Group:
    """Runs given to a worker together."""

    runs: list[int]
    cases: list[Case]
    lives: int = LIVES


@dataclass
class _Pace:
    """How long runs take, and so how many of them make a group."""

    runs: int = 0
    seconds: float = 0.0

    def note(self, rows: Iterable[Row]) -> None:
        """Take rows that are done into account."""
        for row in rows:
            self.runs += 1
            self.seconds += sum(row[name] or 0.0 for name in COLUMNS if name.startswith("seconds"))

    @property
    def group_size(self) -> int:
        """How many runs make a group."""
        if not self.runs:
            return 1
        return max(1, min(_LARGEST_GROUP, int(_SECONDS_AT_ONCE * self.runs / max(self.seconds, 1e-6))))


def _groups(study: Study, todo: Iterator[int], pace: _Pace) -> Iterator[_Group]:
    """Yield groups of runs; those of one scenario stay together unless there are too many."""
    group = _Group([], [])
    for run in todo:
        case = study.trials[run]
        is_full = len(group.runs) >= pace.group_size and not _is_alike(case, group.cases[-1])
        if is_full or len(group.runs) >= _LARGEST_GROUP:
            yield group
            group = _Group([], [])
        group.runs.append(run)
        group.cases.append(case)
    if group.runs:
        yield group


def _is_alike(one: Case, other: Case) -> bool:
    same = (one[key] is other[key] or one[key] == other[key] for key in one if key != "planner")
    return one.keys() == other.keys() and all(same)


def _done(study: Study, todo: Iterator[int], executor: Executor | None, *, apart: bool) -> Iterator[list[Row]]:
    """Yield rows, those of some runs at a time, in whatever order they are done."""
    limits = Limits(study.seconds, study.memory)
    pace = _Pace()
    groups = _groups(study, todo, pace)
    if executor is None:
        for group in groups:
            for run, case in zip(group.runs, group.cases, strict=True):
                yield [_numbered(run, row) for row in run_cases([case], limits)]
        return
    done: SimpleQueue[tuple[_Group, Any]] = SimpleQueue()
    in_flight: dict[int, Any] = {}

    def submit(group: _Group) -> None:
        future = executor.submit(run_cases, group.cases, limits, apart)
        in_flight[group.runs[0]] = future
        future.add_done_callback(lambda future: done.put((group, future)))

    most = _IN_FLIGHT * (getattr(executor, "_max_workers", None) or _WORKERS)
    try:
        for group in groups:
            submit(group)
            while len(in_flight) >= most:
                rows = _collected(done, in_flight, submit)
                pace.note(rows)
                yield rows
        while in_flight:
            yield _collected(done, in_flight, submit)
    finally:
        for future in in_flight.values():
            future.cancel()


def _collected(
    done: SimpleQueue[tuple[_Group, Any]], in_flight: dict[int, Any], submit: Callable[[_Group], None]
) -> list[Row]:
    """Return the rows of all groups that are done, waiting for one; submit again what was lost with its worker."""
    rows: list[Row] = []
    while not rows or (not done.empty() and len(rows) < _ROWS_AT_ONCE):
        group, future = done.get()
        del in_flight[group.runs[0]]
        try:
            made = future.result()
        except StudyError:
            raise
        except (BrokenExecutor, CancelledError) as error:
            reason = f": {' '.join(str(error).split())}" if str(error) else ""
            raise StudyError(f"the executor stopped ({type(error).__name__}{reason}); what is done is kept") from error
        except Exception as error:
            group.lives -= 1
            if group.lives:
                submit(group)
                continue
            text = f"no worker could do it: {type(error).__name__}: {' '.join(str(error).split())[:300]}"
            made = [{**blank_row(case), "error": text} for case in group.cases]
        rows += [_numbered(run, row) for run, row in zip(group.runs, made, strict=True)]
    return rows


def _numbered(run: int, row: Row) -> Row:
    return {**{name: row.get(name) for name in COLUMNS}, "run": run}
