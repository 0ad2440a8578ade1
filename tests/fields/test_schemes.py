"""Schemes: distances and directions against Dijkstra on drawn polygons, and what surrounds them."""

from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.polygons import PolygonGraph
from tests.sweeps import swept
from trihex.kernels.codes import NOT_REACHED

NEIGHBOURHOODS = [
    ("triangular", "full"),
    ("triangular", "edge"),
    ("hexagonal", "full"),
    ("square", "full"),
    ("square", "edge"),
]
RULES = [
    (th.Tessellation(name, neighbourhood, costs), corners)
    for (name, neighbourhood), costs, corners in product(
        NEIGHBOURHOODS, ("paper", "euclidean"), ("allow", "no-squeeze", "no-cut")
    )
]


def random_scenario(rng, tessellation, corners):
    height, width = rng.integers(1, 11, 2)
    barriers = rng.random((height, width)) < rng.uniform(0, 0.6)
    cells = rng.choice(height * width, size=min(rng.integers(1, 4), height * width), replace=False)
    barriers.reshape(-1)[cells] = False
    return th.Scenario(th.Area(tessellation, barriers), cells, corners=corners)


def places(scenario):
    return list(zip(*(axis.tolist() for axis in scenario.area.cell_to_xy(scenario.destinations)), strict=True))


def snake(height, width):
    """Return barriers that leave one corridor, along the even rows and through gaps at alternating ends."""
    barriers = np.zeros((height, width), dtype=bool)
    barriers[1::2] = True
    barriers[1::4, -1] = barriers[3::4, 0] = False
    return barriers


def assert_equal_to_polygons(scenario):
    tessellation = scenario.area.tessellation
    graph = PolygonGraph(tessellation, scenario.area.barriers, scenario.corners)
    want = graph.distance(places(scenario))
    n_scheme = th.make_n_scheme(scenario)
    assert np.array_equal(n_scheme.distance, np.where(np.isfinite(want), want, NOT_REACHED))
    directions = th.make_d_scheme(n_scheme).directions
    steps = tessellation.step_of_direction.tolist()
    for y, x in np.ndindex(want.shape):
        row = steps[int(tessellation.orientation_of_cell(x, y))]
        assert {(x + dx, y + dy) for k, (dx, dy) in enumerate(row) if directions[y, x] >> k & 1} == graph.best(
            want, (x, y)
        )
    return graph, n_scheme


@pytest.mark.parametrize(("tessellation", "corners"), RULES, ids=lambda rule: getattr(rule, "name", rule))
def test_schemes_equal_dijkstra_on_drawn_polygons(tessellation, corners):
    rng = np.random.default_rng(20190204)
    for _ in range(swept(10, 2)):
        scenario = random_scenario(rng, tessellation, corners)
        graph, n_scheme = assert_equal_to_polygons(scenario)
        assert n_scheme.generations == graph.generations(places(scenario))


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_more_than_256_generations(name):
    barriers = snake(24, 50)
    _, n_scheme = assert_equal_to_polygons(th.Scenario(th.Area(name, barriers), [(0, 0)]))
    assert n_scheme.generations > 256


@pytest.mark.parametrize(("costs", "height"), [("paper", 150), ("euclidean", 16)])
def test_distances_beyond_65535(costs, height):
    tessellation = th.Tessellation("square", costs=costs)
    _, n_scheme = assert_equal_to_polygons(th.Scenario(th.Area(tessellation, snake(height, 100)), [(0, 0), (1, 0)]))
    known = n_scheme.distance[n_scheme.distance != NOT_REACHED]
    assert known.max() > 65535


def test_fronts_that_outgrow_their_lists():
    size = 1801
    middle = size // 2
    n_scheme = th.make_n_scheme(th.Scenario(th.Area("square", np.zeros((size, size), bool)), [(middle, middle)]))
    far = np.abs(np.arange(size, dtype=np.int32) - middle)
    assert np.array_equal(n_scheme.distance, 10 * np.maximum.outer(far, far) + 4 * np.minimum.outer(far, far))


