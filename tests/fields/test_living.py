"""Living field: whatever changes, the repaired field equals a fresh one, which Dijkstra on drawn polygons confirms."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.oracles.polygons import PolygonGraph
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.fields import LivingField
from trihex.kernels.codes import NOT_REACHED


def corridor():
    """Two rooms of one row each, joined by two doors, (0, 1) and (4, 1); the destination is (0, 0)."""
    return th.Scenario(th.Area("square", [[0, 0, 0, 0, 0], [0, 1, 1, 1, 0], [0, 0, 0, 0, 0]]), [(0, 0)])


def living(scenario):
    n_scheme = th.make_n_scheme(scenario)
    return LivingField(scenario, n_scheme.distance_of_site, th.make_d_scheme(n_scheme).directions_of_site)


def test_a_door_that_closes_raises_what_hung_on_it_and_one_that_opens_lowers_it():
    field = living(corridor())
    assert field.distance[2].tolist() == [20, 24, 34, 44, 54]
    closing = field.change(blocked=[(0, 1)])
    assert field.distance.tolist() == [
        [0, 10, 20, 30, 40],
        [NOT_REACHED] * 4 + [44],
        [88, 78, 68, 58, 54],
    ]
    assert (closing.raised, closing.lowered) == (5, 4)  # (4, 2) keeps its distance: it has another support
    opening = field.change(freed=[(0, 1)])
    assert field.distance[2].tolist() == [20, 24, 34, 44, 54]
    assert (opening.raised, opening.lowered) == (0, 5)


def test_a_wall_that_cuts_off_and_a_change_far_away_touch_only_what_changes():
    field = living(corridor())
    field.change(blocked=[(0, 1)])
    cut = field.change(blocked=[(4, 1)])
    assert (field.distance[2] == NOT_REACHED).all()
    assert (cut.raised, cut.lowered) == (6, 0)
    assert field.change(blocked=[(4, 2)]).touched == 0
    assert field.change().touched == 0


def test_destinations_open_close_and_move():
    field = living(corridor())
    field.change(opened=[(4, 2)], closed=[(0, 0)])
    assert field.distance[:, 4].tolist() == [20, 10, 0]
    assert field.destinations == {14}
    field.change(closed=[(4, 2)])
    assert (field.distance == NOT_REACHED).all()
    field.change(opened=[(2, 0)])
    fresh = th.make_n_scheme(replace(corridor(), destinations=[(2, 0)]))
    assert np.array_equal(field.distance, fresh.distance)


@pytest.mark.parametrize("corners", ["allow", "no-squeeze", "no-cut"])
@pytest.mark.parametrize(
    ("name", "neighbourhood"),
    [("triangular", "full"), ("triangular", "edge"), ("hexagonal", "full"), ("square", "full"), ("square", "edge")],
)
def test_repaired_fields_equal_dijkstra_on_drawn_polygons(name, neighbourhood, corners):
    rng = np.random.default_rng(42)
    area = th.Area(th.Tessellation(name, neighbourhood, "euclidean"), rng.random((7, 9)) < 0.3)
    free = np.flatnonzero(~area.barriers)
    field = living(th.Scenario(area, free[:1], corners=corners))
    for _ in range(6):
        cells = rng.choice(free[1:] if rng.random() < 0.5 else np.delete(np.arange(63), free[0]), size=3, replace=False)
        is_barrier = field.barriers.flat[cells]
        field.change(blocked=cells[~is_barrier], freed=cells[is_barrier])
        graph = PolygonGraph(area.tessellation, field.barriers, corners)
        want = graph.distance([(int(free[0]) % 9, int(free[0]) // 9)])
        assert np.array_equal(field.distance, np.where(np.isfinite(want), want, NOT_REACHED))


def test_updated_schemes_are_new_records_equal_to_fresh_ones():
    for seed in range(swept(30, 10)):
        scenario = random_scenario(seed, sides=(3, 10), most_robots=3)
        n_scheme = th.make_n_scheme(scenario)
        before = n_scheme.distance.copy()
        rng = np.random.default_rng(seed)
        taken = np.concatenate([scenario.robots, scenario.destinations])
        cells = np.setdiff1d(rng.choice(scenario.area.cell_count, size=3), taken)
        is_barrier = scenario.area.barriers.flat[cells]
        changes = dict(blocked=cells[~is_barrier], freed=cells[is_barrier])
        if rng.random() < 0.5 and is_barrier.any():
            changes["destinations"] = cells[is_barrier]
        barriers = scenario.area.barriers.copy()
        barriers.flat[cells] ^= True
        wanted = changes.get("destinations", scenario.destinations)
        fresh = replace(scenario, area=replace(scenario.area, barriers=barriers), destinations=wanted)
        updated = th.make_d_scheme(n_scheme).updated(**changes)
        assert updated.n_scheme == n_scheme.updated(**changes) == th.make_n_scheme(fresh)
        assert updated == th.make_d_scheme(th.make_n_scheme(fresh))
        assert np.array_equal(updated.n_scheme.scenario.moves, fresh.moves)
        assert np.array_equal(n_scheme.distance, before)


def test_wrong_changes_are_named():
    scenario = corridor().with_robots([(1, 0)])
    field, n_scheme = living(scenario), th.make_n_scheme(scenario)
    with pytest.raises(th.ScenarioError, match=r"blocked and freed at once: \(3, 0\)"):
        field.change(blocked=[(3, 0)], freed=[(3, 0)])
    with pytest.raises(th.ScenarioError, match=r"opened and closed at once: \(0, 0\)"):
        field.change(opened=[(0, 0)], closed=[(0, 0)])
    with pytest.raises(th.ScenarioError, match=r"blocked while it is a destination: \(0, 0\)"):
        field.change(blocked=[(0, 0)])
    with pytest.raises(th.ScenarioError, match=r"\(2, 1\) is a barrier"):
        field.change(opened=[(2, 1)])
    with pytest.raises(th.ScenarioError, match=r"blocked: cell \(9, 9\) lies outside"):
        field.change(blocked=[(9, 9)])
    assert np.array_equal(field.distance, n_scheme.distance)
    with pytest.raises(th.ScenarioError, match=r"robot 0 must stand on a free cell; \(1, 0\) is a barrier"):
        n_scheme.updated(blocked=[(1, 0)])
    wide = th.Scenario(th.make_random_area("square", 400, 400, density=0.0, seed=1), [(0, 0)], [(1, 0)])
    with pytest.raises(th.ScenarioError, match="robots only cannot be updated"):
        th.make_n_scheme(wide, robots_only=True).updated(blocked=[(3, 0)])
