"""Mistakes in Python: each ends in a TrihexError of one line that says what, where, the rule and the value."""

# ruff: noqa: E501

import inspect

import numpy as np
import pytest

import trihex as th
from trihex.plans import plan_from_lists

# Mistake: (what is written, what is said); "..." stands for words that may change.
CASES = {
    # places
    "cell number -1": ("area.cell_to_xy([5, -1])", "cell number -1 lies outside the area of 24 cells; -1 stands for robots that are not in the area: leave them out, cells[cells >= 0]"),
    "cell beyond the last": ("n_scheme.distance_of_cell(10**6)", "cell number 1000000 lies outside the area of 24 cells"),
    "place outside": ("area.is_barrier((6, 0))", "cell (6, 0) lies outside the area: x is 0..5, y is 0..3"),
    "tuple of three numbers": ("th.Scenario(area, (3, 0, 1))", "destinations: (3, 0, 1) is no place (x, y), which has two numbers; cell numbers are to be in a list or an array"),
    "all x and all y": ("th.Scenario(area, area.cell_to_xy([1, 2]))", "destinations might be two places or all x and all y, a tuple of two arrays: area.xy_to_cell(x, y) makes numbers of x and y, a list of the two arrays says that they are places"),
    "pairs or numbers": ("n_scheme.distance_of_cell(np.array([[3, 1], [4, 2]]))", "cell might be pairs (x, y) or numbers of cells, an array of shape (2, 2): area.xy_to_cell(x, y) makes numbers of pairs, .reshape(-1) says that they are numbers"),
    "mask of cells": ("field.change(blocked=area.barriers)", "blocked must be pairs of integers (x, y), one such pair, or cell numbers in a list or a flat array, not an array of bool of shape (4, 6): np.flatnonzero(mask) makes numbers of a mask"),
    "places between cells": ("area.xy_to_cell(2.5, 1)", "x must be whole numbers, the column or row of a cell, not 2.5"),
    "barrier on a destination": ("field.change(blocked=(5, 3))", "a cell must not be blocked while it is a destination: (5, 3)"),
    "axial coordinates of squares": ("area.with_tessellation('square').cell_to_axial(0)", "axial and cube coordinates are of hexagons; the area is square"),
    "start times of some": ("th.Scenario(area, (5, 3), [(0, 3), (1, 3)], start_times=[3])", "start_times must be one for each of 2 robots, not 1"),
    "slowness of some": ("th.Scenario(area, (5, 3), [(0, 3), (1, 3)], slowness=[3])", "slowness must be one for each of 2 robots, not 1"),
    "run of the slow": ("th.Execution(th.Scenario(area, (5, 3), [(0, 3)], slowness=2))", "an execution needs robots that are all as fast, without slowness, not slowness up to 2"),
    "door of a second, made by hand": ("th.Door([3], '1.6/s')", "flow of a door must be robots a step, not '1.6/s'; make_doors takes both"),
    "door of places": ("th.Door([(3, 1)], 1)", "cells of a door must be numbers in a list or a flat array, not [(3, 1)]"),
    "flow in words": ("th.Scenario(area, (5, 3), doors=[((5, 3), 'half')])", "capacity of a door must be a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, such as 1.6/s; not 'half'"),
    # areas
    "area of floats": ("th.Area('hexagonal', [[0.2, 0.7]])", "barriers must be True and False, or 1 and 0, not 0.2: say which values are barriers, such as grid > 0"),
    "area of grey values": ("th.Area('hexagonal', np.full((2, 2), 255))", "barriers must be True and False, or 1 and 0, not 255: say which values are barriers, such as grid > 0"),
    "area of letters": ("th.Area('hexagonal', ['..#', '...'])", "barriers must be rows of True and False, or 1 and 0, not <U3 values; read_area reads files of letters"),
    "area of ragged rows": ("th.Area('hexagonal', [[0, 1], [0]])", "barriers must be a rectangle: its rows differ in length"),
    "area the wrong way round": ("th.Area([[0, 1]], 'hexagonal')", "tessellation must be a Tessellation or a str, not list"),
    "size in words": ("th.make_rooms_area('hexagonal', '9', 9)", "height must be a whole number from 1, not '9'"),
    # arguments of a wrong kind
    "plan of an area": ("th.make_plan(area)", "scenario must be a Scenario, not Area: Scenario(area, destinations, robots) makes one"),
    "field of an area": ("th.make_n_scheme(area)", "scenario must be a Scenario, not Area: Scenario(area, destinations, robots) makes one"),
    "directions of a scenario": ("th.make_d_scheme(scenario)", "n_scheme must be an NScheme, not Scenario: make_n_scheme(scenario) makes one"),
    "report of a scenario": ("th.make_report(scenario)", "plan must be a Plan, not Scenario: make_plan(scenario) makes one"),
    "prices of a scenario": ("th.make_prices(scenario)", "plan must be a Plan, not Scenario: make_plan(scenario) makes one"),
    "prices of windows": ("th.make_prices(report.plan, kinds='window')", "kinds must be one of barrier, choke, door, not 'window'"),
    "audit of a report": ("th.audit_plan(report)", "plan must be a Plan, not Report: report.plan is one"),
    "audit of a file": ("th.audit_plan('plan.npz')", "plan must be a Plan, not 'plan.npz': read_plan(path) reads one"),
    "picture of a scenario as a plan": ("th.picture_of_plan(scenario)", "plan must be a Plan or a Run, not Scenario: make_plan(scenario) makes one"),
    "drawing of an N-scheme as directions": ("th.draw_d_scheme(n_scheme)", "d_scheme must be a DScheme, not NScheme: make_d_scheme(n_scheme) makes one"),
    "viewer of a file": ("th.open_viewer('rooms.map')", "record must be an Area or a Scenario or a Plan or a Run or a Draft, not 'rooms.map': read_area(path) reads one"),
    "scenario without an area": ("th.Scenario([[0, 1]], (0, 0))", "area must be an Area, not list"),
    "execution of a plan": ("th.Execution(plan)", "scenario must be a Scenario, not Plan: plan.scenario is one"),
    "trial for a run": ("th.audit_run(th.Trial(scenario))", "run must be a Run, not Trial: trial.run() makes one"),
    "N-scheme of another": ("th.make_plan(scenario, n_scheme=area)", "n_scheme must be an NScheme or None, not Area"),
    "one scenario for many": ("th.make_comparison(scenario, ['greedy'])", "scenarios must be a list of scenarios, not Scenario: put it into brackets, [scenario]"),
    "file and record the wrong way round": ("th.write_plan('plan.npz', plan)", "plan must be a Plan or a Run, not 'plan.npz': read_plan(path) reads one"),
    "no path": ("th.read_area(5)", "path must be the path of a file, not int"),
    # options
    "option with a slip": ("th.read_area('house.yaml', cellsize=3)", "option of read_area must be one of tessellation, cell_size, ..., not 'cellsize'; did you mean 'cell_size'?"),
    "option of another planner": ("th.make_plan(scenario, 'greedy', rule='paper')", "planner 'greedy' has no options, so not 'rule'; planner 'fcost' has it"),
    "rule of a scenario, by the symbol of the paper": ("th.make_plan(scenario, wt=5)", "option of planner 'fcost' must be one of rule, rounds, not 'wt'; it is a part of the scenario, Scenario(waiting_cost=...)"),
    "planner with a slip": ("th.make_plan(scenario, 'fcsot')", "planner must be one of greedy, fcost, astar, optimal, not 'fcsot'; did you mean 'fcost'?"),
    "delay in words": ("th.Trial(scenario, delay='10%')", "delay must be a number from 0 to below 1, not '10%'"),
    "events in words": ("th.Trial(scenario, events='events.csv')", "events must be a list of events, such as those of read_events, not 'events.csv'"),
    "event that is none": ("th.Trial(scenario, events=[(5, 'barrier')])", "events[0] must be an Event, not tuple"),
    "optimum where it is no flow": ("th.make_plan(th.Scenario(area, (5, 3), following='forbid'), 'optimal')", "planner 'optimal' needs following='allow', not 'forbid', which is no pure flow; the lower bound in the report of another planner tells how far its plan is from the optimum at most"),
    "memory in words": ("th.make_plan(scenario, 'optimal', memory_limit='1GB')", "memory_limit, in bytes, must be a number from 0, not '1GB'"),
    # steps and robots
    "one late robot": ("th.Execution(scenario).step(late=1)", "late must be a list of the numbers of robots, not int: put it into brackets, [late]"),
    "late robot by name": ("th.Execution(scenario).step(late=['a'])", "late must name robots by their numbers, not ['a']"),
    "places without robots": ("th.Execution(scenario).place([(1, 0)])", "cell_of_robot must be a Mapping, not list"),
    "steps in words": ("th.Trial(scenario).run(most_steps='9')", "most_steps must be a whole number from 0, not '9'"),
    "step that there is not": ("plan.sets_at(9)", "step must be 1..6, the last of them after all is done, not 9"),
    "robot that there is not": ("plan.cells_of_robot(2)", "robot must be one of 0..1, not 2"),
}  # fmt: skip


