"""Numba kernels: arrays in, arrays filled; no objects, no shapes' names, no messages.

Conventions, the same in every kernel:

- A *site* is an index into the padded flat array that `trihex.tessellation.Layout` describes. The padding counts as
  barrier, so that no kernel ever tests bounds.
- ``parity = site & 1`` picks the row of an offset table: ``neighbour = site + offset[parity, direction]``.
- Directions are numbered from 0, edge moves first; `WAIT` (255) is the action that stays. Bit k of a uint16 of
  ``moves`` tells whether direction k may be taken from a site (target free, corner rule met).
- The lattice vertex that a vertex move passes has a number of its own, ``site + vertex[parity, direction]``, in the
  same padded range as the sites.

Its modules import numba, so the rest of trihex imports them inside functions only, when a kernel is to run.
"""

# The distance of a cell from which no destination can be reached, in int32 as in the files that users see.
NOT_REACHED = 2**31 - 1

# The command line sets it: nobody else compiles anything in this process.
is_alone = False


def load_numba_alone() -> None:
    """Load numba without the optional packages it would import on the way, for a process that runs trihex alone.

    When its first function is compiled or found on disk, numba imports scipy.linalg (to see whether ``np.dot`` may be
    compiled) and cffi, if they are there: 0.4 s of 0.7 s, for nothing that a kernel needs. They are hidden from it and
    can be imported as ever afterwards, but code compiled in this process cannot call linear algebra.
    """
    import sys

    if "numba.np.arraymath" in sys.modules:
        return
    hidden = {name for name in ("scipy.linalg", "cffi") if name not in sys.modules}
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type]  # None: an ImportError for whoever asks
    try:
        from numba.core.registry import cpu_target

        cpu_target.target_context.refresh()
    finally:
        for name in hidden:
            del sys.modules[name]
