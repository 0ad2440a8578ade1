"""What axe-core, a checker of accessibility, finds on each state of the page: nothing serious."""

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

import trihex as th
from tests.sweeps import swept

SIZES = [(1400, 900), (1024, 768), (800, 600), (390, 844)]
GRAVE = ("serious", "critical")


def faults(shown):
    """Return what is grave, as (rule, impact, elements)."""
    found = Axe().run(shown.page).response["violations"]
    return [
        (one["id"], one["impact"], [node["html"][:160] for node in one["nodes"]])
        for one in found
        if one["impact"] in GRAVE
    ]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(("width", "height"), SIZES[: swept(4)])
def test_nothing_grave_is_found_on_the_way_through_the_page(open_viewer, width, height, scheme):
    area = th.make_rooms_area("triangular", 16, 20, room=5, seed=4)
    end = np.flatnonzero(~area.barriers)[-1:]
    scenario = th.Scenario(area, end, th.random_robots(area, 30, 1, avoid=end), seed=1)
    shown = open_viewer(scenario, viewport={"width": width, "height": height}, color_scheme=scheme)
    app = "document.querySelector('#trihex').app"
    found = {"start": faults(shown)}
    shown.page.evaluate(f"{app}.panel.fold(false)")
    shown.page.get_by_text("Options of the planner").click()
    shown.page.locator("summary", has_text="Rules").last.click()
    found["open"] = faults(shown)
    shown.page.get_by_label("Planner beside it").select_option("greedy")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job")
    shown.page.evaluate(f"{app}.followed.follow(3)")
    found["plans"] = faults(shown)
    shown.press("Help")
    found["help"] = faults(shown)
    shown.press("Show me: a guided minute")
    shown.wait("app.growth && app.growth.isComplete")
    found["guide"] = faults(shown)
    shown.press("Skip")
    for name in ("New…", "Open…", "Save…"):
        shown.press(name)
        shown.page.get_by_role("dialog").wait_for()
        found[name] = faults(shown)
        shown.page.keyboard.press("Escape")
    shown.press("Run live")
    shown.wait("app.live && app.live.last.step > 1")
    found["live"] = faults(shown)
    grave = [(state, *fault) for state, faults in found.items() for fault in faults]
    assert not grave, "\n".join(map(str, grave))
