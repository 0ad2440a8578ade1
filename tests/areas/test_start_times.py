"""Start times drawn from distributions, and seconds that become steps."""

from dataclasses import replace
from math import ceil

import numpy as np
import pytest

import trihex as th
from trihex.areas import Frame, start_times_of

STEPS = th.Area("hexagonal", [[0] * 4] * 4)
METRES = th.Area("hexagonal", [[0] * 4] * 4, frame=Frame(cell_size=0.5))


@pytest.mark.parametrize(
    ("distribution", "mean", "sd"),
    [
        ("constant:7", 7, 0),
        ("uniform:10,40", 25, 30 / 12**0.5),
        ("normal:60,8", 60, 8),
        ("lognormal:30,15", 30, 15),
    ],
)
def test_what_is_drawn_has_the_mean_and_deviation_that_was_asked_for(distribution, mean, sd):
    times = th.random_start_times(STEPS, 20_000, distribution, seed=3)
    assert times.dtype == np.int64 and times.min() >= 0
    # Rounded up, by half a step in the mean, unless it is a constant.
    assert abs(times.mean() - mean - 0.5 * (sd > 0)) <= 5 * sd / 20_000**0.5
    assert abs(times.std() - sd) <= 0.03 * sd
    assert np.array_equal(times, th.random_start_times(STEPS, 20_000, distribution, seed=3))
    assert sd == 0 or not np.array_equal(times, th.random_start_times(STEPS, 20_000, distribution, seed=4))


def test_nobody_starts_before_the_alarm():
    assert (th.random_start_times(STEPS, 500, "normal:2,8", seed=1) == 0).mean() > 0.3


def test_in_metres_numbers_are_seconds_and_nobody_starts_sooner():
    assert th.random_start_times(METRES, 2, "constant:3", speed=2.0).tolist() == [12, 12]
    seconds = np.random.default_rng(1).uniform(0, 90, 300)
    for speed in (0.7, 1.0, 1.3):
        lasts = 0.5 / speed
        steps = start_times_of(METRES, seconds, speed=speed)
        assert (steps * lasts >= seconds * (1 - 1e-9)).all() and ((steps - 1) * lasts < seconds).all()
        whole = np.arange(200)
        assert start_times_of(METRES, whole * lasts, speed=speed).tolist() == whole.tolist()
    assert start_times_of(STEPS, [0, 1, 1.2]).tolist() == [0, 1, ceil(1.2)]


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("gauss:3,1", "not 'gauss:3,1'"),
        ("normal", "not 'normal'"),
        ("normal:3", "not 'normal:3'"),
        ("normal:3,a", "not 'normal:3,a'"),
        ("uniform:5,2", "LEAST no more than MOST, not 'uniform:5,2'"),
        ("uniform:-1,2", "of numbers from 0 to 1e.06, not 'uniform:-1,2'"),
        ("constant:nan", "of numbers from 0 to 1e.06, not 'constant:nan'"),
        ("lognormal:0,2", "of a mean above 0, not 'lognormal:0,2'"),
        (5, "not 5"),
    ],
)
def test_what_is_no_distribution_is_refused(text, rule):
    with pytest.raises(th.ScenarioError, match=f"start times must be drawn as one of constant:time, .*{rule}"):
        th.random_start_times(STEPS, 3, text)


def test_seconds_must_be_from_0_on():
    with pytest.raises(th.ScenarioError, match=r"start times must be from 0 to 1e\+06, not -1"):
        start_times_of(STEPS, [2, -1])


def test_a_scenario_may_be_replaced_with_other_robots_where_none_starts_late():
    """What a scenario keeps for each robot is then as usual, and says nothing of robots that come."""
    scenario = th.Scenario(th.Area("square", [[0] * 5]), [(0, 0)], [(1, 0), (2, 0)])
    assert replace(scenario, robots=[(3, 0)]) == scenario.with_robots([(3, 0)])
    with pytest.raises(th.ScenarioError, match="start_times must be one for each of 1 robot, not 2"):
        replace(replace(scenario, start_times=[0, 4]), robots=[(3, 0)])
