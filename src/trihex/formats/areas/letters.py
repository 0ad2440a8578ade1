"""Letters: a small world drawn in text, `.` free, `B` or `#` a barrier, `D` a destination, small letters robots."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from trihex.areas import Area, Scenario, Tessellation
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.files import new_file
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.rows import framed, parse_rows, refuse_frame
from trihex.formats.draft import Draft
from trihex.formats.text import Text

_ROBOTS = range(ord("a"), ord("z") + 1)
_KIND_OF_LETTER = np.full(256, 255, dtype=np.uint8)
_KIND_OF_LETTER[[*b".BD", *_ROBOTS]] = [*b".BD", *_ROBOTS]  # every known letter is a kind of its own
_KIND_OF_LETTER[ord("#")] = ord("B")
_SHAPE = ("name", "neighbourhood", "costs")
_RULES = ("waiting_cost", "crossing", "corners", "destination_capacity", "clock", "following")
_KNOWN = ". (free), B or # (barrier), D (destination), a to z (robots)"


def parse_letters(
    text: Text, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None = None
) -> Draft:
    """Return the draft of a file of letters, read at once; see `draft_of_letters`."""
    return framed(draft_of_letters(text, path, options.tessellation), options, path)


def draft_of_letters(content: bytes, path: str | os.PathLike[str], tessellation: Tessellation) -> Draft:
    """Return the area, its destinations and its robots, which are numbered in the order of their letters.

    Destinations and robots are None where there is no `D`, no small letter.

    Raises
    ------
    FormatError
        If the rows are ragged, a letter is unknown, or a robot stands in two cells.
    """
    letters = parse_rows(content, path, _KIND_OF_LETTER, _KNOWN)
    letter_of_cell = letters.reshape(-1)
    robots = np.flatnonzero(letter_of_cell >= ord("a"))
    robots = robots[np.argsort(letter_of_cell[robots], kind="stable")]
    names = letter_of_cell[robots]
    twice = np.flatnonzero(names[1:] == names[:-1])
    area = Area(tessellation, letters == ord("B"), os.path.splitext(os.path.basename(path))[0])
    if twice.size:
        one, other = (area.name_of_cell(int(robots[twice[0] + i])) for i in (0, 1))
        raise FormatError(f"{path}: robot {chr(names[twice[0]])!r} must stand in one cell, not in {one} and {other}")
    destinations = np.flatnonzero(letter_of_cell == ord("D"))
    return Draft(area, destinations if destinations.size else None, robots if robots.size else None)


def letters_of(scenario: Scenario) -> list[str]:
    """Return the rows of letters that show a scenario.

    Raises
    ------
    FormatError
        If letters cannot carry it: more than 26 robots, or a robot on a destination.
    """
    if scenario.robot_count > len(_ROBOTS):
        raise FormatError(f"letters can name at most {len(_ROBOTS)} robots, not {scenario.robot_count}")
    both = np.intersect1d(scenario.robots, scenario.destinations)
    if both.size:
        where = scenario.area.name_of_cell(int(both[0]))
        raise FormatError(f"a letter shows a robot or a destination; cell {where} holds both")
    letters = np.where(scenario.area.barriers, ord("B"), ord(".")).astype(np.uint8).reshape(-1)
    letters[scenario.destinations] = ord("D")
    letters[scenario.robots] = _ROBOTS[: scenario.robot_count]
    return [bytes(row).decode() for row in letters.reshape(scenario.area.barriers.shape)]


def lost_in_letters(scenario: Scenario) -> list[str]:
    """Return what of a scenario its letters do not tell, in words; the seed and the name do not count."""
    plain = Scenario(Area(Tessellation("hexagonal"), scenario.area.barriers), scenario.destinations, scenario.robots)
    one, other = scenario.area.tessellation, plain.area.tessellation
    lost = [f"{name} {getattr(one, name)}" for name in _SHAPE if getattr(one, name) != getattr(other, name)]
    lost += [
        f"{name.replace('_', ' ')} {getattr(scenario, name)}"
        for name in _RULES
        if getattr(scenario, name) != getattr(plain, name)
    ]
    lost += ["doors with a flow"] if scenario.doors else []
    lost += ["start times"] if scenario.has_start_times else []
    lost += ["slowness"] if scenario.has_slowness else []
    return [*lost, *(["a frame in metres"] if scenario.area.frame else [])]


def write_letters(area: Area, path: str | os.PathLike[str]) -> None:
    """Write the barriers of an area; the tessellation is not kept.

    Raises
    ------
    FormatError
        If the area has a frame.
    """
    refuse_frame(area.frame, path)
    _write(["".join("B" if barrier else "." for barrier in row) for row in area.barriers.tolist()], path)


def write_scenario_letters(scenario: Scenario, path: str | os.PathLike[str], **planner: Any) -> None:
    """Write a scenario with its destinations and robots; tessellation, rules and planner are not kept.

    Raises
    ------
    FormatError
        If letters cannot carry it; see `letters_of`.
    """
    _write(letters_of(scenario), path)


def _write(rows: list[str], path: str | os.PathLike[str]) -> None:
    with new_file(path) as part:
        part.write_text("\n".join([*rows, ""]))
