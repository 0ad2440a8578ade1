"""Loading: what of numba a process needs that runs kernels found on disk."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

# The command line sets it: nobody else compiles anything in this process.
is_alone = False


def load_numba_alone() -> None:
    """Load of numba only what runs kernels found on disk, for a process that runs trihex alone.

    Before its first function is compiled or found on disk, numba loads and registers all that it can compile. That is
    put off here until a kernel must be compiled; one found on disk does without. It also imports scipy.linalg (to see
    whether ``np.dot`` may be compiled) and cffi, if they are there, for nothing that a kernel needs. They are hidden
    from it and can be imported as ever afterwards, but code compiled in this process cannot call linear algebra.
    """
    if "numba.np.arraymath" in sys.modules:
        return
    from numba.core.caching import FunctionCache
    from numba.core.registry import cpu_target
    from numba.core.runtime.nrt import rtsys

    context = cpu_target.target_context
    refresh, load = context.refresh, FunctionCache.load_overload

    def refresh_alone() -> None:
        with _hidden("scipy.linalg", "cffi"):
            refresh()

    def load_alone(self: FunctionCache, sig: object, target_context: object) -> object:
        context.refresh = int  # it does nothing
        try:
            with _hidden("scipy.linalg", "cffi"):
                return load(self, sig, target_context)
        finally:
            context.refresh = refresh_alone

    rtsys.initialize(context)  # what kernels call that make arrays
    context.refresh = refresh_alone
    FunctionCache.load_overload = load_alone  # type: ignore[method-assign,assignment]


@contextmanager
def _hidden(*names: str) -> Iterator[None]:
    """Let imports of these modules fail, if they have not been imported yet."""
    hidden = {name for name in names if name not in sys.modules}
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type]  # None: an ImportError for whoever asks
    try:
        yield
    finally:
        for name in hidden:
            del sys.modules[name]
