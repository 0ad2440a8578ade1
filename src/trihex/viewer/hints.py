"""Hints: one line for each planner, each option and each of its choices, as a page tells them."""

from __future__ import annotations

import inspect
import re
from typing import Any

from trihex.planners import PLANNERS, options_of, planner_named

PLANNER_HINTS = {
    "fcost": "Weighs a longer way against waiting: good plans for any crowd, quickly.",
    "greedy": "Everybody takes a shortest way, and waits where it is taken: the quickest to plan.",
    "astar": "One robot after the other, each past the ways of those before it: for few robots.",
    "optimal": "The least total time that there can be, proven: takes seconds to minutes.",
}
OPTION_HINTS = {
    "rule": {
        "best": "Tries aside, greedy ways and lanes, and keeps the best plan.",
        "paper": "Counts the robots whose shortest ways meet, as the paper does; crowds dodge each other for long.",
        "queue": "Counts the line that a robot will find at the end of its way.",
        "aside": "As queue, and who is blocked steps aside.",
        "lanes": "As aside, along lanes: ways to the destination that share no cell.",
    },
    "rounds": {"": "How often robots look ahead for cheaper ways: 8 take about eight times as long."},
    "objective": {
        "time": "The least sum of the times of all robots.",
        "steps": "The fewest steps until each robot has arrived.",
    },
    "memory_limit": {"": "In bytes; by default 80 % of what is free."},
}


def planner_hints() -> dict[str, Any]:
    """Return of each planner a line, and of each of its options its choices, each with a line.

    Choices are read from the docstring of the planner, ``option : {"one", "other"}``; a planner without a line of its
    own tells the first of its docstring.
    """
    found: dict[str, Any] = {}
    for name in PLANNERS:
        text = inspect.getdoc(planner_named(name)) or ""
        options = {}
        for option in options_of(name):
            listed = re.search(rf"^{option} : \{{(.*)\}}$", text, re.MULTILINE)
            hints = OPTION_HINTS.get(option, {})
            choices = re.findall(r'"([^"]+)"', listed[1]) if listed else [""]
            options[option] = {choice: hints.get(choice, "") for choice in choices}
        found[name] = {"line": PLANNER_HINTS.get(name) or text.partition("\n")[0], "options": options}
    return found