def names():
    """Return what the snippets may use."""
    area = th.Area("hexagonal", [[0, 0, 0, 0, 0, 0], [0, 1, 1, 1, 1, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]])
    scenario = th.Scenario(area, destinations=(5, 3), robots=[(0, 3), (1, 3)])
    plan = th.make_plan(scenario)
    n_scheme = th.make_n_scheme(scenario)
    found = {"area": area, "scenario": scenario, "plan": plan, "n_scheme": n_scheme, "field": th.LivingField(scenario)}
    return {"th": th, "np": np, "report": th.make_report(plan), **found}


def said(code, known):
    """Return what trihex says to a snippet."""
    try:
        eval(code, known)
    except th.TrihexError as error:
        return str(error)
    return "nothing"


@pytest.fixture(scope="module")
def known():
    return names()


@pytest.mark.parametrize("case", CASES)
def test_a_mistake_is_named_in_one_line(known, case):
    code, message = CASES[case]
    answer = said(code, known)
    head, dots, tail = message.partition("...,")
    assert answer.startswith(head)
    assert answer.endswith(tail)
    assert dots or answer == message
    assert "\n" not in answer


def chapter_lines():
    """Yield the lines of the chapter of docs/mistakes.md."""
    known = names()
    yield "## In Python\n"
    yield "Each raises a `TrihexError`. `th` is trihex, `np` numpy; `area`, `scenario`, `n_scheme`, `plan`, `report` and `field`, a"
    yield "`LivingField`, are of a hexagonal area of 6 x 4 cells. The rule for places is in [Conventions](conventions.md#places).\n"
    yield "| mistake | code | message |"
    yield "|---|---|---|"
    for case, (code, message) in CASES.items():
        yield f"| {case} | `{code}` | {message if '...,' in message else said(code, known)} |"


