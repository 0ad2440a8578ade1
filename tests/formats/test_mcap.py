"""Recordings of ROS in MCAP, read back: grids against drawn cells, times and places against the plan."""

import sys
from collections import defaultdict
from dataclasses import replace
from math import atan2, cos, sin, sqrt

import numpy as np
import pytest
import shapely
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

import trihex as th
from tests.formats.test_waypoints import seconds_per_step
from trihex.formats.tracks.samples import make_samples

ROWS = [[0, 0, 0, 1, 0, 0], [0, 1, 0, 0, 0, 1], [0, 0, 0, 1, 0, 0], [1, 0, 0, 1, 1, 0]]
FRAME = th.Frame(0.5, origin=(3.0, -2.0), yaw=0.3)
SHAPES = ("triangular", "hexagonal", "square")
CLOCKS = ("steps", "costs")


def plan_of(shape, clock="steps", robots=((0, 0), (0, 2), (2, 3), (4, 0))):
    area = th.Area(shape, ROWS, frame=FRAME)
    return th.make_plan(th.Scenario(area, [(5, 2), (4, 2)], robots, clock=clock), "greedy")


def recorded(plan, path, speed=0.5):
    """Return the messages of each topic, (nanoseconds, message)."""
    th.write_waypoints(plan, path, speed=speed)
    found = defaultdict(list)
    with open(path, "rb") as file:
        for _, channel, message, ros in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            assert message.log_time == message.publish_time
            found[channel.topic].append((message.log_time, ros))
    return found


def grid_of(message):
    """Return the numbers of a grid and the points in the world in the middle of each of its squares."""
    info = message.info
    numbers = np.array(message.data).reshape(info.height, info.width)
    yaw = 2 * atan2(info.origin.orientation.z, info.origin.orientation.w)
    row, column = np.mgrid[: info.height, : info.width] + 0.5
    east, north = column * info.resolution, row * info.resolution
    x = info.origin.position.x + east * cos(yaw) - north * sin(yaw)
    y = info.origin.position.y + east * sin(yaw) + north * cos(yaw)
    return numbers, x, y


def polygons_of(area):
    """Return each cell, drawn in the world."""
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(np.arange(area.cell_count)))
    return shapely.polygons(np.stack(area.frame.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))


