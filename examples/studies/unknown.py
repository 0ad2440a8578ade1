"""The page of the study of unknown worlds and late robots, made from its results."""

# Lines of the page with numbers in them are longer here than there.
# ruff: noqa: E501

import json
from collections.abc import Sequence

from examples.studies.tables import Row, chosen, made_with, markdown, mean_by_seed, read_rows

AREAS = ("random", "rooms", "caves", "maze", "warehouse")
CELLS = ("triangular", "hexagonal", "square")
RADII = (0.0, 2.0, 3.0, 5.0, 8.0, 12.0)
DELAYS = (0.05, 0.1, 0.2, 0.3)
CROWDS = ("uniform", "far")  # 200 robots all over the area, 20 together
KNOWN = {"run": {}}
PLANNED = {"run": {"delays": 0.0, "in_order": True}}


def sensing(radius: float) -> dict[str, object]:
    """Return the options of robots without a map that see so far."""
    return {"run": {"sense": radius}}


def late(delay: float, *, in_order: bool = False) -> dict[str, object]:
    """Return the options of robots that are late in this share of the steps."""
    return {"run": {"delays": delay, **({"in_order": True} if in_order else {})}}


def prices(
    rows: Sequence[Row], crowd: str, options: dict[str, object], than: dict[str, object], **wanted: str
) -> list[Row]:
    """Return for each scenario how much more time robots take, in %, than with other options."""
    some = chosen(rows, placement=crowd, **wanted)
    text, other = (json.dumps(one, sort_keys=True, separators=(",", ":")) for one in (options, than))
    least = {row["scenario"]: row["total_time"] for row in chosen(some, planner_options=other)}
    return [
        {**row, "price": 100 * (row["total_time"] / least[row["scenario"]] - 1)}
        for row in chosen(some, planner_options=text)
    ]


def price(row: Row) -> float:
    """Return the price of a row made by `prices`."""
    return float(row["price"])


def table(rows: Sequence[Row], crowd: str, columns: dict[str, tuple[dict[str, object], dict[str, object]]]) -> str:
    """Return the prices by area, and over all."""
    lines = []
    for name in (*AREAS, "all"):
        wanted = {} if name == "all" else {"area": name}
        cells = [shown(prices(rows, crowd, *pair, **wanted)) for pair in columns.values()]
        lines.append([name, *cells])
    return markdown(["area", *columns], lines)


def shown(some: Sequence[Row]) -> str:
    """Return the mean price and half its interval as text."""
    mean, half = mean_by_seed(some, price)
    return f"{mean:.1f} ± {half:.1f}"


def mean(rows: Sequence[Row], crowd: str, options: dict[str, object], than: dict[str, object], **wanted: str) -> float:
    """Return the mean price."""
    return mean_by_seed(prices(rows, crowd, options, than, **wanted), price)[0]


def by_cells(rows: Sequence[Row]) -> str:
    """Return prices by tessellation."""
    columns = {
        "200, sensing 0": ("uniform", sensing(0.0), KNOWN),
        "20 together, sensing 0": ("far", sensing(0.0), KNOWN),
        "20 together, sensing 3": ("far", sensing(3.0), KNOWN),
        "200, late in 10 %": ("uniform", late(0.1), KNOWN),
        "200, in order, late in 10 %": ("uniform", late(0.1, in_order=True), PLANNED),
    }
    lines = [[cells, *(shown(prices(rows, *one, tessellation=cells)) for one in columns.values())] for cells in CELLS]
    return markdown(["cells", *columns], lines)


