"""Maps and exits: where time is lost, where robots crowd, who leaves where; beside an oracle that walks each robot."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import example, given, settings, strategies as st

import trihex as th
from tests.running.random_runs import random_trial
from tests.strategies import random_scenario
from trihex.areas import Frame
from trihex.cli import main
from trihex.kernels.codes import LATE, WAIT
from trihex.pictures import palette


def by_hand(motion):
    """Return steps waited and steps spent in each cell, and arrivals (step, cell), robot by robot."""
    area = motion.scenario.area
    waited, spent = np.zeros((2, area.cell_count), dtype=int)
    arrivals, cells = [], list(motion.cells_by_step())
    for robot in range(motion.robots.size):
        for step in range(motion.steps + 1):
            cell = cells[step][robot]
            if cell >= 0:
                spent[cell] += 1
            stands = step < motion.steps and motion.actions_in(step + 1)[robot] in (WAIT, LATE)
            starts = robot >= motion.scenario.robot_count or step >= motion.scenario.start_times[robot]
            if cell >= 0 and stands and starts and motion.ended[robot] > step:
                waited[cell] += 1
        if motion.arrived[robot]:
            arrivals.append((int(motion.ended[robot]), int(motion.last_cell_of_robot[robot])))
    return waited.reshape(area.height, area.width), spent.reshape(area.height, area.width), arrivals


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 10_000), is_run=st.booleans())
@example(seed=923, is_run=True)  # robots stand where a destination opens, and is blocked by the next event of the step
def test_maps_and_exits_are_those_of_each_robot(seed, is_run):
    motion = random_trial(seed).run(most_steps=50) if is_run else th.make_plan(random_scenario(seed), "greedy")
    waited, spent, arrivals = by_hand(motion)
    np.testing.assert_array_equal(th.make_waiting_map(motion), waited)
    gone = motion.ended >= 0
    gone &= ~motion.arrived  # who leaves or breaks down counts in its last step, too
    np.add.at(spent.reshape(-1), motion.last_cell_of_robot[gone], 1)
    area = motion.scenario.area
    unit = 1.0 if area.frame is None else area.tessellation.area_of_cell * area.frame.cell_size**2
    np.testing.assert_allclose(th.make_density_map(motion) * max(motion.steps, 1) * unit, spent)
    exits = th.make_exits(motion)
    for step in range(motion.steps + 1):
        for cells, own in zip(exits.cells, exits.arrived, strict=True):
            assert own[step] == sum(when <= step and cell in cells for when, cell in arrivals)
    assert exits.total[-1] == len(arrivals)


def test_density_in_metres_is_of_a_square_metre():
    """One robot waits for 1 of 2 steps in a cell of 0.25 square metres, is then in the next, and leaves."""
    area = th.Area("square", [[0, 0, 0]], frame=Frame(0.5))
    plan = th.make_plan(th.Scenario(area, [(2, 0)], [(0, 0)]))
    np.testing.assert_allclose(th.make_density_map(plan), [[2.0, 2.0, 0.0]])
    for name, size in (("hexagonal", 3**0.5 / 2), ("triangular", 3 * 3**0.5 / 4), ("square", 1.0)):
        corners = th.Tessellation(name).polygon_of_cell(np.array([2]), np.array([2]))[0]
        x, y = corners.T
        drawn = abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2
        assert drawn == pytest.approx(size) == pytest.approx(th.Tessellation(name).area_of_cell)


def test_destinations_that_touch_are_one_exit():
    area = th.Area("square", np.zeros((3, 6)))
    plan = th.make_plan(th.Scenario(area, [(0, 0), (0, 1), (5, 2)], [(2, 0), (2, 1), (4, 2)]))
    exits = th.make_exits(plan)
    assert exits.names == ("(0, 0)", "(5, 2)") and exits.arrived.tolist() == [[0, 0, 2], [0, 1, 1]]
    ax = th.draw_exits(plan, th.make_earliest_arrivals(plan.scenario))
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["least possible", "all exits", "(0, 0)", "(5, 2)"]
    assert [line.get_ydata().tolist() for line in ax.lines] == [[0, 1, 3], [0, 1, 3], [0, 0, 2], [0, 1, 1]]


def test_pictures_of_maps_shade_what_is_not_nought():
    area = th.Area("square", np.zeros((1, 6)), frame=Frame(1.0))
    scenario = th.Scenario(area, [(5, 0)], [(3, 0), (4, 0), (2, 0)])
    run = th.Trial(scenario, events=[th.Event(1, "late", robot=0, steps=3)]).run()
    image = th.picture_of_waiting(run, title="", legend=False, width=240).to_array()
    assert th.make_waiting_map(run).tolist() == [[0, 0, 3, 3, 0, 0]]
    free = (image[5, 20::40] == palette.FREE).all(axis=-1)
    assert free.tolist() == [True, True, False, False, True, False]
    told = th.picture_of_waiting(run, speed=2**0.5).scene
    assert told.subtitle.endswith("6 seconds in all") and told.legend[0].words == "seconds lost"
    cells = replace(run, scenario=replace(scenario, area=replace(area, frame=None)))
    assert th.picture_of_waiting(cells).scene.legend[0].words == "steps lost"
    assert th.picture_of_density(run).scene.legend[0].words == "robots a square metre"


def test_exits_with_a_name_are_counted_by_it(tmp_path):
    """Two doors of one zone are one exit; a zone beside another is its own; the rest is told by its cell."""
    zones = (th.Zone("north", [0, 6]), th.Zone("arrived", [1]), th.Zone("hall", [10]))
    area = th.Area("square", np.zeros((3, 7), dtype=bool), zones=zones)
    destinations = [(0, 0), (6, 0), (1, 0), (3, 2)]
    scenario = th.Scenario(area, destinations, [(0, 1), (6, 1), (1, 1), (3, 1)])
    plan = th.make_plan(scenario, "greedy")
    exits = th.make_exits(plan)
    assert exits.names == ("north", "arrived", "(3, 2)")
    assert [own.tolist() for own in exits.cells] == [[0, 6], [1], [17]]
    assert exits.arrived[:, -1].tolist() == [2, 1, 1]
    labels = [line.get_label() for line in th.draw_exits(plan).lines]
    assert labels == ["all exits", "north", "arrived", "(3, 2)"]
    th.write_scenario(scenario, tmp_path / "s.toml")
    command = ["plan", str(tmp_path / "s.toml"), "--planner", "greedy", "--arrivals", str(tmp_path / "n.csv")]
    assert CliRunner().invoke(main, command).exit_code == 0
    rows = list(csv.DictReader((tmp_path / "n.csv").read_text().splitlines()))
    assert [rows[-1][name] for name in ("arrived", "north", "exit arrived", "(3, 2)")] == ["4", "2", "1", "1"]


def test_what_is_waited_until_the_start_time_is_no_loss():
    scenario = th.Scenario(th.Area("square", [[0, 0, 0, 0]]), [(3, 0)], [(0, 0), (1, 0)], start_times=[1, 4])
    for motion in (th.make_plan(scenario), th.Trial(scenario).run()):
        assert th.make_waiting_map(motion).tolist() == [[3, 0, 0, 0]]
        assert th.make_waiting_map(motion, before_start=True).tolist() == [[1, 4, 0, 0]]