@pytest.mark.parametrize("shape", SHAPES)
def test_grids_are_the_cells_drawn(tmp_path, shape):
    plan = plan_of(shape)
    found = recorded(plan, tmp_path / "p.mcap")
    distance = th.make_n_scheme(plan.scenario).distance.reshape(-1)
    far = distance[distance < 10**6].max()
    ((at, plain),), ((_, costs),) = found["/map"], found["/n_scheme"]
    assert (at, plain.header.frame_id, costs.header.frame_id) == (0, "map", "map")
    numbers, x, y = grid_of(plain)
    share = grid_of(costs)[0]
    points, inside, seen = shapely.points(x, y), np.zeros(x.shape, dtype=bool), 0
    for cell, polygon in enumerate(polygons_of(plan.scenario.area)):
        within = shapely.contains(polygon.buffer(-1e-6), points)
        inside |= shapely.intersects(polygon.buffer(1e-6), points)
        seen += within.any()
        is_barrier = ROWS[cell // 6][cell % 6] == 1
        assert (numbers[within] == (100 if is_barrier else 0)).all()
        expected = 100 if is_barrier else -1 if distance[cell] > 10**6 else round(98 * distance[cell] / far)
        assert (share[within] == expected).all()
    assert seen == 24  # no cell is too small for the grid
    assert (numbers[~inside] == -1).all() and (share[~inside] == -1).all()
    assert set(np.unique(share)) > {0, 98, 100}


@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("shape", SHAPES)
def test_robots_are_where_the_plan_has_them(tmp_path, shape, clock):
    plan = plan_of(shape, clock)
    area, tick = plan.scenario.area, seconds_per_step(plan, 0.5)
    found = recorded(plan, tmp_path / "p.mcap")
    assert plan.steps >= 3 and len(found["/robots"]) == len(found["/robots/poses"]) == plan.steps + 1
    place = {}
    for step, ((at, message), (also_at, poses)) in enumerate(
        zip(found["/robots"], found["/robots/poses"], strict=True)
    ):
        wipe, *markers = message.markers
        assert at == also_at == round(step * tick * 1e9) and wipe.action == 3
        assert [one.id for one in markers] == [r for r in range(4) if plan.last_step_of_robot[r] >= step]
        assert [repr(one.pose) for one in markers] == [repr(pose) for pose in poses.poses]
        for one in [*markers, poses]:
            assert one.header.stamp.sec * 10**9 + one.header.stamp.nanosec == at
        place.update({(one.id, step): (one.pose.position.x, one.pose.position.y) for one in markers})
    for robot in range(4):
        x, y = area.cell_to_metres(plan.cells_of_robot(robot))
        for px, py, step in zip(x, y, plan.ticks_of_robot(robot).tolist(), strict=True):
            assert place[robot, step] == pytest.approx((px, py), abs=1e-6)
        steps = [step for own, step in place if own == robot]
        assert max(steps) == plan.arrival_step_of_robot[robot]
        gone = [np.hypot(*np.subtract(place[robot, step + 1], place[robot, step])) for step in steps[:-1]]
        assert max(gone) <= 0.5 * tick + 2e-6  # nobody is faster than asked


@pytest.mark.parametrize("clock", CLOCKS)
def test_paths_and_headings(tmp_path, clock):
    plan = plan_of("triangular", clock)
    found, tick = recorded(plan, tmp_path / "p.mcap"), seconds_per_step(plan, 0.5)
    ((at, lines),) = found["/paths"]
    assert at == 0 and [line.id for line in lines.markers] == [0, 1, 2, 3]
    for robot, line in enumerate(lines.markers):
        x, y = plan.scenario.area.cell_to_metres(plan.cells_of_robot(robot))
        moved = np.append(True, (np.diff(x) != 0) | (np.diff(y) != 0))
        assert np.allclose([(p.x, p.y) for p in line.points], np.stack([x, y], axis=-1)[moved])
        ((at, path),) = found[f"/robot_{robot}/path"]
        stamps = [pose.header.stamp.sec + pose.header.stamp.nanosec / 1e9 for pose in path.poses]
        assert at == 0 and set(stamps) <= {round(step * tick, 9) for step in range(plan.steps + 1)}
        assert stamps[-1] == pytest.approx(plan.arrival_step_of_robot[robot] * tick)
        first, second = (pose.pose for pose in path.poses[:2])
        ahead = atan2(second.position.y - first.position.y, second.position.x - first.position.x)
        turned = 2 * atan2(first.orientation.z, first.orientation.w) - ahead
        assert sin(turned / 2) == pytest.approx(0, abs=1e-5) or plan.actions[plan.first_action[robot]] == 255


def test_a_recording_says_what_it_is_of(tmp_path):
    recorded(plan_of("hexagonal"), tmp_path / "p.mcap")
    with open(tmp_path / "p.mcap", "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        words = {one.name: one.metadata for one in reader.iter_metadata()}["trihex"]
        schemas = {one.name: one.data.decode() for one in reader.get_summary().schemas.values()}
    assert words["tessellation"] == "hexagonal" and 0 < int(words["farthest"]) < 200
    assert float(words["seconds_per_step"]) == 1.0
    assert schemas["nav_msgs/msg/OccupancyGrid"].splitlines()[2] == "int8[] data"


def test_a_plan_without_robots_is_a_map(tmp_path):
    assert sorted(recorded(plan_of("square", robots=()), tmp_path / "p.mcap")) == ["/map", "/n_scheme"]


def test_a_robot_that_cannot_arrive_stays(tmp_path):
    area = th.Area("square", [[0, 0, 0, 1, 0]], frame=FRAME)
    plan = th.make_plan(th.Scenario(area, (2, 0), [(0, 0), (4, 0)]), "greedy")
    found = recorded(plan, tmp_path / "p.mcap")
    assert [[one.id for one in message.markers[1:]] for _, message in found["/robots"]] == [[0, 1]] * 3
    assert len({(line.id, len(line.points)) for line in found["/paths"][0][1].markers} & {(0, 3), (1, 2)}) == 2


def test_squares_are_not_sampled_and_large_areas_coarsely(tmp_path):
    found = recorded(plan_of("square"), tmp_path / "p.mcap")
    info = found["/map"][0][1].info
    assert (info.width, info.height, info.resolution) == (6, 4, 0.5)
    info = recorded(plan_of("hexagonal"), tmp_path / "p.mcap")["/map"][0][1].info
    assert info.resolution == pytest.approx(0.5 / 6) and info.width == np.ceil(6 * (1.5 * 6 + 0.5) / sqrt(3))
    large = th.Area("hexagonal", np.zeros((1500, 1500)), frame=FRAME)
    samples = make_samples(large)
    assert samples.resolution == 0.25 and samples.cells.size < 2**24


def test_without_metres_and_without_the_extra(tmp_path, monkeypatch):
    plan = plan_of("square")
    bare = replace(plan, scenario=replace(plan.scenario, area=th.Area("square", ROWS), following="allow"))
    with pytest.raises(th.AreaError, match=r"measured in cells, not in metres; give it a frame \(cell_size\)"):
        th.write_waypoints(bare, tmp_path / "p.mcap")
    monkeypatch.setitem(sys.modules, "mcap_ros2.writer", None)
    with pytest.raises(th.MissingExtraError, match=r"^MCAP needs mcap and mcap-ros2.*pip install 'trihex\[ros\]'$"):
        th.write_waypoints(plan, tmp_path / "p.mcap")
    assert not list(tmp_path.iterdir())
