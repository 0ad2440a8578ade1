"""Scenarios: the rules their parts must obey, and the moves that follow from barriers and corner rules."""

import numpy as np
import pytest

import trihex as th

OPEN = th.Area("square", np.zeros((3, 4), bool), "open")
WALLED = th.Area("square", [[0, 1, 0], [0, 0, 0]])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (dict(destinations=[]), "destinations must name at least one cell"),
        (dict(destinations=[(4, 0)]), r"destinations: cell \(4, 0\) lies outside the area: x is 0..3, y is 0..2"),
        (dict(destinations=[12]), "destinations: cell number 12 lies outside the area of 12 cells"),
        (dict(destinations=[(0.5, 1)]), "destinations must be pairs of integers"),
        (dict(destinations=[(0, 1, 2)]), "destinations must be pairs of integers"),
        (dict(destinations=[(0, 1), (2,)]), "destinations must be pairs of integers"),
        (dict(robots=[(0, 0), (1, 1), (0, 0)]), r"robots 0 and 2 both start at \(0, 0\)"),
        (dict(robots=[(-1, 0)]), "robots: cell"),
        (dict(waiting_cost=-1), "waiting_cost must be a whole number from 0 to .*, not -1"),
        (dict(waiting_cost=2.5), "waiting_cost must be a whole number"),
        (dict(destination_capacity=0), "destination_capacity must be a number of robots above 0"),
        (dict(crossing="forbidden"), "crossing must be one of forbid, allow, not 'forbidden'; did you mean 'forbid'"),
        (dict(corners="nosqueeze"), "did you mean 'no-squeeze'"),
        (dict(start_times=[1]), "start_times must be one for each of 0 robots, not 1"),
        (dict(robots=[(0, 0), (1, 0)], start_times=[1]), "start_times must be one for each of 2 robots, not 1"),
        (
            dict(robots=[(0, 0), (1, 0)], start_times=[1, -2]),
            r"start_times\[1\] must be a whole number from 0 to 16777216, not -2",
        ),
        (dict(robots=[(0, 0)], start_times=2**24 + 1), r"start_times\[0\] must be .* not 16777217"),
        (dict(robots=[(0, 0)], start_times=[0.5]), r"start_times must be whole numbers, .*, not \[0.5\]"),
        (dict(robots=[(0, 0)], start_times="5"), "start_times must be whole numbers, one for each robot, not '5'"),
        (dict(robots=[(0, 0)], start_times=[[1]]), "start_times must be whole numbers, one for each robot"),
        (dict(area=[[0, 1]]), "area must be an Area, not list"),
    ],
)
def test_what_does_not_fit_is_refused(arguments, message):
    with pytest.raises(th.ScenarioError, match=message):
        th.Scenario(**{"area": OPEN, "destinations": [(3, 2)], **arguments})


@pytest.mark.parametrize("parameter", ["destinations", "robots"])
def test_nothing_stands_on_a_barrier(parameter):
    with pytest.raises(th.ScenarioError, match=rf"{parameter[:-1]} 1 must stand on a free cell; \(1, 0\) is a barrier"):
        th.Scenario(WALLED, **{"destinations": [(0, 1)], parameter: [(0, 0), (1, 0)]})


def test_places_may_be_pairs_arrays_or_cell_numbers():
    want = th.Scenario(OPEN, [(3, 2)], [(0, 0), (1, 2)])
    assert th.Scenario(OPEN, np.array([[3, 2]]), np.array([0, 9])) == want
    assert th.Scenario(OPEN, ((3, 2), (3, 2)), iter([(0, 0), (1, 2)])) == want


def test_waiting_costs_as_much_as_an_edge_step_unless_set():
    area = th.Area(th.Tessellation("square", costs="euclidean"), np.zeros((2, 2), bool))
    assert th.Scenario(area, [(0, 0)]).waiting_cost == 1000
    assert th.Scenario(OPEN, [(0, 0)]).waiting_cost == 10
    assert th.Scenario(OPEN, [(0, 0)], waiting_cost=0).waiting_cost == 0


