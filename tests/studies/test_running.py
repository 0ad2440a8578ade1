"""Studies of robots that are late or have no map: a row says what the run of `trihex run` does."""

import json

import numpy as np
import pytest

import trihex as th
from trihex.running import Trial, make_passing_order

AREA = {"generator": "rooms", "size": [30, 24], "room": 5}
STUDY = """
seeds = 2
robots = [20, {count = 5, placement = "far"}]
bound = false
planners = ["greedy", {name = "fcost", run = {}}, {name = "fcost", run = {sense = [0, 2.5], delays = [0, 0.2]}},
            {name = "fcost", run = {in_order = true, delays = 0.2}},
            {name = "greedy", run = {sense = 2, line_of_sight = true, replan = true}}]
[[areas]]
generator = "rooms"
size = [30, 24]
room = 5
"""


def scenario_of(row):
    area = th.make_rooms_area("hexagonal", 24, 30, room=5, seed=row["seed"])
    away = np.hypot(*(np.array(area.tessellation.centre_of_cell(*area.cell_to_xy(np.arange(720)))).T - centre(area)).T)
    end = min(np.flatnonzero(~area.barriers), key=lambda cell: (away[cell], cell))
    empty = th.Scenario(area, [int(end)])
    distance = th.make_n_scheme(empty).distance.reshape(-1)
    if row["placement"] == "far":
        cells = sorted(np.flatnonzero(distance < 2**31 - 1), key=lambda cell: (-distance[cell], cell))[:5]
        return empty.with_robots(np.array(cells), row["seed"])
    avoid = np.append(np.flatnonzero(distance == 2**31 - 1), end)
    return empty.with_robots(th.random_robots(area, 20, row["seed"], avoid=avoid), row["seed"])


def centre(area):
    return np.array(area.tessellation.extent(area.height, area.width)) / 2


def test_rows_are_those_of_the_runs(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    rows = list(th.run_study(tmp_path / "study.toml"))
    assert len(rows) == 2 * 2 * 8 and not any(row["error"] for row in rows)
    told = [json.loads(row["planner_options"]) for row in rows[:8]]
    assert told[0] == {} and told[1] == {"run": {}} and told[6] == {"run": {"delays": 0.2, "in_order": True}}
    for row in rows:
        scenario, options = scenario_of(row), json.loads(row["planner_options"])
        assert (row["conflicts"], row["arrived"]) == (0, row["robots"])
        if "run" not in options:
            assert row["total_time"] == th.make_plan(scenario, "greedy").total_time
            continue
        wanted = options["run"]
        delay, sense = wanted.get("delays", 0), wanted.get("sense")
        if wanted.get("in_order"):
            run = make_passing_order(th.make_plan(scenario)).run(delay=delay, seed=row["seed"])
        else:
            sensor = None if sense is None else th.Sensor(scenario.area.tessellation, sense, "line_of_sight" in wanted)
            more = {"sensor": sensor, "delay": delay, "seed": row["seed"], "replan": "replan" in wanted}
            run = Trial(scenario, row["planner"], **more).run()
        assert (row["total_time"], row["steps"], row["total_waiting"]) == (
            run.total_time,
            run.steps,
            run.waiting_of_robot.sum(),
        )
    assert len({row["total_time"] for row in rows}) > 20


@pytest.mark.parametrize(
    ("run", "words"),
    [
        ({"sense": -1}, "run.sense: must be greater than or equal to 0, not -1"),
        ({"delays": 1}, "run.delays: must be less than 1, not 1"),
        ({"in_order": True, "sense": 2}, "in_order) neither sense nor replan"),
        ({"line_of_sight": True}, "add sense"),
        ({"speed": 1}, "run.speed: "),
    ],
)
def test_mistakes_are_told_before_anything_runs(run, words):
    with pytest.raises(th.StudyError) as error:
        th.run_study([{"area": AREA, "robots": 3, "planner": {"name": "fcost", "run": run}}])
    assert words in str(error.value)


def test_options_that_only_plans_take_are_refused():
    planner = {"name": "fcost", "options": {"rule": "queue"}, "run": {}}
    with pytest.raises(th.StudyError, match="take the options aside, budget, not rule"):
        th.run_study([{"area": AREA, "robots": 3, "planner": planner}])
    planner["options"] = {"aside": "never"}
    assert next(iter(th.run_study([{"area": AREA, "robots": 3, "planner": planner}])))["arrived"] == 3


def test_more_robots_than_far_cells_are_a_row_with_an_error():
    run = {"area": AREA, "robots": {"count": 10**6, "placement": "far"}}
    row = next(iter(th.run_study([run])))
    assert row["error"].startswith("robots must be at most the number of cells that reach a destination")
