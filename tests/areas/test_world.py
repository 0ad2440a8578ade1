"""World: barriers and destinations as they come and go, in worlds that fit in the head."""

import numpy as np
import pytest

import trihex as th
from trihex.areas import World


def small():
    """Return a world of two rows; row 1 is all barrier but its end, (0, 0) is the destination."""
    return World(th.Scenario(th.Area("square", [[0, 0, 0], [1, 1, 0]]), [(0, 0)], [(1, 0)]))


def cells(*numbers):
    return np.array(numbers, dtype=np.int64)


def test_what_comes_and_goes_is_there_and_gone():
    world = small()
    assert world.barriers.tolist() == [[False, False, False], [True, True, False]]
    sites = world.change(blocked=cells(2), freed=(3, 4), opened=[4], closed=cells(0))
    assert world.barriers.tolist() == [[False, False, True], [False, False, False]]
    assert world.destinations == {4} and world.destination_cells.tolist() == [4]
    assert [world.is_barrier(cell) for cell in (2, 3)] == [True, False]
    found = {name: world.layout.site_to_cell(own).tolist() for name, own in sites.items()}
    assert found == {"blocked": [2], "freed": [3, 4], "opened": [4], "closed": [0]}
    assert world.blocked.sum() == world.layout.size - 5  # the padding stays


def test_a_change_of_nothing_and_of_what_is_so_already():
    world = small()
    before = world.blocked.copy()
    world.change()
    world.change(blocked=[3], freed=[0], opened=[0], closed=[2])
    assert np.array_equal(world.blocked, before) and world.destinations == {0}
    world.change(closed=[0])
    assert world.destination_cells.size == 0 and world.destination_cells.dtype == np.int64


def test_the_scenario_stays_as_it_was():
    world = small()
    scenario = th.Scenario(th.Area("square", [[0, 0, 0], [1, 1, 0]]), [(0, 0)], [(1, 0)])
    other = World(scenario)
    other.change(blocked=[1], opened=[2])
    assert not scenario.area.barriers[0, 1] and scenario.destinations.tolist() == [0]
    assert not world.is_barrier(1)
    with pytest.raises(ValueError, match="read-only"):
        world.barriers[0, 0] = True


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"blocked": (1,), "freed": (1,)}, r"be blocked and freed at once: \(1, 0\)"),
        ({"opened": (2,), "closed": (2,)}, r"be opened and closed at once: \(2, 0\)"),
        ({"blocked": (2, 0)}, r"be blocked while it is a destination: \(0, 0\)"),
        ({"blocked": (2,), "opened": (2,)}, r"be blocked while it is a destination: \(2, 0\)"),
        ({"opened": (2, 4)}, r"a destination must be a free cell; \(1, 1\) is a barrier"),
    ],
)
def test_a_cell_cannot_be_two_things_at_once(change, why):
    wanted = {name: cells(*change.get(name, ())) for name in ("blocked", "freed", "opened", "closed")}
    with pytest.raises(th.ScenarioError, match=why):
        small().check(**wanted)


def test_what_becomes_free_in_the_same_change_may_be_a_destination():
    nothing = cells()
    small().check(nothing, cells(3), cells(3), nothing)
    small().check(cells(0), nothing, nothing, cells(0))
