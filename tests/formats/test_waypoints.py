"""Waypoints in all their formats: places by hand, and the same motion read back by those it was written for."""

import csv
import json
import re
from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
import shapely
from hypothesis import given, settings, strategies as st

from tests.formats.strategies import walks
from trihex import Area, AreaError, FormatError, Scenario
from trihex.areas import Frame
from trihex.formats import write_plan, write_waypoints
from trihex.kernels.codes import WAIT
from trihex.plans import Plan, plan_from_lists

FRAMES = st.builds(Frame, st.floats(0.1, 10), st.tuples(st.floats(-100, 100), st.floats(-100, 100)), st.floats(-pi, pi))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("waypoints")


def framed(plan, frame):
    """Return the same plan in an area that lies in the world."""
    return replace(plan, scenario=replace(plan.scenario, area=replace(plan.scenario.area, frame=frame)))


def places_by_hand(plan):
    """Return the places (step, x, y) of each robot, walked cell by cell; in ticks with the last of waits alone."""
    is_in_ticks = plan.scenario.clock == "costs"
    area, places = plan.scenario.area, []
    frame, tessellation = area.frame, area.tessellation
    for robot, start in enumerate(plan.scenario.robots.tolist()):
        y, x = divmod(start, area.width)
        rows, step = [(0, x, y, False)], 0  # and whether it waited
        for action in plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]].tolist():
            step += 1
            if action != WAIT:
                dx, dy = tessellation.step_of_direction[int(tessellation.orientation_of_cell(x, y))][action].tolist()
                x, y = x + dx, y + dy
                step += TICKS[tessellation.name, tessellation.neighbourhood][action] - 1 if is_in_ticks else 0
            rows.append((step, x, y, action == WAIT))
        if y * area.width + x not in plan.scenario.destinations:
            rows += [(later, x, y, True) for later in range(step + 1, plan.steps + 1)]
        if is_in_ticks:
            rows = [
                row for row, after in zip(rows, [*rows[1:], (0, 0, 0, False)], strict=True) if not row[3] * after[3]
            ]
        own = []
        for step, x, y, _ in rows:
            px, py = (frame.cell_size * float(number) for number in tessellation.centre_of_cell(x, y))
            turned = px * cos(frame.yaw) + py * sin(frame.yaw), px * sin(frame.yaw) - py * cos(frame.yaw)
            own.append((step, frame.origin[0] + turned[0], frame.origin[1] + turned[1]))
        places.append(own)
    return places


# In metres, of each direction.
TICKS = {
    ("triangular", "full"): [4] * 3 + [7] * 6 + [8] * 3,
    ("square", "full"): [7] * 4 + [10] * 4,
    ("triangular", "edge"): [1] * 3,
    ("square", "edge"): [1] * 4,
    **{("hexagonal", kind): [1] * 6 for kind in ("full", "edge")},
}


def seconds_per_step(plan, speed):
    tessellation = plan.scenario.area.tessellation
    if plan.scenario.clock == "costs" and tessellation.neighbourhood == "full":
        edge = {"hexagonal": 1, "square": 7, "triangular": 4}[tessellation.name]
        return plan.scenario.area.frame.cell_size / edge / speed
    longest = {"hexagonal": 1.0, "square": sqrt(2), "triangular": 2.0}[tessellation.name]
    return (longest if tessellation.neighbourhood == "full" else 1.0) * plan.scenario.area.frame.cell_size / speed


@settings(deadline=None, max_examples=40)
@given(plan=walks(), frame=FRAMES, speed=st.sampled_from([0.3, 1.0, 2.5]))
def test_csv_has_the_place_of_each_robot_at_each_step(folder, plan, frame, speed):
    plan = framed(plan, frame)
    path = folder / "w.csv"
    write_waypoints(plan, path, speed=speed)
    rows = list(csv.reader(path.read_text().splitlines()))
    assert rows[0] == ["robot", "t", "x", "y", "yaw"]
    expected = [(robot, *place) for robot, own in enumerate(places_by_hand(plan)) for place in own]
    assert [int(row[0]) for row in rows[1:]] == [row[0] for row in expected]
    step = seconds_per_step(plan, speed)
    for row, (_, number, x, y) in zip(rows[1:], expected, strict=True):
        assert [float(one) for one in row[1:4]] == pytest.approx([number * step, x, y], abs=1e-5)


