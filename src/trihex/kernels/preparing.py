"""Preparing: kernels that are not on disk yet are compiled side by side, before the work begins.

numba compiles a function when its module is first imported, on one core, and nothing else happens meanwhile. A first
plan needs about thirty functions. So whoever is about to use kernels says for what; what the disk lacks is compiled by
as many processes as there are cores, and numba finds it on disk.
"""

import json
import logging
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from time import perf_counter

from trihex.kernels.marks import can_keep, is_marked
from trihex.kernels.needs import Kernels, kernels_of
from trihex.kernels.sources import file_of

Progress = Callable[[int, int], None]

_LOG = logging.getLogger(__name__)
_loaded: set[str | Kernels] = set()

#: Called with (parts compiled, parts to compile) while anything is compiled, first with 0; the command line sets it.
watch: Progress | None = None


def prepare(*uses: str | Kernels) -> None:
    """Compile what some uses need and the disk lacks, and load it, so that what follows is work alone.

    Parameters
    ----------
    *uses
        Keys of `trihex.kernels.needs.KERNELS_OF` (one that is not there needs none), or kernels themselves.
    """
    if _loaded.issuperset(uses):
        return
    new = [kernels for kernels in kernels_of(uses) if kernels not in _loaded]
    missing = [kernels for kernels in new if not is_marked(kernels)]
    if len(missing) > 1 and _can_start_workers() and can_keep():
        begin = perf_counter()
        _LOG.info("compiling kernels, once: %d parts", len(missing))
        missing.sort(key=_effort, reverse=True)
        _compile(missing, watch or (lambda done, total: None))
        _LOG.info("compiled in %.1f s", perf_counter() - begin)
    for kernels in new:
        kernels.load()
    _loaded.update(uses, new)


def _can_start_workers() -> bool:
    """Tell whether this is an interpreter that compiles: inside another program, `sys.executable` may be that one."""
    name = Path(sys.executable or "").name.lower()
    return name.startswith(("python", "pypy")) and os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")


def _effort(kernels: Kernels) -> int:
    """Return a guess of how long compiling takes: what takes longest goes first, so that no core waits in the end."""
    return file_of(kernels.module).stat().st_size


def _compile(parts: list[Kernels], progress: Progress) -> None:
    """Let workers compile; what fails is left to whoever imports it, who sees why."""
    waiting: SimpleQueue[Kernels] = SimpleQueue()
    done: SimpleQueue[str] = SimpleQueue()
    for part in parts:
        waiting.put(part)
    progress(0, len(parts))
    workers = [_start() for _ in range(min(_cores(), len(parts)))]
    for worker in workers:
        Thread(target=_feed, args=(worker, waiting, done), daemon=True).start()
    try:
        for count in range(1, len(parts) + 1):
            if failure := done.get():
                _LOG.warning("kernels could not be compiled beforehand: %s", failure)
            progress(count, len(parts))
    finally:
        for worker in workers:
            worker.kill()
            worker.wait()
            for pipe in (worker.stdin, worker.stdout):
                if pipe is not None:
                    pipe.close()


def _start() -> "subprocess.Popen[str]":
    folder = str(Path(__file__).parents[2])
    path = os.pathsep.join([folder, *filter(None, [os.environ.get("PYTHONPATH")])])
    return subprocess.Popen(
        [sys.executable, "-m", "trihex.kernels.worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    )


def _feed(worker: "subprocess.Popen[str]", waiting: "SimpleQueue[Kernels]", done: "SimpleQueue[str]") -> None:
    """Hand one part after the other to a worker; of each, say that it is done, or what went wrong."""
    while True:
        try:
            part = waiting.get_nowait()
        except Empty:
            return
        try:
            print(json.dumps(astuple(part)), file=worker.stdin, flush=True)
            answer = worker.stdout.readline() if worker.stdout else ""
        except (OSError, ValueError) as error:  # it has ended, or has been stopped
            answer = str(error)
        done.put("" if answer == "\n" else f"{part.module}: {answer.strip() or 'the process ended'}")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
