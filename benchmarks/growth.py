"""Growth: how work grows with cells b, robots n and steps K, for the paper taken literally and for trihex.

`python -m benchmarks growth` measures and prints; with ``--write`` it also writes docs/studies/complexity.csv, the
plot, and the table in docs/studies/complexity.md. ``--table`` writes the table anew from the results file.
"""

import argparse
import csv
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

import trihex as th
from benchmarks.literal import run_literally
from benchmarks.measure import cpu_seconds, exponent, machine
from benchmarks.planning import make_scenario

DOCS = Path(__file__).parent.parent / "docs"
RESULTS, PAGE = DOCS / "studies" / "complexity.csv", DOCS / "studies" / "complexity.md"
FIGURE = DOCS / "figures" / "growth.png"
COLUMNS = ("what", "in", "paper", "who", "unit", "size", "result")
ANSWER = "<!-- answer, by python -m benchmarks growth -->", "<!-- end of answer -->"
CROWDS = (12_500, 25_000, 50_000, 100_000, 200_000, 400_000, 800_000)
TABLE = "<!-- table, by python -m benchmarks growth -->", "<!-- end of table -->"
Row = dict[str, str]


def corridor(cells: int, robots: int, first: int = 1) -> th.Scenario:
    """Return a corridor one cell wide, robots at equal distances from cell `first` on, the destination at its end."""
    area = th.Area("hexagonal", np.zeros((1, cells), dtype=bool))
    return th.Scenario(area, [0], np.linspace(first, cells - 1, robots).astype(np.int64))