def test_yaw_is_where_the_robot_will_go_next(tmp_path):
    area = Area("square", np.zeros((3, 4)), frame=Frame(1.0, yaw=0.5))
    east, south = area.tessellation.direction_names[0].index("E"), area.tessellation.direction_names[0].index("S")
    scenario = Scenario(area, [(2, 1)], [(0, 0), (3, 2), (2, 1)])
    plan = plan_from_lists(scenario, [[WAIT, east, WAIT, east, south], [], []])
    write_waypoints(plan, tmp_path / "w.csv")
    rows = [
        (int(row["robot"]), float(row["yaw"])) for row in csv.DictReader((tmp_path / "w.csv").read_text().splitlines())
    ]
    assert [yaw for robot, yaw in rows if robot == 0] == pytest.approx([0.5] * 4 + [0.5 - pi / 2] * 2, abs=1e-6)
    assert [yaw for robot, yaw in rows if robot == 1] == pytest.approx([0.5] * 6, abs=1e-6)  # stays: it cannot arrive
    assert [yaw for robot, yaw in rows if robot == 2] == [0.5]  # gone at once


@settings(deadline=None, max_examples=30)
@given(plan=walks(), frame=FRAMES)
def test_paths_in_json_and_yaml_are_those_of_the_csv(folder, plan, frame):
    plan = framed(plan, frame)
    for suffix in ("csv", "json", "yaml"):
        write_waypoints(plan, folder / f"p.{suffix}")
    rows = [[float(one) for one in row] for row in list(csv.reader((folder / "p.csv").read_text().splitlines()))[1:]]
    messages = json.loads((folder / "p.json").read_text())
    poses = [(robot, pose) for robot, message in enumerate(messages) for pose in message["poses"]]
    assert len(messages) == plan.scenario.robot_count
    for (robot, t, x, y, yaw), (own, pose) in zip(rows, poses, strict=True):
        stamp, at, turn = pose["header"]["stamp"], pose["pose"]["position"], pose["pose"]["orientation"]
        assert (own, stamp["sec"] + stamp["nanosec"] / 1e9, at["x"], at["y"]) == pytest.approx(
            (robot, t, x, y), abs=1e-5
        )
        assert abs(turn["z"] * cos(yaw / 2) - turn["w"] * sin(yaw / 2)) < 1e-5
    numbers = re.findall(r"(?:sec|nanosec|x|y|z|w): (\S+)", (folder / "p.yaml").read_text())
    flat = []
    for message in messages:
        for part in [message, *message["poses"]]:
            flat += part["header"]["stamp"].values()
            if "pose" in part:
                flat += [*part["pose"]["position"].values(), *part["pose"]["orientation"].values()]
    assert [float(number) for number in numbers] == pytest.approx(flat, abs=1e-9)


def test_yaml_is_a_document_for_each_robot(tmp_path):
    area = Area("square", [[0, 0, 0]], frame=Frame(2.0))
    plan = plan_from_lists(Scenario(area, [(2, 0)], [(1, 0)]), [[1]])
    write_waypoints(plan, tmp_path / "p.yaml", speed=0.5)
    assert (tmp_path / "p.yaml").read_text() == (
        "---  # robot 0\nheader:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: map\nposes:\n"
        "- header:\n    stamp:\n      sec: 0\n      nanosec: 0\n    frame_id: map\n"
        "  pose:\n    position:\n      x: 3.0\n      y: -1.0\n      z: 0.0\n"
        "    orientation:\n      x: 0.0\n      y: 0.0\n      z: 0.0\n      w: 1.0\n"
        "- header:\n    stamp:\n      sec: 5\n      nanosec: 656854249\n    frame_id: map\n"
        "  pose:\n    position:\n      x: 5.0\n      y: -1.0\n      z: 0.0\n"
        "    orientation:\n      x: 0.0\n      y: 0.0\n      z: 0.0\n      w: 1.0\n"
    )


