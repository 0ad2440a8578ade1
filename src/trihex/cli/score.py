"""`trihex score`: a crowd that was recorded beside the best possible."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trihex.cli.described import complete, read_described
from trihex.cli.group import DONE, NO
from trihex.cli.maps import CHART_SUFFIXES
from trihex.cli.options import PATH, area_options, rule_options
from trihex.cli.outputs import check_outputs, tell_written, write_text
from trihex.cli.types import Metres, Positive


@click.command("score")
@click.argument("trajectories", type=PATH)
@click.argument("area", type=PATH)
@area_options
@rule_options
@click.option("--speed", type=Metres(), help="Nobody is faster, in metres a second. [default: the greatest of anyone]")
@click.option(
    "--flow", type=Positive("persons"), help="Persons a second through all exits without a capacity. [default: any]"
)
@click.option("--summary", type=PATH, metavar="FILE", help="The numbers as JSON; - writes them to the standard output.")
@click.option("--curve", type=PATH, metavar="FILE", help="N(t) beside the bound, as .csv, .png, .svg or .pdf.")
@click.option("--lost", type=PATH, metavar="FILE", help="Seconds lost in each cell, drawn or .npy.")
def command(
    trajectories: Path,
    area: Path,
    speed: float | None,
    flow: float | None,
    summary: Path | None,
    curve: Path | None,
    lost: Path | None,
    **options: Any,
) -> int:
    """Tell how far a recorded crowd is from the best possible.

    TRAJECTORIES is an sqlite file of JuPedSim, or text that PedPy reads; AREA is a place in metres with its exits, in
    the same coordinates: give --cell-size, not more than persons are apart. No crowd that keeps to what is assumed can
    have more arrivals at any time than the bound.

    Exit status 1: this one has, so what is assumed is not so.
    """
    from dataclasses import replace
    from json import dumps

    from trihex.formats import read_trajectories, write_field, write_values
    from trihex.judging import make_score
    from trihex.pictures import PICTURE_SUFFIXES

    is_chart = curve is not None and curve.suffix.lower() != ".csv"
    check_outputs(
        (summary, (), "a summary"),
        (curve, (".csv", *CHART_SUFFIXES), "a chart" if is_chart else "a table"),
        (lost, (*PICTURE_SUFFIXES, ".npy"), "a map"),
    )
    crowd = read_trajectories(trajectories)
    # What doors let in a second is made of steps and of seconds again: at one speed, whatever the scenario has.
    draft = replace(read_described(area, options), outputs={})
    scenario = complete(draft, "bound", "reach", needs_robots=False)
    score = make_score(crowd, scenario, speed=speed, flow=flow)
    if summary is not None:
        write_text(dumps(score.as_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n", summary)
    if curve is not None and is_chart:
        _draw_curve(score, curve)
    elif curve is not None:
        write_values(curve_rows(score), curve)
    if lost is not None and lost.suffix.lower() == ".npy":
        write_field(score.lost, lost)
    elif lost is not None:
        from trihex.pictures import picture_of_lost

        picture_of_lost(score).save(lost)
    if str(summary) != "-":
        click.echo("\n".join(score_lines(score)))
        tell_written(summary, curve, lost)
    return DONE if score.is_within else NO


def _draw_curve(score: Any, path: Path) -> None:
    from trihex.files import new_file
    from trihex.pictures import draw_score

    ax = draw_score(score)
    with new_file(path) as part:
        ax.figure.savefig(part, format=path.suffix.lower()[1:])


def curve_rows(score: Any) -> list[dict[str, Any]]:
    """Return when the i-th person arrived, and when he can have at best."""
    pairs = zip(score.arrivals.tolist(), score.earliest.tolist(), strict=False)
    return [
        {"arrived": number, "seconds": round(seconds, 6), "least_seconds": round(least, 6)}
        for number, (seconds, least) in enumerate(pairs, 1)
    ]


def score_lines(score: Any) -> list[str]:
    """Return the score in a few lines."""
    numbers = score.as_dict()
    lines = [f"{numbers['trajectories']}: {numbers['arrived']} of {numbers['persons']} persons arrived"]
    if numbers["arrived"]:
        lines[0] += f", the last after {numbers['last_arrival_seconds']:.1f} s, in the mean after "
        lines[0] += f"{numbers['mean_arrival_seconds']:.1f} s"
        if score.is_within:
            gap = "" if score.gap is None else f": {100 * score.gap:.0f} % above it in the mean"
            last, mean = numbers["least_last_seconds"], numbers["least_mean_seconds"]
            lines.append(f"at best the last after {last:.1f} s, in the mean after {mean:.1f} s{gap}")
        else:
            first = f"{score.first_beyond:.1f} s"
            lines.append(f"more arrived than the bound allows, first after {first}: see what is assumed")
    lines += [f"exit {name}: {count} persons" for name, count in numbers["exits"].items()]
    lines.append(f"{numbers['seconds_lost']:.0f} person seconds lost to standing and walking slowly")
    body = f"one person in a cell of {numbers['cell_size']:g} m, exits and doors as wide as their cells"
    lines.append(f"assumed: nobody is faster than {score.speed:.3g} m/s; {body}{_flows_in_words(score)}")
    return lines


def _flows_in_words(score: Any) -> str:
    """Return how many leave in a second at most, by exit where exits tell it."""
    if set(score.flows) <= {"elsewhere"}:
        return f"; at most {score.flow:g} persons leave in a second" if score.flow else ""
    flows = ", ".join(f"{flow:.4g} {'' if name == 'elsewhere' else 'by '}{name}" for name, flow in score.flows.items())
    any_number = "" if score.flow else "; any number by the other exits, so that flows do not count"
    return f"; at most so many persons leave in a second: {flows}{any_number}"