def test_random_robots_stand_apart_on_free_cells_and_depend_on_the_seed_alone():
    robots = th.random_robots(WALLED, 4, seed=3, avoid=[(0, 1)])
    assert sorted(robots) == [0, 2, 4, 5]
    assert np.array_equal(robots, th.random_robots(WALLED, 4, seed=3, avoid=[(0, 1)]))
    assert len({tuple(th.random_robots(OPEN, 6, seed=s)) for s in range(5)}) == 5


def test_more_robots_than_free_cells_are_refused():
    with pytest.raises(th.ScenarioError, match="at most the number of free cells, 5, not 6"):
        th.random_robots(WALLED, 6)


def open_names(scenario, x, y):
    site = scenario.area.layout.cell_to_site(scenario.area.xy_to_cell([x], [y]))[0]
    names = scenario.area.tessellation.direction_names[int(scenario.area.tessellation.orientation_of_cell(x, y))]
    return {name for k, name in enumerate(names) if scenario.moves[site] >> k & 1}


@pytest.mark.parametrize(
    ("rows", "corners", "want"),
    [
        ("..|..", "allow", {"E", "S", "SE"}),
        (".B|..", "allow", {"S", "SE"}),
        (".B|..", "no-squeeze", {"S", "SE"}),
        (".B|..", "no-cut", {"S"}),
        (".B|B.", "allow", {"SE"}),
        (".B|B.", "no-squeeze", set()),
        ("..|..", "no-cut", {"E", "S", "SE"}),
    ],
)
def test_corner_rules_on_squares(rows, corners, want):
    area = th.Area("square", [[c == "B" for c in row] for row in rows.split("|")])
    assert open_names(th.Scenario(area, [(0, 0)], corners=corners), 0, 0) == want


@pytest.mark.parametrize(
    ("barriers", "corners", "want"),
    [
        ([], "allow", {"WW", "W", "E", "EE", "NW", "N", "NE", "SSW", "SW", "S", "SE", "SSE"}),
        ([(2, 3)], "no-squeeze", {"WW", "E", "EE", "NW", "N", "NE", "SSW", "SW", "S", "SE", "SSE"}),
        # W closed: the ways west round the apex and round the west end of the base are cut.
        ([(2, 3)], "no-cut", {"E", "EE", "S", "SE", "SSE"}),
        # Both ways round the apex closed: no way through it to the cell beyond.
        ([(2, 3), (4, 3)], "no-squeeze", {"S", "WW", "SSW", "SW", "EE", "SE", "SSE"}),
    ],
)
def test_corner_rules_on_a_triangle_in_the_middle(barriers, corners, want):
    blocked = np.zeros((5, 7), bool)
    for x, y in barriers:
        blocked[y, x] = True
    scenario = th.Scenario(th.Area("triangular", blocked), [(0, 0)], corners=corners)
    assert open_names(scenario, 3, 3) == want  # x + y even: points north


def test_the_border_counts_as_barrier_for_corner_rules():
    area = th.Area("triangular", np.zeros((1, 5), bool))
    assert open_names(th.Scenario(area, [(0, 0)], corners="no-squeeze"), 2, 0) == {"WW", "W", "E", "EE"}
    assert open_names(th.Scenario(area, [(0, 0)], corners="no-cut"), 2, 0) == {"W", "E"}


def test_start_times_are_of_each_robot_or_of_all():
    at_once = th.Scenario(OPEN, (3, 2), [(0, 0), (1, 0)])
    assert at_once.start_times.tolist() == [0, 0] and not at_once.has_start_times
    assert at_once.start_times.dtype == np.int64 and not at_once.start_times.flags.writeable
    assert th.Scenario(OPEN, (3, 2), [(0, 0), (1, 0)], start_times=3).start_times.tolist() == [3, 3]
    late = th.Scenario(OPEN, (3, 2), [(0, 0), (1, 0)], start_times=(0, 2))
    assert late != at_once and late.in_words() == at_once.in_words() + ", start_times=0..2"
    assert not late.with_robots([(2, 0)]).has_start_times