def assert_is_fixed_point(n_scheme):
    """Costs being positive, one scheme alone holds 0 at destinations and elsewhere the least of neighbour and cost."""
    scenario, layout = n_scheme.scenario, n_scheme.scenario.area.layout
    distance = n_scheme.distance_of_site.astype(np.int64)
    best = np.full(distance.size, NOT_REACHED)
    sites = np.flatnonzero(scenario.moves)
    for k, cost in enumerate(scenario.area.tessellation.cost_of_direction.tolist()):
        movable = sites[scenario.moves[sites] >> k & 1 == 1]
        there = distance[movable + layout.offset_of_direction[movable & 1, k]]
        best[movable] = np.minimum(best[movable], there + cost)
    best[layout.cell_to_site(scenario.destinations)] = 0
    assert np.array_equal(distance, np.minimum(best, NOT_REACHED))


def with_halls(area, seed):
    """Return a maze with ways round and two halls, in which long fronts form."""
    barriers = area.barriers & (np.random.default_rng(seed).random(area.barriers.shape) >= 0.02)
    barriers[20:260, 20:260] = barriers[-30:, -30:] = False
    return th.Area(area.tessellation, barriers)


@pytest.mark.parametrize(("tessellation", "corners"), RULES, ids=lambda rule: getattr(rule, "name", rule))
def test_corridors_and_halls(tessellation, corners, monkeypatch):
    monkeypatch.setattr("trihex.fields.settling._FIRST_BUDGET", 500)
    monkeypatch.setattr("trihex.fields.settling._BUDGET", 2000)
    maze = th.make_maze_area(tessellation, 300, 300, seed=3)
    for area in (maze, with_halls(maze, 4)):
        for destination in np.flatnonzero(~area.barriers)[[0, -1]]:
            scenario = th.Scenario(area, [destination], corners=corners)
            n_scheme = th.make_n_scheme(scenario)
            assert_is_fixed_point(n_scheme)
        robots = th.random_robots(area, 3, seed=5)
        some = th.make_n_scheme(scenario.with_robots(robots), robots_only=True)
        known = np.where(n_scheme.distance < some.horizon, n_scheme.distance, NOT_REACHED)
        assert np.array_equal(some.distance, known)


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_every_free_cell_a_destination(name):
    barriers = np.random.default_rng(1).random((70, 70)) < 0.3
    scenario = th.Scenario(th.Area(name, barriers), np.flatnonzero(~barriers))
    n_scheme = th.make_n_scheme(scenario)
    assert np.array_equal(n_scheme.distance, np.where(barriers, NOT_REACHED, 0))
    assert not th.make_d_scheme(n_scheme).directions.any()
    assert n_scheme.generations == 0


def test_robots_that_cannot_arrive_are_named():
    area = th.Area("hexagonal", [[0, 1, 0, 0], [0, 1, 1, 1], [0, 0, 0, 0]])
    n_scheme = th.make_n_scheme(th.Scenario(area, [(0, 0)], [(3, 2), (3, 0), (0, 0), (2, 0)]))
    assert n_scheme.unreachable_robots.tolist() == [1, 3]
    assert n_scheme.distance_of_cell(n_scheme.scenario.robots).tolist() == [50, NOT_REACHED, 0, NOT_REACHED]


def test_a_scheme_for_the_robots_only_stops_when_it_knows_their_distances():
    barriers = np.random.default_rng(5).random((600, 600)) < 0.2
    barriers[300, 300] = False
    scenario = th.Scenario(th.Area("triangular", barriers), [(300, 300)])
    whole = th.make_n_scheme(scenario)
    assert whole.horizon == NOT_REACHED
    near = np.flatnonzero(whole.distance.reshape(-1) < 1000)
    some = th.make_n_scheme(scenario.with_robots(near), robots_only=True)
    is_known = some.distance != NOT_REACHED
    assert 1000 <= some.horizon < whole.distance[whole.distance != NOT_REACHED].max()
    assert np.array_equal(is_known, whole.distance < some.horizon)
    assert np.array_equal(some.distance[is_known], whole.distance[is_known])
    directions = th.make_d_scheme(whole).directions
    assert np.array_equal(th.make_d_scheme(some).directions, np.where(is_known, directions, 0))


