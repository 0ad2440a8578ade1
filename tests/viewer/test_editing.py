"""Editing, undoing, following, and doing it all by keyboard or by touch."""

import numpy as np
import pytest

import trihex as th
from tests.sweeps import swept
from tests.viewer.pages import is_near
from trihex.pictures import palette
from trihex.planners import make_plan


def small(tessellation="square"):
    area = th.Area(tessellation, np.zeros((8, 12)), "small")
    return th.Scenario(area, [(10, 4)], [(1, 1), (2, 6)])


def robots(shown):
    return [(cell % 12, cell // 12) for cell in shown.ask("[...app.doc.robots]")]


def destinations(shown):
    return [(cell % 12, cell // 12) for cell in shown.ask("[...app.doc.destinations]")]


def walls(shown):
    y, x = np.nonzero(is_near(shown.colours(), palette.BARRIER))
    return sorted(zip(x.tolist(), y.tolist(), strict=True))


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal", "square"][: swept(3)])
def test_things_are_placed_moved_and_taken_away(open_viewer, tessellation):
    shown = open_viewer(small(tessellation))
    shown.press("Robot")
    shown.click(5, 5)
    assert robots(shown) == [(1, 1), (2, 6), (5, 5)]
    shown.click(1, 1)
    assert robots(shown) == [(2, 6), (5, 5)]
    shown.press("Destination")
    shown.click(0, 0)
    assert destinations(shown) == [(10, 4), (0, 0)]
    shown.press("Move")
    shown.drag([(2, 6), (7, 7)])
    assert robots(shown) == [(7, 7), (5, 5)]
    shown.drag([(0, 0), (3, 0)])
    assert destinations(shown) == [(10, 4), (3, 0)]
    shown.drag([(7, 7), (10, 4)])  # taken
    assert robots(shown) == [(7, 7), (5, 5)] and "taken" in shown.text(".status")
    shown.press("Wall")
    shown.click(5, 5)
    assert robots(shown) == [(7, 7)] and walls(shown) == [(5, 5)]
    shown.press("Robot")
    shown.click(5, 5)
    assert robots(shown) == [(7, 7)] and "barrier" in shown.text(".status")
    shown.press("Erase")
    for cell in ((3, 0), (7, 7), (5, 5)):
        shown.click(*cell)
    assert (robots(shown), destinations(shown), walls(shown)) == ([], [(10, 4)], [])
    assert "no robots yet" in shown.text(".status")


def test_everything_can_be_undone_and_done_again(open_viewer):
    shown = open_viewer(small())
    page = shown.page
    seen = [walls(shown)]
    shown.press("Wall")
    for cell in ((3, 3), (4, 3), (5, 3)):
        shown.click(*cell)
        seen.append(walls(shown))
    page.get_by_role("radio", name="Hexagonal").check(force=True)
    assert shown.text(".name").endswith("hexagonal")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    shown.press("Undo")
    assert shown.text(".results") == "No plan yet."
    shown.press("Redo")
    assert "Total time" in shown.table()
    shown.press("Undo")
    shown.press("Undo")
    assert shown.text(".name").endswith("square")
    for there in seen[-2::-1]:
        page.keyboard.press("Control+z")
        assert walls(shown) == there
    assert page.get_by_role("button", name="Undo").is_disabled()
    for there in seen[1:]:
        page.keyboard.press("Control+Shift+z")
        assert walls(shown) == there
    shown.press("Wall")
    shown.click(8, 0)  # another future
    assert page.get_by_role("button", name="Redo").is_disabled()


def test_a_fast_hand_leaves_no_gaps_and_a_broad_brush_paints_discs(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((16, 24))), [(0, 15)]))
    shown.press("Wall")
    start, end = shown.place(1, 2), shown.place(20, 2)
    shown.page.mouse.move(*map(float, start))
    shown.page.mouse.down()
    shown.page.mouse.move(*map(float, end))
    shown.page.mouse.up()
    assert walls(shown) == [(x, 2) for x in range(1, 21)]
    shown.page.get_by_label("Width of the brush in cells").fill("5")
    shown.click(12, 9)
    disc = [(x, y) for x in range(24) for y in range(16) if (x - 12) ** 2 + (y - 9) ** 2 < 2.5**2]
    assert walls(shown) == sorted([(x, 2) for x in range(1, 21)] + disc)


def test_one_robot_is_followed_with_its_moves_waits_and_time(open_viewer):
    area = th.Area("hexagonal", [[0, 0, 0, 0, 0, 0], [1, 1, 0, 1, 1, 1], [0, 0, 0, 0, 0, 0]])
    starts = [(0, 0), (1, 0), (0, 2), (1, 2), (2, 2), (3, 2)]
    plan = make_plan(th.Scenario(area, [(5, 0)], starts), "greedy")
    assert plan.waiting_of_robot[5] > 0
    shown = open_viewer(plan)
    shown.press("Move")
    shown.click(3, 2)
    shown.page.locator(".scrub").fill(str(plan.steps))
    shown.wait("app.clock.at > 0")
    rows = shown.page.locator(".robot tbody tr").all()
    told = {row.locator("th").inner_text(): row.locator("td").all_inner_texts() for row in rows}
    assert told["moves d"] == [str(plan.distance_of_robot[5])] * 2
    assert told["waits w"] == [str(plan.waiting_of_robot[5])] * 2
    assert told["time t = d + w"] == [str(plan.time_of_robot[5])] * 2
    assert f"robot f (number 5) at (5, 0), arrived at step {plan.arrival_step_of_robot[5]}" in shown.text(".robot")
    shown.press("None")
    assert "Click a robot" in shown.text(".robot")


def test_conflicts_of_a_plan_are_shown_and_lead_to_their_step(open_viewer):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0, 0]]), [(3, 0)], [(0, 0), (1, 0)])
    shown = open_viewer(th.Plan(scenario, [1, 1, 1, 3, 1, 1, 1], [0, 3, 7]))
    assert shown.table()["Conflicts"] == ["1"]
    shown.press("To the start")
    shown.page.get_by_text("exchange cells (0, 0) and (1, 0)").click()
    assert shown.text(".clock").startswith("step 0")


