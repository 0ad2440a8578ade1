"""The page of the study of the tessellations, made from its results."""

# Lines of the page with numbers in them are longer here than there.
# ruff: noqa: E501

from math import sqrt
from statistics import fmean

from examples.studies.tables import Row, chosen, made_with, markdown, mean_by_seed, read_rows, shown

GROUNDS = ("open", "obstacles", "rooms", "doors")
CELLS = (
    ("triangular", "full", "triangles with 12 neighbours"),
    ("triangular", "edge", "triangles with 3"),
    ("hexagonal", "full", "hexagons"),
    ("square", "full", "squares with 8"),
    ("square", "edge", "squares with 4"),
)
# Greatest distance of a move in edge steps, and how near two robots come; both as in the library.
LONGEST = {("triangular", "full"): 2.0, ("square", "full"): sqrt(2)}
NEAREST = {("triangular", "full"): sqrt(3 / 28), ("triangular", "edge"): sqrt(3 / 4), ("hexagonal", "full"): 0.5,
           ("square", "full"): sqrt(1 / 5), ("square", "edge"): sqrt(1 / 2)}  # fmt: skip


def detour(row: Row) -> float:
    """Return the length of the paths over that of straight lines."""
    return float(row["path_length"] / row["straight_length"])


def metres_per_robot(row: Row) -> float:
    """Return the total time for each robot, as metres: a wait counts as an edge step."""
    edge = 10 if row["costs"] == "paper" else 1000
    return float(row["total_time"] / edge * row["cell_size"] / row["arrived"])


def seconds_to_last(row: Row) -> float:
    """Return when the last robot arrives at 1 metre a second, if each step lasts as long as the longest move."""
    longest = LONGEST.get((row["tessellation"], row["neighbourhood"]), 1.0)
    return float(row["steps"] * longest * row["cell_size"])


def of(rows: list[Row], cells: tuple[str, str, str], **wanted: object) -> list[Row]:
    """Return the rows of one kind of cells."""
    return chosen(rows, tessellation=cells[0], neighbourhood=cells[1], **wanted)


def table_of_cells(rows: list[Row], costs: str, robots: int) -> str:
    """Return the means over all grounds, by kind of cells."""
    lines = []
    for cells in CELLS:
        some = of(rows, cells, costs=costs, robots=robots)
        ours, greedy = chosen(some, planner="fcost"), chosen(some, planner="greedy")
        radius = NEAREST[cells[:2]] * ours[0]["cell_size"] / 2
        lines.append([
            cells[2],
            shown(ours, detour, 3),
            shown(ours, metres_per_robot, 1),
            shown(ours, seconds_to_last, 1),
            shown(ours, lambda row: row["steps"], 0),
            shown(greedy, lambda row: row["gap"]),
            shown(ours, lambda row: row["gap"]),
            f"{radius:.3f}",
        ])  # fmt: skip
    header = [
        "cells",
        "path / straight line",
        "m a robot",
        "s to the last",
        "steps",
        "gap, greedy",
        "gap, fcost",
        "largest radius, m",
    ]
    return markdown(header, lines)


def table_of_grounds(rows: list[Row]) -> str:
    """Return path over straight line by ground and kind of cells."""
    lines = []
    for cells in CELLS:
        some = of(rows, cells, costs="euclidean", robots=20, planner="fcost")
        lines.append([cells[2], *(shown(chosen(some, area=ground), detour, 3) for ground in GROUNDS)])
    return markdown(["cells", *GROUNDS], lines)


