"""The page of the study of clocks and following, made from its results."""

# Lines of the page with numbers in them are longer here than there.
# ruff: noqa: E501

from collections.abc import Callable, Sequence

from examples.studies.radius import BEFORE_DOOR, DOORS, FARTHEST, IN_HALL, RADIUS, WIDTHS
from examples.studies.tables import Row, chosen, made_with, markdown, mean_by_seed, read_rows, shown
from examples.studies.tessellations import CELLS, GROUNDS, of

from trihex import Tessellation

RULES = [(clock, following) for following in ("allow", "forbid") for clock in ("steps", "costs")]
UNEVEN = [cells for cells in CELLS if cells[0] != "hexagonal" and cells[1] == "full"]
TRIANGLES_3, HEXAGONS, SQUARES_8, SQUARES_4 = CELLS[1:]


def seconds(row: Row) -> float:
    """Return when the last robot arrives at 1 metre a second; a tick is as long as the fastest move needs."""
    cells = Tessellation(row["tessellation"], row["neighbourhood"], row["costs"], clock=row["clock"])
    return float(row["steps"] * cells.longest_tick * row["cell_size"])


def dearer(rows: Sequence[Row], value: Callable[[Row], float]) -> list[Row]:
    """Return the rows where following is forbidden, with how much more they have of `value` than where it is allowed, in %."""

    def pair(row: Row) -> tuple[object, ...]:
        return tuple(row[name] for name in ("area", "seed", "tessellation", "neighbourhood", "clock", "robots"))

    allowed = {pair(row): value(row) for row in chosen(rows, following="allow")}
    return [{**row, "more": 100 * (value(row) / allowed[pair(row)] - 1)} for row in chosen(rows, following="forbid")]


def more(row: Row) -> float:
    """Return what `dearer` found."""
    return float(row["more"])


def clocks_of(cells: tuple[str, str, str]) -> tuple[str, ...]:
    """Return the clocks that differ: where all moves last as long, one."""
    return ("steps", "costs") if cells in UNEVEN else ("steps",)


def table_of_rules(rows: Sequence[Row], value: Callable[[Row], float], digits: int, **wanted: object) -> str:
    """Return a value by kind of cells, clock and rule."""
    lines = [
        [cells[2], *(shown(of(rows, cells, clock=c, following=f, **wanted), value, digits) for c, f in RULES)]
        for cells in CELLS
    ]
    return markdown(["cells", *(f"{clock}, {following}" for clock, following in RULES)], lines)


def table_of_price(rows: Sequence[Row], robots: int) -> str:
    """Return how much more time it takes where nobody follows at once, on the same cells, by kind and clock, in %."""
    lines = []
    for cells in CELLS:
        for clock in clocks_of(cells):
            some = of(rows, cells, clock=clock, robots=robots)
            grounds = [shown(dearer(chosen(some, area=ground), seconds), more, 0) for ground in GROUNDS]
            total, last = dearer(some, lambda row: row["total_time"]), dearer(some, seconds)
            lines.append([cells[2], clock, shown(total, more, 1), shown(last, more, 1), *grounds])
    return markdown(["cells", "clock", "total time", "last arrival", *(f"last, {name}" for name in GROUNDS)], lines)


def table_of_radius(rows: Sequence[Row], what: str, value: str, places: Sequence[object], head: Sequence[str], digits: int) -> str:  # fmt: skip
    """Return a value at equal robot radius by kind of cells, clock and rule, and place."""
    lines = []
    for cells in CELLS:
        for clock in ("costs",) if what == "floor" and cells in UNEVEN else clocks_of(cells):
            for following in ("allow", "forbid"):
                some = of(rows, cells, what=what, clock=clock, following=following)
                line = [cells[2], clock, following, f"{some[0]['cell_size']:.2f}"]
                for place in places:
                    here = chosen(some, place=place)
                    is_whole = all(row[value] is not None for row in here)
                    line.append(shown(here, lambda row: row[value], digits) if is_whole else "no room")
                lines.append(line)
    return markdown(["cells", "clock", "following", "cell size, m", *head], lines)


