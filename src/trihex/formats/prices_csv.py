"""Prices as CSV: a row for each cell that is priced."""

from __future__ import annotations

import os

from trihex.errors import check_type
from trihex.files import new_file
from trihex.prices import Prices

PRICES_SUFFIXES = (".csv",)


def write_prices(prices: Prices, path: str | os.PathLike[str], *, speed: float = 1.0) -> None:
    """Write prices with the header ``x,y,kind,price,robots,proven,most``.

    In an area in metres where all steps cost the same with ``seconds`` after the price, all robots together. A price
    that is not proven is at least that, and at most ``most``, where that is known; where other robots can arrive than
    now there is none, and ``robots`` says how many more, or less.

    Parameters
    ----------
    prices : Prices
    path : path
    speed : float
        Of robots, in metres a second.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    check_type("prices", prices, Prices)
    rows = prices.rows(speed)
    names = list(rows[0]) if rows else ["x", "y", "kind", "price", "robots", "proven", "most"]
    with new_file(path) as part, open(part, "w", newline="", encoding="utf-8") as file:
        file.write(",".join(names) + "\n")
        for row in rows:
            row["proven"] = "true" if row["proven"] else "false"
            file.write(",".join("" if value is None else str(value) for value in row.values()) + "\n")
