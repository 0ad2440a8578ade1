"""Progress: a bar on a terminal for work that takes over a second, nothing elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any

_DELAY = 1.0  # seconds; until then not even tqdm is imported, which takes a tenth of a second


@contextmanager
def bar(what: str, unit: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function of (done, total) that moves the bar."""
    begin = monotonic()
    shown: Any = None

    def move(done: int, total: int) -> None:
        nonlocal shown
        if shown is None:
            if monotonic() < begin + _DELAY:
                return
            from tqdm import tqdm

            # The bar is gone when the work is done: what stays on the screen is the result.
            shown = tqdm(desc=what, unit=f" {unit}", unit_scale=True, disable=None, leave=False)
            shown.start_t = shown.start_t - _DELAY if not shown.disable else None
        shown.total = total
        shown.update(done - shown.n)

    try:
        yield move
    finally:
        if shown is not None:
            shown.close()
