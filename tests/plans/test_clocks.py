"""Plans of all clocks and rules, written, drawn and counted: beside an oracle that follows each robot tick by tick."""

import csv
from itertools import pairwise, product

import numpy as np
import pandas
import pedpy
import pytest

import trihex as th
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_slowness
from trihex.areas import Frame, seconds_per_step
from trihex.errors import FormatError, PlanError
from trihex.kernels.codes import WAIT
from trihex.plans import rows_of_motion, visits_of
from trihex.viewer import write_page

RULES = list(product(("steps", "costs"), ("allow", "forbid")))
CROWD = th.Scenario(th.Area("square", np.zeros((4, 6)), frame=Frame(0.5)), [(5, 1)], [0, 1, 2, 7, 8, 19], clock="costs")


def plans(seed):
    """Yield plans of one random scenario by all rules."""
    scenario = random_scenario(seed, sides=(3, 7), most_robots=8)
    for clock, following in RULES:
        timed = with_time(scenario, clock, following)
        if seed % 3 < 2 and seed % 4 == 1:
            timed = with_slowness(timed, seed)
        yield th.make_plan(timed, ("greedy", "fcost", "astar")[seed % 3])


def by_hand(plan):
    """Return ticks waited and ticks spent in each cell, in a robot's cell until its move ends."""
    waited, spent = np.zeros((2, plan.scenario.area.cell_count), dtype=int)
    durations = plan.scenario.duration_of_direction.tolist()
    for robot, arrives in enumerate(plan.arrived.tolist()):
        first, last = plan.first_action[robot : robot + 2].tolist()
        cells, tick = plan.cells_of_robot(robot).tolist(), 0
        for cell, action in zip(cells, plan.actions[first:last].tolist(), strict=False):
            lasts = 1 if action == WAIT else durations[action] * int(plan.scenario.slowness[robot])
            waited[cell] += arrives * (action == WAIT)
            spent[cell] += lasts
            tick += lasts
        spent[cells[-1]] += 0 if arrives else plan.steps - tick + 1  # as a run counts the last step of who stays
    return waited, spent


@pytest.mark.parametrize("seed", range(12))
def test_maps_count_ticks(seed):
    for plan in plans(seed):
        area, (waited, spent) = plan.scenario.area, by_hand(plan)
        unit = 1.0 if area.frame is None else area.tessellation.area_of_cell * area.frame.cell_size**2
        np.testing.assert_array_equal(th.make_waiting_map(plan).ravel(), waited)
        np.testing.assert_allclose(th.make_density_map(plan).ravel() * max(plan.steps, 1) * unit, spent)
        assert visits_of(plan).sum() == plan.scenario.robot_count + np.sum(plan.actions != WAIT)


@pytest.mark.parametrize("seed", range(12))
def test_rows_are_where_actions_end(seed):
    for plan in plans(seed):
        first_row, step, cell = rows_of_motion(plan)
        for robot in range(plan.scenario.robot_count):
            own = slice(*first_row[robot : robot + 2].tolist())
            ticks, cells = plan.ticks_of_robot(robot), plan.cells_of_robot(robot)
            if plan.has_steps and not plan.arrived[robot]:
                ticks, cells = np.arange(plan.steps + 1), np.append(cells, [cells[-1]] * (plan.steps - cells.size + 1))
            elif not plan.arrived[robot] and ticks[-1] < plan.steps:
                ticks, cells = np.append(ticks, plan.steps), np.append(cells, cells[-1])
            np.testing.assert_array_equal(step[own], ticks)
            np.testing.assert_array_equal(cell[own], cells)
        for tick in range(1, plan.steps + 1):
            for robot, action in enumerate(plan.actions_in(tick).tolist()):
                own = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]]
                index = np.searchsorted(plan.ticks_of_robot(robot), tick) - 1
                assert action == (own[index] if index < own.size else WAIT)


@pytest.mark.parametrize("seed", range(24))
def test_no_plan_has_more_arrivals_than_the_bound(seed):
    for plan in plans(seed):
        earliest, exits = th.make_earliest_arrivals(plan.scenario), th.make_exits(plan)
        is_exact = plan.scenario.is_stepwise or not plan.scenario.robot_count
        assert earliest.name == ("optimum" if is_exact else "distance" if plan.scenario.has_slowness else "cut")
        assert earliest.steps.size == exits.total[-1] == np.sum(plan.arrived)
        assert (exits.total <= earliest.curve(plan.steps)).all()


def test_a_door_is_passed_a_headway_apart():
    """Two cells from the exit stands a door of one cell; robots pass it 5 ticks apart, or 10 where nobody follows."""
    rows = ["....#...", "........", "....#..."]
    area = th.Area("square", [[letter == "#" for letter in row] for row in rows])
    scenario = th.Scenario(area, [(6, 1)], [(3, 1), (2, 1), (1, 1)], clock="costs", following="allow")
    assert th.make_earliest_arrivals(scenario).steps.tolist() == [15, 20, 25]
    scenario = th.Scenario(area, [(6, 1)], [(3, 1), (2, 1), (1, 1)], clock="costs", following="forbid")
    assert th.make_earliest_arrivals(scenario).steps.tolist() == [15, 25, 35]


