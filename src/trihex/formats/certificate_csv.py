"""Certificate as CSV: place, step and toll, a row for each."""

from __future__ import annotations

import os

import numpy as np

from trihex.errors import check_type
from trihex.files import new_file
from trihex.optimum import Certificate

CERTIFICATE_SUFFIXES = (".csv",)


def write_certificate(certificate: Certificate, path: str | os.PathLike[str]) -> None:
    """Write the tolls of a certificate with the header ``place,x,y,step,toll``; the plan is written by `write_plan`.

    A place is a ``cell``, or a ``vertex`` with the position of the cell that lends it its number (see `Layout`): that
    to its south-east on squares, that whose apex it is on triangles. It may lie just outside of the area.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    check_type("certificate", certificate, Certificate)
    area, layout = certificate.plan.scenario.area, certificate.plan.scenario.area.layout
    # Positions to the west of the area have numbers in the row before.
    row, column = np.divmod(certificate.vertex - layout.origin + 1, layout.pitch)
    kinds = (
        ("cell", *area.cell_to_xy(certificate.cell), certificate.step, certificate.toll),
        ("vertex", column - 1, row, certificate.vertex_step, certificate.vertex_toll),
    )
    with new_file(path) as part, open(part, "w", newline="", encoding="utf-8") as file:
        file.write("place,x,y,step,toll\n")
        for place, *columns in kinds:
            rows = np.stack(columns, axis=1).tolist()
            file.writelines(f"{place},{x},{y},{step},{toll}\n" for x, y, step, toll in rows)
