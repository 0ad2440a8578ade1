"""The byte of a node: by which arc a robot comes and by which it leaves.

    7..4  place of the arc it comes by, plus 1; `START`: it starts here
    3..0  place of the arc it leaves by, plus 1

It is 0 where nobody passes. A destination holds the number of those who arrive instead.
"""

from trihex.kernels.signatures import HELPER

# In place of an arc that comes in: a robot starts here.
START = 15


@HELPER
def arc_in(flow):
    """Return the place of the arc by which flow comes, -1 where there is none; `START` - 1 at a start."""
    return (flow >> 4) - 1


@HELPER
def arc_out(flow):
    """Return the place of the arc by which flow leaves, -1 where there is none."""
    return (flow & 15) - 1


@HELPER
def is_start(flow):
    """Tell whether a robot starts here."""
    return flow >> 4 == START


@HELPER
def with_arc_in(flow, place):
    """Return the byte of a node into which flow comes along another arc."""
    return (flow & 15) | ((place + 1) << 4)


@HELPER
def with_arc_out(flow, place):
    """Return the byte of a node which flow leaves by another arc."""
    return (flow & 0xF0) | (place + 1)
