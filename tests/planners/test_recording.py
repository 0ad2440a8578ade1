"""What `greedy` and `fcost` record: a plan that does not fit into memory is refused, with what to do."""

import numpy as np
import pytest

import trihex as th
from trihex.planners import make_plan, recording

PLANNERS = ["greedy", "fcost"]


def queue(robots=60):
    """Return a corridor one cell wide with a full queue at its end, where one robot arrives every step."""
    area = th.Area("hexagonal", np.zeros((1, robots + 1), dtype=bool))
    return th.Scenario(area, [(0, 0)], np.arange(1, robots + 1), destination_capacity=1)


@pytest.fixture
def free(monkeypatch):
    """Let so many bytes be free, however few."""
    monkeypatch.setattr(recording, "_SMALL", 0)
    monkeypatch.setattr(recording, "_PART", 1)
    return lambda count: monkeypatch.setattr(recording, "available_memory", lambda: count)


@pytest.mark.parametrize("planner", PLANNERS)
def test_what_cannot_fit_is_refused_before_the_first_step(planner, free):
    scenario = queue()
    free(2 * sum(range(1, 61)) - 1)  # bytes: no way is shorter, and each action is there twice for a while
    told = []
    with pytest.raises(
        th.TooLargeError, match=r"the plan would take .* GiB more, .* 1830 actions, .*record='arrivals'"
    ):
        make_plan(scenario, planner, progress=lambda *done: told.append(done))
    assert told == []
    assert make_plan(scenario, planner, record="arrivals").steps == 60


@pytest.mark.parametrize("planner", PLANNERS)
def test_waiting_that_makes_it_too_large_is_noticed_on_the_way(planner, free):
    area = th.Area("square", np.zeros((11, 11), dtype=bool))
    scenario = th.Scenario(area, [(5, 5)], [c for c in range(121) if c != 60], destination_capacity=1)
    ways = int(th.make_n_scheme(scenario).distance.sum()) // 14
    assert 2 * ways < 6000 < 2 * make_plan(scenario, planner).actions.size
    free(6000)
    told = []
    with pytest.raises(th.TooLargeError, match="the plan would take"):
        make_plan(scenario, planner, progress=lambda *done: told.append(done))
    assert told[0][1] == 120 and 0 < told[-1][0] < 120


@pytest.mark.parametrize("planner", PLANNERS)
def test_what_fits_is_planned(planner, free):
    scenario = queue()
    free(1 << 30)
    assert make_plan(scenario, planner).total_time == 10 * 1830
