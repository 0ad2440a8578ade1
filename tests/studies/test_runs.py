"""Runs: one table whoever does them, failures as rows, limits, and workers that die."""

import os
import signal
import threading
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import pytest

import trihex as th
from trihex.studies import Study, worker
from trihex.studies.row import COLUMNS, hash_of_scenario, versions
from trihex.studies.study import make_study
from trihex.studies.worker import Limits, Worker, run_cases

AREA = {"generator": "random", "size": [12, 9], "density": 0.1}
RUNS = [
    {"area": AREA, "robots": robots, "seed": seed, "planner": planner, "tessellation": name}
    for name in ("square", "triangular")
    for robots in (5, 200)
    for seed in range(2)
    for planner in ("greedy", "fcost")
]
HUGE = [{"area": {"generator": "maze", "size": [5000, 5000]}, "robots": 1}]


def without_seconds(rows):
    return [{name: value for name, value in row.items() if not name.startswith("seconds")} for row in rows]


class Reversed:
    """An executor that does the last call first, and nothing before somebody waits."""

    def __init__(self):
        self.calls = []

    def submit(self, function, *arguments):
        future = Future()
        self.calls.append((future, function, arguments))
        if len(self.calls) == 1:
            threading.Timer(0.2, self.work).start()
        return future

    def work(self):
        while self.calls:
            future, function, arguments = self.calls.pop()
            future.set_result(function(*arguments))


class Losing:
    """An executor that loses what it is given, at first."""

    def __init__(self, losses, error):
        self.losses, self.error = losses, error

    def submit(self, function, *arguments):
        future = Future()
        self.losses -= 1
        if self.losses >= 0:
            future.set_exception(self.error)
        else:
            future.set_result(function(*arguments))
        return future


def test_rows_are_those_of_the_plans_in_the_order_of_the_study():
    rows = th.run_study(RUNS)
    assert [row["run"] for row in rows] == list(range(len(RUNS)))
    for run, row in zip(RUNS, rows, strict=True):
        assert list(row) == list(COLUMNS)
        assert (row["seed"], row["planner"], row["tessellation"]) == (run["seed"], run["planner"], run["tessellation"])
        assert versions().items() <= row.items()
        if run["robots"] == 200:  # more than there are cells
            assert "robots must be at most the number of free cells" in row["error"] and row["total_time"] is None
            continue
        area = th.make_random_area(run["tessellation"], 9, 12, density=0.1, seed=run["seed"])
        assert row["area"] == area.name and row["free_cells"] == area.free_count
        assert row["error"] is None and row["arrived"] == 5 and row["conflicts"] == 0
        assert row["total_time"] >= row["lower_bound"] > 0
        assert all(row[name] >= 0 for name in COLUMNS if name.startswith("seconds"))


def test_a_scenario_given_as_such_has_the_numbers_of_its_report():
    area = th.make_caves_area("hexagonal", 24, 36, seed=4)
    scenario = th.Scenario(area, [(18, 12)], th.random_robots(area, 60, seed=1, avoid=[(18, 12)]), seed=1)
    (row,) = th.run_study([{"scenario": scenario, "planner": "fcost"}])
    summary = th.make_report(th.make_plan(scenario)).as_dict()
    # Tables of studies keep their columns: what was recorded is compared with what is done anew.
    later = {"turning", "step_seconds", "last_arrival_seconds", "mean_arrival_seconds"}
    names = summary.keys() - {"seconds", "corner_moves", "squeezing_moves"} - later
    assert {name: row[name] for name in names} == {name: summary[name] for name in names}
    assert row["scenario"] == hash_of_scenario(scenario)


def test_the_hash_tells_scenarios_apart():
    area = th.Area("square", [[0, 0, 0], [0, 0, 0]])
    base = th.Scenario(area, [(0, 0)], [(1, 0)])
    others = [
        th.Scenario(th.Area("hexagonal", area.barriers), [(0, 0)], [(1, 0)]),
        th.Scenario(th.Area(th.Tessellation("square", "edge"), area.barriers), [(0, 0)], [(1, 0)]),
        th.Scenario(th.Area("square", [[0, 0], [0, 0], [0, 0]]), [(0, 0)], [(1, 0)]),
        th.Scenario(th.Area("square", [[0, 0, 1], [0, 0, 0]]), [(0, 0)], [(1, 0)]),
        th.Scenario(th.Area("square", area.barriers, frame=th.Frame(1.0)), [(0, 0)], [(1, 0)]),
        th.Scenario(area, [(1, 0)], [(0, 0)]),
        th.Scenario(area, [(0, 0)], [(2, 0)]),
        th.Scenario(area, [(0, 0)], [(1, 0)], waiting_cost=11),
        th.Scenario(area, [(0, 0)], [(1, 0)], corners="no-cut"),
        th.Scenario(area, [(0, 0)], [(1, 0)], destination_capacity=1),
    ]
    assert len({hash_of_scenario(scenario) for scenario in [base, *others]}) == 11
    assert hash_of_scenario(th.Scenario(area, [(0, 0)], [(1, 0)], seed=5)) == hash_of_scenario(base)


