"""Pictures: the viewer as the documentation shows it; `python -m tests.viewer.picture`."""

from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import trihex as th
from tests.viewer.conftest import FLAGS, find_browser
from tests.viewer.pages import Shown
from trihex.studies.placing import place_robots
from trihex.viewer.desk import Desk
from trihex.viewer.server import make_viewing

FIGURES = Path(__file__).parents[2] / "docs/figures"


def main():
    path = find_browser()
    if path is None:
        print("no Chrome or Chromium on this machine: the pictures of the viewer stay as they are")
        return
    area = th.make_rooms_area("hexagonal", 32, 40, seed=5)
    scenario = th.Scenario(area, [(20, 16)], th.random_robots(area, 120, seed=1, avoid=[(20, 16)]))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        draw(browser, scenario, compare, FIGURES / "viewer.png")
        draw(browser, crossing(area), run_live, FIGURES / "viewer_live.png")
        browser.close()


def draw(browser, scenario, act, path):
    """Show a scenario, do something, and keep the picture."""
    desk = Desk()
    with make_viewing(desk, desk.show(scenario)).running() as viewing:
        shown = Shown(browser.new_page(viewport={"width": 1280, "height": 800}))
        shown.page.goto(viewing.address)
        shown.wait("app.doc && !app.job")
        act(shown)
        shown.page.wait_for_timeout(500)
        shown.page.screenshot(path=path)
        shown.page.close()
    # The method that keeps rare colours, such as that of the few robots that arrive.
    picture = Image.open(path).convert("RGB").quantize(255, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    picture.save(path, optimize=True)
    print(path)


def compare(shown):
    """A greedy plan beside the optimal one, and one robot followed."""
    shown.page.get_by_label("Colours").check()
    shown.page.get_by_label("Planner", exact=True).select_option("greedy")
    shown.page.get_by_label("Planner beside it").select_option("optimal")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job && app.runs[0].summary.lower_bound_name === 'optimum'")
    shown.page.locator(".scrub").fill("12.5")
    shown.page.get_by_label("Number of the robot to follow").fill("7")
    shown.page.keyboard.press("Enter")
    shown.page.locator(".results").evaluate("(e) => e.closest('details').scrollIntoView()")


def crossing(area):
    """Return robots in the west of an area whose destination lies in the east."""
    end = th.Scenario(area, [(36, 20)])
    return end.with_robots(place_robots(th.make_n_scheme(end), 120, "west", 1), 1)


def run_live(shown):
    """Robots in the fog that have seen half of the area, and walls just painted in their way."""
    shown.page.get_by_label("Sensing, in cells").fill("3")
    shown.page.get_by_label("line of sight").check()
    shown.press("Run live")
    shown.wait("app.live && app.live.last.step >= 18")
    shown.press("Pause")
    shown.wait("!app.live.isAsking && !app.live.frames.length && app.live.fraction === 1")
    for x in range(22, 27):
        for y in (6, 11):
            shown.click(x, y)
    shown.wait("!app.live.events.length && !app.live.isAsking")
    shown.page.locator(".results").evaluate("(e) => e.closest('details').previousElementSibling.scrollIntoView()")


if __name__ == "__main__":
    main()
