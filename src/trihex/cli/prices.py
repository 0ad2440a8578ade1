"""`trihex prices`: what each wall and each door costs."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import Any

import click

from trihex.cli.described import complete, read_described
from trihex.cli.group import DONE, INTERRUPTED, NO
from trihex.cli.options import PATH, area_options, robot_options, rule_options
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.types import Metres, Name, Seconds

_MOST_LINES = 5  # of walls and chokes that are named


@click.command("prices")
@click.argument("area", type=PATH)
@area_options
@rule_options
@robot_options
@click.option("--kind", type=Name("trihex.prices", "KINDS"), multiple=True, help="Only these; may be repeated.")
@click.option("--limit-seconds", type=Seconds(), help="Then leave the rest unproven.")
@click.option("--speed", type=Metres(), default=1.0, show_default=True, help="Of robots, in metres a second.")
@click.option("--out", type=PATH, metavar="FILE", help="A row for each cell, as .csv.")
@click.option("--picture", type=PATH, metavar="FILE", help="The prices drawn, as .png, .svg or .pdf.")
def command(
    area: Path,
    kind: tuple[str, ...],
    limit_seconds: float | None,
    speed: float,
    out: Path | None,
    picture: Path | None,
    **options: Any,
) -> int:
    """Tell what each wall and each door costs all robots together.

    For each barrier: the time saved if it were open. For each choke, the cells of the narrowest places between robots
    and destinations: the time lost if it were closed. And the best next door: the barrier that saves most if it becomes
    a destination. All are proven, as differences of optima.

    With --out what is found is kept in FILE.part until all is: interrupted at any moment, by --limit-seconds or by
    Ctrl-C, the same command goes on. Prices that are not proven are at least what FILE says.

    Exit status 1: some robots cannot arrive. The prices are those of the others.
    """
    from trihex.fields import make_n_scheme
    from trihex.formats import PRICES_SUFFIXES, PricesJournal, write_prices
    from trihex.pictures import PICTURE_SUFFIXES
    from trihex.planners import make_plan
    from trihex.prices import KINDS, make_prices

    check_outputs((out, PRICES_SUFFIXES, "prices"), (picture, PICTURE_SUFFIXES, "a picture"))
    scenario = complete(read_described(area, options), "optimal", "prices", *(["picture"] if picture else []))
    n_scheme = make_n_scheme(scenario)
    with bar("planning", "robots") as progress:
        plan = make_plan(scenario, "optimal", n_scheme=n_scheme, progress=progress)
    journal = None if out is None else PricesJournal(out.with_name(f"{out.name}.part"), plan)
    work: dict[str, Any] = {"kinds": kind or KINDS, "n_scheme": n_scheme}
    if journal is not None:
        work |= {"known": journal.known, "tell": journal.note}
    with _stopping(limit_seconds) as asked, bar("pricing", "cells") as progress:
        prices = make_prices(plan, **work, stop=asked, progress=progress)
    if out is not None:
        write_prices(prices, out, speed=speed)
    if journal is not None and prices.is_complete:
        journal.remove()
    if picture is not None:
        from trihex.pictures import picture_of_prices

        picture_of_prices(prices, speed=speed).save(picture)
    click.echo("\n".join(price_lines(prices, speed)))
    if not prices.is_complete:
        more = "the same command goes on" if journal else "add --out to be able to go on"
        click.echo(f"not proven: {int((~prices.proven).sum())} of {prices.cell.size} prices; {more}", err=True)
    tell_written(out, picture)
    if asked.is_interrupted:
        return INTERRUPTED
    return DONE if plan.arrived.all() else NO


class _Stop:
    """Whether the work is to stop: Ctrl-C was pressed, or the time is over."""

    def __init__(self, limit_seconds: float | None) -> None:
        self.is_interrupted = False
        self._end = None if limit_seconds is None else monotonic() + limit_seconds

    def __call__(self) -> bool:
        return self.is_interrupted or (self._end is not None and monotonic() >= self._end)


@contextmanager
def _stopping(limit_seconds: float | None) -> Iterator[_Stop]:
    """Yield what to ask whether to stop; the first Ctrl-C lets the work end well, a second ends it at once."""
    asked = _Stop(limit_seconds)
    before: Any = signal.getsignal(signal.SIGINT)

    def interrupt(*_: Any) -> None:
        asked.is_interrupted = True
        signal.signal(signal.SIGINT, before)

    signal.signal(signal.SIGINT, interrupt)
    try:
        yield asked
    finally:
        signal.signal(signal.SIGINT, before)


def price_lines(prices: Any, speed: float = 1.0) -> list[str]:
    """Return prices in a few lines: how many are something, and the greatest of them."""
    from trihex.record import counted

    plan = prices.plan
    total = f"{plan.total_time} units ({plan.scenario.waiting_cost} for a step of waiting)"
    if prices.seconds_per_unit(speed) is not None:
        total = prices.told(int(plan.total_time), speed)
    robots = counted(plan.scenario.robot_count, "robot")
    lines = [f"{plan.scenario.area.name}: {robots}, total time {total}, which is the least"]
    return lines + _wall_lines(prices, speed) + _choke_lines(prices, speed) + _door_lines(prices, speed)


def _wall_lines(prices: Any, speed: float) -> list[str]:
    """Return what is known of barriers."""
    return _lines_of_kind(
        prices, "barrier", "barriers", ("save time to open", "save nothing"), "let more robots arrive"
    ) + _greatest(prices, "barrier", "to open", "saves", "lets {} arrive", "more robot", speed)


def _choke_lines(prices: Any, speed: float) -> list[str]:
    """Return what is known of chokes."""
    return _lines_of_kind(
        prices, "choke", "chokes", ("cost time to close", "cost nothing"), "cut robots off"
    ) + _greatest(prices, "choke", "to close", "costs", "cuts {} off", "robot", speed)


def _lines_of_kind(prices: Any, kind: str, name: str, verbs: tuple[str, str], change: str) -> list[str]:
    """Return how many rows of a kind have a price, have none, or change who can arrive; no line if there are none."""
    rows = prices.kind == kind
    if not rows.any():
        return []
    dear, other = int((rows & (prices.price > 0)).sum()), int((rows & (prices.robots != 0)).sum())
    unknown = int((rows & ~prices.proven & (prices.price == 0)).sum())
    told = [f"{name}: {dear} {verbs[0]}", f"{int(rows.sum()) - dear - other - unknown} {verbs[1]}"]
    told += [f"{other} {change}"] if other else []
    return [", ".join([*told, *([f"{unknown} not known"] if unknown else [])])]


def _greatest(prices: Any, kind: str, what: str, verb: str, change: str, whom: str, speed: float) -> list[str]:
    """Return the rows that change most, first those that change who can arrive."""
    from trihex.record import counted

    rows = ((prices.kind == kind) & ((prices.price > 0) | (prices.robots != 0))).nonzero()[0]
    lines = []
    for row in sorted(rows, key=lambda i: (-abs(prices.robots[i]), -prices.price[i], prices.cell[i]))[:_MOST_LINES]:
        x, y = prices.plan.scenario.area.cell_to_xy(int(prices.cell[row]))
        robots, least = int(prices.robots[row]), "" if prices.proven[row] else "at least "
        told = change.format(counted(abs(robots), whom)) if robots else f"{verb} {least}{_told(prices, row, speed)}"
        if robots < 0 and prices.cell[row] in prices.plan.scenario.robots:
            told += ", one of which starts there" if robots < -1 else ", which starts there"
        lines.append(f"  {what} ({x}, {y}) {told}")
    return lines


def _told(prices: Any, row: int, speed: float) -> str:
    """Return a price in words, and beside the total time of all robots."""
    price, total = int(prices.price[row]), int(prices.plan.total_time)
    return f"{prices.told(price, speed)}{f' ({100 * price / total:.3g} %)' if total else ''}"


def _door_lines(prices: Any, speed: float) -> list[str]:
    """Return what is known of the best next door, in a line; none if it is not asked for, or nothing saves anything."""
    rows = (prices.kind == "door").nonzero()[0]
    if not rows.size:
        return []
    most = prices.told(int(prices.most[rows[0]]), speed)
    if prices.best_door is None:
        return [f"best next door: not known; none saves more than {most}"]
    more = "" if prices.proven[rows[0]] else f"; a better one is not ruled out, but none saves more than {most}"
    return [f"best next door: {prices.best_door} saves {_told(prices, rows[0], speed)}{more}"]
