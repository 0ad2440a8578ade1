"""The curves of a plan, against robots that are followed one by one; and the page that plays it, against the plan."""

import base64
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

import trihex as th
from tests.strategies import random_scenario, scenarios, with_slowness
from trihex.kernels.codes import JUMP, WAIT
from trihex.pictures.ways import bends_of, places_between
from trihex.planners import make_plan
from trihex.plans import Plan, Walk, make_playback, plan_from_lists
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


@pytest.mark.parametrize("seed", range(40))
def test_curves_in_ticks_are_those_of_robots_followed_one_by_one(seed):
    plan = wandering_plan(seed)
    scenario, n_scheme = plan.scenario, th.make_n_scheme(plan.scenario)
    playback = make_playback(plan, n_scheme)
    curves = np.zeros((5, plan.steps + 1), dtype=int)
    for robot in range(scenario.robot_count):
        cells, ticks = plan.cells_of_robot(robot).tolist(), plan.ticks_of_robot(robot).tolist()
        first = plan.first_action[robot]
        for tick in range(plan.steps + 1):
            on_way = next((i for i in range(len(ticks) - 1) if ticks[i] < tick <= ticks[i + 1]), None)
            if on_way is not None:
                curves[int(plan.actions[first + on_way] == WAIT), tick] += 1
            if plan.arrived[robot]:
                done = on_way + 1 if on_way is not None else 0 if tick == 0 else len(cells) - 1
                spent = min(tick, ticks[-1])
                # Whoever has begun a move must end it, and goes on from there.
                ahead = (
                    ticks[done] - spent + int(n_scheme.distance_of_cell(cells[done])) * int(scenario.slowness[robot])
                )
                curves[2:, tick] += (tick >= ticks[-1], spent, spent + ahead)
    for name, curve in zip(("moving", "waiting", "arrived", "spent", "least_total"), curves, strict=True):
        assert getattr(playback, name).tolist() == curve.tolist(), name


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


def wandering_plan(seed):
    """Robots that wander, some into the destination, by clock costs, some slower; they may collide."""
    rng = np.random.default_rng(seed)
    scenario = replace(random_scenario(seed, sides=(4, 8)), clock="costs", waiting_cost=None, corners="allow")
    scenario = with_slowness(scenario, seed) if seed % 3 == 0 else scenario
    area, lists = scenario.area, []
    for cell in scenario.robots.tolist():
        own: list[int] = []
        for _ in range(0 if cell in scenario.destinations else 6):
            x, y = cell % area.width, cell // area.width
            steps = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y))]
            k = int(rng.integers(len(steps) + 1))
            to_x, to_y = (x, y) if k == len(steps) else np.add((x, y), steps[k]).tolist()
            is_inside = 0 <= to_x < area.width and 0 <= to_y < area.height and k < len(steps)
            is_open = is_inside and not area.barriers[to_y, to_x]
            own.append(k if is_open else WAIT)
            cell = to_y * area.width + to_x if is_open else cell
            if cell in scenario.destinations:
                break
        lists.append(own)
    return plan_from_lists(scenario, lists)


def test_the_page_shows_robots_between_centres_while_moves_last(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((2, 2))), [(0, 0)]))
    rng, bent = np.random.default_rng(5), 0
    plans = [wandering_plan(seed) for seed in range(30)]
    for plan in [plan for plan in plans if plan.scenario.robot_count and not plan.has_steps]:
        area, walks = plan.scenario.area, {}
        walk = Walk(plan)
        for step in range(plan.steps + 1):
            walk.go_to(step)
            cells = (area.layout.site_to_cell(site) for site in (walk.site, walk.next_site()))
            here, there = (own.copy() for own in cells)
            places = [np.array(places_between(area, here, there, walk.done(share))) for share in (0.0, 0.5, 1.0)]
            walks[step] = places, walk.sets()
        # To and fro, past the steps that the page keeps.
        steps = [*range(plan.steps + 1), *rng.integers(0, plan.steps + 1, 12).tolist()]
        text = base64.b64encode(encode(*Desk().show(plan))).decode()
        for step, (x0, y0, x1, y1, state, bx, by) in zip(steps, shown.page.evaluate(PLAY, [text, steps]), strict=True):
            (begin, middle, end), sets = walks[step]
            acts = plan.last_step_of_robot > step
            np.testing.assert_allclose(np.array([x0, y0]), begin, atol=1e-4)
            np.testing.assert_allclose(np.array([x1, y1])[:, acts], end[:, acts], atol=1e-4)
            np.testing.assert_allclose(np.array([bx, by])[:, acts], (middle - (begin + end) / 2)[:, acts], atol=1e-4)
            bent += np.count_nonzero(np.hypot(bx, by) > 1e-4)
            np.testing.assert_array_equal(np.flatnonzero(np.isin(state, [MOVING, FINAL])), sets.filled)
            np.testing.assert_array_equal(np.flatnonzero(np.array(state) == HIDDEN), sets.final)
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
    runners.move(doc, { cells: Int32Array.from(cells), sets: new Uint8Array(cells.length) }, steps);
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
