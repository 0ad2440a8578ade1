"""The page of the study of the planner, made from its results."""

# Lines of the page with numbers in them are longer here than there.
# ruff: noqa: E501

from collections.abc import Callable
from statistics import fmean

from examples.studies.tables import Row, chosen, made_with, markdown, mean_by_seed, read_rows, shown

EXITS = (1, 4, 16)
ROBOTS = (10, 100, 500, 2000)
WEIGHTS = (0, 3, 10, 30, 100)
RULES = ("paper", "queue", "aside", "lanes")


def time_at_10(row: Row) -> float:
    """Return the total time at a waiting cost of 10, whatever weight the plan was made with."""
    return float(row["total_distance"] + 10 * row["waits"])


def case(rows: list[Row], cells: str, exits: int, robots: int) -> list[Row]:
    """Return the rows of one crowd."""
    return chosen(rows, tessellation=cells, robots=robots, destinations=f'{{"count":{exits},"place":"east"}}')


def ratios(crowd: list[Row], rule: str, weight: int, value: Callable[[Row], float] = time_at_10) -> list[Row]:
    """Return for each seed the value of a rule over that of greedy descent."""
    greedy = {row["seed"]: row for row in chosen(crowd, planner="greedy", waiting_cost=10)}
    mine = chosen(crowd, planner_options=f'{{"rule":"{rule}"}}', waiting_cost=weight)
    return [{"seed": row["seed"], "ratio": value(row) / max(value(greedy[row["seed"]]), 1e-9)} for row in mine]


def ratio(row: Row) -> float:
    """Return the ratio of a row made by `ratios`."""
    return float(row["ratio"])


def table_of_rules(rows: list[Row]) -> str:
    """Return total times over those of greedy descent at w_t = 10, by crowd and rule."""
    lines = []
    for cells in ("hexagonal", "triangular"):
        for exits in EXITS:
            for robots in ROBOTS:
                crowd = case(rows, cells, exits, robots)
                gaps = [shown(chosen(crowd, planner="greedy", waiting_cost=10), lambda row: row["gap"])]
                gaps += [
                    shown(chosen(crowd, planner_options='{"rule":"lanes"}', waiting_cost=10), lambda row: row["gap"])
                ]
                ours = [shown(ratios(crowd, rule, 10), ratio) for rule in RULES]
                lines.append([cells, str(exits), str(robots), *ours, *gaps])
    return markdown(["cells", "exits", "robots", *RULES, "gap, greedy", "gap, lanes"], lines)


def table_of_weights(rows: list[Row]) -> str:
    """Return the mean ratio over all crowds of 100 robots and more, by rule and weight."""
    lines = []
    for rule in RULES:
        for cells in ("hexagonal", "triangular"):
            found = [mean_over_crowds(rows, cells, rule, weight) for weight in WEIGHTS]
            lines.append([rule, cells, *(f"{value:.2f}" for value in found)])
    return markdown(["rule", "cells", *(f"w_t = {weight}" for weight in WEIGHTS)], lines)


def mean_over_crowds(rows: list[Row], cells: str, rule: str, weight: int) -> float:
    """Return the mean ratio over all crowds of 100 robots and more."""
    crowds = [case(rows, cells, exits, robots) for exits in EXITS for robots in ROBOTS[1:]]
    return fmean(mean_by_seed(ratios(crowd, rule, weight), ratio)[0] for crowd in crowds)