def table_of_gaps(rows: list[Row]) -> str:
    """Return how far greedy and fcost lie above the bound and above the optimum, by kind of cells."""
    least = {row["scenario"]: row for row in chosen(rows, planner="optimal")}

    def gap(row: Row) -> float:
        return float(row["total_time"] / least[row["scenario"]]["total_time"] - 1)

    lines = []
    for cells in CELLS[1:]:
        greedy, ours = (of(rows, cells, planner=planner) for planner in ("greedy", "fcost"))
        proven = [row for row in of(rows, cells, planner="optimal") if row["optimal"] == "True"]
        lines.append([
            cells[2],
            shown(greedy, lambda row: row["gap"], 3),
            shown(greedy, gap, 3),
            shown(ours, lambda row: row["gap"], 3),
            shown(ours, gap, 3),
            f"{len(proven)} of {len(ours)}",
        ])  # fmt: skip
    header = [
        "cells",
        "greedy to the bound",
        "greedy to the optimum",
        "fcost to the bound",
        "fcost to the optimum",
        "proven",
    ]
    return markdown(header, lines)


def told_of_gaps(rows: list[Row]) -> str:
    """Return in a sentence how much of the gap of fcost to the bound is real."""
    least = {row["scenario"]: row for row in chosen(rows, planner="optimal")}
    ours = chosen(rows, planner="fcost")
    bound = fmean(row["gap"] for row in ours)
    real = fmean(row["total_time"] / least[row["scenario"]]["total_time"] - 1 for row in ours)
    return (
        f"On average `fcost` lies {bound:.1%} above the bound and {real:.1%} above the optimum: {1 - real / bound:.0%} of its gap "
        "is the bound's."
    )


def table_of_seconds(rows: list[Row]) -> str:
    """Return the CPU milliseconds of field, plan and audit, by kind of cells."""
    lines = []
    for cells in CELLS:
        some = of(rows, cells, costs="euclidean", robots=160)
        line = [cells[2], shown(chosen(some, planner="fcost"), lambda row: 1000 * row["seconds_field"])]
        line += [
            shown(chosen(some, planner=name), lambda row: 1000 * row["seconds_plan"]) for name in ("greedy", "fcost")
        ]
        line.append(shown(chosen(some, planner="fcost"), lambda row: 1000 * row["seconds_bound"]))
        lines.append(line)
    return markdown(["cells", "field, ms", "greedy, ms", "fcost, ms", "bound, ms"], lines)


