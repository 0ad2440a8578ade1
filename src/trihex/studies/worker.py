"""Worker: runs cases in a child process, so that limits can be kept and its death is no more than an error."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from time import monotonic
from typing import NamedTuple

from trihex.errors import StudyError
from trihex.studies.case import run_case
from trihex.studies.row import Case, Row, blank_row

# How often a case may lose its child before it is given up, and how often a child may die before it is ready. Each
# loss may be somebody else's doing, such as that of the kernel when memory is short.
LIVES = 3
_STARTS = 5


class Limits(NamedTuple):
    """What one run may take: seconds, and bytes of memory beside those of an idle child; None for any."""

    seconds: float | None = None
    memory: int | None = None


class Worker:
    """One child at a time, started when first needed and again after its death."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._child: subprocess.Popen[bytes] | None = None
        self._ask: Connection | None = None
        self._told: Connection | None = None
        self._closed = False

    def run(self, case: Case) -> Row:
        """Return the row of a case, whatever becomes of the child."""
        known, status = blank_row(case), 0
        for _ in range(LIVES):
            ask, told = self._ready()
            deadline: float | None = None
            try:
                ask.send(case)
                while told.poll(None if deadline is None else max(0.0, deadline - monotonic())):
                    kind, row = told.recv()
                    if kind == "row":
                        return self._judged(row)
                    known = row
                    # The clock runs from when the child has loaded what it needs.
                    if deadline is None and self.limits.seconds is not None:
                        deadline = monotonic() + self.limits.seconds
                self.kill()
                return {**known, "error": f"took longer than {self.limits.seconds:g} s"}
            except (EOFError, OSError):
                status = self.kill()
        return {**known, "error": f"its process ended {LIVES} times ({_reason(status)})"}

    def _judged(self, row: Row) -> Row:
        if row["error"] == "out of memory" and self.limits.memory:
            row["error"] = f"out of memory: needed more than {self.limits.memory} bytes"
            self.kill()  # what is left of its memory is in pieces
        return row

    def _ready(self) -> tuple[Connection, Connection]:
        """Return how to ask the child and what it tells, after it has started."""
        for _ in range(_STARTS):
            if self._closed:
                raise StudyError("the study was stopped")
            if self._ask is not None and self._told is not None:
                return self._ask, self._told
            memory = [str(self.limits.memory)] if self.limits.memory else []
            self._child = subprocess.Popen(
                [sys.executable, "-P", "-m", "trihex.studies.child", *memory],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            self._ask, self._told = _connections(self._child)
            try:
                self._told.recv()
            except (EOFError, OSError):
                self.kill()
        raise StudyError(
            f"the workers end as soon as they start; {Path(sys.executable).name} -m trihex.studies.child shows why"
        )

    def kill(self) -> int:
        """End the child, if there is one, and return its exit status."""
        child, self._child = self._child, None
        for connection in (self._ask, self._told):
            if connection is not None:
                connection.close()
        self._ask = self._told = None
        if child is None:
            return 0
        child.kill()
        return child.wait()

    def close(self) -> None:
        """End the child for good, from any thread; a case that runs there is lost."""
        self._closed = True
        if (child := self._child) is not None:
            child.kill()
            child.wait()


def _connections(child: subprocess.Popen[bytes]) -> tuple[Connection, Connection]:
    """Return how to send to a child and how to hear from it."""
    if child.stdin is None or child.stdout is None:
        raise StudyError("a child must be started with pipes for its standard input and output")
    with child.stdin, child.stdout:
        return (
            Connection(os.dup(child.stdin.fileno()), readable=False),
            Connection(os.dup(child.stdout.fileno()), writable=False),
        )


def _reason(status: int) -> str:
    return f"signal {signal.Signals(-status).name}" if status < 0 else f"status {status}"


_own = threading.local()
_workers: list[Worker] = []


def run_cases(cases: Sequence[Case], limits: Limits, apart: bool = False) -> list[Row]:
    """Return the rows of some cases, one after the other; this is what executors are given to run.

    Parameters
    ----------
    cases : sequence of mapping
    limits : Limits
    apart : bool
        Whether to run them in a child even if there are no limits.
    """
    if not apart and limits == Limits():
        return [run_case(case) for case in cases]
    worker: Worker | None = getattr(_own, "worker", None)
    if worker is None or worker.limits != limits:
        if worker is not None:
            worker.kill()
        worker = _own.worker = Worker(limits)
        _workers.append(worker)
    return [worker.run(case) for case in cases]


def close_workers() -> None:
    """End all children of this process."""
    while _workers:
        _workers.pop().close()
