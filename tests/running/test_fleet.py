"""Fleet: who is where, in a corridor."""

import numpy as np
import pytest

import trihex as th
from trihex.kernels.codes import LATE, WAIT
from trihex.running import ARRIVED, BROKEN, GOING, LEFT
from trihex.running.fleet import Fleet

EAST = 1


def fleet_of(*robots, cells=6):
    scenario = th.Scenario(th.Area("square", np.zeros((1, cells), dtype=bool)), [(cells - 1, 0)], robots)
    return Fleet(scenario), scenario


def occupied(fleet):
    return fleet.layout.site_to_cell(np.flatnonzero(fleet.occupied)).tolist()


def test_robots_move_into_cells_that_are_left_in_the_same_step():
    fleet, scenario = fleet_of((0, 0), (1, 0), (3, 0))
    distance = th.make_n_scheme(scenario).distance_of_site
    fleet.move(np.array([EAST, EAST, LATE], dtype=np.uint8), distance)
    assert fleet.cell_of_robot.tolist() == occupied(fleet) == [1, 2, 3]
    came_from = fleet.layout.site_to_cell(fleet.came_from[:2]).tolist()
    assert came_from == [0, 1] and fleet.came_from[2] == -1
    fleet.move(np.array([WAIT, WAIT, EAST], dtype=np.uint8), distance)
    assert fleet.cell_of_robot.tolist() == [1, 2, 4]


def test_who_arrives_leaves_or_breaks_down_is_in_nobodys_way():
    fleet, scenario = fleet_of((0, 0), (2, 0), (4, 0))
    distance = th.make_n_scheme(scenario).distance_of_site
    fleet.move(np.array([WAIT, WAIT, EAST], dtype=np.uint8), distance)
    fleet.arrive(fleet.going, distance)
    fleet.end(0, LEFT)
    fleet.end(1, BROKEN)
    assert fleet.state.tolist() == [LEFT, BROKEN, ARRIVED] and fleet.going.size == 0
    assert fleet.cell_of_robot.tolist() == [-1, 2, -1] and occupied(fleet) == []
    for robot, words in ((0, "has left"), (1, "has broken down"), (2, "has arrived")):
        with pytest.raises(th.ExecutionError, match=f"robot {robot} is not on its way: it {words}"):
            fleet.end(robot, LEFT)


def test_robots_join_on_empty_free_cells_only():
    fleet, _ = fleet_of((0, 0))
    blocked = fleet.area.make_blocked()
    assert fleet.join((3, 0), blocked) == 1
    assert fleet.state.tolist() == [GOING, GOING] and occupied(fleet) == [0, 3]
    with pytest.raises(th.ExecutionError, match=r"robot must join on an empty cell; robot 1 stands at \(3, 0\)"):
        fleet.join(3, blocked)
    blocked[fleet.layout.cell_to_site(np.array([2]))] = True
    with pytest.raises(th.ExecutionError, match=r"a robot must join on a free cell; \(2, 0\) is a barrier"):
        fleet.join((2, 0), blocked)
    with pytest.raises(th.ExecutionError, match=r"must not appear on a robot: robot 1 stands at \(3, 0\)"):
        fleet.check_empty(np.array([2, 3]))
    assert fleet.size == 2


def test_a_fleet_goes_back_to_what_it_was():
    fleet, scenario = fleet_of((0, 0), (2, 0))
    before = fleet.as_arrays()
    fleet.place({0: (1, 0)}, fleet.area.make_blocked())
    fleet.end(1, LEFT)
    fleet.join((4, 0), fleet.area.make_blocked())
    fleet.restore(before, th.make_n_scheme(scenario).distance_of_site)
    assert fleet.cell_of_robot.tolist() == occupied(fleet) == [0, 2] and fleet.state.tolist() == [GOING, GOING]
