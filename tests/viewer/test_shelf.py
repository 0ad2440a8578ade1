"""What a desk keeps: the last plans, live runs and fields, each up to a limit."""

import numpy as np
import pytest

import trihex as th
from trihex.viewer import shelf as shelves
from trihex.viewer.live import Live, trial_of
from trihex.viewer.requests import parse_request
from trihex.viewer.shelf import Shelf


def scenario_of(width):
    return th.Scenario(th.Area("square", np.zeros((2, width))), [(width - 1, 0)], [(0, 0), (0, 1)])


def report_of(width, planner="greedy"):
    return th.make_report(th.make_plan(scenario_of(width), planner))


def test_the_last_plans_are_kept_by_name():
    shelf = Shelf()
    assert shelf.last_report is None
    reports = [report_of(width) for width in range(3, 13)]
    names = [shelf.put_report(report) for report in reports]
    assert len(set(names)) == 10 and shelf.last_report is reports[-1]
    assert [shelf.report(name) for name in names[2:]] == reports[2:]
    for name in (*names[:2], "plan-99", ""):
        with pytest.raises(th.FormatError, match="this plan is not kept any more"):
            shelf.report(name)
    shelf.replace_report(names[5], reports[0])
    assert shelf.report(names[5]) is reports[0]


def test_long_plans_go_sooner_but_never_the_last(monkeypatch):
    monkeypatch.setattr(shelves, "_MOST_ACTIONS", 40)
    shelf, reports = Shelf(), [report_of(width) for width in (5, 6, 30, 40)]
    names = [shelf.put_report(report) for report in reports[:2]]
    assert shelf.report(names[0]) is reports[0]
    for report in reports[2:]:
        names.append(shelf.put_report(report))
        assert shelf.report(names[-1]) is report
        with pytest.raises(th.FormatError):
            shelf.report(names[-2])


def test_the_last_live_runs_are_kept_by_name():
    shelf = Shelf()
    assert shelf.last_live is None
    request = parse_request({"op": "live", "planner": "fcost"})
    runs = [Live(trial_of(scenario_of(4), request)) for _ in range(3)]
    names = [shelf.put_live(live) for live in runs]
    assert [shelf.live(name) for name in names[1:]] == runs[1:] and shelf.last_live is runs[2]
    with pytest.raises(th.FormatError, match="this live run is not kept any more"):
        shelf.live(names[0])


def test_a_field_is_made_once_for_equal_scenarios_and_the_optimum_is_known_once_proven():
    shelf = Shelf()
    assert shelf.n_scheme(scenario_of(9)) is shelf.n_scheme(scenario_of(9))
    assert shelf.n_scheme(scenario_of(8)) is not shelf.n_scheme(scenario_of(9))
    proven = report_of(9, "optimal")
    assert shelf.optimum(scenario_of(9)) is None
    shelf.put_report(proven)
    assert shelf.optimum(scenario_of(9)).value == proven.total_time and shelf.optimum(scenario_of(8)) is None