def test_tables_waypoints_and_trajectories_agree(tmp_path):
    plan = th.make_plan(CROWD)
    assert plan.steps > 20 and (plan.actions == WAIT).any() and (CROWD.duration_of_direction > 1).all()
    for name in ("p.csv", "p.parquet", "w.csv", "w.yaml", "t.sqlite"):
        (th.write_plan if name.startswith("p") else th.write_waypoints)(plan, tmp_path / name)
    table = pandas.read_csv(tmp_path / "p.csv")
    assert table.equals(pandas.read_parquet(tmp_path / "p.parquet").astype({"action": table["action"].dtype}))
    tick = seconds_per_step(CROWD.area)
    assert tick == pytest.approx(0.5 * CROWD.area.tessellation.longest_tick)
    way = pandas.read_csv(tmp_path / "w.csv")
    fps = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite")
    assert fps.frame_rate == pytest.approx(1 / tick)
    for robot, rows in table.groupby("robot"):
        is_wait = rows["action"] == "wait"
        kept = rows[~is_wait | ~is_wait.shift(-1, fill_value=False)]
        own = way[way["robot"] == robot]
        np.testing.assert_allclose(own.iloc[:, 1], kept["step"] * tick, atol=1e-6)
        for (_, one), (_, other) in pairwise(own.iterrows()):
            assert np.hypot(*(other.iloc[2:4] - one.iloc[2:4])) <= (other.iloc[1] - one.iloc[1]) * 1.0001 + 1e-5
        frames = fps.data[fps.data["id"] == robot]["frame"]
        assert frames.tolist() == list(range(int(rows["step"].max()) + 1))


def test_turning_takes_time_only_where_all_stand_at_once(tmp_path):
    message = "turn_time must be 0 where clock is 'costs' and moves last several ticks"
    for call in (
        lambda: th.write_waypoints(th.make_plan(CROWD), tmp_path / "w.csv", turn_time=0.5),
        lambda: th.make_report(th.make_plan(CROWD), turn_time=0.5),
    ):
        with pytest.raises(FormatError, match=message):
            call()
    area = th.Area("hexagonal", np.zeros((4, 6)), frame=Frame(0.5))
    plan = th.make_plan(th.Scenario(area, [(5, 1)], [0, 1, 2, 7, 8, 19], clock="costs"))
    th.write_waypoints(plan, tmp_path / "w.csv", turn_time=0.5)
    rows = np.loadtxt(tmp_path / "w.csv", delimiter=",", skiprows=1)
    for robot in range(6):
        own, ticks = rows[rows[:, 0] == robot], plan.ticks_of_robot(robot)
        assert own[-1, 1] == pytest.approx(ticks[-1] * 1.0) and own[1, 1] == 0.5
        moves = np.hypot(*np.diff(own[:, 2:4], axis=0).T) > 1e-6
        np.testing.assert_allclose(np.diff(own[:, 1])[moves], 0.5, atol=1e-6)  # half a metre in half a second


def test_what_cannot_be_straightened_by_these_rules_is_told():
    for clock, following in RULES[1:]:
        plan = th.make_plan(with_time(CROWD, clock, following))
        with pytest.raises(PlanError, match=f"not clock {clock!r} and following {following!r}"):
            th.straighten(plan)


def test_reports_pictures_movies_and_pages_tell_ticks(tmp_path):
    plan = th.make_plan(CROWD)
    numbers = th.make_report(plan, speed=2.0).as_dict()
    assert numbers["last_arrival_seconds"] == pytest.approx(plan.steps * numbers["step_seconds"])
    assert numbers["step_seconds"] == pytest.approx(0.25 * CROWD.area.tessellation.longest_tick)
    assert numbers["turning"] > 0
    th.write_animation(plan, tmp_path / "m.gif", max_frames=12)
    write_page(plan, tmp_path / "p.html")
    assert (tmp_path / "m.gif").stat().st_size > 0 and (tmp_path / "p.html").stat().st_size > 0
    seconds = plan.steps * seconds_per_step(CROWD.area)
    assert th.draw_exits(plan, th.make_earliest_arrivals(CROWD)).lines[0].get_xdata()[-1] == pytest.approx(seconds)
    bare = th.make_plan(th.Scenario(th.Area("square", np.zeros((4, 6))), [(5, 1)], CROWD.robots, clock="costs"))
    assert th.draw_exits(bare).get_xlabel() == th.draw_arrivals(bare).get_xlabel() == "tick"
    assert th.draw_exits(bare).lines[0].get_xdata()[-1] == bare.steps
    assert th.picture_of_waiting(bare).scene.legend[0].words == "ticks lost"
    assert th.picture_of_density(bare).scene.subtitle.endswith(f"mean over {bare.steps} ticks")


def test_arrivals_in_the_file_of_exits_are_in_ticks(tmp_path):
    from trihex.cli.maps import Maps, write_maps

    plan = th.make_plan(CROWD)
    write_maps(plan, Maps(tmp_path / "w.npy", tmp_path / "d.npy", tmp_path / "e.csv"), {})
    assert np.load(tmp_path / "w.npy").sum() == np.sum(plan.actions == WAIT)
    rows = list(csv.DictReader((tmp_path / "e.csv").read_text().splitlines()))
    assert len(rows) == plan.steps + 1 and rows[-1]["arrived"] == "6"
    assert float(rows[-1]["seconds"]) == pytest.approx(plan.steps * seconds_per_step(CROWD.area))
    assert all(int(row["arrived"]) <= int(row["most (cut)"]) for row in rows)