def mean(rows: Sequence[Row], cells: tuple[str, str, str], value: Callable[[Row], float], **wanted: object) -> float:
    """Return the mean over seeds."""
    return mean_by_seed(of(list(rows), cells, **wanted), value)[0]


def order(last: dict[tuple[str, str, str], float]) -> str:
    """Return kinds of cells with their seconds, the soonest first."""
    return ", ".join(f"{cells[2]} ({last[cells]:.0f} s)" for cells in sorted(last, key=lambda cells: last[cells]))


def summary(rows: Sequence[Row], radius: Sequence[Row]) -> str:
    """Return the answer in three sentences."""
    last = {
        (cells, clock): mean(rows, cells, seconds, robots=160, clock=clock, following="forbid")
        for cells in CELLS
        for clock in ("steps", "costs")
    }
    place = {
        clock: ("first", "second", "third", "fourth", "fifth")[
            sorted(CELLS, key=lambda cells: last[cells, clock]).index(SQUARES_8)
        ]
        for clock in ("steps", "costs")
    }
    prices = [
        mean_by_seed(dearer(of(list(rows), cells, robots=160, clock=clock), lambda row: row["total_time"]), more)[0]
        for cells in CELLS
        for clock in clocks_of(cells)
    ]
    times, share = {}, {}
    for cells in (HEXAGONS, SQUARES_4, TRIANGLES_3):
        flow = {
            f: mean(radius, cells, lambda row: row["flow"], what="door", place=2.0, following=f)
            for f in ("allow", "forbid")
        }
        times[cells] = flow["forbid"] / flow["allow"]
    for following in ("allow", "forbid"):
        share[following] = 100 * mean(
            radius, HEXAGONS, lambda row: row["share"], what="floor", place=1.0, following=following
        )
    t12, s8 = UNEVEN
    return f"""**By a clock, at the same speed and where nobody follows, 160 robots are out of a hall after {last[s8, "costs"]:.0f} s in place of {last[s8, "steps"]:.0f} on
squares with 8 neighbours and {last[t12, "costs"]:.0f} in place of {last[t12, "steps"]:.0f} on triangles with 12: squares with 8 come from the {place["steps"]}
place to the {place["costs"]}, level with edge neighbourhoods. To forbid following costs a crowd {min(prices):.0f} to {max(prices):.0f} % of its total time
on the same cells. But robots of one radius then fit on smaller cells: through a door of 2 metres pass {times[HEXAGONS]:.1f} times as many a second on hexagons, {times[SQUARES_4]:.1f} times on squares with 4 neighbours, though only
{times[TRIANGLES_3]:.1f} times on triangles with 3, and behind doors of 1 metre hexagons reach {share["forbid"]:.0f} % of the floor in place of {share["allow"]:.0f}.**"""


