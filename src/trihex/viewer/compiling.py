"""Compiling: what a request needs is compiled before it begins, and its page is told how far that is."""

from __future__ import annotations

from threading import Lock, get_ident

from trihex.areas import Scenario
from trihex.fields import field_kernels
from trihex.kernels import preparing
from trihex.kernels.marks import is_marked
from trihex.kernels.needs import Kernels, kernels_of
from trihex.viewer.call import TICK, Call

_lock = Lock()
_prepared: set[str | Kernels] = set()


def prepare_for(call: Call, *uses: str, scenario: Scenario | None = None) -> None:
    """Compile what some uses need, by the keys of `trihex.kernels.needs.KERNELS_OF`; a page that waits is told of it.

    Two requests would compile the same twice: the second waits for the first.

    Raises
    ------
    CancelledError
        If the page has gone meanwhile.
    """
    wanted: list[str | Kernels] = list(uses)
    if scenario is not None:
        wanted.append(field_kernels(scenario.area.tessellation, scenario.corners))
    if _prepared.issuperset(wanted):
        return
    while not _lock.acquire(timeout=TICK):
        call.check()
    before = preparing.watch
    try:
        if _prepared.issuperset(wanted):
            return
        if missing := sum(not is_marked(kernels) for kernels in kernels_of(wanted)):
            call.tell("compiling", 0, missing)
        preparing.watch = _telling(call)
        preparing.prepare(*wanted)
        _prepared.update(wanted)
    finally:
        preparing.watch = before
        _lock.release()


def _telling(call: Call) -> preparing.Progress:
    """Return what tells the page of what this thread compiles; others may compile at the same time."""
    own = get_ident()

    def tell(done: int, total: int) -> None:
        if get_ident() == own:
            call.check()
            call.tell("compiling", done, total)

    return tell
