"""Certificate as CSV: cell, step and toll, a row for each."""

from __future__ import annotations

import os

import numpy as np

from trihex.errors import check_type
from trihex.files import new_file
from trihex.optimum import Certificate

CERTIFICATE_SUFFIXES = (".csv",)


def write_certificate(certificate: Certificate, path: str | os.PathLike[str]) -> None:
    """Write the tolls of a certificate with the header ``x,y,step,toll``; the plan is written by `write_plan`.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    check_type("certificate", certificate, Certificate)
    x, y = certificate.plan.scenario.area.cell_to_xy(certificate.cell)
    rows = np.stack([x, y, certificate.step, certificate.toll], axis=1).tolist()
    with new_file(path) as part, open(part, "w", newline="", encoding="utf-8") as file:
        file.write("x,y,step,toll\n")
        file.writelines(f"{x},{y},{step},{toll}\n" for x, y, step, toll in rows)