def test_robots_that_cannot_arrive_are_told_and_drawn_otherwise(open_viewer):
    scenario = th.Scenario(th.Area("square", [[0, 0, 1, 0], [0, 0, 1, 0]]), [(0, 0)], [(1, 1), (3, 1)])
    shown = open_viewer(scenario)
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    assert "1 robot cannot arrive" in shown.text(".status")
    assert shown.table()["Arrived"] == ["1 of 2"]
    beside = shown.colours(shift=(0, -0.2))
    assert is_near(beside[1, 3], palette.STRANDED) and not is_near(beside[1, 1], palette.STRANDED)


def test_rules_reach_the_planner(open_viewer):
    scenario = th.Scenario(th.Area("square", np.zeros((5, 5))), [(4, 4)], [(0, 0), (1, 0), (0, 1)])
    shown = open_viewer(scenario)
    page = shown.page
    page.locator("summary", has_text="Rules").last.click()
    page.get_by_label("Neighbours").select_option("edge")
    page.get_by_label("Costs").select_option("euclidean")
    page.get_by_label("Waiting cost w_t").fill("700")
    page.get_by_label("Arrivals per step and destination").fill("1")
    page.keyboard.press("Tab")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    area = th.Area(th.Tessellation("square", "edge", "euclidean"), np.zeros((5, 5)))
    rules = {"waiting_cost": 700, "destination_capacity": 1}
    wanted = make_plan(th.Scenario(area, [(4, 4)], scenario.robots, **rules), "fcost")
    summary = shown.ask("app.runs[0].summary")
    assert (summary["neighbourhood"], summary["costs"], summary["waiting_cost"]) == ("edge", "euclidean", 700)
    assert summary["total_time"] == wanted.total_time and summary["destination_capacity"] == 1


