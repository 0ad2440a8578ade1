"""Kernels: what all compiled code shares; each package has its own kernels in a folder of that name.

Conventions, the same in every kernel:

- A *site* is an index into the padded flat array that `trihex.areas.Layout` describes. The padding counts as barrier,
  so that no kernel ever tests bounds.
- ``parity = site & 1`` picks the row of an offset table: ``neighbour = site + offset[parity, direction]``.
- Directions are numbered from 0, edge moves first; `WAIT` (255) is the action that stays. Bit k of a uint16 of
  ``moves`` tells whether direction k may be taken from a site (target free, corner rule met).
- The lattice vertex that a vertex move passes has a number of its own, ``site + vertex[parity, direction]``, in the
  same padded range as the sites.

Its modules import numba, so the rest of trihex imports them inside functions only, when a kernel is to run.
"""
