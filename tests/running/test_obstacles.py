"""Obstacles in metres: told to an execution, and in events."""

import numpy as np
import pytest
import shapely

import trihex as th
from trihex.areas import Covering, cover_polygons
from trihex.running import Event, Execution, Trial, audit_run

HALL, RADIUS = shapely.box(0, 0, 12, 8), 0.12
AREA = cover_polygons(HALL, Covering("hexagonal", 0.5, RADIUS))
BOX = [(5, 2), (7, 2), (7, 6), (5, 6)]


def scenario(count=20, goal=(11, 4), seed=1):
    goal = int(AREA.metres_to_cell(*goal))
    west = np.flatnonzero(AREA.cell_to_metres(np.arange(AREA.cell_count))[0] > 4)
    return th.Scenario(AREA, [goal], th.random_robots(AREA, count, seed, avoid=np.append(west, goal)))


def nearest(execution, before, after, shape):
    """Return how near robots come to a shape in a step."""
    moved = np.flatnonzero((before >= 0) & (after >= 0))
    lines = np.stack([np.stack(AREA.cell_to_metres(cells[moved]), axis=-1) for cells in (before, after)], axis=1)
    return shapely.distance(shape, shapely.linestrings(lines)).min(initial=9)


@pytest.mark.parametrize("planner", ["fcost", "greedy"])
def test_robots_keep_clear_of_an_obstacle_that_comes_and_use_its_place_when_it_is_gone(planner):
    execution, shape = Execution(scenario(), planner), shapely.Polygon(BOX)
    execution.observe(obstacles=[BOX])
    assert np.array_equal(
        np.flatnonzero(execution.field.barriers & ~AREA.barriers),
        np.setdiff1d(AREA.cells_touched(BOX), np.flatnonzero(AREA.barriers)),
    )
    while not execution.is_over:
        before = execution.cell_of_robot
        assert nearest(execution, before, execution.step().cell_of_robot, shape) > RADIUS
    assert (execution.state_of_robot == 1).all()
    execution.observe(gone=[shape])
    assert np.array_equal(execution.field.barriers, AREA.barriers)


def test_what_other_obstacles_and_the_map_block_stays_blocked():
    execution = Execution(scenario())
    wall, other = [(5, -1), (7, -1), (7, 1), (5, 1)], [(6, 0.5), (6, 3)]  # one stands on the border of the hall
    execution.observe(obstacles=[wall, other])
    execution.observe(gone=[wall])
    blocked = AREA.barriers.copy()
    blocked.reshape(-1)[AREA.cells_touched(other)] = True
    assert np.array_equal(execution.field.barriers, blocked)
    state = execution.state()
    execution.observe(gone=[other], blocked=[(20, 8)])
    again = Execution(scenario())
    again.restore(state)
    again.observe(gone=[other])
    assert np.array_equal(again.field.barriers, AREA.barriers)
    spot = int(AREA.xy_to_cell(20, 8))
    point = np.array(AREA.cell_to_metres(spot)) + 0.01
    execution.observe(obstacles=[point])
    execution.observe(gone=[point])
    assert execution.field.barriers[8, 20]  # of which it was told as a cell


def test_robots_that_an_obstacle_comes_upon_are_told_and_the_rest_is_blocked():
    start = scenario()
    execution = Execution(start)
    x, y = (float(metres) for metres in AREA.cell_to_metres(start.robots[3]))
    shape = shapely.box(x - 0.6, y - 0.6, x + 0.6, y + 0.6)
    execution.observe(obstacles=[shape])
    touched = set(AREA.cells_touched(shape).tolist())
    inside = [robot for robot, cell in enumerate(start.robots.tolist()) if cell in touched]
    assert execution.obstructed_robots.tolist() == inside and 3 in inside
    barred = set(np.flatnonzero(execution.field.barriers).tolist())
    assert touched - barred == {int(start.robots[robot]) for robot in inside}


def test_an_obstacle_on_a_destination_closes_it():
    execution = Execution(scenario())
    execution.observe(obstacles=[(11, 4)])
    assert execution.field.destinations == set() and execution.is_over


