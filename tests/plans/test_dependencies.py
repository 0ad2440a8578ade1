"""Dependencies: they enforce all that the plan does, with none too many; rings are found; unsafe plans are refused."""

import numpy as np
import pytest

import trihex as th
from tests.oracles.waiting import Events, closure_of, events_of
from tests.oracles.wanderers import wandering_plan
from tests.strategies import SHAPES
from tests.sweeps import swept
from trihex.errors import PlanError
from trihex.kernels.codes import WAIT
from trihex.plans import make_dependencies, plan_from_lists


def small_plan(seed, name, neighbourhood, following):
    """Return a random plan on a few cells, by all rules and both clocks in turn."""
    rng = np.random.default_rng(seed)
    tessellation = th.Tessellation(
        name, neighbourhood, ("paper", "euclidean")[seed % 2], ("steps", "costs")[seed // 2 % 2]
    )
    barriers = rng.random(rng.integers(3, 7, size=2)) < 0.15
    barriers.flat[rng.integers(barriers.size)] = False
    free = np.flatnonzero(~barriers)
    scenario = th.Scenario(
        th.Area(tessellation, barriers),
        rng.choice(free, size=min(2, free.size), replace=False),
        rng.choice(free, size=free.size // 2, replace=False),
        following=following,
        crossing=("forbid", "allow")[seed // 4 % 2],
        destination_capacity=(None, 1, 2)[seed % 3],
    )
    return wandering_plan(scenario, seed, 400) or th.make_plan(scenario, "greedy")


@pytest.mark.parametrize(("name", "neighbourhood"), SHAPES)
@pytest.mark.parametrize("following", ["forbid", "allow"])
def test_they_enforce_what_every_owner_does_and_none_of_them_is_implied(name, neighbourhood, following):
    found = implied = 0
    for seed in range(swept(100, 12)):
        plan = small_plan(seed, name, neighbourhood, following)
        dependencies = make_dependencies(plan)
        before = events_of(dependencies)
        after = closure_of(before)
        assert after == Events(plan).closure()
        in_rings = {here for here, own in after.items() if here in own}
        assert in_rings == {tuple(own) for ring in dependencies.rings for own in ring.tolist()}
        for robot, waypoint, other, reached in dependencies.waits.tolist():
            before[robot, waypoint].remove((other, reached))
            assert closure_of(before) != after
            before[robot, waypoint].add((other, reached))
        found, implied = found + len(dependencies.waits), implied + dependencies.implied
    assert found > 50 and implied > 0


def test_a_ring_is_named_and_a_train_is_none():
    area = th.Area(th.Tessellation("square", "edge"), np.zeros((2, 4)))
    scenario = th.Scenario(area, [(3, 0)], [(0, 0), (1, 0), (1, 1), (0, 1)])
    east, south, west, north = (area.tessellation.direction_names[0].index(name) for name in "ESWN")
    ring = make_dependencies(plan_from_lists(scenario, [[east], [south], [west], [north]]))
    assert [own.tolist() for own in ring.rings] == [[[0, 1], [1, 1], [2, 1], [3, 1]]]
    assert "This plan has 1, such as that of robots 0, 1, 2, 3" in ring.sentence and "1 ring" in repr(ring)
    train = make_dependencies(plan_from_lists(scenario.with_robots([(0, 0), (1, 0)]), [[east] * 3, [east] * 2]))
    assert train.rings == () and train.waits.tolist() == [[0, 1, 1, 1], [0, 2, 1, 2]]
    assert "This plan has none" in train.sentence


def test_a_destination_that_takes_some_at_a_time():
    area = th.Area(th.Tessellation("square", "edge"), np.zeros((3, 3)))
    robots = [(1, 0), (0, 1), (2, 1), (1, 2)]
    scenario = th.Scenario(area, [(1, 1)], robots, destination_capacity=2, following="forbid")
    plan = th.make_plan(scenario, "fcost")
    order = np.argsort(plan.arrival_step_of_robot, kind="stable").tolist()
    waits = make_dependencies(plan).waits.tolist()
    assert sorted(waits) == sorted([[order[2], 1, order[0], 1], [order[3], 1, order[1], 1]])
    assert make_dependencies(th.make_plan(th.Scenario(area, [(1, 1)], robots), "fcost")).waits.size == 0


@pytest.mark.parametrize(
    ("robots", "actions", "message"),
    [
        ([(0, 0), (1, 0)], [["E"], ["WAIT"]], r"up to step 1 robots 1 and 0 are both in \(1, 0\)"),
        ([(0, 0), (1, 0)], [["E"], ["W"]], "robots 0 and 1 exchange cells"),
        ([(0, 0), (1, 0)], [["SE"], ["SW"]], "robots 0 and 1 pass one lattice vertex"),
        ([(1, 0)], [["WAIT", "N"]], "up to step 2 robot 0 goes where it cannot"),
        ([(2, 0)], [["E", "W"]], "robot 0 goes on from a destination"),
        ([(2, 0), (3, 1)], [["E"], ["N"]], "are more than the 1 robot that enter a destination at a time"),
    ],
)
def test_what_is_not_safe_is_refused(robots, actions, message):
    scenario = th.Scenario(th.Area("square", np.zeros((2, 4))), [(3, 0)], robots, destination_capacity=1)
    names = scenario.area.tessellation.direction_names[0]
    numbers = [[WAIT if name == "WAIT" else names.index(name) for name in own] for own in actions]
    with pytest.raises(PlanError, match=f"dependencies need a safe plan; .*{message}"):
        make_dependencies(plan_from_lists(scenario, numbers))


def test_a_plan_with_jumps_has_none(tmp_path):
    scenario = th.Scenario(th.Area("square", np.zeros((2, 4))), [(3, 0)], [(0, 0)])
    plan = th.Plan(scenario, np.array([254], dtype=np.uint8), [0, 1], jumps=[[0, 3]])
    with pytest.raises(PlanError, match="robots jump has no dependencies"):
        make_dependencies(plan)


def test_nobody_and_nothing():
    scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 1, 0]]), [(0, 0)], [(0, 0), (3, 0)])
    for robots in ([], scenario.robots):
        dependencies = make_dependencies(th.make_plan(scenario.with_robots(robots)))
        assert dependencies.waits.shape == (0, 4) and dependencies.first_waypoint.tolist() == list(
            range(len(robots) + 1)
        )