@settings(deadline=None, max_examples=30)
@given(plan=walks(), frame=FRAMES)
def test_geojson_has_a_line_for_each_robot(folder, plan, frame):
    plan = framed(plan, frame)
    write_waypoints(plan, folder / "w.geojson")
    document = json.loads((folder / "w.geojson").read_text())
    assert len(document["features"]) == plan.scenario.robot_count
    for robot, (feature, own) in enumerate(zip(document["features"], places_by_hand(plan), strict=True)):
        line = shapely.from_geojson(json.dumps(feature["geometry"]))
        assert line.geom_type == ("LineString" if len(own) > 1 else "Point")
        assert np.allclose(shapely.get_coordinates(line), [place[1:] for place in own], atol=1e-6)
        properties = feature["properties"]
        assert properties["robot"] == robot and properties["arrived"] == plan.arrived[robot]
        assert len(properties["times"]) == len(own)


def walk_on(name, seed=0):
    """Return a plan of robots that walk about for a while, on cells with a hole in their midst."""
    rng = np.random.default_rng(seed)
    barriers = np.zeros((7, 9), dtype=bool)
    barriers[2:5, 3:6] = True
    area = Area(name, barriers, frame=Frame(0.5, (2.0, 3.0), 0.2))
    steps = area.tessellation.step_of_direction
    actions, robots = [], [(0, 0), (8, 6), (0, 6)]
    for x, y in robots:
        own = []
        for _ in range(12):
            ways = [
                (k, x + dx, y + dy)
                for k, (dx, dy) in enumerate(steps[int(area.tessellation.orientation_of_cell(x, y))].tolist())
                if 0 <= x + dx < 9 and 0 <= y + dy < 7 and not barriers[y + dy, x + dx]
            ]
            k, x, y = ways[rng.integers(len(ways))]
            own.append(k)
        actions.append(own)
    return plan_from_lists(Scenario(area, [(8, 0)], robots), actions)


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_pedpy_reads_the_trajectories_and_the_ground_they_stand_on(tmp_path, name):
    import pedpy

    plan = walk_on(name)
    write_waypoints(plan, tmp_path / "t.sqlite", speed=1.5)
    trajectories = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite")
    ground = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite")
    assert trajectories.frame_rate == pytest.approx(1 / seconds_per_step(plan, 1.5))
    for robot, own in enumerate(places_by_hand(plan)):
        data = trajectories.data[trajectories.data.id == robot].sort_values("frame")
        assert data.frame.tolist() == [place[0] for place in own]
        assert np.allclose(data[["x", "y"]], [place[1:] for place in own])
    assert pedpy.is_trajectory_valid(traj_data=trajectories, walkable_area=ground)
    area, frame = plan.scenario.area, plan.scenario.area.frame
    corners = area.tessellation.polygon_of_cell(0, 0)
    one = shapely.Polygon(np.transpose(frame.point_to_metres(corners[:, 0], corners[:, 1]))).area
    assert ground.area == pytest.approx(area.free_count * one, rel=0.01)
    assert len(ground.polygon.interiors) == 1
    speed = pedpy.compute_individual_speed(traj_data=trajectories, frame_step=1)
    assert 0 < speed.speed.max() <= 1.5 + 1e-9


def test_ground_that_no_robot_stands_on_is_left_out(tmp_path):
    import pedpy

    area = Area("square", [[0, 0, 1, 0]], frame=Frame(1.0))
    write_waypoints(plan_from_lists(Scenario(area, [(1, 0)], [(0, 0)]), [[1]]), tmp_path / "t.sqlite")
    ground = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite")
    assert ground.area == pytest.approx(2.0, rel=0.01)


