"""Who owns which cells now: in plans and in live runs, against the rules, in colours and in words; robots glide."""

import base64

import numpy as np

import trihex as th
from tests.viewer.pages import is_near
from tests.viewer.test_live import Page
from trihex.kernels.codes import LATE
from trihex.pictures import palette
from trihex.pictures.ways import places_between
from trihex.planners import make_plan
from trihex.viewer.bundle import encode
from trihex.viewer.desk import Desk

RULES = [("triangular", "costs", "forbid"), ("triangular", "costs", "allow"), ("hexagonal", "steps", "forbid")]
OWNED = """async ([text, times]) => {
  const { decode, documentOf, Playback } = await import("./viewer.js");
  const bundle = decode(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
  const playback = new Playback(bundle, documentOf(bundle.header.document, bundle.arrays));
  return times.map((time) => {
    playback.seek(Math.floor(time));
    const all = Array.from({ length: playback.count }, (_, r) => r);
    return all.map((r) => [playback.held(r, time % 1), playback.alsoHeld(r)]);
  });
}"""
RUN = """async ([header, frames]) => {
  const { Runners } = await import("./viewer.js");
  const runners = new Runners();
  return frames.map(({ cells, sets, came_from, share }) => {
    const as = (Kind, list) => (list ? Kind.from(list) : undefined);
    runners.move(header, { cells: as(Int32Array, cells), sets: as(Uint8Array, sets),
      came_from: as(Int32Array, came_from), share: as(Uint8Array, share) }, 1);
    const all = cells.map((_, r) => r);
    return [[...runners.x1], [...runners.y1], all.map((r) => [runners.held(r), runners.alsoHeld(r)])];
  });
}"""


def crowd(shape, clock, following):
    area = th.Area(shape, np.zeros((9, 16)))
    robots = [(x, y) for x in range(5) for y in range(1, 8, 2)]
    return th.Scenario(area, [(14, 4)], robots, clock=clock, following=following)


def owned_in(plan, time):
    """Return the cells that each robot owns by the rule, as (one, the one that it enters, too) or -1."""
    scenario, layout = plan.scenario, plan.scenario.area.layout
    duration, found = scenario.duration_of_direction, []
    for robot, cell in enumerate(scenario.robots.tolist()):
        begun, own = 0, (-1, -1)
        actions = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]].tolist()
        for action in actions:
            is_move = action < LATE
            lasts = duration[action] if is_move else 1
            (site,) = layout.cell_to_site(np.array([cell]))
            after = cell
            if is_move:
                (after,) = layout.site_to_cell(site + layout.offset_of_direction[site & 1, [action]]).tolist()
            if begun <= time < begun + lasts:
                enters = -1 if after in scenario.destinations else after
                if after == cell:
                    own = (cell, -1)
                elif scenario.following == "forbid":
                    own = (cell, enters)
                else:
                    own = (cell if 2 * (time - begun) < lasts else enters, -1)
            begun, cell = begun + lasts, after
        found.append(own)
    return found


def test_robots_of_a_plan_own_what_the_rules_say(open_viewer):
    shown = open_viewer(crowd(*RULES[0]))
    for rules in RULES:
        plan = make_plan(crowd(*rules), "fcost")
        text = base64.b64encode(encode(*Desk().show(plan))).decode()
        compared, times = 0, [*np.arange(0, plan.steps - 1, max(1, plan.steps // 12)) + 0.25, plan.steps - 0.75]
        for time, told in zip(times, shown.page.evaluate(OWNED, [text, list(map(float, times))]), strict=True):
            there = [own for own in zip(told, owned_in(plan, time), strict=True) if own[1] != (-1, -1)]
            assert [tuple(one) for one, _ in there] == [other for _, other in there], (rules, time)
            compared += len(there)
        assert compared > 100


def test_robots_that_run_live_glide_and_own_what_the_engine_says(open_viewer):
    shown = open_viewer(crowd(*RULES[0]))
    for rules in RULES:
        compare_live(shown, *rules)


def compare_live(shown, name, clock, following):
    scenario = crowd(name, clock, following)
    page = Page(scenario)
    fleet = page.desk.shelf.live(page.name).trial.execution.fleet
    duration, frames, expected = scenario.duration_of_direction, [], []
    while not page.header["is_over"]:
        answer = page.ask({"op": "advance", "live": page.name})
        page.take(answer)
        frames.append({key: answer.arrays[key].tolist() for key in ("cells", "sets", "came_from", "share")})
        moves = (fleet.came_from >= 0) & (fleet.due > fleet.tick)
        lasts = duration[np.minimum(fleet.heading, duration.size - 1)]
        done = np.where(moves, 1 - (fleet.due - fleet.tick) / lasts, 0)
        here = scenario.area.layout.site_to_cell(np.where(moves, fleet.came_from, fleet.site))
        there = scenario.area.layout.site_to_cell(fleet.site)
        expected.append((*places_between(scenario.area, here, there, done), fleet.cells_owned.copy(), moves))
    header = {"header": {"tessellation": name, "clock": clock, "following": following}, "height": 9, "width": 16}
    told = shown.page.evaluate(RUN, [header, frames])
    assert any(moves.any() for *_, moves in expected) == (clock == "costs")  # else they are at centres after each step
    ends = scenario.destinations
    for (x, y, own), (right, down, owned, moves) in zip(told, expected, strict=True):
        is_there = owned[0] >= 0
        np.testing.assert_allclose(np.array([x, y])[:, is_there], np.array([right, down])[:, is_there], atol=0.02)
        for robot in np.flatnonzero(moves & ~np.isin(owned[0], ends)).tolist():
            if following == "forbid":
                assert own[robot] == [owned[1, robot], owned[0, robot]]
            elif owned[1, robot] < 0:
                assert own[robot] == [owned[0, robot], -1]


def test_owned_cells_are_seen_told_and_can_be_hidden(open_viewer):
    plan = make_plan(crowd("hexagonal", "steps", "forbid"), "fcost")
    shown = open_viewer(plan)
    page, box = shown.page, shown.page.get_by_label("Cells they own")
    page.locator(".scrub").fill("3")
    shown.wait("app.runs[0].playback.step === 3")
    assert "owned by a robot" in shown.text(".legend") and shown.text(".clock") == f"step 3 / {plan.steps}"
    owned = {cell for own in owned_in(plan, 3) for cell in own if cell >= 0}
    tinted = ~is_near(shown.colours(shift=(0, 0.44)), palette.FREE, 8).ravel()  # beside robots and their way
    tinted[plan.scenario.destinations] = False
    assert set(np.flatnonzero(tinted)) == owned
    x, y = next((cell % 16, cell // 16) for cell in owned)
    page.mouse.move(*map(float, shown.place(x, y)))
    assert "owned by robot" in shown.text(".readout")
    shown.keep("owned-cells")
    box.uncheck()
    assert "owned" not in shown.text(".legend") and shown.ask("app.panes[0].owns") is False
    box.check()
    shown.press("Run live")
    shown.wait("app.live && app.live.last.step > 6 && app.panes[0].owns")
    assert "owned by a robot" in shown.text(".legend") and shown.text(".clock").startswith("step ")
    shown.press("Stop")
    page.get_by_text("Rules", exact=True).click()
    page.get_by_label("Following").select_option("allow")
    assert not box.is_visible() and shown.faults == []