def ground(side: int, robots: int = 0, destinations: int = 1, capacity: int | None = None) -> th.Scenario:
    """Return a random area, 20 % barriers; the destinations, and then the robots, are cells that reach each other."""
    area = th.make_random_area("hexagonal", side, side, density=0.2, seed=1)
    free = np.flatnonzero(~area.barriers)
    middle = free[np.argmin(np.abs(free - (side * side + side) // 2))]
    reached = np.flatnonzero(th.make_n_scheme(th.Scenario(area, [middle])).distance.reshape(-1) < 2**31 - 1)
    chosen = np.random.default_rng(1).permutation(reached[reached != middle])
    exits = np.concatenate([[middle], chosen[: destinations - 1]])
    return th.Scenario(area, exits, chosen[destinations - 1 :][:robots], destination_capacity=capacity)


def seconds_of(thing: Callable[[], object], repeats: int = 5) -> float:
    """Return the median CPU time of `thing`."""
    return cpu_seconds({"": thing}, repeats)[""]


def fields() -> Iterator[Row]:
    """Yield how many cells the automaton updates, all in each generation, and how long our fields take."""
    for side in (32, 64, 128, 256, 512):
        scenario = ground(side)
        yield row("N-scheme, random area", "b", "-", "automaton", "updates", side * side, updates(scenario))
    for side in (128, 256, 512, 1024, 2048):
        scenario = ground(side)
        n_scheme = th.make_n_scheme(scenario)
        took = cpu_seconds(
            {"N": lambda s=scenario: th.make_n_scheme(s), "D": lambda n=n_scheme: th.make_d_scheme(n)},
            3 if side > 1000 else 15,
        )
        yield row("N-scheme, random area", "b", "-", "trihex", "s", side * side, took["N"])
        yield row("D-scheme, random area", "b", "O(b)", "trihex", "s", side * side, took["D"])
    for cells in (1 << 8, 1 << 10, 1 << 12, 1 << 14):
        yield row("N-scheme, corridor", "b", "-", "automaton", "updates", cells, updates(corridor(cells, 0)))
    for cells in (1 << 14, 1 << 16, 1 << 18, 1 << 20):
        scenario = corridor(cells, 0)
        took = seconds_of(lambda s=scenario: th.make_n_scheme(s))
        yield row("N-scheme, corridor", "b", "-", "trihex", "s", cells, took)


def updates(scenario: th.Scenario) -> int:
    """Return how many cells the synchronous automaton updates until a generation changes nothing."""
    return (th.make_n_scheme(scenario).generations + 1) * scenario.area.cell_count


def one_step() -> Iterator[Row]:
    """Yield what the first step of all robots costs the paper's planner, in comparisons of two cells."""
    for robots in (16, 32, 64, 128, 256):
        n_scheme = th.make_n_scheme(ground(64, robots))
        yield literal("one step of all robots", "n", "O(n^2)", robots, n_scheme, 1)
    for cells in (256, 512, 1024, 2048, 4096):
        n_scheme = th.make_n_scheme(corridor(cells, 16))
        yield literal("one step of all robots", "b", "O(b)", cells, n_scheme, 1)


def many_steps() -> Iterator[Row]:
    """Yield what K steps cost, all robots far from the destination, and whole plans of n robots that queue up."""
    n_scheme = th.make_n_scheme(corridor(4096, 16, first=3500))
    for steps in (8, 32, 128, 512):
        yield literal("K steps of all robots", "K", "O(K)", steps, n_scheme, steps)
    for robots in (16, 32, 64, 128):
        n_scheme = th.make_n_scheme(ground(24, robots, capacity=1))
        yield literal("a plan, one robot enters a step", "n", "O(K n^2)", robots, n_scheme)


def literal(what: str, variable: str, paper: str, size: int, n_scheme: th.NScheme, steps: int = 1 << 30) -> Row:
    """Return how many cells the paper's planner compares in so many steps."""
    return row(what, variable, paper, "literal", "comparisons", size, int(run_literally(n_scheme, steps)[0][-1]))


def ours() -> Iterator[Row]:
    """Yield how long plans by `fcost` take, for each robot and step, and in all."""
    for robots in (4000, 8000, 16000, 32000, 64000):
        yield planned("fcost, a robot and step", "n", "O(nb)", robots, ground(512, robots, destinations=50), True)
    for side in (256, 512, 1024, 2048):
        scenario = ground(side, side * side // 32, destinations=side * side // 3200)
        yield planned("fcost, a robot and step", "b", "O(nb)", side * side, scenario, True)
    for length in (250, 500, 1000, 2000, 4000):
        area = th.Area("hexagonal", np.zeros((20, 4096), dtype=bool))
        robots = np.arange(1000).reshape(20, 50) % 50 + length + 4096 * np.arange(20)[:, None]
        scenario = th.Scenario(area, [(0, y) for y in range(20)], robots.reshape(-1))
        yield planned("fcost, a plan", "K", "O(K)", length + 50, scenario, False)
    for robots in (1024, 2048, 4096, 8192):
        scenario = ground(160, robots, capacity=1)
        yield planned("fcost, a plan, one robot enters a step", "n", "O(K n^2)", robots, scenario, False)


def crowds(most: dict[str, int]) -> Iterator[Row]:
    """Yield how long plans of ever more robots on the same ground take: a robot's step, a step of all, the plan.

    Robots up to `most` of each planner. Least of two times for each.
    """
    for planner, limit in most.items():
        found = []
        for robots in (n for n in CROWDS if n <= limit):
            scenario = make_scenario("hexagonal", 2048, robots, 200)
            n_scheme = th.make_n_scheme(scenario)
            took, plan = [], th.make_plan(scenario.with_robots(scenario.robots[:100]), planner)
            for _ in range(2):
                begin = time.process_time()
                plan = th.make_plan(scenario, planner, n_scheme=n_scheme)
                took.append(time.process_time() - begin)
            found.append((robots, min(took), plan.steps, plan.actions.size))
            print(f"{planner}: {robots} robots, {plan.steps} steps, {plan.actions.size} robot-steps, {min(took):.3g} s")
        for what, number in (("a robot and step", 3), ("one step of all robots", 2), ("a plan", None)):
            for one in found:
                took = one[1] / one[number] if number else one[1]
                yield row(f"{planner}, crowds: {what}", "n", "-", "trihex", "s", one[0], took)


def planned(what: str, variable: str, paper: str, size: int, scenario: th.Scenario, for_each: bool) -> Row:
    """Return how long a plan takes, for each robot and step or in all; the fields are there already."""
    n_scheme = th.make_n_scheme(scenario)
    plan = th.make_plan(scenario, "fcost", n_scheme=n_scheme, rule="queue")
    took = seconds_of(lambda: th.make_plan(scenario, "fcost", n_scheme=n_scheme, rule="queue"), 3)
    return row(what, variable, paper, "trihex", "s", size, took / plan.actions.size if for_each else took)


def row(what: str, variable: str, paper: str, who: str, unit: str, size: float, result: float) -> Row:
    """Return a row of results; it is printed as well."""
    values = (what, variable, paper, who, unit, str(size), f"{result:.4g}" if unit == "s" else str(result))
    print(f"{what:40}{variable:3}{who:10}{size:10}  {values[-1]} {unit}", flush=True)
    return dict(zip(COLUMNS, values, strict=True))


PARTS: dict[str, Callable[[], Iterator[Row]]] = {
    "fields": fields,
    "step": one_step,
    "steps": many_steps,
    "ours": ours,
    "greedy": lambda: crowds({"greedy": 800_000}),
    "fcost": lambda: crowds({"fcost": 400_000}),
}


def read_results() -> list[Row]:
    """Return the rows of the results file."""
    with open(RESULTS, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def curves(rows: list[Row]) -> dict[tuple[str, ...], tuple[list[float], list[float]]]:
    """Return sizes and results by what was measured: (what, in, paper, who, unit)."""
    found: dict[tuple[str, ...], tuple[list[float], list[float]]] = {}
    for one in rows:
        sizes, results = found.setdefault(tuple(one[name] for name in COLUMNS[:5]), ([], []))
        sizes.append(float(one["size"]))
        results.append(float(one["result"]))
    return found


def table_lines(rows: list[Row]) -> list[str]:
    """Return the table of the page: an exponent for each curve."""
    lines = ["| what | in | sizes | paper | who | measured in | exponent |", "|---|---|---|---|---|---|---|"]
    for (what, variable, paper, who, unit), (sizes, results) in curves(rows).items():
        span = f"{sizes[0]:.0f} to {sizes[-1]:.0f}"
        unit = "seconds" if unit == "s" else unit
        lines.append(f"| {what} | {variable} | {span} | {paper} | {who} | {unit} | {exponent(sizes, results):.2f} |")
    return lines


def answer_lines(rows: list[Row]) -> list[str]:
    """Return the answer of the page in two sentences."""
    grown = {(what, variable, who): exponent(*curve) for (what, variable, _, who, _), curve in curves(rows).items()}
    literal = [
        grown["one step of all robots", "n", "literal"],
        grown["one step of all robots", "b", "literal"],
        grown["K steps of all robots", "K", "literal"],
    ]
    ours = [grown["fcost, a robot and step", variable, "trihex"] for variable in ("n", "b")]
    crowd = [grown[f"{name}, crowds: one step of all robots", "n", "trihex"] for name in ("greedy", "fcost")]
    fields = [grown[f"{field}-scheme, random area", "b", "trihex"] for field in ("N", "D")]
    return [
        "Taken literally, the paper's planner grows as its section V states: the comparisons of one step as",
        f"n^{literal[0]:.2f} and b^{literal[1]:.2f}, those of K steps as K^{literal[2]:.2f}. With c looked up,",
        f"the time of a robot's step grows as n^{ours[0]:.2f} and b^{ours[1]:.2f}, so not at all,",
        f"that of one step of all robots as n^{crowd[0]:.2f} by greedy and n^{crowd[1]:.2f} by fcost,",
        f"that of the N-scheme as b^{fields[0]:.2f}, that of the D-scheme as b^{fields[1]:.2f}.",
    ]


def page_with(text: str, rows: list[Row]) -> str:
    """Return the text of the page with answer and table made from the results."""
    for (begin, end), lines in ((ANSWER, answer_lines(rows)), (TABLE, table_lines(rows))):
        head, rest = text.split(begin)
        text = head + "\n".join([begin, "", *lines, "", end]) + rest.split(end)[1]
    return text


def draw(rows: list[Row]) -> None:
    """Plot all curves against their sizes, both axes logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker

    panels = {
        "fields: cells b": ("N-scheme", "D-scheme"),
        "one step: robots n, cells b": ("one step",),
        "K steps": ("K steps",),
        "a robot's step: robots n, cells b": ("fcost, a robot",),
        "whole plans: steps K": ("fcost, a plan in K",),
        "whole plans: robots n": ("a plan, one", "fcost, a plan, one"),
        "crowds on 2048 x 2048 cells, 200 exits: robots n": ("greedy, crowds", "fcost, crowds"),
    }
    # As wide as a page of 820 pixels at 100 an inch, so that letters are seen at the size that they have here.
    figure, axes = pyplot.subplots(4, 2, figsize=(8.2, 15.0), layout="constrained")
    for ax, (title, starts) in zip(axes.flat, panels.items(), strict=False):
        units = set()
        for (what, variable, _, who, unit), (sizes, results) in curves(rows).items():
            if f"{what} in {variable}".startswith(starts):
                label = f"{who}, {what}: {variable}^{exponent(sizes, results):.2f}"
                ax.loglog(sizes, results, "o-" if who == "trihex" else "s--", markersize=3, label=label)
                units.add("seconds" if unit == "s" else f"{unit} (dashed)")
        if title.startswith("a robot's step"):
            ax.set_ylim(1e-8, 1e-5)  # so that noise looks as small as it is
        ax.set_title(title, fontsize=10.5)
        ax.set_ylabel(" or ".join(sorted(units)), fontsize=9)
        ax.tick_params(labelsize=9)
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_minor_formatter(ticker.NullFormatter())
        ax.grid(alpha=0.3)
        ax.legend(fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.1), frameon=False)
    axes.flat[-1].set_axis_off()
    figure.savefig(FIGURE, dpi=150, metadata={"Software": None})


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks growth", description=__doc__)
    parser.add_argument("--write", action="store_true", help="write results, plot and page")
    parser.add_argument("--table", action="store_true", help="write plot and page from the results file")
    parser.add_argument("--only", nargs="+", choices=PARTS, help="measure these, take the rest from the results file")
    chosen = parser.parse_args(options)
    rows = read_results() if chosen.table or chosen.only else []
    if not chosen.table:
        print(machine())
        for part in chosen.only or PARTS:
            found = list(PARTS[part]())
            names = {one["what"] for one in found}
            rows = [one for one in rows if one["what"] not in names or one["who"] not in {new["who"] for new in found}]
            rows += found
    print("\n".join(table_lines(rows)))
    if chosen.write:
        with open(RESULTS, "w", newline="", encoding="utf-8") as file:
            file.write(f"# {machine()}\n")
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    if chosen.write or chosen.table:
        PAGE.write_text(page_with(PAGE.read_text(encoding="utf-8"), rows), encoding="utf-8")
        draw(rows)
