"""Codes: numbers with a meaning in arrays, plans and files, each written here and nowhere else."""

# The distance of a cell from which no destination can be reached, in int32 as in the files that users see.
NOT_REACHED = 2**31 - 1

# Actions, a byte each: below these they are directions.
WAIT = 255
JUMP = 254  # no move to a neighbour, as only a file can hold; its cell stands in a list beside
LATE = 253  # in a run: the robot stood still because it could not move
UNDERWAY = 252  # in a run: the move that the robot began some ticks ago goes on

# Corner rules: when a move through a lattice vertex is open; in the order of `trihex.areas.CORNERS`.
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2
