"""Compiling: what a request needs is compiled before it begins, and pages are told how far that is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from threading import Lock, get_ident
from time import sleep

from trihex.areas import Scenario
from trihex.fields import field_kernels
from trihex.kernels import preparing
from trihex.kernels.marks import is_marked
from trihex.kernels.needs import Kernels, kernels_of
from trihex.viewer.call import TICK, Call

# What most clicks need, in the order in which people click: a stage after the other is compiled, and a request waits
# for the end of one stage at most.
USUAL = (("fcost", "audit", "page", "slot_bound"), ("bound",), ("trial",))

Uses = Sequence[str | Kernels]

_lock = Lock()
_prepared: set[str | Kernels] = set()
_under_way = (0, 0)  # parts that are compiled, of how many, where somebody compiles


def prepare_for(call: Call, *uses: str | Kernels, scenario: Scenario | None = None) -> None:
    """Compile what some uses need, by the keys of `trihex.kernels.needs.KERNELS_OF`; a page that waits is told of it.

    Two requests would compile the same twice: the second waits for the first, and its page is told how far that is.

    Raises
    ------
    CancelledError
        If the page has gone meanwhile.
    """
    field = () if scenario is None else (field_kernels(scenario.area.tessellation, scenario.corners),)
    _prepare(call, [(*uses, *field)])


def prepare_usual(call: Call) -> None:
    """Compile what most requests will need; others that come meanwhile have their turn between two stages."""
    _prepare(call, USUAL)


def are_compiled(uses: Uses) -> bool:
    """Tell whether all that some uses need is on disk."""
    return _prepared.issuperset(uses) or all(is_marked(kernels) for kernels in kernels_of(uses))


def _prepare(call: Call, stages: Sequence[Uses]) -> None:
    stages = [stage for stage in stages if not _prepared.issuperset(stage)]
    missing = [kernels for kernels in kernels_of(use for stage in stages for use in stage) if not is_marked(kernels)]
    for number, stage in enumerate(stages):
        if number:
            sleep(2 * TICK)  # who waits has its turn: locks are not fair
        with _turn(call):
            if _prepared.issuperset(stage):  # whoever had the turn before has compiled the same
                continue
            before, done = preparing.watch, sum(is_marked(kernels) for kernels in missing)
            if done < len(missing):
                _tell(call, done, len(missing))
            preparing.watch = _telling(call, done, len(missing))
            try:
                preparing.prepare(*stage)
            finally:
                preparing.watch = before
            _prepared.update(stage)


@contextmanager
def _turn(call: Call) -> Iterator[None]:
    """Wait until nobody else compiles."""
    global _under_way
    while not _lock.acquire(timeout=TICK):
        call.check()
        done, total = _under_way
        if done < total:
            call.tell("compiling", done, total)
    try:
        yield
    finally:
        _under_way = (0, 0)
        _lock.release()


def _telling(call: Call, before: int, total: int) -> preparing.Progress:
    """Return what tells the page of what this thread compiles, after `before` parts; others may compile as well."""
    own = get_ident()

    def tell(done: int, _: int) -> None:
        if get_ident() == own:
            call.check()
            _tell(call, before + done, total)

    return tell


def _tell(call: Call, done: int, total: int) -> None:
    global _under_way
    _under_way = (done, total)
    call.tell("compiling", done, total)
