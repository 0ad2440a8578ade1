"""The curves of a plan, against robots that are followed one by one; and the page that plays it, against the plan."""

import base64

import numpy as np
from hypothesis import given, settings

import trihex as th
from tests.strategies import random_scenario, scenarios
from trihex.kernels.codes import JUMP, WAIT
from trihex.pictures.ways import bends_of
from trihex.planners import make_plan
from trihex.plans import Plan, make_playback, plan_from_lists
from trihex.viewer.bundle import encode
from trihex.viewer.desk import Desk

HIDDEN, MOVING, WAITING, FINAL, STRANDED = range(5)  # as in viewer.js
PLAY = """async ([text, steps]) => {
  const { decode, documentOf, Playback } = await import("./viewer.js");
  const bundle = decode(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
  const playback = new Playback(bundle, documentOf(bundle.header.document, bundle.arrays));
  return steps.map((step) => {
    playback.seek(step);
    return [[...playback.x0], [...playback.y0], [...playback.x1], [...playback.y1], [...playback.state],
      [...playback.bx], [...playback.by]];
  });
}"""


def followed(plan, n_scheme):
    """Return the same curves, by following each robot from cell to cell."""
    scenario = plan.scenario
    costs, wait = scenario.area.tessellation.cost_of_direction, scenario.waiting_cost
    curves = {name: [0] * (plan.steps + 1) for name in ("moving", "waiting", "arrived", "spent", "least_total")}
    cells = list(plan.cells_by_step())
    for robot in range(scenario.robot_count):
        actions = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]]
        spent = 0
        for step in range(plan.steps + 1):
            if 1 <= step <= actions.size:
                action = actions[step - 1]
                curves["waiting" if action == WAIT else "moving"][step] += 1
                spent += wait if action == WAIT else costs[action]
            if plan.arrived[robot]:
                here = cells[step][robot]
                ahead = 0 if here < 0 else int(n_scheme.distance_of_cell(here))
                curves["arrived"][step] += here < 0
                curves["spent"][step] += spent
                curves["least_total"][step] += spent + ahead
    return curves


@settings(max_examples=30, deadline=None)
@given(scenarios())
def test_curves_are_those_of_robots_followed_one_by_one(scenario):
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, "greedy", n_scheme=n_scheme)
    playback = make_playback(plan, n_scheme)
    for name, curve in followed(plan, n_scheme).items():
        assert getattr(playback, name).tolist() == curve, name
    assert playback.spent[-1] == playback.least_total[-1] == plan.total_time
    assert (np.diff(playback.least_total) >= 0).all()


def test_a_jump_costs_nothing():
    scenario = th.Scenario(th.Area("square", [[0, 0, 0, 0]]), [(3, 0)], [(0, 0)])
    jumping = Plan(scenario, [JUMP, 1], [0, 2], jumps=[[0, 2]])
    playback = make_playback(jumping, th.make_n_scheme(scenario))
    assert playback.spent.tolist() == [0, 0, 10] and playback.least_total.tolist() == [30, 10, 10]


def test_the_page_shows_robots_where_the_plan_has_them(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((2, 2))), [(0, 0)]))
    rng = np.random.default_rng(3)
    jumper = th.Scenario(th.Area("hexagonal", np.zeros((4, 9))), [(8, 3)], [(0, 0), (4, 0)])
    plans = [Plan(jumper, [3, WAIT, JUMP, 1, JUMP], [0, 4, 5], jumps=[[2, 34], [4, 35]])]
    # Fewer plans may pass no corner.
    plans += [make_plan(random_scenario(seed, sides=(6, 14)), "greedy") for seed in range(12)]
    bent = 0
    for plan in plans:
        area, cells = plan.scenario.area, list(plan.cells_by_step())
        # To and fro, past the steps that the page keeps.
        steps = [*range(plan.steps + 1), *rng.integers(0, plan.steps + 1, 12).tolist()]
        text = base64.b64encode(encode(*Desk().show(plan))).decode()
        for step, (x0, y0, x1, y1, state, bx, by) in zip(steps, shown.page.evaluate(PLAY, [text, steps]), strict=True):
            here, there = cells[step], cells[min(step + 1, plan.steps)]
            np.testing.assert_array_equal(np.array(state) == HIDDEN, here < 0)
            for cell, x, y in ((here, x0, y0), (there, x1, y1)):
                seen = cell >= 0
                px, py = area.tessellation.centre_of_cell(*area.cell_to_xy(cell[seen]))
                np.testing.assert_allclose(np.array(x)[seen], px, rtol=1e-6)
                np.testing.assert_allclose(np.array(y)[seen], py, rtol=1e-6)
            cell, later = (np.where(own < 0, plan.last_cell_of_robot, own) for own in (here, there))
            np.testing.assert_allclose(np.stack([bx, by], axis=-1), bends_of(area, cell, later), atol=1e-5)
            bent += np.count_nonzero(np.hypot(bx, by))
            if step < plan.steps:
                sets = plan.sets_at(step + 1)
                np.testing.assert_array_equal(np.flatnonzero(np.isin(state, [MOVING, FINAL])), sets.filled)
                np.testing.assert_array_equal(np.flatnonzero(np.isin(state, [WAITING, STRANDED])), sets.waiting)
                is_last = plan.arrived & (np.diff(plan.first_action) == step + 1)
                np.testing.assert_array_equal(np.array(state) == FINAL, is_last)
    assert bent > 20
    assert shown.faults == []


def test_plan_from_lists_of_no_robots_plays():
    scenario = th.Scenario(th.Area("square", [[0, 0]]), [(0, 0)])
    playback = make_playback(plan_from_lists(scenario, []), th.make_n_scheme(scenario))
    assert playback.arrived.tolist() == playback.spent.tolist() == [0]


RUNNERS = """async ([width, height, frames]) => {
  const { Runners } = await import("./viewer.js");
  const doc = { header: { tessellation: "triangular" }, width, height }, runners = new Runners();
  return frames.map(([cells, steps]) => {
    runners.move(doc, Int32Array.from(cells), new Uint8Array(cells.length), steps);
    return [[...runners.bx], [...runners.by]];
  });
}"""


def test_robots_that_run_live_bend_too(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((2, 2))), [(0, 0)]))
    area = th.Area("triangular", np.zeros((5, 8)))
    rng, steps = np.random.default_rng(4), area.tessellation.step_of_direction
    cells = area.xy_to_cell([3, 4, 4, 3], [1, 1, 2, 3])
    sides = area.tessellation.orientation_of_cell(*area.cell_to_xy(cells))
    for _ in range(12):
        dx, dy = steps[sides, rng.integers(0, 12, 4)].T
        x, y = area.cell_to_xy(cells)
        later = area.xy_to_cell(x + dx, y + dy)
        # A frame without a step, in which another robot joins, leaves the others on their way; two steps do not.
        frames = [[cells, 0], [later, 1], [[*later, 0], 0], [[*later, 0], 2]]
        asked = [8, 5, [[list(map(int, own)), count] for own, count in frames]]
        still, moved, joined, again = (np.transpose(way) for way in shown.page.evaluate(RUNNERS, asked))
        assert not still.any() and not again.any()
        np.testing.assert_allclose(moved, bends_of(area, cells, later), atol=1e-5)
        np.testing.assert_allclose(joined, [*moved, (0, 0)], atol=1e-5)
    assert shown.faults == []