def table_of_queues(rows: list[Row], best: list[Row]) -> str:
    """Return how many robots wait in the worst step, and how often robots wait; on hexagons also in the optimum."""
    lines = []
    for cells in ("hexagonal", "triangular"):
        for exits in EXITS:
            for robots in (500, 2000):
                crowd = chosen(case(rows, cells, exits, robots), waiting_cost=10)
                line = [cells, str(exits), str(robots)]
                for key, value in (
                    ("planner", "greedy"),
                    ("planner_options", '{"rule":"aside"}'),
                    ("planner_options", '{"rule":"paper"}'),
                ):
                    some = chosen(crowd, **{key: value})
                    line.append(shown(some, lambda row: row["most_waiting"], 0))
                    line.append(shown(some, lambda row: row["waits"] / row["robots"], 1))
                some = case(best, cells, exits, robots)
                line.append(shown(some, lambda row: row["most_waiting"], 0) if some else "-")
                line.append(shown(some, lambda row: row["waits"] / row["robots"], 1) if some else "-")
                lines.append(line)
    header = ["cells", "exits", "robots"]
    for planner in ("greedy", "aside", "paper", "optimum"):
        header += [f"longest queue, {planner}", f"waits per robot, {planner}"]
    return markdown(header, lines)


def page() -> str:
    """Return the page as Markdown."""
    rows = read_rows("planner")
    best = {(c, e, n): mean_by_seed(ratios(case(rows, c, e, n), "lanes", 10), ratio)[0]
            for c in ("hexagonal", "triangular") for e in EXITS for n in ROBOTS}  # fmt: skip
    (cells, exits, robots), least = min(best.items(), key=lambda item: item[1])
    paper = mean_by_seed(ratios(case(rows, "hexagonal", 1, 500), "paper", 10), ratio)[0]
    lanes = {w: fmean(mean_over_crowds(rows, c, "lanes", w) for c in ("hexagonal", "triangular")) for w in WEIGHTS}
    literal = [
        (c, e, n, w, mean_by_seed(ratios(case(rows, c, e, n), "paper", w), ratio)[0])
        for c in ("hexagonal", "triangular") for e in EXITS for n in ROBOTS for w in WEIGHTS[1:]
    ]  # fmt: skip
    won = min(literal, key=lambda item: item[-1])
    share = sum(item[-1] > 1.005 for item in literal) / len(literal)
    shorter = queues_shortened(rows)
    best_plans = read_rows("queues")
    longer = mean_over_greedy(rows, best_plans, (1,), "most_waiting")
    fewer = 1 - mean_over_greedy(rows, best_plans, (4, 16), "waits")
    return f"""# Study: the planner and its weight

**Does Fcost beat going straight down the distances? With c taken as the length of the queue and V along lanes, yes:
total times fall to as little as {least:.2f} of those of greedy descent ({robots} robots, {exits} exits, {cells} cells). The weight
hardly matters: in the mean over all crowds it is {lanes[3]:.2f} with w_t = 3, {lanes[10]:.2f} with 10 and {lanes[100]:.2f} with 100.
With c counted as the paper counts it, no: with 500 robots and one exit on hexagons the total time is {paper:.0f} times as
long.**

The ground: 64 x 64 cells, a tenth of them barriers; exits evenly along the eastern side, each of which takes any number
of robots a step as far as they find a way in. Robots start anywhere. {made_with(rows, "planner")}

Plans are made with the weight w_t from 0 to 100, but all are measured with one yardstick: a wait costs 10, as much as a
step. So the figures tell what the weight does to the plan, not what it does to the unit.

![Total time over that of greedy descent against w_t, for four rules.](../figures/study_planner.png)

## Where it helps, where it hurts

Total time over that of greedy descent, w_t = 10. Below 1 the planner is better. The gaps are to the lower bound.

{table_of_rules(rows)}

- Ten robots hardly ever meet: nothing is to be gained. The gain comes with the queue, and is largest where there are several
  exits to choose from: greedy descent sends everyone to the nearest way in.
- With one exit nothing makes the exit wider. What is gained is that all its sides are used.
- `lanes` gain where many exits are close to each other and what leads to them is narrow: shortest ways to several of them share
  cells, lanes do not.
- `paper`, the count of all meetings on the shortest ways, makes robots dodge queues that they must join in the end. It is
  worse than greedy descent in {share:.0%} of the crowds and weights, and best with {won[2]} robots, {won[1]} exits,
  {won[0]} cells and w_t = {won[3]}: {won[4]:.2f}.

## The best weight

Mean over all crowds of 100 robots and more:

{table_of_weights(rows)}

- w_t = 0 is greedy descent for `paper` and `queue`; `aside` and `lanes` step aside for free whatever the weight.
- For the other weights `queue`, `aside` and `lanes` differ little: what decides is whether the line is shorter elsewhere, not
  by how much. And a place in the line never costs more than a step, because who has to let others pass can go to and fro
  instead. Without that limit robots dodge each other at any price from w_t = 30 on, and wander as with `paper`.
- For `paper`, the smaller the better.

## Do queues get shorter?

The paper says so of its planner. How many robots wait in the worst step, and how often each waits, w_t = 10:

{table_of_queues(rows, best_plans)}

They do, by {shorter:.0%} on average in the worst step with `aside`: robots that would wait walk on around those that do, or
to another exit. With `paper` queues in the worst step can be shorter, too, but only because robots wander about.

The best plans (`trihex study examples/studies/queues.toml`, proven) tell the two apart. Where there are several exits their
robots wait {fewer:.0%} less often than those of greedy descent, and hardly anybody waits with 500 robots and four exits: the
queue was avoidable. Where one exit decides, the worst queue is {longer:.2f} times as long as that of greedy descent, though
robots wait less often: somebody has to wait, and whoever waits in place wastes no step. So a short queue is no aim of
its own.
"""


