"""The study of complexity: its page is made from its results, and the planner that it counts is the paper's."""

import numpy as np
import pytest
from benchmarks import growth
from benchmarks.literal import run_literally

import trihex as th
from tests.strategies import random_scenario


def test_the_page_is_made_from_the_results_file():
    text = growth.PAGE.read_text(encoding="utf-8")
    assert growth.page_with(text, growth.read_results()) == text


def test_exponents_are_those_of_power_laws():
    rows = [growth.row("x", "n", "-", "trihex", "s", size, 3 * size**2.5) for size in (10, 20, 40)]
    assert growth.table_lines(rows)[-1] == "| x | n | 10 to 40 | - | trihex | seconds | 2.50 |"


def test_comparisons_in_a_corridor_are_those_counted_by_hand():
    """Two robots, at 2 and 4 of a corridor of 6, the destination at 0. Their shortest ways: 2 1, and 4 3 2 1.

    The nearer one may wait (2 2 1: two comparisons at the steps that both ways have), go west (2 1: one), or go east
    (2 3 2 1: met at the first). The other way ends after one step, so the farther robot makes one comparison for each
    of its three.
    """
    area = th.Area("square", np.zeros((1, 6), dtype=bool))
    n_scheme = th.make_n_scheme(th.Scenario(area, [0], [2, 4]))
    assert run_literally(n_scheme, 1).comparisons.tolist() == [(2 + 1 + 1) + 3]


@pytest.mark.parametrize("seed", range(10))
def test_the_literal_planner_ends_and_all_arrive(seed):
    scenario = random_scenario(seed, sides=(3, 8))
    n_scheme = th.make_n_scheme(scenario)
    run = run_literally(n_scheme)
    distance = n_scheme.distance_of_cell(scenario.robots)
    assert ((run.arrival_step > 0) == ((distance > 0) & (distance < 2**31 - 1))).all()
    assert run.steps == run.arrival_step.max(initial=0)