def page() -> str:
    """Return the page as Markdown."""
    rows, gaps = read_rows("tessellations"), read_rows("gaps")
    few = {
        cells[2]: mean_by_seed(of(rows, cells, costs="euclidean", robots=20, planner="fcost"), detour)[0]
        for cells in CELLS
    }
    last = {
        cells[2]: mean_by_seed(of(rows, cells, costs="euclidean", robots=160, planner="fcost"), seconds_to_last)[0]
        for cells in CELLS
    }
    metres, late = (
        {
            costs: mean_by_seed(of(rows, CELLS[0], costs=costs, robots=160, planner="fcost"), value)[0]
            for costs in ("paper", "euclidean")
        }
        for value in (metres_per_robot, seconds_to_last)
    )
    many8, many4 = (
        mean_by_seed(of(rows, cells, costs="euclidean", robots=160, planner="fcost"), detour)[0] for cells in CELLS[3:]
    )
    shortest, longest = min(few, key=lambda name: few[name]), max(few, key=lambda name: few[name])
    first, slowest = min(last, key=lambda name: last[name]), max(last, key=lambda name: last[name])
    t12, t3, s8, s4 = (
        few[name] for name in ("triangles with 12 neighbours", "triangles with 3", "squares with 8", "squares with 4")
    )
    return f"""# Study: the tessellations

**What does the neighbourhood buy? On the same halls with cells of the same area, paths are {few[shortest]:.2f} times the straight
line on {shortest}, and {few[longest]:.2f} times on {longest}. Yet a crowd of 160 robots is out first on
{first}, after {last[first]:.0f} s, and last on {slowest}, after {last[slowest]:.0f} s: a step lasts as long as its longest
move, and an exit takes one robot a step.**

The ground: four halls of 24 by 18 metres, open, with 30 blocks, with 12 rooms, or with two walls that have two doors each;
three exits to the east, each for one robot a step. Cells have 0.25 square metres, robots a radius of 7 cm, and walls are
kept clear of. {made_with(rows, "tessellations")}

![Length of paths over straight lines, and seconds until the last robot is out, for five kinds of cells on four grounds.](../figures/study_tessellations.png)

## Lengths

Path over straight line by ground, 20 robots, euclidean costs:

{table_of_grounds(rows)}

- Triangles with 3 neighbours make robots zigzag; the 9 vertex neighbours shorten paths by {1 - t12 / t3:.0%}. On squares the
  4 diagonals bring {1 - s8 / s4:.0%}.
- Hexagons have one kind of move only, and lie between. In the open a path on them is up to 15 % longer than the straight
  line, on squares with 8 neighbours up to 8 %, on squares with 4 up to 41 %.
- On `doors` straight lines lead through walls, so all ratios are larger.

## Crowds

160 robots, mean of the four grounds, euclidean costs. "m a robot" is the total time over the number of robots, with a wait
counted as an edge step; "s to the last" takes 1 metre a second and steps as long as the longest move of the tessellation,
as [waypoints](../metric.md) do; the gap is that to the lower bound; the largest radius is that of robots that never touch
on cells of this size.

{table_of_cells(rows, "euclidean", 160)}

The same with 20 robots:

{table_of_cells(rows, "euclidean", 20)}

- More neighbours mean shorter paths, longer moves and smaller robots: on triangles with 12 neighbours a robot may be only
  {NEAREST["triangular", "full"] / NEAREST["triangular", "edge"]:.0%} as wide as with 3. Who has large robots takes edge neighbourhoods or hexagons.
- In a crowd the exits decide, not the paths: 160 robots on squares go {many8:.2f} times the straight line with 8 neighbours and
  {many4:.2f} with 4. Before a queue a [slower way over edges](../planners.md#looking-ahead) costs less than to hurry and wait.

## How much of the gap is the bound's

The same crowds of 160, 4 seeds, with the planner `optimal`, which proves the least sum of times (`examples/studies/gaps.toml`;
triangles with 12 neighbours are left out: their optimum takes minutes):

{table_of_gaps(gaps)}

{told_of_gaps(gaps)}

## The paper's costs

The paper charges 14 for each vertex move, though it covers 1.73 or 2 edge steps on triangles. The same crowds of 160 planned by
these costs (lengths are measured in metres all the same):

{table_of_cells(rows, "paper", 160)}

Triangles with 12 neighbours look better by these costs, {metres["paper"]:.1f} m a robot in place of {metres["euclidean"]:.1f}, though the last is out
after {late["paper"]:.0f} s in place of {late["euclidean"]:.0f}: vertex moves are only called shorter. Squares and edge neighbourhoods hardly change.

## Computing

CPU time, 160 robots; it depends on the machine:

{table_of_seconds(rows)}
"""


def draw(path: str) -> None:
    """Draw lengths and times by ground."""
    from matplotlib.figure import Figure

    rows = chosen(read_rows("tessellations"), costs="euclidean", planner="fcost")
    figure = Figure(figsize=(8.5, 3.6), layout="constrained")
    pairs = (
        ("path / straight line, 20 robots", 20, detour),
        ("seconds to the last of 160 robots", 160, seconds_to_last),
    )
    colours = ("#b5442c", "#e39a6f", "#2f8f5b", "#2c6fb5", "#8db4dc")
    for i, (title, robots, value) in enumerate(pairs):
        ax = figure.add_subplot(1, 2, i + 1)
        for j, cells in enumerate(CELLS):
            found = [mean_by_seed(of(rows, cells, robots=robots, area=ground), value) for ground in GROUNDS]
            at = [k + 0.16 * (j - 2) for k in range(len(GROUNDS))]
            ax.bar(
                at,
                [m for m, _ in found],
                0.15,
                yerr=[h for _, h in found],
                color=colours[j],
                label=cells[2],
                error_kw={"lw": 0.8},
            )
        ax.set_xticks(range(len(GROUNDS)), GROUNDS)
        ax.set_title(title, fontsize=9)
        if i == 0:
            ax.set_ylim(1, None)
    figure.legend(
        *figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False, fontsize=8
    )
    figure.savefig(path, dpi=110)