def test_without_a_mouse(open_viewer):
    shown = open_viewer(small())
    page = shown.page
    canvas = page.locator("canvas").first
    assert "12 by 8 cells" in canvas.get_attribute("aria-label")
    canvas.focus()
    page.keyboard.press("w")
    page.keyboard.press("ArrowRight")
    assert shown.text(".readout").startswith("cell (7, 4) · free")
    page.keyboard.press("Enter")
    assert walls(shown) == [(7, 4)]
    page.keyboard.press("r")
    for key in ("ArrowUp", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    assert robots(shown)[-1] == (7, 2)
    page.keyboard.press("Shift+ArrowLeft")
    page.keyboard.press("d")
    page.keyboard.press("Enter")
    assert destinations(shown) == [(10, 4), (0, 2)]
    page.keyboard.press("p")
    shown.wait("app.runs[0] && !app.job")
    page.keyboard.press(".")
    assert shown.text(".clock").startswith("step 1 /")
    page.keyboard.press(",")
    assert shown.text(".clock").startswith("step 0 /")
    page.keyboard.press("?")
    assert "no two ever collide" in page.get_by_role("dialog").inner_text()
    page.keyboard.press("Escape")
    assert not page.get_by_role("dialog").is_visible()


def test_every_control_has_a_name(open_viewer):
    shown = open_viewer(small())
    nameless = shown.page.evaluate(
        """() => [...document.querySelectorAll("button, input, select, canvas, progress")].filter((e) =>
             !(e.ariaLabel || e.textContent.trim() || e.labels?.[0]?.textContent.trim())).map((e) => e.outerHTML)"""
    )
    assert nameless == []


def test_touch_paints_with_one_finger_and_zooms_with_two(open_viewer):
    shown = open_viewer(small(), has_touch=True, viewport={"width": 420, "height": 800})
    session = shown.page.context.new_cdp_session(shown.page)

    def touch(kind, *points):
        touches = [{"x": float(x), "y": float(y), "id": number} for number, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": touches})

    shown.page.get_by_role("button", name="Wall").tap()
    touch("Start", shown.place(2, 3))
    touch("Move", shown.place(6, 3))
    touch("End")
    assert walls(shown) == [(x, 3) for x in range(2, 7)]
    before = shown.view()[0]
    x, y = shown.place(6, 4)
    touch("Start", (x - 20, y), (x + 20, y))
    touch("Move", (x - 60, y), (x + 60, y))
    touch("End")
    assert shown.view()[0] > 1.5 * before
    assert shown.ask("app.doc.barriers.reduce((a, b) => a + b)") == 5  # nothing was painted on the way


@pytest.mark.parametrize(("width", "height"), [(1680, 1000), (1024, 700), (820, 600), (600, 900), (360, 640)])
def test_it_fits_windows_of_any_size(open_viewer, width, height):
    shown = open_viewer(make_plan(small("hexagonal"), "greedy"), viewport={"width": width, "height": height})
    shown.keep(f"window-{width}x{height}")
    assert shown.page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    box = shown.page.locator("canvas").first.bounding_box()
    assert box["width"] > 0.35 * width and box["height"] >= 250
    outside = shown.page.evaluate(
        """() => [...document.querySelectorAll("button, input, select")].filter((e) => {
             const { left, right, width } = e.getBoundingClientRect();
             return e.checkVisibility() && width > 1 && (left < -1 || right > innerWidth + 1);
           }).map((e) => e.ariaLabel ?? e.textContent)"""
    )
    assert outside == []


def test_light_and_dark_are_told_apart_and_remembered(open_viewer):
    shown = open_viewer(small(), color_scheme="dark")
    dark = shown.colours()[0, 5]
    assert dark.max() < 90
    shown.press("Light")
    assert is_near(shown.colours()[0, 5], palette.FREE)
    shown.page.reload()
    shown.wait("app.doc")
    assert is_near(shown.colours()[0, 5], palette.FREE)


def test_work_can_be_cancelled(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("triangular", np.zeros((400, 400))), [(0, 0)]))
    shown.press("Grow the field")
    shown.wait("app.growth && app.growth.last > 1")
    shown.press("Cancel")
    shown.page.wait_for_function("() => document.querySelector('.status').textContent === 'Cancelled.'")
    assert not shown.page.get_by_role("progressbar").is_visible()


def test_numbers_and_arrows_of_the_field(open_viewer):
    scenario = th.Scenario(th.Area("hexagonal", np.zeros((5, 7))), [(3, 2)])
    shown = open_viewer(scenario)
    plain = shown.pixels()
    shown.page.get_by_label("Colours").check()
    shown.page.get_by_label("Arrows").check()
    shown.wait("app.fields?.directions")
    d_scheme = th.make_d_scheme(th.make_n_scheme(scenario))
    for cell in (0, 9, 34):
        x, y = cell % 7, cell // 7
        shown.page.mouse.move(*map(float, shown.place(x, y)))
        far = d_scheme.n_scheme.distance[y, x]
        best = ", ".join(d_scheme.names_of_cell(cell))
        assert shown.text(".readout") == f"cell ({x}, {y}) · free · {far} to go · best {best}"
    arrows = shown.pixels()
    assert (arrows != plain).any()
    shown.page.get_by_label("Numbers").check()
    shown.keep("numbers-and-arrows")
    assert (shown.pixels() != arrows).any()