def page() -> str:
    """Return the page as Markdown."""
    rows = read_rows("unknown")
    fog = {crowd: {radius: mean(rows, crowd, sensing(radius), KNOWN) for radius in RADII} for crowd in CROWDS}
    steps = {delay: mean(rows, "uniform", late(delay), KNOWN) for delay in DELAYS}
    order = {delay: mean(rows, "uniform", late(delay, in_order=True), PLANNED) for delay in DELAYS}
    seen = {f"{radius:g} cells": (sensing(radius), KNOWN) for radius in RADII}
    delayed = {f"{100 * delay:g} %": (late(delay), KNOWN) for delay in DELAYS}
    ordered = {f"{100 * delay:g} %": (late(delay, in_order=True), PLANNED) for delay in DELAYS}
    worst = max(AREAS, key=lambda name: mean(rows, "far", sensing(3.0), KNOWN, area=name))
    enough = min(radius for radius in RADII if fog["uniform"][radius] < 0.5)
    singles = [price(row) for radius in RADII[:3] for row in prices(rows, "uniform", sensing(radius), KNOWN)]
    gains = 100 * sum(one < 0 for one in singles) / len(singles)
    return f"""# Study: a world that is unknown, robots that are late

**Without a map, 200 robots all over an area take {fog["uniform"][0.0]:.1f} % more time than with one if each feels only its
neighbours, {fog["uniform"][3.0]:.1f} % if it sees 3 cells far; 20 that start together at the far end lose {fog["far"][0.0]:.0f} % and {fog["far"][3.0]:.0f} %.
Late in 10 or 30 % of the steps, robots that decide step by step take {steps[0.1]:.0f} or {steps[0.3]:.0f} % more time, those that keep
the order of a plan {order[0.1]:.0f} or {order[0.3]:.0f} %.**

The ground: areas of 64 x 64 cells from five generators, on three tessellations; one destination at the centre. Robots
start anywhere, or on the 20 cells farthest from it; planner fcost. {made_with(rows, "unknown")}

All prices are in % of the total time of the same robots, in the same way, with a map and without delays.

![The price of not knowing by how far robots see, and the price of being late by how often they are.](../figures/study_unknown.png)

## The price of not knowing

200 robots all over the area, each seeing so many cells far, one map for all:

{table(rows, "uniform", seen)}

20 robots that start together at the far end:

{table(rows, "far", seen)}

- What one robot finds out all know, and where the way is long many walk it: so a crowd that is everywhere loses little.
  A group that goes through unknown ground pays for each dead end, most on the ground `{worst}`.
- The more is seen, the less it costs; a crowd that sees {enough:g} cells far does as well as with a map. In {gains:.0f} % of the single runs of
  the crowd below that it does better: a worse map spreads the robots, and queues are shorter.
- There is no chance in the warehouse, so the group does the same for every seed.

## The price of being late

Robots that decide step by step, late by chance in this share of the steps. That alone makes each move take 1 / (1 - p)
steps: {", ".join(f"{100 / (1 - delay) - 100:.0f} % more at {100 * delay:g} %" for delay in DELAYS)}.

{table(rows, "uniform", delayed)}

Robots that keep the [order](../changing-world.md#late-robots-and-plans) in which a plan has them pass each cell:

{table(rows, "uniform", ordered)}

- Step by step a late robot costs hardly more than its own delay: the others go round it, or wait behind it.
- In the order of a plan each late robot holds up all that come after it anywhere on their ways, though they could have
  passed before it. That is the price of a promise: nobody ever meets anybody the plan did not foresee.

## By tessellation

{by_cells(rows)}
"""


def draw(path: str) -> None:
    """Draw the prices: of not knowing against the radius, of being late against the share of steps."""
    from matplotlib.figure import Figure

    rows = read_rows("unknown")
    figure = Figure(figsize=(8.5, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for crowd, words, colour in (("uniform", "200 all over", "#2c6fb5"), ("far", "20 together", "#b5442c")):
        found = [mean_by_seed(prices(rows, crowd, sensing(radius), KNOWN), price) for radius in RADII]
        left.errorbar(RADII, [m for m, _ in found], [h for _, h in found], label=words, color=colour, marker="o", ms=3)
    left.set_xlabel("robots see so many cells far")
    left.set_ylabel("price of not knowing, %")
    for in_order, words, colour in ((False, "step by step", "#2c6fb5"), (True, "in the order of a plan", "#b5442c")):
        than = PLANNED if in_order else KNOWN
        found = [mean_by_seed(prices(rows, "uniform", late(d, in_order=in_order), than), price) for d in DELAYS]
        share = [100 * delay for delay in DELAYS]
        right.errorbar(share, [m for m, _ in found], [h for _, h in found], label=words, color=colour, marker="o", ms=3)
    right.plot(
        share, [100 / (1 - delay) - 100 for delay in DELAYS], color="#888", ls="--", label="the delays themselves"
    )
    right.set_xlabel("late in % of the steps")
    right.set_ylabel("price of being late, %")
    for ax in (left, right):
        ax.axhline(0, color="#888", lw=0.8)
        ax.legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=110)