class Thing:
    """Something that no function of trihex takes."""


def entry_points():
    """Yield the name of each public function and of each public class that is made of something."""
    for name in th.__all__:
        thing = getattr(th, name)
        is_error = inspect.isclass(thing) and issubclass(thing, Exception)
        if callable(thing) and not is_error:
            needed = [
                parameter
                for parameter in inspect.signature(thing).parameters.values()
                if parameter.default is parameter.empty and parameter.kind is parameter.POSITIONAL_OR_KEYWORD
            ]
            if needed:
                yield name, len(needed)


# Made by others than users: their makers check what they are given.
MADE = {"Arrivals", "Audit", "Comparison", "Conflict", "DScheme", "Follower", "LastGeneration", "LowerBound", "NScheme",
        "PassingOrder", "Picture", "Report", "Run", "RunAudit", "RunReport", "Study", "TiledField", "Occurrence",
        "EarliestArrivals", "Exits", "Score", "Trajectories"}  # fmt: skip


@pytest.mark.parametrize(("name", "count"), [(n, c) for n, c in entry_points() if n not in MADE])
def test_every_entry_point_says_what_it_needs(name, count):
    for wrong in (Thing(), None, 3.5):
        if (name, wrong) == ("Frame", 3.5):
            continue
        with pytest.raises(th.TrihexError, match=r"must|not|is no") as raised:
            getattr(th, name)(*[wrong] * count)
        assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", ["open_viewer", "make_widget", "picture_of_area", "draw_arrivals"])
def test_so_do_those_that_take_several_kinds(name):
    with pytest.raises(th.TrihexError, match=r"must be an? .* not Thing"):
        getattr(th, name)(Thing())


def test_an_argument_error_is_a_type_error_and_names_the_way():
    with pytest.raises(TypeError, match=r"^plan must be a Plan, not 'p.npz': read_plan\(path\) reads one$"):
        th.make_report("p.npz")
    assert issubclass(th.ArgumentError, th.TrihexError)


def test_plans_by_hand_name_what_they_lack():
    with pytest.raises(th.TrihexError, match="scenario must be a Scenario, not Area"):
        plan_from_lists(names()["area"], [[]])