def page() -> str:
    """Return the page as Markdown."""
    rows, radius = read_rows("time"), read_rows("radius")
    last = {
        rule: {c: mean(rows, c, seconds, robots=160, clock=rule[0], following=rule[1]) for c in CELLS} for rule in RULES
    }
    crowds = chosen(rows, robots=160)
    bound, others = (
        {
            rule: mean_by_seed(chosen(some, clock=rule[0], following=rule[1]), lambda row: 100 * row["gap"])[0]
            for rule in RULES
        }
        for some in (crowds, [row for cells in CELLS[1:] for row in of(crowds, cells)])
    )
    heads = [f"{width:g} m" for width in DOORS]
    return f"""# Study: clocks and following

{summary(rows, radius)}

What the two rules are, and for whom, is told in [Concepts](../concepts.md); [Metres](../metric.md) has the proofs. In short: games
and automata, in which all act at once, keep to `clock="steps"` and `following="allow"`; machines that take time to move
gain by `clock="costs"`, and those that may be late or slow need `following="forbid"`.

The ground for cells of equal area: the four halls of [the study of the tessellations](tessellations.md), 24 by 18 metres, three exits to
the east, each for one robot at a time, cells of 0.25 square metres, euclidean costs, planner fcost. {made_with(rows, "time")}

For one robot radius: {RADIUS:g} metres, cells as small as each rule allows, the grid shifted so that most connects. {len(radius)} rows, 10 seeds, of
which {sum(bool(row["conflicts"]) for row in radius)} with a conflict; `python -m examples.studies.radius` makes `examples/studies/radius.csv` again.

All robots go at most 1 metre a second. A tick is as long as the fastest move of the clock needs: by `steps` each step lasts as long
as the longest move, by `costs` each move as long as it takes. On hexagons, squares with 4 and triangles with 3 neighbours both
are the same.

![Seconds until the last robot is out, by cells, clock and rule; robots a second through a door by its width.](../figures/study_time.png)

## What a clock changes

Seconds until the last of 160 robots is out, mean of the four halls, cells of equal area:

{table_of_rules(rows, seconds, 1, robots=160)}

The same with 20 robots, which hardly meet:

{table_of_rules(rows, seconds, 1, robots=20)}

- Soonest first where others may follow, by steps: {order(last["steps", "allow"])};
  by costs: {order(last["costs", "allow"])}.
- Where nobody follows, by steps: {order(last["steps", "forbid"])};
  by costs: {order(last["costs", "forbid"])}.
- Part of what a clock brings where others may follow comes from the exits: one that takes one robot at a time is owned for the second
  half of a move by `costs`, hence by two robots in the time of a move; by `steps` one enters in each step. Where nobody follows
  it is owned for the whole move by both clocks: those columns compare like with like.

## What following costs

How much more the same 160 robots need on the same cells where nobody follows, in %; the last four columns are the last arrival by
hall:

{table_of_price(rows, 160)}

- A file that moves on at once has a robot every cell, one that may not follow every other: where robots queue, half of
  them pass. But an exit has several neighbours that take turns, and robots that hardly meet (20 in the same halls) pay
  {mean_by_seed(dearer(chosen(rows, robots=20), seconds), more)[0]:.1f} % until the last arrives.
- Who forbids following makes plans that are legal by either rule. Where they come out better, as with 7 of the 10
  seeds on hexagons in the open, it is the planner that left something: fcost tries one rule more (`queue`) where time runs in ticks
  or nobody follows.
- By steps, where others may follow, fcost [looks ahead](../planners.md#looking-ahead) on triangles with 12 and squares with 8
  neighbours; where nobody follows it cannot. Beside its plans without that (`rounds=0`) following costs 12.2 and 7.7 % of the
  total time and 13.3 and 17.1 % of the last arrival.
- The dearer by `costs` on triangles with 12 and squares with 8 neighbours is again the exit: by `allow` it is owned half as long.

## What it brings: doors

{BEFORE_DOOR} robots stand before a door in a wall of 0.4 metres, as near as they can on four fifths of the cells; behind it they are out. Robots a
second between the first and the last tenth of them; the door is at a place that the seed draws:

{table_of_radius(radius, "door", "flow", DOORS, heads, 2)}

- On hexagons cells shrink most, from 4 to 2.3 radii: more files fit beside each other, and narrow doors open at all. On
  triangles with 12 neighbours, too; but their cells stay the largest.
- On triangles with 3 neighbours cells shrink by an eighth only, which does not pay for robots that wait.
- 0: there is no way through on these cells.
- These are the flows of plans by fcost, not the most that a door can pass.

## What it brings: rooms that open up

Twelve rooms with doors of one width, at places that the seed draws; the area of the cells that are connected with the exit, over
the area that the centre of a disc of this radius can reach at all, so 1 would be all of it:

{table_of_radius(radius, "floor", "share", WIDTHS, [f"doors of {width:g} m" for width in WIDTHS], 2)}

By the clock `steps` and `allow`, triangles with 12 and squares with 8 neighbours need larger cells still, and reach less.

## One radius in the halls

{IN_HALL} robots start at the same places, whatever the cells, and leave by three exits of 1 metre radius; seconds until the last is
out:

{table_of_radius(radius, "hall", "last", GROUNDS, GROUNDS, 1)}

"no room": with one of the seeds or more a robot has no cell within {FARTHEST:g} metres of its place from which it could get to an exit.

- These robots are few and exits wide, so ways count more than queues: smaller cells bring shorter ways, and two files through
  doors that were for one.
- By steps squares with 8 neighbours are the last of those that find room everywhere; by costs and where nobody follows they are first in
  three halls of four, and second behind hexagons in the other.

## How far from the best

Gap of the plans of 160 robots to the lower bound:

{table_of_rules(rows, lambda row: row["gap"], 2, robots=160)}

Mean over all cells: {bound["steps", "allow"]:.0f} % by steps and {bound["costs", "allow"]:.0f} % by costs where others may follow, {bound["steps", "forbid"]:.0f} and {bound["costs", "forbid"]:.0f} % where nobody follows; without triangles
with 12 neighbours {others["steps", "allow"]:.0f}, {others["costs", "allow"]:.0f}, {others["steps", "forbid"]:.0f} and {others["costs", "forbid"]:.0f} %. Of these, by steps where others may follow, plans were found to be nearly that far from the
[optimum](tessellations.md), too. Where nobody follows the bound is weaker (for up to ten robots the [optimum](../bounds.md) is known): it
knows queues at destinations and at narrow places, and hardly what robots that may not follow lose on their way. How much of
these gaps is the planner's and how much the bound's nobody has proven at this size; prices of following, and what a clock brings, are
those of these plans, which look ahead by steps alone.
"""


