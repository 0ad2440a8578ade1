"""From a map in metres to waypoints: discs that follow them touch neither walls nor each other, in continuous space."""

from itertools import product

import numpy as np
import pytest
import shapely
from PIL import Image

import trihex as th
from tests.areas.test_clearance import drawn_moves, nearest
from tests.oracles.continuous import (
    boxes_of_pixels,
    contacts_between_robots,
    contacts_with_world,
    find_contacts,
    greatest_speed,
    read_waypoints,
)
from tests.sweeps import swept
from trihex.areas import CLOCKS, FOLLOWINGS, NEIGHBOURHOODS, TESSELLATIONS, Tessellation
from trihex.areas.clearance import least_cell_size, least_distance
from trihex.formats import read_area, write_waypoints
from trihex.kernels.codes import WAIT
from trihex.planners import make_plan
from trihex.plans import plan_from_lists

KINDS = list(product(TESSELLATIONS, NEIGHBOURHOODS))
RESOLUTION, ORIGIN, YAW = 0.05, (-3.0, 2.0), 0.4


def draw_rooms(seed):
    """Return occupied pixels of a house of 12 x 9 metres: four rooms with doors, and things that stand about."""
    rng = np.random.default_rng(seed)
    house = np.zeros((180, 240), dtype=bool)
    house[[0, -1], :] = house[:, [0, -1]] = True
    house[:, 118:122] = house[88:92, :] = True
    for y, x in ((45, 120), (135, 120), (90, 60), (90, 180)):
        house[y - 20 : y + 20, x - 20 : x + 20] = False
    for _ in range(12):
        y, x, tall, wide = rng.integers(0, 170), rng.integers(0, 230), *rng.integers(2, 12, 2)
        house[y : y + tall, x : x + wide] = True
    return house


@pytest.fixture(scope="module")
def houses(tmp_path_factory):
    """Four ROS maps: path of the YAML, and what the judge sees of it."""
    made = []
    for seed in range(4):
        folder = tmp_path_factory.mktemp("house")
        house = draw_rooms(seed)
        Image.fromarray(np.where(house, 0, 254).astype(np.uint8)).save(folder / "house.pgm")
        yaml = f"image: house.pgm\nresolution: {RESOLUTION}\norigin: [{ORIGIN[0]}, {ORIGIN[1]}, {YAW}]\nnegate: 0\n"
        (folder / "house.yaml").write_text(yaml)
        room = boxes_of_pixels(np.ones_like(house), RESOLUTION, ORIGIN, YAW)
        made.append((folder / "house.yaml", boxes_of_pixels(house, RESOLUTION, ORIGIN, YAW), shapely.union_all(room)))
    return made


@pytest.mark.parametrize(("clock", "following"), list(product(CLOCKS, FOLLOWINGS)))
@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_robots_touch_neither_walls_nor_each_other(houses, tmp_path, name, neighbourhood, clock, following):
    tessellation = Tessellation(name, neighbourhood, "euclidean", clock)
    radius = 0.07 if (name, neighbourhood) == ("triangular", "full") else 0.12
    size = round(least_cell_size(tessellation, radius, following) + 5e-5, 4)
    for seed, (path, occupied, room) in enumerate(houses[: swept(4)]):
        area = read_area(path, tessellation, cell_size=size, robot_radius=radius)
        free = np.flatnonzero(~area.barriers)
        exits = np.random.default_rng(seed).choice(free, size=2, replace=False)
        robots = th.random_robots(area, min(60, free.size // 4), seed=seed, avoid=exits)
        plan = make_plan(th.Scenario(area, exits, robots, following=following), "greedy")
        assert plan.arrived.sum() > 20
        write_waypoints(plan, tmp_path / "w.csv", speed=0.5)
        assert find_contacts(tmp_path / "w.csv", radius, occupied, room) == []
        assert greatest_speed(read_waypoints(tmp_path / "w.csv")) <= 0.5 + 1e-5


def tightest_plan(tessellation):
    """Return a plan of two robots of the greatest radius that come as near as the table says."""
    area = th.Area(tessellation, np.zeros((12, 12)), frame=th.Frame(1.0, robot_radius=least_distance(tessellation) / 2))
    a = (5, 5)
    names = tessellation.step_of_direction
    for dx, dy in product(range(-3, 4), range(-2, 3)):
        b = (a[0] + dx, a[1] + dy)
        if a == b:
            continue
        for (to_a, vertex_a), (to_b, vertex_b) in product(
            [(a, None), *drawn_moves(tessellation, a)], [(b, None), *drawn_moves(tessellation, b)]
        ):
            if to_a == to_b or (to_a == b and to_b == a) or (vertex_a and vertex_a == vertex_b):
                continue
            places = [tuple(map(float, tessellation.centre_of_cell(*cell))) for cell in (a, to_a, b, to_b)]
            if nearest(*places) < least_distance(tessellation) + 1e-9:
                scenario = th.Scenario(area, [(11, 11)], [a, b])
                actions = []
                for start, target in ((a, to_a), (b, to_b)):
                    steps = names[int(tessellation.orientation_of_cell(*start))].tolist()
                    step = [target[0] - start[0], target[1] - start[1]]
                    actions.append([WAIT if step == [0, 0] else steps.index(step)])
                return plan_from_lists(scenario, actions)
    raise AssertionError("no pair of moves comes as near as the table says")


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_the_table_is_sharp_robots_of_the_greatest_radius_just_touch(tmp_path, name, neighbourhood):
    plan = tightest_plan(Tessellation(name, neighbourhood))
    write_waypoints(plan, tmp_path / "w.csv")
    tracks, radius = read_waypoints(tmp_path / "w.csv"), plan.scenario.area.frame.robot_radius
    assert contacts_between_robots(tracks, radius) == []
    assert len(contacts_between_robots(tracks, radius + 1e-4)) == 1


def test_the_judge_sees_what_it_should():
    one, other = np.array([[0.0, 0, 0], [1, 1, 0]]), np.array([[0.0, 1, 0], [1, 0, 0]])
    assert [contact[1:3] for contact in contacts_between_robots({3: one, 5: other}, 0.2)] == [(3, 5)]
    gone = np.array([[0.0, 0, 0], [1, 1, 0]]), np.array([[2.0, 1, 0], [3, 0, 0]])
    assert contacts_between_robots(dict(enumerate(gone)), 0.2) == []
    instant = {0: np.array([[0.0, 0, 0]]), 1: np.array([[0.0, 0.3, 0]])}
    assert len(contacts_between_robots(instant, 0.2)) == 1
    wall = np.array([shapely.box(0.4, 0.2, 0.6, 0.5), shapely.box(3, 3, 4, 4)])
    assert contacts_with_world({7: one}, 0.25, wall) == [(7, 0)]
    assert contacts_with_world({7: one}, 0.15, wall) == []
    assert contacts_with_world({7: one}, 0.15, wall, shapely.box(-0.1, -1, 2, 1)) == [(7, -1)]
    assert contacts_with_world({7: one}, 0.15, wall, shapely.box(0.5, -1, 2, 1)) == [(7, -1)]
    assert greatest_speed({7: one, 8: np.array([[0.0, 0, 0], [0.5, 0, 1]])}) == 2.0
