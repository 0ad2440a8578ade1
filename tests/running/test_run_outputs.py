"""Whatever takes a plan takes a run: what happened is written, drawn and counted as a plan would be."""

import csv
import json
from dataclasses import replace

import numpy as np
import pandas
import pedpy
import pytest
from hypothesis import example, given, settings, strategies as st

import trihex as th
from tests.running.random_runs import random_trial
from trihex.areas import Frame
from trihex.kernels.codes import LATE, WAIT
from trihex.pictures import palette, picture_of_plan, picture_of_run
from trihex.plans import Plan, visits_of
from trihex.running import BROKEN, GOING
from trihex.viewer.show_run import show_run

FRAME = Frame(0.5, (3.0, -2.0), 0.3)


def framed(run, frame=FRAME):
    """Return the same run in an area in metres."""
    return replace(run, scenario=replace(run.scenario, area=replace(run.scenario.area, frame=frame)))


def random_run(seed, **limits):
    return framed(random_trial(seed, **limits).run(most_steps=60))


def rows_by_hand(run):
    """Return (robot, step, cell, action) for each robot and step in which it is there, walked cell by cell."""
    area, rows = run.scenario.area, []
    for robot in range(run.robots.size):
        y, x = divmod(int(run.robots[robot]), area.width)
        end = int(run.ended[robot]) if run.ended[robot] >= 0 else run.steps
        rows.append((robot, int(run.joined[robot]), y * area.width + x, "start"))
        for step in range(int(run.joined[robot]) + 1, end + 1):
            action = int(run.actions[step - 1, robot])
            word = {WAIT: "wait", LATE: "late"}.get(action)
            if word is None:
                side = int(area.tessellation.orientation_of_cell(x, y))
                dx, dy = area.tessellation.step_of_direction[side, action].tolist()
                x, y, word = x + dx, y + dy, area.tessellation.direction_names[side][action]
            rows.append((robot, step, y * area.width + x, word))
    return rows


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 10_000))
@example(seed=2765)  # nobody is there
def test_waypoints_and_tables_tell_what_happened(folder, seed):
    run = random_run(seed)
    expected, area = rows_by_hand(run), run.scenario.area
    th.write_waypoints(run, folder / "w.csv", speed=2.0)
    rows = list(csv.reader((folder / "w.csv").read_text().splitlines()))[1:]
    x, y = area.cell_to_metres(np.array([cell for _, _, cell, _ in expected], dtype=np.int64))
    lasts = area.tessellation.longest_move * 0.5 / 2.0
    assert [int(row[0]) for row in rows] == [robot for robot, *_ in expected]
    for row, (_, step, *_), px, py in zip(rows, expected, x.tolist(), y.tolist(), strict=True):
        assert [float(value) for value in row[1:4]] == pytest.approx([step * lasts, px, py], abs=2e-6)
    th.write_plan(run, folder / "p.csv")
    table = pandas.read_csv(folder / "p.csv")
    own = [(robot, step, cell % area.width, cell // area.width, word) for robot, step, cell, word in expected]
    assert list(table[["robot", "step", "x", "y", "action"]].itertuples(index=False, name=None)) == own
    spent = table.groupby("robot")["time"].last().to_numpy()
    stays = (run.state_of_robot == GOING) | (run.state_of_robot == BROKEN)
    np.testing.assert_array_equal(spent[~stays], run.time_of_robot[~stays])
    th.write_plan(run, folder / "p.parquet")
    same = pandas.read_parquet(folder / "p.parquet").astype({"action": object})
    pandas.testing.assert_frame_equal(same, table.astype(same.dtypes))  # of a run of nobody text knows no types


@pytest.mark.parametrize("seed", range(6))
def test_a_run_without_surprises_is_written_like_the_plan_that_it_is(tmp_path, seed):
    """The same motion told as a plan gives the same bytes in all formats, the same counts and the same arrivals."""
    scenario = framed(random_trial(seed).run(most_steps=0)).scenario
    run = th.Trial(scenario).run()
    mine = run.arrived
    actions = [run.actions[: run.ended[r] if mine[r] else 0, r].tolist() for r in range(mine.size)]
    first = np.cumsum([0, *map(len, actions)])
    plan = Plan(scenario, np.array([a for own in actions for a in own], dtype=np.uint8), first, run.planner)
    assert plan.steps == run.steps
    for suffix in ("csv", "yaml", "json", "geojson", *(("sqlite",) if mine.size else ())):
        for name, motion in (("plan", plan), ("run", run)):
            th.write_waypoints(motion, tmp_path / f"{name}.{suffix}", turn_time=0.25 * (seed % 2))
        assert (tmp_path / f"run.{suffix}").read_bytes() == (tmp_path / f"plan.{suffix}").read_bytes()
    np.testing.assert_array_equal(visits_of(run), visits_of(plan))
    assert th.make_arrivals(run) == th.make_arrivals(plan)
    np.testing.assert_array_equal(run.last_cell_of_robot, plan.last_cell_of_robot)


def test_robots_turn_while_all_stand(tmp_path):
    """With a turn time each step has two rows: it ends, heading as it came; all have turned, the next begins."""
    run = random_run(3)
    th.write_waypoints(run, tmp_path / "slow.csv", turn_time=0.5)
    th.write_waypoints(run, tmp_path / "fast.csv")
    slow, fast = (np.loadtxt(tmp_path / name, delimiter=",", skiprows=1) for name in ("slow.csv", "fast.csv"))
    move = run.scenario.area.tessellation.longest_move * 0.5
    for robot in range(run.robots.size):
        mine, other = slow[slow[:, 0] == robot], fast[fast[:, 0] == robot]
        steps = np.rint(other[:, 1] / move)
        np.testing.assert_allclose(mine[::2, 1], steps * (move + 0.5), atol=1e-5)
        np.testing.assert_allclose(mine[1::2, 1], steps[:-1] * (move + 0.5) + 0.5, atol=1e-5)
        np.testing.assert_allclose(mine[::2, 2:4], other[:, 2:4], atol=1e-5)
        np.testing.assert_allclose(mine[1::2, 2:4], other[:-1, 2:4], atol=1e-5)
        np.testing.assert_allclose(mine[1::2, 4], other[:-1, 4], atol=1e-5)  # turned to where they will go
        np.testing.assert_allclose(mine[2:-1:2, 4], other[:-2, 4], atol=1e-5)  # and before, as they came


def test_pedpy_reads_a_run(tmp_path):
    run = random_run(17)
    th.write_waypoints(run, tmp_path / "t.sqlite", turn_time=0.5)
    data = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite").data
    expected = rows_by_hand(run)
    assert sorted(zip(data["id"], data["frame"], strict=True)) == sorted((robot, step) for robot, step, *_ in expected)


def test_nav_paths_name_their_frame(tmp_path):
    th.write_waypoints(random_run(5), tmp_path / "p.json", frame_id="depot/map")
    message = json.loads((tmp_path / "p.json").read_text())[0]
    names = {message["header"]["frame_id"], *(pose["header"]["frame_id"] for pose in message["poses"])}
    assert names == {"depot/map"}
    th.write_waypoints(random_run(5), tmp_path / "p.yaml", frame_id="no")
    assert 'frame_id: "no"' in (tmp_path / "p.yaml").read_text()
    with pytest.raises(th.FormatError, match="frame_id must be a name in one line, not ''"):
        th.write_waypoints(random_run(5), tmp_path / "p.json", frame_id="")
    with pytest.raises(th.FormatError, match="turn_time must be a number from 0"):
        th.write_waypoints(random_run(5), tmp_path / "p.json", turn_time=-1)


def test_squares_for_mapf_visualizer_stay_where_they_were(tmp_path):
    seed = next(seed for seed in range(100) if random_run(seed).scenario.area.tessellation.name == "square")
    run = random_run(seed)
    th.write_plan(run, tmp_path / "p.txt")
    lines = (tmp_path / "p.txt").read_text().splitlines()
    assert len(lines) == run.steps + 1
    for step, (line, cells) in enumerate(zip(lines, run.cells_by_step(), strict=True)):
        assert line.startswith(f"{step}:") and line.count("(") == run.robots.size
        places = [tuple(map(int, place.strip("(").split(","))) for place in line.split(":")[1].split("),")[:-1]]
        for (x, y), cell in zip(places, cells.tolist(), strict=True):
            assert cell < 0 or y * run.scenario.area.width + x == cell


def test_a_run_as_npz_is_a_run(tmp_path):
    run = random_run(8)
    th.write_plan(run, tmp_path / "a.npz")
    th.write_run(run, tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def a_run_with_changes():
    """Return a run on squares in which a wall comes, another goes, a destination opens and one closes."""
    area = th.Area("square", np.pad(np.zeros((3, 8)), 1, constant_values=1), frame=FRAME)
    scenario = th.Scenario(area, [(8, 2)], [(1, 1), (1, 2), (1, 3)])
    events = [
        th.Event(2, "barrier", (4, 2)),
        th.Event(3, "open", (7, 1)),
        th.Event(4, "clear", (5, 0)),
        th.Event(5, "close", (8, 2)),
        th.Event(6, "join", (1, 2)),
        th.Event(7, "late", robot=1, steps=1),
    ]
    return th.Trial(scenario, events=events).run()


def colours_of(picture, area):
    """Return the colour in the south-east of each cell, where no robot and no letter hides it."""
    side = picture.scene.scale
    image = picture.to_array()
    y, x = np.mgrid[: area.height, : area.width]
    return image[((y + 0.85) * side).astype(int), ((x + 0.85) * side).astype(int)]


def test_pictures_show_the_world_as_it_was_in_each_step():
    run = a_run_with_changes()
    area, worlds = run.scenario.area, [(run.scenario.area.barriers, run.scenario.destinations), *run.worlds()]
    for step, (barriers, destinations) in enumerate(worlds):
        colours = colours_of(picture_of_run(run, step=step, title="", legend=False, width=400), area)
        is_barrier = (colours == palette.BARRIER).all(axis=-1)
        is_destination = np.flatnonzero((colours == palette.DESTINATION).all(axis=-1))
        np.testing.assert_array_equal(is_barrier, barriers)
        np.testing.assert_array_equal(is_destination, np.sort(destinations))
    colours = colours_of(picture_of_plan(run, title="", legend=False, width=400, paths=False), area)
    np.testing.assert_array_equal((colours == palette.BARRIER).all(axis=-1), worlds[-1][0])
    assert np.flatnonzero((colours == palette.DESTINATION).all(axis=-1)).tolist() == worlds[-1][1].tolist()
    with pytest.raises(th.ExecutionError, match=rf"step must be a whole number from 0 to {run.steps}, not -1"):
        picture_of_run(run, step=-1)


def test_a_run_that_ends_without_destinations_is_drawn():
    area = th.Area("triangular", np.zeros((4, 6)))
    run = th.Trial(th.Scenario(area, [(5, 3)], [(0, 0)]), events=[th.Event(2, "close", (5, 3))]).run()
    assert run.last_world[1].size == 0
    assert "0 of 1 robots arrive" in picture_of_plan(run).scene.subtitle
    picture_of_run(run).to_array()


def test_movies_and_curves_of_runs(tmp_path):
    run = a_run_with_changes()
    th.write_animation(run, tmp_path / "a.gif")
    th.write_run_animation(run, tmp_path / "b.gif")
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
    th.write_animation(run, tmp_path / "c.gif", clock=False, legend=False, title="")
    assert (tmp_path / "c.gif").stat().st_size < (tmp_path / "a.gif").stat().st_size
    ax = th.draw_arrivals([run], speed=0.25)
    (line,) = ax.lines
    lasts = 2**0.5 * 0.5 / 0.25
    arrivals = np.sort(run.ended[run.arrived])
    np.testing.assert_allclose(line.get_xdata(), lasts * np.array([0, *arrivals, run.steps]))
    assert ax.get_xlabel() == "seconds"
    without = replace(run.scenario, area=replace(run.scenario.area, frame=None), destination_capacity=None)
    assert th.draw_arrivals([run, replace(run, scenario=without)]).get_xlabel() == "step"
    assert th.draw_plan(run).get_title().startswith("Run (fcost)")


def test_what_a_page_is_told_of_a_run():
    """Worlds change in the steps in which they did, and the actions of each robot follow those of the one before."""
    run = a_run_with_changes()
    header, arrays = show_run(th.make_run_report(run))
    assert [one["step"] for one in header["worlds"]] == [2, 3, 4, 5]
    first, rows = arrays["first_action"], rows_by_hand(run)
    for robot in range(run.robots.size):
        own = arrays["actions"][first[robot] : first[robot + 1]].tolist()
        steps = [step for r, step, *_ in rows if r == robot][1:]
        assert own == [int(run.actions[step - 1, robot]) for step in steps]
        assert arrays["joined"][robot] == run.joined[robot]
    assert arrays["spent_by_step"][-1] == run.total_time
    assert arrays["arrived_by_step"].tolist() == [
        int(np.sum(run.arrived & (run.ended <= s))) for s in range(run.steps + 1)
    ]