def draw(path: str) -> None:
    """Draw the seconds by cells, clock and rule, and the flows through doors by their width."""
    from matplotlib.figure import Figure

    rows, radius = chosen(read_rows("time"), robots=160), chosen(read_rows("radius"), what="door")
    figure = Figure(figsize=(9.5, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    looks = (("#8db4dc", ""), ("#2c6fb5", ""), ("#e39a6f", "//"), ("#b5442c", "//"))
    for i, ((clock, following), (colour, hatch)) in enumerate(zip(RULES, looks, strict=True)):
        found = [mean_by_seed(of(rows, cells, clock=clock, following=following), seconds) for cells in CELLS]
        at = [k + 0.2 * (i - 1.5) for k in range(len(CELLS))]
        heights, errors = [m for m, _ in found], [h for _, h in found]
        left.bar(at, heights, 0.19, yerr=errors, color=colour, hatch=hatch, edgecolor="white", lw=0, label=f"{clock}, {following}", error_kw={"lw": 0.8})  # fmt: skip
    words = [cells[2].replace(" with ", "\nwith ").replace(" neighbours", "") for cells in CELLS]
    left.set_xticks(range(len(CELLS)), words, fontsize=8)
    left.set_title("equal area: seconds to the last of 160 robots", fontsize=9)
    left.legend(frameon=False, fontsize=8)
    for cells, colour in zip(CELLS, ("#b5442c", "#e39a6f", "#2f8f5b", "#2c6fb5", "#8db4dc"), strict=True):
        for following, line in (("allow", "--"), ("forbid", "-")):
            some = of(radius, cells, clock=clocks_of(cells)[-1], following=following)
            flow = [mean_by_seed(chosen(some, place=width), lambda row: row["flow"])[0] for width in DOORS]
            right.plot(DOORS, flow, line, color=colour, marker="o", ms=3, label=cells[2] if line == "-" else None)
    right.set_title("equal radius: robots a second; dashed where others may follow", fontsize=9)
    right.set_xlabel("width of the door, m")
    right.set_xticks(DOORS)
    right.set_ylim(0, None)
    right.legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=110)