@pytest.mark.parametrize(("tessellation", "corners"), RULES, ids=lambda rule: getattr(rule, "name", rule))
def test_kernels_may_stop_and_go_on_anywhere(tessellation, corners, monkeypatch):
    rng = np.random.default_rng(7)
    for budget in (1, 2, 5, 30):
        barriers = rng.random((25, 25)) < 0.3
        barriers[12, 12] = False
        scenario = th.Scenario(th.Area(tessellation, barriers), [(12, 12)], corners=corners)
        robots = th.random_robots(scenario.area, 2, seed=budget)
        whole = th.make_n_scheme(scenario)
        monkeypatch.setattr("trihex.fields.schemes._BUDGET", budget)
        monkeypatch.setattr("trihex.fields.settling._BUDGET", budget)
        monkeypatch.setattr("trihex.fields.settling._FIRST_BUDGET", budget)
        assert th.make_n_scheme(scenario) == whole
        assert th.make_n_scheme(scenario).generations == whole.generations
        some = th.make_n_scheme(scenario.with_robots(robots), robots_only=True)
        monkeypatch.undo()
        assert np.array_equal(some.distance_of_cell(robots), whole.distance_of_cell(robots))
        want = np.where(whole.distance < some.horizon, whole.distance, NOT_REACHED)
        assert np.array_equal(some.distance, want)


def test_a_scheme_for_the_robots_only_is_whole_if_one_cannot_arrive():
    barriers = np.zeros((20, 20), bool)
    barriers[:, 10] = True
    scenario = th.Scenario(th.Area("square", barriers), [(0, 0)], [(1, 1), (15, 15)])
    some = th.make_n_scheme(scenario, robots_only=True)
    assert some == th.make_n_scheme(scenario)
    assert some.unreachable_robots.tolist() == [1]


def test_names_of_the_best_directions():
    area = th.Area("triangular", np.zeros((5, 5), bool))
    d_scheme = th.make_d_scheme(th.make_n_scheme(th.Scenario(area, [(2, 2)])))
    names = {(x, y): d_scheme.names_of_cell(5 * y + x) for y in range(5) for x in range(5)}
    assert names[2, 2] == ()
    assert names[1, 2] == ("E",) and names[3, 2] == ("W",)
    assert names[2, 3] == ("N",)  # it shares an edge with the destination, which points north
    assert names[2, 1] == ("S",)  # it meets the destination's apex
    assert names[0, 2] == ("EE",)


def test_schemes_are_views_that_cannot_be_written():
    n_scheme = th.make_n_scheme(th.Scenario(th.Area("square", np.zeros((3, 4), bool)), [(0, 0)]))
    d_scheme = th.make_d_scheme(n_scheme)
    for array in (n_scheme.distance, n_scheme.distance_of_site, d_scheme.directions, d_scheme.directions_of_site):
        assert not array.flags.writeable
    assert n_scheme.distance.shape == d_scheme.directions.shape == (3, 4)


def test_distances_too_large_to_add_up_are_refused():
    tessellation = th.Tessellation("square", "edge", "euclidean")
    with pytest.raises(th.ScenarioError, match="distances must stay below 2000000000"):
        th.make_n_scheme(th.Scenario(th.Area(tessellation, snake(4001, 1001)), [(0, 0)]))


def test_progress_counts_up_to_the_free_cells():
    calls = []
    area = th.Area("hexagonal", np.zeros((500, 700), bool))
    th.make_n_scheme(th.Scenario(area, [(0, 0)]), progress=lambda done, total: calls.append((done, total)))
    assert len(calls) > 3
    assert calls == sorted(calls) and calls[-1] == (350_000, 350_000)


def test_fields_may_be_made_in_threads():
    area = th.make_random_area("square", 300, 300, density=0.3, seed=1)
    free = np.flatnonzero(~area.barriers)[::5000]
    scenarios = [th.Scenario(area, [cell], corners="no-cut") for cell in free]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(th.make_n_scheme, scenarios)) == [th.make_n_scheme(s) for s in scenarios]
