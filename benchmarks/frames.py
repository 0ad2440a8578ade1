"""Frames: how smoothly the viewer plays, and how soon a map is seen; `python -m benchmarks.frames [map]`.

Prints the median of the frames per second over 5 s, with software drawing in a window of 1280 x 800, and the time from
the click on a file to its picture. Needs Chrome or Chromium.
"""

import shutil
import sys
import tempfile
from pathlib import Path
from statistics import median

import numpy as np
from playwright.sync_api import sync_playwright
from tests.viewer.conftest import FLAGS, find_browser
from tests.viewer.pages import Shown

import trihex as th
from trihex.planners import make_plan
from trihex.viewer.desk import Desk
from trihex.viewer.folder import Folder
from trihex.viewer.server import make_viewing

FRAMES = """() => new Promise((done) => {
  const lengths = [], end = performance.now() + 5000;
  let last;
  const frame = (time) => {
    if (last !== undefined) lengths.push(time - last);
    last = time;
    if (performance.now() < end) requestAnimationFrame(frame);
    else done(lengths);
  };
  requestAnimationFrame(frame);
})"""
# The least of 50: what it costs where nobody else wants the processor.
DRAW = """() => {
  const { panes: [pane], runs: [{ playback }] } = document.querySelector("#trihex").app, times = [];
  for (let i = 0; i < 50; i++) {
    const begin = performance.now();
    playback.seek(playback.step + 1);
    pane.draw(0.5);
    times.push(performance.now() - begin);
  }
  return Math.min(...times);
}"""
CLICK = """(name) => new Promise((done) => {
  const app = document.querySelector("#trihex").app;
  const begin = performance.now(), before = app.doc;
  [...document.querySelectorAll(".files button")].find((button) => button.textContent === name).click();
  const look = () => (app.doc !== before && !app.panes[0].isStale.base ? requestAnimationFrame(
    () => done(performance.now() - begin)) : requestAnimationFrame(look));
  look();
})"""


def plan_of(side, robots):
    """Return a greedy plan on hexagons, a tenth of them barriers, with a destination each 200 cells or so."""
    area = th.make_random_area("hexagonal", side, side, density=0.1, seed=1)
    spots = [(x, y) for x in range(50, side, 205) for y in range(50, side, 205) if not area.barriers[y, x]]
    return make_plan(th.Scenario(area, spots, th.random_robots(area, robots, 1, avoid=spots)), "greedy")


def main(options: list[str]) -> None:
    folder = Path(tempfile.mkdtemp())
    maps = [Path(path) for path in options]
    for path in maps:
        shutil.copy(path, folder)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_browser(), args=list(FLAGS))
        for side, robots in ((512, 10_000), (2048, 100_000)):
            desk = Desk(Folder(folder))
            with make_viewing(desk, desk.show(plan_of(side, robots))).running() as viewing:
                shown = Shown(browser.new_page(viewport={"width": 1280, "height": 800}))
                shown.page.goto(viewing.address)
                shown.wait("app.doc && app.runs[0]")
                shown.press("Play")
                lengths = shown.page.evaluate(FRAMES)
                work = shown.page.evaluate(DRAW)
                print(
                    f"{robots} robots on {side} x {side}: {1000 / median(lengths):.0f} frames/s (median), "
                    f"slowest tenth {1000 / np.percentile(lengths, 90):.0f}, step and drawing {work:.1f} ms"
                )
                shown.page.close()
        for path in maps:
            with make_viewing(Desk(Folder(folder))).running() as viewing:
                shown = Shown(browser.new_page(viewport={"width": 1280, "height": 800}))
                shown.page.goto(viewing.address)
                for attempt in ("cold", "warm"):
                    shown.wait("app.doc && !app.job")
                    shown.press("Open…")
                    shown.page.wait_for_selector(".files button")
                    print(
                        f"{path.name}: {shown.page.evaluate(CLICK, path.name):.0f} ms from click to picture ({attempt})"
                    )
                shown.page.close()
        browser.close()
    shutil.rmtree(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
