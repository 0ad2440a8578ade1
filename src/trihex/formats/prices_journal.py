"""Journal of prices: what is proven is kept as it is found, so that work that was interrupted goes on."""

from __future__ import annotations

import os
from hashlib import sha256
from pathlib import Path

import numpy as np

from trihex.areas import Scenario
from trihex.errors import FormatError
from trihex.files import read_bytes
from trihex.plans import Plan
from trihex.prices import KINDS


class PricesJournal:
    """A file with a line for each price that took some work: kind, cell and price.

    Parameters
    ----------
    path : path
        It may be there: then it must be of prices of the same scenario. It is made with the first price that is noted.
    plan : Plan
        Of what the prices are.

    Attributes
    ----------
    known : dict of (kind, cell) to price
        What is in the file; for `make_prices`.

    Raises
    ------
    FormatError
        If the file is of another scenario, or no such file.
    """

    def __init__(self, path: str | os.PathLike[str], plan: Plan) -> None:
        self.path, self.known = Path(path), dict[tuple[str, int], int]()
        self._header = f"prices {_digest(plan)}"
        if self.path.exists():
            self._read()

    def _read(self) -> None:
        # Beyond the last end of a line there is what was being written when the work was ended.
        header, *lines = read_bytes(self.path).decode("utf-8", errors="replace").split("\n")[:-1] or [""]
        if header != self._header:
            raise FormatError(f"{self.path} is of the prices of another scenario; remove it, or choose another --out")
        for number, line in enumerate(lines, 2):
            kind, cell, price = (*line.split(","), "", "")[:3]
            if kind not in KINDS or not cell.isdecimal() or not price.isdecimal():
                raise FormatError(f"{self.path}:{number}: must be kind,cell,price, not {line!r:.80}; remove it")
            self.known[kind, int(cell)] = int(price)

    def note(self, kind: str, cell: int, price: int) -> None:
        """Write a price that was found."""
        is_new = not self.path.exists()
        with open(self.path, "a", encoding="utf-8") as file:
            if is_new:
                file.write(self._header + "\n")
            file.write(f"{kind},{cell},{price}\n")

    def remove(self) -> None:
        """Remove the file, when all is done."""
        self.path.unlink(missing_ok=True)


def _digest(plan: Plan) -> str:
    """Return what tells scenarios apart that have other prices."""
    scenario: Scenario = plan.scenario
    rules = (scenario.area.barriers.shape, scenario.area.tessellation, scenario.waiting_cost, scenario.crossing)
    more = (scenario.corners, scenario.destination_capacity, scenario.clock, scenario.following, plan.total_time)
    doors = [(door.cells.tolist(), door.flow) for door in scenario.doors]
    order = np.argsort(scenario.robots)
    arrays = (
        scenario.area.barriers,
        np.sort(scenario.destinations),
        scenario.robots[order],
        scenario.start_times[order],
    )
    return sha256(repr((rules, more, doors)).encode() + b"".join(array.tobytes() for array in arrays)).hexdigest()[:32]
