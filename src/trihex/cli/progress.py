"""Progress: a bar on a terminal for work that takes over a second, nothing elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(what: str, unit: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function of (done, total) that moves the bar."""
    from tqdm import tqdm

    # The bar is gone when the work is done: what stays on the screen is the result.
    with tqdm(desc=what, unit=f" {unit}", unit_scale=True, disable=None, delay=1, leave=False) as shown:

        def move(done: int, total: int) -> None:
            shown.total = total
            shown.update(done - shown.n)

        yield move
