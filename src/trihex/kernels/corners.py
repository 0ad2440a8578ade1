"""Corners: how cells lie around one another, and when a move through a lattice vertex is open."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import IN_I32, TABLE_I32, declared


class CornerRule(NamedTuple):
    """What tells which moves barriers leave open."""

    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # what to add to a site for the vertex that a direction passes
    ring: IN_I32  # what to add to a vertex for the sites around it, clockwise
    edge_count: types.int64  # directions from there on pass vertices
    rule: types.int64  # `ALLOW`, `NO_SQUEEZE` or `NO_CUT`


CORNER_RULE = declared(CornerRule)