def queues_shortened(rows: list[Row]) -> float:
    """Return by what share the longest queue shrinks, on average over the crowds of 500 robots and more."""
    shares = []
    for cells in ("hexagonal", "triangular"):
        for exits in EXITS:
            for robots in (500, 2000):
                crowd = case(rows, cells, exits, robots)
                found = ratios(crowd, "aside", 10, lambda row: row["most_waiting"])
                shares.append(1 - mean_by_seed(found, ratio)[0])
    return fmean(shares)


def mean_over_greedy(rows: list[Row], best: list[Row], exits: tuple[int, ...], column: str) -> float:
    """Return the mean ratio of a column of the best plans to that of greedy descent, on hexagons."""
    return fmean(
        mean[0] / mean_by_seed(chosen(crowd, planner="greedy", waiting_cost=10), lambda row: row[column])[0]
        for count in exits
        for robots in (500, 2000)
        for crowd in [case(rows, "hexagonal", count, robots)]
        for mean in [mean_by_seed(case(best, "hexagonal", count, robots), lambda row: row[column])]
    )


def draw(path: str) -> None:
    """Draw the ratio against the weight, for crowds of 500 and 2000 robots and four exits."""
    from matplotlib.figure import Figure

    rows = read_rows("planner")
    figure = Figure(figsize=(8.5, 3.4), layout="constrained")
    for i, (cells, robots) in enumerate(
        (cells, robots) for cells in ("hexagonal", "triangular") for robots in (500, 2000)
    ):
        ax = figure.add_subplot(1, 4, i + 1)
        crowd = case(rows, cells, 4, robots)
        for rule, colour in zip(RULES, ("#b5442c", "#2c6fb5", "#2f8f5b", "#8a5bb5"), strict=True):
            found = [mean_by_seed(ratios(crowd, rule, weight), ratio) for weight in WEIGHTS]
            ax.errorbar(
                range(len(WEIGHTS)),
                [m for m, _ in found],
                [h for _, h in found],
                label=rule,
                color=colour,
                marker="o",
                ms=3,
            )
        ax.axhline(1, color="#888", lw=0.8)
        ax.set_yscale("log")
        ax.set_ylim(0.45, 40)
        ax.set_yticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"] if i == 0 else [""] * 6)
        ax.set_yticks([], minor=True)
        ax.set_xticks(range(len(WEIGHTS)), [str(weight) for weight in WEIGHTS])
        ax.set_title(f"{cells}, {robots} robots", fontsize=9)
        ax.set_xlabel("w_t")
    figure.axes[0].set_ylabel("total time / that of greedy")
    figure.axes[0].legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=110)
