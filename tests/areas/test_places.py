"""Places: one rule for all of the API how (x, y) and numbers of cells are told apart, and what is refused."""

import numpy as np
import pytest

import trihex as th
from trihex.areas import cells_from, numbers_from

AREA = th.Area("hexagonal", np.zeros((10, 20), dtype=bool))
PLACE, NUMBER = (3, 4), 83

ONE = [(3, 4), (np.int64(3), np.int32(4)), AREA.cell_to_xy(83), [(3, 4)], [[3, 4]], np.array([[3, 4]]), 83, [83], {83},
       np.array([83]), np.array(83), iter([(3, 4)]), range(83, 84)]  # fmt: skip
SEVERAL = {
    "list of two numbers": ([3, 4], [3, 4]),
    "flat array of two numbers": (np.array([3, 4]), [3, 4]),
    "tuple of pairs": (((3, 4), (1, 0)), [83, 1]),
    "list of lists": ([[3, 4], [1, 0]], [83, 1]),
    "array of pairs": (np.array([[3, 4], [1, 0], [0, 0]]), [83, 1, 0]),
    "list of two arrays": ([np.array([3, 4]), np.array([1, 0])], [83, 1]),
    "unsigned numbers": (np.array([3, 4], dtype=np.uint8), [3, 4]),
    "nothing": ((), []),
}
REFUSED = {
    "tuple of three": ((3, 4, 5), r"places: \(3, 4, 5\) is no place \(x, y\), which has two numbers; cell numbers are"),
    "tuple of one": ((3,), r"places: \(3,\) is no place"),
    "all x and all y": ((np.array([3, 4, 5]), np.array([1, 0, 2])), "places might be two places or all x and all y"),
    "two x and two y": ((np.array([3, 4]), np.array([1, 0])), r"area.xy_to_cell\(x, y\) makes numbers of x and y"),
    "fractions": ([(0.5, 1)], "must be pairs of integers .* or cell numbers in a list or a flat array, not"),
    "a mask": (np.zeros((10, 20), dtype=bool), r"not an array of bool of shape \(10, 20\): np.flatnonzero\(mask\)"),
    "words": ("3,4", "not '3,4'"),
    "a mapping": ({3: 4}, "not {3: 4}"),
    "pairs and numbers": ([(3, 4), 83], "must be pairs of integers"),
    "truths": ([True, False], "must be pairs"),
    "outside": ((20, 0), r"places: cell \(20, 0\) lies outside the area"),
    "a robot that has left": ([5, -1], r"places: cell number -1 lies outside the area of 200 cells; -1 stands for rob"),
}  # fmt: skip


@pytest.mark.parametrize("place", ONE, ids=range(len(ONE)))
def test_one_place_is_one_cell_however_it_is_written(place):
    assert cells_from(AREA, place, "places", th.ScenarioError).tolist() == [NUMBER]


@pytest.mark.parametrize(("places", "numbers"), SEVERAL.values(), ids=SEVERAL)
def test_several_places(places, numbers):
    assert cells_from(AREA, places, "places", th.ScenarioError).tolist() == numbers


@pytest.mark.parametrize(("places", "message"), REFUSED.values(), ids=REFUSED)
def test_what_might_mean_two_things_or_none_is_refused(places, message):
    with pytest.raises(th.ScenarioError, match=message) as raised:
        cells_from(AREA, places, "places", th.ScenarioError)
    assert "\n" not in str(raised.value)


def test_a_lone_pair_means_one_place_wherever_places_are_taken():
    scenario = th.Scenario(AREA, PLACE, robots=(0, 0))
    assert (scenario.destinations.tolist(), scenario.robots.tolist()) == ([NUMBER], [0])
    assert scenario.with_robots((5, 5)).robots.tolist() == [105]
    assert NUMBER not in th.random_robots(AREA, 199, avoid=PLACE)
    n_scheme = th.make_n_scheme(scenario)
    assert int(n_scheme.distance_of_cell(PLACE)) == 0 == int(n_scheme.distance_of_cell(NUMBER))
    assert n_scheme.updated(destinations=(5, 5)).scenario.destinations.tolist() == [105]
    d_scheme = th.make_d_scheme(n_scheme)
    assert d_scheme.names_of_cell((3, 5)) == ("N",)
    assert int(d_scheme.next_cell((3, 5))) == NUMBER
    field = th.LivingField(scenario)
    field.change(blocked=(5, 5))
    assert np.flatnonzero(field.barriers).tolist() == [105]
    execution = th.Execution(scenario)
    execution.observe(blocked=(5, 5), opened=(6, 6))
    assert execution.field.destinations == {NUMBER, 126}
    assert execution.join((7, 7)) == 1
    execution.place({0: (1, 1), 1: 2})
    assert execution.cell_of_robot.tolist() == [21, 2]
    with pytest.raises(th.ExecutionError, match=r"place of robot 0: cell \(20, 0\) lies outside"):
        execution.place({0: (20, 0)})


def test_what_an_event_has_changed_can_be_told_to_a_field():
    scenario = th.Scenario(AREA, PLACE, robots=[(0, 0)])
    trial = th.Trial(scenario, events=[th.Event(1, "move", cell=PLACE, to=(5, 5))])
    trial.run()
    field = th.LivingField(scenario)
    field.change(**trial.occurrences[0].changes)
    assert field.destinations == {105}
    both = th.Occurrence(th.Event(1, "barrier", cell=PLACE), blocked=(3, 4))  # two numbers, no place
    field.change(**both.changes)
    assert np.flatnonzero(field.barriers).tolist() == [3, 4]


def test_functions_of_cells_keep_the_shape_of_what_they_are_asked():
    assert numbers_from(AREA, PLACE).shape == () == numbers_from(AREA, NUMBER).shape
    assert numbers_from(AREA, [PLACE]).shape == (1,)
    assert numbers_from(AREA, np.arange(200).reshape(10, 20)).shape == (10, 20)
    with pytest.raises(
        th.AreaError, match=r"cell might be pairs \(x, y\) or numbers of cells, an array of shape \(3, 2"
    ):
        numbers_from(AREA, np.zeros((3, 2), dtype=int))


@pytest.mark.parametrize("cell", [-1, 200, 10**6, (20, 0), [5, -1], np.array([-1])])
def test_cells_outside_are_named_and_never_wrap_round(cell):
    area = th.Area("hexagonal", np.zeros((10, 20), dtype=bool), frame=th.Frame(0.5))
    n_scheme = th.make_n_scheme(th.Scenario(area, PLACE))
    d_scheme, field = th.make_d_scheme(n_scheme), th.LivingField(n_scheme.scenario)
    for ask in (
        area.cell_to_xy, area.cell_to_metres, area.is_barrier, area.cell_to_axial, area.cell_to_cube,
        n_scheme.distance_of_cell, d_scheme.direction_of_cell, d_scheme.next_cell, d_scheme.names_of_cell,
        field.distance_of_cell, field.direction_of_cell, field.next_cell, field.world.is_barrier,
    ):  # fmt: skip
        with pytest.raises(th.AreaError, match=r"lies outside the area"):
            ask(cell)


@pytest.mark.parametrize("x", [2.7, np.nan, "2", None, [0, 0.5]])
def test_columns_that_are_no_whole_numbers_are_refused_not_cut(x):
    with pytest.raises(th.AreaError, match="x must be whole numbers, the column or row of a cell, not"):
        AREA.xy_to_cell(x, 1)
    assert int(AREA.xy_to_cell(np.floor(2.7), 1)) == 22
