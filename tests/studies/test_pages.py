"""Pages of the studies: they say what the tables of results say, and these are of the studies beside them."""

import csv
import json
import math
import re
import sys
from collections import defaultdict
from pathlib import Path

import pytest

import trihex as th
from trihex.studies.row import COLUMNS

ROOT = Path(__file__).parents[2]
NAMES = ("tessellations", "planner", "unknown", "time")


@pytest.fixture(autouse=True)
def _in_repository(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))


def rows_of(name):
    with open(ROOT / "examples" / "studies" / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def text_of(name):
    return (ROOT / "docs" / "studies" / f"{name}.md").read_text(encoding="utf-8")


def table_after(text, words):
    """Return the rows of the first table behind some words, as lists of cells."""
    lines = text.partition(words)[2].splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("|"))
    last = next(i for i, line in enumerate(lines) if i > first and not line.startswith("|"))
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[first:last]]


@pytest.mark.parametrize("name", [*NAMES, "gaps", "queues"])
def test_results_are_those_of_the_study_beside_them(name):
    study = th.read_study(ROOT / "examples" / "studies" / f"{name}.toml")
    rows = rows_of(name)
    assert [int(row["run"]) for row in rows] == list(range(len(study)))
    assert list(rows[0]) == list(COLUMNS)
    for row, case in zip(rows, study.trials, strict=True):
        planned = (case["planner"]["name"], case["tessellation"]["name"], str(case["seed"]))
        assert (row["planner"], row["tessellation"], row["seed"]) == planned
        assert row["conflicts"] == "0" and row["error"] == "" and row["robots"] == row["arrived"]


def means(rows, value):
    """Return mean and half a 95 % interval of the means of the seeds, written anew."""
    by_seed = defaultdict(list)
    for row in rows:
        by_seed[row["seed"]].append(value(row))
    found = [sum(values) / len(values) for values in by_seed.values()]
    mean = sum(found) / len(found)
    variance = sum((one - mean) ** 2 for one in found) / (len(found) - 1)
    student = {4: 3.182446, 10: 2.262157}[len(found)]
    return mean, student * math.sqrt(variance / len(found))


KINDS = [("triangular", "full"), ("triangular", "edge"), ("hexagonal", "full"), ("square", "full"), ("square", "edge")]


def test_the_lengths_in_the_page_of_the_tessellations_are_those_of_the_results():
    rows, table = rows_of("tessellations"), table_after(text_of("tessellations"), "## Lengths")
    assert table[0] == ["cells", "open", "obstacles", "rooms", "doors"] and len(table) == 7
    for kind, line in zip(KINDS, table[2:], strict=True):
        for ground, cell in zip(table[0][1:], line[1:], strict=True):
            some = [
                row for row in rows
                if (row["tessellation"], row["neighbourhood"]) == kind and row["area"] == ground
                and row["costs"] == "euclidean" and row["robots"] == "20" and row["planner"] == "fcost"
            ]  # fmt: skip
            assert len(some) == 10
            mean, half = means(some, lambda row: float(row["path_length"]) / float(row["straight_length"]))
            told = [float(part) for part in cell.split(" ± ")]
            assert told == pytest.approx([mean, half], abs=6e-4)


def test_the_queues_in_the_page_of_the_planner_are_those_of_the_results():
    rows, table = rows_of("planner"), table_after(text_of("planner"), "## Do queues get shorter?")
    for cells, exits, robots, greedy, _, aside, *_ in table[2:]:
        for planner, options, cell in (("greedy", "{}", greedy), ("fcost", '{"rule":"aside"}', aside)):
            some = [
                row for row in rows
                if (row["tessellation"], row["robots"], row["planner"]) == (cells, robots, planner)
                and row["planner_options"] == options and row["waiting_cost"] == "10"
                and re.search(r'"count":(\d+)', row["destinations"])[1] == exits
            ]  # fmt: skip
            mean, half = means(some, lambda row: float(row["most_waiting"]))
            assert [float(part) for part in cell.split(" ± ")] == pytest.approx([mean, half], abs=0.51)
    assert len(table) == 2 + 12


def test_the_prices_in_the_page_of_the_unknown_are_those_of_the_results():
    rows, text = rows_of("unknown"), text_of("unknown")
    known, planned = {"run": {}}, {"run": {"delays": 0.0, "in_order": True}}
    for words, placement, than, axis, more in (
        ("200 robots all over the area, each", "uniform", known, "sense", {}),
        ("20 robots that start together", "far", known, "sense", {}),
        ("That alone makes", "uniform", known, "delays", {}),
        ("Robots that keep the [order]", "uniform", planned, "delays", {"in_order": True}),
    ):
        table = table_after(text, words)
        assert [line[0] for line in table[2:]] == ["random", "rooms", "caves", "maze", "warehouse", "all"]
        values = [float(column.split()[0]) / (100 if axis == "delays" else 1) for column in table[0][1:]]
        assert values == ([0, 2, 3, 5, 8, 12] if axis == "sense" else [0.05, 0.1, 0.2, 0.3])
        for area, *cells in table[2:]:
            some = [row for row in rows if row["placement"] == placement and area in (row["area"], "all")]
            least = {
                row["scenario"]: int(row["total_time"]) for row in some if json.loads(row["planner_options"]) == than
            }
            for value, cell in zip(values, cells, strict=True):
                these = [row for row in some if json.loads(row["planner_options"]) == {"run": {axis: value, **more}}]
                assert len(these) == (60 if area == "all" else 12)
                ratio = means(these, lambda row, least=least: int(row["total_time"]) / least[row["scenario"]])
                told = [float(part) for part in cell.split(" ± ")]
                assert told == pytest.approx([100 * ratio[0] - 100, 100 * ratio[1]], abs=0.06)
    # The two sentences on top are taken from these tables, and lead the page on changing worlds.
    told = (ROOT / "docs" / "changing-world.md").read_text(encoding="utf-8")
    assert " ".join(text.split("**")[1].split()) in " ".join(told.split())
    top = text.partition("The ground:")[0]
    for words, column in (
        ("200 robots all over the area, each", "0 cells"),
        ("20 robots that start together", "3 cells"),
    ):
        table = table_after(text, words)
        assert f"{float(table[-1][table[0].index(column)].split()[0]):.{0 if column == '3 cells' else 1}f} %" in top