@settings(deadline=None, max_examples=20)
@given(plan=walks())
def test_mapf_text_has_a_line_for_each_step_on_squares_only(folder, plan):
    path = folder / "w.txt"
    if plan.scenario.area.tessellation.name != "square":
        with pytest.raises(FormatError, match="mapf-visualizer draws squares only"):
            write_plan(plan, path)
        return
    if not plan.has_steps:
        with pytest.raises(FormatError, match=r"w\.txt: .* moves that last one step; here clock is 'costs'"):
            write_plan(plan, path)
        return
    plan = replace(plan, scenario=replace(plan.scenario, clock="steps", waiting_cost=None))
    write_plan(plan, path)
    unframed = framed(plan, Frame(1.0))
    lines = path.read_text().splitlines()
    assert len(lines) == plan.steps + 1
    for step, line in enumerate(lines):
        number, _, places = line.partition(":")
        cells = [tuple(map(int, pair)) for pair in re.findall(r"\((\d+),(\d+)\),", places)]
        own = [places_of[min(step, len(places_of) - 1)][1:] for places_of in places_by_hand(unframed)]
        assert int(number) == step and cells == [(round(x - 0.5), round(-y - 0.5)) for x, y in own]


def test_by_the_clock_of_costs_no_robot_is_faster_than_said_and_frames_lie_between_centres(tmp_path):
    import pedpy

    area = Area("square", np.zeros((3, 4)), frame=Frame(0.5))
    scenario = Scenario(area, [(3, 0)], [(0, 0), (2, 2)], clock="costs")
    plan = plan_from_lists(scenario, [[1, WAIT, WAIT, 1, 1], [WAIT, 4, 0]])  # E, E, E and NE, N
    write_waypoints(plan, tmp_path / "w.csv", speed=2.0)
    rows = [
        [float(row[key]) for key in "rtxy" if key != "r"]
        for row in csv.DictReader((tmp_path / "w.csv").read_text().splitlines())
        if row["robot"] == "0"
    ]
    tick = 0.5 / 7 / 2.0  # an edge is the farthest that a robot goes in 7 ticks; a vertex move goes 0.99 as far in 10
    places = [(0, 0.25), (7, 0.75), (9, 0.75), (16, 1.25), (23, 1.75)]
    assert np.allclose(rows, [[number * tick, x, -0.25] for number, x in places], atol=1e-6)
    write_waypoints(plan, tmp_path / "t.sqlite", speed=2.0)
    trajectories = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=tmp_path / "t.sqlite")
    assert trajectories.frame_rate == pytest.approx(1 / tick)
    own = trajectories.data[trajectories.data.id == 1].sort_values("frame")
    assert own.frame.tolist() == list(range(19))
    expected = [(1.25, -1.25)] + [(1.25 + 0.05 * n, -1.25 + 0.05 * n) for n in range(11)]
    expected += [(1.75, -0.75 + 0.5 * n / 7) for n in range(1, 8)]
    assert np.allclose(own[["x", "y"]], expected)
    speed = pedpy.compute_individual_speed(traj_data=trajectories, frame_step=1)
    assert 1.9 < speed.speed.max() <= 2.0 + 1e-9


@pytest.mark.parametrize(("speed", "shown"), [(0, "0"), (-1.0, "-1.0"), (float("nan"), "nan"), (float("inf"), "inf")])
def test_a_speed_that_is_none_is_refused(tmp_path, speed, shown):
    with pytest.raises(FormatError, match=f"speed must be above 0 metres in a second, not {shown}"):
        write_waypoints(walk_on("square"), tmp_path / "w.csv", speed=speed)


def test_what_cannot_be_written_is_refused_and_nothing_is_left(tmp_path):
    plan = plan_from_lists(Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)]), [[1, 1]])
    with pytest.raises(AreaError, match=r"give it a frame \(cell_size\)"):
        write_waypoints(plan, tmp_path / "w.csv")
    framed_plan = framed(plan, Frame(1.0))
    jump = Plan(framed_plan.scenario, [254], [0, 1], jumps=[[0, 2]])
    with pytest.raises(FormatError, match="robot 0 jumps in step 1, as no robot can"):
        write_waypoints(jump, tmp_path / "w.csv")
    with pytest.raises(FormatError, match="trajectories need at least one robot"):
        write_waypoints(plan_from_lists(framed_plan.scenario.with_robots([]), []), tmp_path / "w.sqlite")
    with pytest.raises(FormatError, match=r"the suffix of waypoints must be one of .csv"):
        write_waypoints(framed_plan, tmp_path / "w.xlsx")
    assert list(tmp_path.iterdir()) == []
