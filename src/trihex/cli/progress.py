"""Progress: on a terminal, within a second what is done and how far it has come; nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from shutil import get_terminal_size
from threading import Event, Thread
from time import monotonic
from typing import Any

import click

_DELAY = 0.8  # seconds since the command began; until then not even tqdm is imported, which takes a tenth of a second
_LEAST = 0.3  # seconds that something takes before it gets a bar
_PERIOD = 0.5  # seconds from one look at the clock to the next
_MANY = 100_000  # from here on counts are told in thousands
_WIDTH = 30  # of the bar while kernels are compiled
_BEGIN = monotonic()  # the command line imports this file first


class _Bar:
    """A bar that lives in a thread of its own, so that it shows the time even while nothing is told."""

    def __init__(self, what: str, unit: str) -> None:
        self.what, self.unit = what, unit
        self.done, self.total = 0, 0
        #: Whether another line has the terminal.
        self.is_hidden = False
        self._is_over = Event()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def move(self, done: int, total: int) -> None:
        """Take note of how far the work has come."""
        self.done, self.total = done, total

    def close(self) -> None:
        """Wipe the bar: what stays on the screen is the result."""
        self._is_over.set()
        self._thread.join()

    def _run(self) -> None:
        begin = monotonic()
        if self._is_over.wait(max(_LEAST, _BEGIN + _DELAY - begin)):
            return
        from tqdm import tqdm

        # Some terminals say that they have no columns and no lines; tqdm believes them and shows nothing.
        columns, lines = get_terminal_size()
        shown: Any = tqdm(
            desc=self.what,
            unit=f" {self.unit}",
            initial=self.done,
            total=self.total or None,
            leave=False,
            mininterval=0,
            ncols=columns - 1,
            nrows=lines,
        )
        shown.start_t -= monotonic() - begin
        while True:
            shown.total, shown.n, shown.unit_scale = self.total or None, self.done, self.total >= _MANY
            shown.clear() if self.is_hidden else shown.refresh()
            if self._is_over.wait(_PERIOD):
                shown.close()
                return


_shown: list[_Bar] = []


@contextmanager
def bar(what: str, unit: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function of (done, total) that moves the bar."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    shown = _Bar(what, unit)
    _shown.append(shown)
    try:
        yield shown.move
    finally:
        _shown.remove(shown)
        shown.close()


def show_compiling(done: int, total: int) -> None:
    """Show on stderr how many parts have been compiled: a bar where somebody watches, else one line."""
    if not sys.stderr.isatty():
        if done == 0:
            click.echo("trihex: compiling kernels, once; this takes up to a minute", err=True)
        return
    for shown in _shown:
        shown.is_hidden = done < total
    filled = round(_WIDTH * done / total)
    text = f"compiling kernels, once: {done} of {total} [{'#' * filled}{'.' * (_WIDTH - filled)}]"
    click.echo(f"\r{text}" if done < total else f"\r{' ' * len(text)}\r", nl=False, err=True)