def test_events_in_metres_are_as_those_in_cells(tmp_path):
    events = [
        Event(1, "barrier", metres=BOX),
        Event(3, "open", metres=(11, 1)),
        Event(4, "join", metres=(3, 7)),
        Event(6, "move", metres=(11, 1), to_metres=(11, 6.5)),
        Event(9, "clear", metres=BOX),
        Event(9, "clear", metres=BOX),
        Event(9, "close", metres=(50, 1)),
        Event(9, "barrier", metres=[(0, 0), (2, 2), (2, 0), (0, 2)]),
    ]
    run = Trial(scenario(), events=events).run()
    assert audit_run(run).is_clean and run.arrived.all()
    refusals = [one.refusal for one in run.occurrences]
    assert refusals[:5] == [""] * 5 and refusals[5] == "no cell of (5, 2) metres and 3 more points is a barrier"
    assert refusals[6].startswith("point (50, 1) metres lies outside the area") and "is invalid" in refusals[7]
    box = set(AREA.cells_touched(BOX).tolist()) - set(np.flatnonzero(AREA.barriers).tolist())
    assert set(run.occurrences[0].blocked) == set(run.occurrences[4].freed) == box
    assert run.occurrences[3].opened == (int(AREA.metres_to_cell(11, 6.5)),)
    assert str(run.occurrences[3].event) == "step 6: destination moves from (11, 1) metres to (11, 6.5) metres"
    th.write_run(run, tmp_path / "run.npz")
    assert th.read_run(tmp_path / "run.npz") == run
    th.write_events(tuple(events), tmp_path / "events.csv")
    assert th.read_events(tmp_path / "events.csv") == tuple(events)
    (tmp_path / "e.toml").write_text(
        '[[event]]\nstep = 1\nevent = "barrier"\nmetres = [[5, 2], [7, 2], [7, 6], [5, 6]]\n'
        '[[event]]\nstep = 6\nevent = "move"\nmetres = [11, 1]\nto_metres = [11, 6.5]\n'
    )
    assert th.read_events(tmp_path / "e.toml") == (events[0], events[3])


def test_a_run_with_an_obstacle_on_robots_names_them_in_metres(tmp_path):
    from click.testing import CliRunner

    from trihex.cli import main

    th.write_scenario(scenario(), tmp_path / "s.toml")
    cell = int(scenario().robots[0])
    x, y = (float(metres) for metres in AREA.cell_to_metres(cell))
    (tmp_path / "e.csv").write_text(f"step,event,metres\n1,barrier,{x} {y}\n2,clear,{x} {y}\n")
    result = CliRunner().invoke(main, ["run", str(tmp_path / "s.toml"), "--events", str(tmp_path / "e.csv")])
    assert result.exit_code == 1
    assert f"it stays free where a robot stands: {AREA.place_of_cell(cell)}" in result.stderr


@pytest.mark.parametrize(
    ("details", "why"),
    [
        (dict(kind="join", metres=[(1, 1), (2, 2)]), "metres of event 'join' must be one point, not 2"),
        (
            dict(kind="barrier", metres=(1, 2), cell=(1, 2)),
            r"takes cell or zone \(or metres\), not cell=\(1, 2\) and metres=",
        ),
        (dict(kind="move", metres=(1, 2)), r"takes cell and to \(or metres\), not to=None"),
        (dict(kind="barrier", metres="here"), "metres of an event must be a point"),
        (dict(kind="barrier", metres=(1, float("inf"))), "metres of an event must be a point"),
    ],
)
def test_events_in_metres_that_make_no_sense(details, why):
    with pytest.raises(th.ScenarioError, match=why):
        Event(1, **details)


def test_wrong_metres_in_csv_are_told_with_their_line(tmp_path):
    (tmp_path / "e.csv").write_text("step,event,metres\n1,barrier,3.2\n")
    with pytest.raises(
        th.FormatError, match=r"line 2: metres must be X Y in metres, or several as X Y; X Y, not '3.2'"
    ):
        th.read_events(tmp_path / "e.csv")