def test_any_executor_makes_the_same_table():
    rows = without_seconds(th.run_study(RUNS))
    assert without_seconds(th.run_study(RUNS, executor=Reversed())) == rows
    with ThreadPoolExecutor(2) as pool:
        assert without_seconds(th.run_study(RUNS, executor=pool)) == rows
    with ProcessPoolExecutor(1) as pool:
        assert without_seconds(th.run_study(RUNS, executor=pool)) == rows


def test_progress_is_told_run_by_run():
    told = []
    th.run_study(RUNS[:3], progress=lambda *done: told.append(done))
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_what_an_executor_loses_is_done_again_and_then_given_up():
    rows = without_seconds(th.run_study(RUNS[:1]))
    assert without_seconds(th.run_study(RUNS[:1], executor=Losing(2, OSError("gone")))) == rows
    (row,) = th.run_study(RUNS[:1], executor=Losing(3, OSError("gone")))
    assert row["error"] == "no worker could do it: OSError: gone"
    assert (row["planner"], row["robots"], row["total_time"]) == ("greedy", 5, None)


def test_an_executor_that_breaks_ends_the_study():
    with pytest.raises(th.StudyError, match=r"the executor stopped \(BrokenExecutor: all dead\); what is done is kept"):
        th.run_study(RUNS, executor=Losing(9, BrokenExecutor("all dead")))


def test_short_runs_are_given_out_together_and_those_of_one_scenario_always_are():
    calls = []

    class Counting(ThreadPoolExecutor):
        def submit(self, function, cases, *arguments):
            calls.append([case["seed"] for case in cases])
            return super().submit(function, cases, *arguments)

    runs = [{**RUNS[0], "seed": seed, "planner": planner} for seed in range(60) for planner in ("greedy", "fcost")]
    with Counting(1) as pool:
        assert len(th.run_study(runs, executor=pool)) == 120
    assert [seed for seeds in calls for seed in seeds] == [run["seed"] for run in runs]
    assert all(seeds[0] == seeds[1] and seeds[-1] == seeds[-2] for seeds in calls)
    assert len(calls[0]) == 2 and max(map(len, calls)) > 4


def test_a_fault_is_a_row(monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError("by\nzero")

    monkeypatch.setattr("trihex.studies.case.audit_plan", broken)
    assert th.run_study(RUNS[:1])[0]["error"] == "fault of trihex: ZeroDivisionError: by zero"


def test_limits_make_rows_and_the_next_run_is_as_ever():
    cases = make_study(HUGE).trials
    small = make_study(RUNS[:1]).trials
    rows = run_cases([*cases, *small], Limits(seconds=1.5))
    assert [row["error"] for row in rows] == ["took longer than 1.5 s", None]
    assert rows[0]["planner"] == "fcost" and rows[0]["robots"] == 1
    rows = run_cases([*cases, *small], Limits(memory=20_000_000))
    assert [row["error"] for row in rows] == ["out of memory: needed more than 20000000 bytes", None]
    worker.close_workers()


class Death:
    """A part of a case that ends the process that reads it."""

    def __reduce__(self):
        return os._exit, (3,)


def test_a_process_that_dies_is_a_row_and_one_that_is_killed_is_no_loss(monkeypatch):
    monkeypatch.setattr(worker, "LIVES", 1)
    mine = Worker(Limits())
    (case,) = make_study(RUNS[:1]).trials
    row = mine.run({**case, "death": Death()})
    assert row["error"] == "its process ended 1 times (status 3)"
    assert (row["planner"], row["robots"]) == ("greedy", 5)
    monkeypatch.undo()
    whole = mine.run(case)
    os.kill(mine._child.pid, signal.SIGKILL)
    assert without_seconds([mine.run(case)]) == without_seconds([whole])
    mine.close()
    with pytest.raises(th.StudyError, match="stopped"):
        mine.run(case)


def test_workers_that_cannot_start_end_the_study(monkeypatch):
    monkeypatch.setattr(worker.sys, "executable", "/bin/false")
    with pytest.raises(th.StudyError, match=r"the workers end as soon as they start; false -m trihex\.studies\.child"):
        Worker(Limits()).run({**make_study(RUNS[:1]).trials[0]})


def test_the_planners_of_one_scenario_share_what_is_made_for_it(monkeypatch):
    from trihex.studies import case

    made = []
    monkeypatch.setattr(case, "make_n_scheme", lambda scenario: made.append(1) or th.make_n_scheme(scenario))
    study = make_study(RUNS[:4])
    case.warm_up("greedy"), case.warm_up("fcost")
    made.clear()
    case._kept.__dict__.clear()
    assert len(th.run_study(Study(study.trials, study.key))) == 4
    assert len(made) == 2
