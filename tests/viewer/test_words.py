"""The words of the page: every number and every choice tells what it means."""

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import is_near
from trihex.optimum import OBJECTIVES
from trihex.pictures import palette
from trihex.planners import PLANNERS, make_plan, options_of, planner_named
from trihex.planners.fcost import RULES
from trihex.viewer.hints import OPTION_HINTS, PLANNER_HINTS, planner_hints


def crowd(**frame):
    area = th.Area("square", np.zeros((5, 12)), frame=th.Frame(**frame) if frame else None)
    return th.Scenario(area, [(11, 2)], [(x, y) for x in range(4) for y in range(5)], destination_capacity=1)


def test_every_planner_and_every_choice_has_a_line_of_its_own():
    hints = planner_hints()
    assert set(hints) == set(PLANNERS) == set(PLANNER_HINTS)
    for name, hint in hints.items():
        assert hint["line"] == PLANNER_HINTS[name] and set(hint["options"]) == set(options_of(name))
        for option, choices in hint["options"].items():
            assert all(choices.values()) and set(choices) == set(OPTION_HINTS[option])
    assert tuple(hints["fcost"]["options"]["rule"]) == RULES
    assert tuple(hints["optimal"]["options"]["objective"]) == tuple(OBJECTIVES)


def test_a_planner_without_a_line_tells_the_first_of_its_docstring(monkeypatch):
    monkeypatch.delitem(PLANNER_HINTS, "greedy")
    assert planner_hints()["greedy"]["line"] == planner_named("greedy").__doc__.partition("\n")[0]


def test_a_rule_is_chosen_from_a_menu_that_explains_it(open_viewer):
    shown = open_viewer(crowd())
    page = shown.page
    assert PLANNER_HINTS["fcost"] in page.locator("[data-section=Plan]").inner_text()
    page.get_by_text("Options of the planner").click()
    page.get_by_label("Rule", exact=True).select_option("queue")
    assert OPTION_HINTS["rule"]["queue"] in page.locator("[data-section=Plan]").inner_text()
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    assert shown.ask("app.runs[0].summary.total_time") == make_plan(crowd(), rule="queue").total_time
    page.get_by_label("Planner", exact=True).select_option("astar")
    assert PLANNER_HINTS["astar"] in page.locator("[data-section=Plan]").inner_text()
    assert page.get_by_label("Memory limit").get_attribute("type") == "number"


def unexplained(shown, rows):
    return shown.page.evaluate(
        "(rows) => [...document.querySelectorAll(rows)].filter((row) => !row.title.endsWith('.'))"
        ".map((row) => row.textContent)",
        rows,
    )


def test_every_number_has_a_sentence(open_viewer):
    shown = open_viewer(crowd())
    page = shown.page
    page.get_by_label("Planner beside it").select_option("greedy")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job")
    shown.click(0, 0)
    page.get_by_label("Number of the robot to follow").fill("3")
    page.keyboard.press("Enter")
    assert page.locator(".results tbody tr").count() > 8 and page.locator(".robot tbody tr").count() == 6
    assert unexplained(shown, ".results tbody tr, .robot tbody tr, .sofar, .clock") == []
    assert "a move over an edge takes 10, a wait 10" in shown.text(".results")
    shown.press("Run live")
    shown.wait("app.live && app.live.last.is_over && app.live.summary")
    assert page.locator(".results tbody tr").count() > 7 and unexplained(shown, ".results tbody tr") == []
    untitled = "[data-section=Live] label:not([title]), .inner label.field:not([title]):not(:has([data-option]))"
    assert page.locator(untitled).count() == 0
    assert shown.page.evaluate("[...document.querySelectorAll('[title]')].filter((e) => e.title === 'undefined')") == []
    assert unexplained(shown, ".sets, .chart figure, [data-section='Cells and rules'] .inner label") == []


def test_two_plans_tell_what_their_difference_is_made_of(open_viewer):
    one, two = (make_plan(crowd(), planner) for planner in ("greedy", "optimal"))
    shown = open_viewer(one)
    shown.page.get_by_label("Planner beside it").select_option("optimal")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job")
    first, second = th.make_report(one), th.make_report(two)
    waits, moves = first.total_waiting - second.total_waiting, first.total_distance - second.total_distance
    assert waits + moves == one.total_time - two.total_time > 0
    words = [f"{what} {abs(by)} {'more' if by > 0 else 'less'}" if by else f"{what} as much"
             for what, by in (("wait", waits), ("move", moves))]  # fmt: skip
    assert " and ".join(words) in shown.text(".results").replace("\u2009", "")


def test_what_was_used_and_what_is_still_needed_is_told_in_words(open_viewer):
    plan = make_plan(crowd(), "greedy")
    shown = open_viewer(plan)
    spent = int(plan.scenario.robot_count * 10)
    assert shown.text(".sofar").startswith(f"0 of {plan.total_time:,} time units used. If nobody".replace(",", " "))
    shown.page.keyboard.press(".")
    assert shown.text(".sofar").startswith(f"{spent} of ")
    shown.page.keyboard.press("End")
    assert shown.text(".sofar") == f"All {plan.total_time:,} time units are used.".replace(",", " ")


def test_steps_are_seconds_where_there_are_metres(open_viewer):
    plan = make_plan(crowd(cell_size=0.5), "greedy")
    shown = open_viewer(plan)
    seconds = plan.steps * 0.5 * plan.scenario.area.tessellation.longest_move
    assert shown.table()["Steps"] == [str(plan.steps)]
    assert shown.table()["Last arrival"] == [f"{seconds:.1f} s"]
    assert shown.ask("app.runs[0].step_seconds") == pytest.approx(0.5 * 2**0.5)


def test_robots_have_the_names_that_they_have_in_pictures(open_viewer):
    few = th.Scenario(th.Area("square", np.zeros((3, 5))), [(4, 1)], [(0, 0), (2, 1)])
    shown = open_viewer(few)
    shown.page.mouse.move(*map(float, shown.place(2, 1)))
    assert shown.text(".readout") == "cell (2, 1) · free · robot b (number 1)"
    shown.press("Move")
    shown.click(2, 1)
    assert "Robot b (number 1) starts at (2, 1)" in shown.text(".robot")
    # The same disc with an "a" and with a "b" on it.
    scale, left, top = shown.view()
    discs = [shown.pixels()[int(top + y * scale) :, int(left + x * scale) :] for x, y in ((0, 0), (2, 1))]
    a, b = (disc[int(0.3 * scale) : int(0.7 * scale), int(0.3 * scale) : int(0.7 * scale)] for disc in discs)
    assert (~is_near(a, palette.MOVING)).any() and (a != b).any()
    many = th.Scenario(th.Area("square", np.zeros((3, 12))), [(11, 1)], np.arange(27))
    shown = open_viewer(many)
    shown.page.mouse.move(*map(float, shown.place(2, 1)))
    assert shown.text(".readout").endswith("robot 14")


def test_there_is_no_seed_where_nothing_is_drawn_by_chance(open_viewer):
    shown = open_viewer(crowd())
    shown.press("New…")
    dialog = shown.page.get_by_role("dialog")
    dialog.get_by_label("Kind").select_option("empty")
    assert not dialog.get_by_label("Seed").is_visible()
    dialog.get_by_label("Kind").select_option("caves")
    assert dialog.get_by_label("Seed").is_visible()
