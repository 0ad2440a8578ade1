"""Windows of all sizes: the panel folds, two plans stand as they are largest, what is needed stays in sight."""

import numpy as np
import pytest

import trihex as th
from trihex.planners import make_plan

SIZES = [(1400, 900), (1024, 768), (800, 600), (390, 844)]
# Labels that are cut off, or leave the border of their button.
TIGHT = """() => [...document.querySelectorAll("button, .caption, .legend span")].filter((e) => {
  if (!e.checkVisibility()) return false;
  const range = document.createRange();
  range.selectNodeContents(e);
  const text = range.getBoundingClientRect(), box = e.getBoundingClientRect(), least = e.tagName === "BUTTON" ? 2 : 0;
  return text.left < box.left + least || text.right > box.right - least || e.scrollWidth > e.clientWidth + 1;
}).map((e) => e.textContent)"""


def wide(tessellation="hexagonal", height=8, width=30):
    return th.Scenario(th.Area(tessellation, np.zeros((height, width)), "wide"), [(20, 4)], [(1, 1), (2, 6), (3, 3)])


def in_sight(shown, name):
    width, height = shown.page.viewport_size["width"], shown.page.viewport_size["height"]
    box = shown.page.get_by_role("button", name=name, exact=True).bounding_box()
    inside = box["x"] >= 0 and box["y"] >= 0
    return inside and box["x"] + box["width"] <= width and box["y"] + box["height"] <= height


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_plan_and_play_stay_in_sight_and_labels_have_room(open_viewer, width, height):
    shown = open_viewer(wide(), viewport={"width": width, "height": height})
    assert in_sight(shown, "Plan") and in_sight(shown, "Play")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    shown.page.evaluate("document.querySelector('#trihex').app.planning.plan(1)")
    shown.wait("app.runs[1] && !app.job")
    assert in_sight(shown, "Plan") and in_sight(shown, "Play")
    shown.keep(f"small-{width}")
    assert shown.page.evaluate(TIGHT) == []
    assert shown.page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    assert shown.faults == []


def test_the_panel_folds(open_viewer):
    shown = open_viewer(wide(), viewport={"width": 800, "height": 600})
    panel, button = shown.page.locator(".panel"), shown.page.get_by_role("button", name="Controls")
    canvas = shown.page.locator("canvas").first
    assert not panel.is_visible() and button.get_attribute("aria-expanded") == "false"
    large = canvas.bounding_box()["width"]
    button.click()
    assert panel.is_visible() and button.get_attribute("aria-expanded") == "true"
    assert canvas.bounding_box()["width"] < large - 200
    button.click()
    assert not panel.is_visible()
    assert open_viewer(wide(), viewport={"width": 1024, "height": 768}).page.locator(".panel").is_visible()


@pytest.mark.parametrize(("height", "width", "is_above"), [(8, 40, True), (40, 8, False)])
def test_two_plans_stand_as_they_are_largest(open_viewer, height, width, is_above):
    area = th.Area("square", np.zeros((height, width)))
    shown = open_viewer(make_plan(th.Scenario(area, [(4, 4)], [(1, 1)]), "greedy"))
    alone = shown.view()[0]
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job")
    first, second = (canvas.bounding_box() for canvas in shown.page.locator("canvas").all())
    assert (second["y"] > first["y"] + 100) == is_above and (second["x"] > first["x"] + 100) != is_above
    assert shown.view()[0] > 0.7 * alone  # side by side, or above one another, they would have half the room
    shown.press("End comparing")
    shown.wait(f"Math.abs(app.panes[0].view.scale - {alone}) < 0.01")
