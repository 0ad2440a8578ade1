"""Preparing: kernels that are not on disk yet are compiled side by side, before the work begins.

numba compiles a function when its module is first imported, on one core, and nothing else happens meanwhile. A first
plan needs about thirty functions. So whoever is about to use kernels says for what; what the disk lacks is compiled by
as many processes as there are cores, and numba finds it on disk.
"""

import logging
import os
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from time import perf_counter

from trihex.kernels.marks import can_keep, is_marked
from trihex.kernels.needs import modules_of
from trihex.kernels.sources import file_of

Progress = Callable[[int, int], None]

_LOG = logging.getLogger(__name__)
_prepared: set[str] = set()


def prepare(*uses: str, progress: Progress | None = None) -> None:
    """Compile what some uses need and the disk lacks, and load it, so that what follows is work alone.

    Parameters
    ----------
    *uses : str
        Keys of `trihex.kernels.needs.KERNELS_OF`.
    progress : callable, optional
        Called with (modules compiled, modules to compile), at the beginning and after each; not if there are none.
    """
    new = [name for name in modules_of(uses) if name not in _prepared]
    _prepared.update(new)
    missing = [name for name in new if name not in sys.modules and not is_marked(name)]
    if len(missing) > 1 and sys.executable and can_keep():
        begin = perf_counter()
        _LOG.info("compiling kernels, once: %d modules, for %s", len(missing), ", ".join(uses))
        missing.sort(key=lambda name: -file_of(name).stat().st_size)  # what takes longest first
        _compile(missing, progress or (lambda done, total: None))
        _LOG.info("compiled in %.1f s", perf_counter() - begin)
    for name in new:
        import_module(name)


def _compile(modules: list[str], progress: Progress) -> None:
    """Let workers compile modules; one that fails is left to whoever imports it, who sees why."""
    waiting: SimpleQueue[str] = SimpleQueue()
    done: SimpleQueue[str] = SimpleQueue()
    for module in modules:
        waiting.put(module)
    workers = [_start() for _ in range(min(_cores(), len(modules)))]
    for worker in workers:
        Thread(target=_feed, args=(worker, waiting, done), daemon=True).start()
    try:
        progress(0, len(modules))
        for count in range(1, len(modules) + 1):
            if failure := done.get():
                _LOG.warning("kernels could not be compiled beforehand: %s", failure)
            progress(count, len(modules))
    finally:
        for worker in workers:
            worker.kill()
            worker.wait()


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


def _feed(worker: "subprocess.Popen[str]", waiting: "SimpleQueue[str]", done: "SimpleQueue[str]") -> None:
    """Hand one module after the other to a worker; of each, say that it is done, or what went wrong."""
    while True:
        try:
            module = waiting.get_nowait()
        except Empty:
            return
        try:
            print(module, file=worker.stdin, flush=True)
            answer = worker.stdout.readline() if worker.stdout else ""
        except OSError as error:
            answer = str(error)
        done.put("" if answer == "\n" else f"{module}: {answer.strip() or 'the process ended'}")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
