"""Findings: the breaches of rules that the judge has counted and kept."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, OUT_I64, declared

# Numbers that are handed to helpers are np.int64, or numba would compile these for each of them.
CELL, EXCHANGE, CROSSING, JUMPS, OUT_OF_AREA, ONTO_BARRIER, CORNER, CAPACITY, ACTS_ON, OWNED, SHUT = np.arange(11)
NONE = np.int64(-1)
ROWS = types.Array(types.int32, 2, "C")


class Findings(NamedTuple):
    """Conflicts, in the order found."""

    row: ROWS  # of the first of them: code, step, two robots, four sites; `NONE` for none
    total: OUT_I64  # how many there are in all, at 0


FINDINGS = declared(Findings)


@APART
def note(findings, step, code, robots, sites):
    """Count a conflict of two robots at four sites, and keep it while there is room."""
    count = findings.total[0]
    if count < findings.row.shape[0]:
        findings.row[count, 0] = code
        findings.row[count, 1] = step
        for i in range(2):
            findings.row[count, 2 + i] = robots[i]
        for i in range(4):
            findings.row[count, 4 + i] = sites[i]
    findings.total[0] = count + 1
