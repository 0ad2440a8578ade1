"""Picture: the viewer as the documentation shows it; `python -m tests.viewer.picture`."""

from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import trihex as th
from tests.viewer.conftest import FLAGS, find_browser
from tests.viewer.pages import Shown
from trihex.viewer.desk import Desk
from trihex.viewer.server import make_viewing

PATH = Path(__file__).parents[2] / "docs/figures/viewer.png"


def main():
    path = find_browser()
    if path is None:
        print(f"no Chrome or Chromium on this machine: {PATH.name} stays as it is")
        return
    area = th.make_rooms_area("hexagonal", 32, 40, seed=5)
    scenario = th.Scenario(area, [(20, 16)], th.random_robots(area, 120, seed=1, avoid=[(20, 16)]))
    desk = Desk()
    with make_viewing(desk, desk.show(scenario)).running() as viewing, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        shown = Shown(browser.new_page(viewport={"width": 1280, "height": 800}))
        shown.page.goto(viewing.address)
        shown.wait("app.doc")
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
        shown.page.wait_for_timeout(500)
        shown.page.screenshot(path=PATH)
        browser.close()
    # The method that keeps rare colours, such as that of the few robots that arrive.
    picture = Image.open(PATH).convert("RGB").quantize(255, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    picture.save(PATH, optimize=True)
    print(PATH)


if __name__ == "__main__":
    main()