def told_is(cell, mean_and_half, abs_):
    assert [float(part) for part in cell.split(" ± ")] == pytest.approx(mean_and_half, abs=abs_)


def test_the_seconds_and_prices_in_the_page_of_time_are_those_of_the_results():
    text = text_of("time")
    # How long a tick lasts at 1 metre a second, in edge steps: so that no move is faster.
    tick = {("triangular", "steps"): 2.0, ("triangular", "costs"): 1 / 4, ("square", "steps"): math.sqrt(2)}
    tick |= {("square", "costs"): 1 / 7}

    def seconds(row):
        ticks = tick.get((row["tessellation"], row["clock"]), 1.0) if row["neighbourhood"] == "full" else 1.0
        return int(row["steps"]) * ticks * float(row["cell_size"])

    rows = [row for row in rows_of("time") if row["robots"] == "160"]
    table = table_after(text, "Seconds until the last of 160 robots")
    assert table[0] == ["cells", "steps, allow", "costs, allow", "steps, forbid", "costs, forbid"]
    by_kind = {kind: [r for r in rows if (r["tessellation"], r["neighbourhood"]) == kind] for kind in KINDS}
    for kind, line in zip(KINDS, table[2:], strict=True):
        for rule, cell in zip(table[0][1:], line[1:], strict=True):
            told_is(
                cell, means([r for r in by_kind[kind] if f"{r['clock']}, {r['following']}" == rule], seconds), 0.051
            )
    prices = table_after(text, "## What following costs")
    steps = [line for line in prices[2:] if line[1] == "steps"]
    for kind, line in zip(KINDS, steps, strict=True):
        some = [row for row in by_kind[kind] if row["clock"] == "steps"]
        free = {(r["area"], r["seed"]): int(r["total_time"]) for r in some if r["following"] == "allow"}
        forbidden = [row for row in some if row["following"] == "forbid"]

        def price(row, free=free):
            return 100 * int(row["total_time"]) / free[row["area"], row["seed"]] - 100

        told_is(line[2], means(forbidden, price), 0.051)


def test_robots_of_one_radius_do_what_the_table_says_and_the_page_says_it():
    from examples.studies import radius

    rows, text = rows_of("radius"), text_of("time")
    assert len(rows) == 14 * 10 * 12 and {row["conflicts"] for row in rows} == {"0", ""}
    columns = {"door": "flow", "hall": "last", "floor": "share"}
    made = radius.rows([3])
    for old, new in zip([row for row in rows if row["seed"] == "3"], made, strict=True):
        words = ("what", "place", "seed", "tessellation", "neighbourhood", "clock", "following", "robots")
        assert [old[name] for name in words] == [str(new.get(name, "")) for name in words]
        numbers = {name: value for name, value in radius.rounded(new).items() if isinstance(value, float)}
        assert {name: float(old[name]) for name in numbers} == pytest.approx(numbers, abs=2e-6)
    for words, what, abs_ in (
        ("## What it brings: doors", "door", 6e-3),
        ("that open up", "floor", 6e-3),
        ("## One radius", "hall", 0.06),
    ):
        table = table_after(text, words)
        places = {"door": radius.DOORS, "floor": radius.WIDTHS, "hall": ("open", "obstacles", "rooms", "doors")}[what]
        lines = [line for line in table[2:] if line[0] == "hexagons"]
        for following, line in zip(("allow", "forbid"), lines, strict=True):
            for place, cell in zip(places, line[4:], strict=True):
                some = [
                    row for row in rows
                    if (row["what"], row["place"], row["following"]) == (what, str(place), following)
                    and row["tessellation"] == "hexagonal"
                ]  # fmt: skip
                told_is(cell, means(some, lambda row, what=what: float(row[columns[what]])), abs_)


def test_the_example_is_the_one_that_is_explained_and_runs(tmp_path):
    text = (ROOT / "examples" / "study.toml").read_text()
    page = (ROOT / "docs" / "how-to" / "studies.md").read_text()
    assert "\n".join(line for line in text.splitlines() if not line.startswith("#")) in page
    study = th.read_study(ROOT / "examples" / "study.toml")
    assert len(study) == 120
    (tmp_path / "study.toml").write_text("sample = 6\n" + text)
    assert [row["error"] for row in th.run_study(tmp_path / "study.toml")] == [None] * 6


def test_pages_are_what_their_results_make_them_and_written_by_one_command(tmp_path, monkeypatch, capsys):
    from examples.studies import __main__ as command

    monkeypatch.setattr(sys, "argv", ["studies"])
    command.main(tmp_path)
    for name in NAMES:
        assert (tmp_path / "studies" / f"{name}.md").read_text(encoding="utf-8") == text_of(name), "make studies"
        assert (tmp_path / "figures" / f"study_{name}.png").stat().st_size > 10_000
    assert capsys.readouterr().out.count("\n") == len(NAMES)
