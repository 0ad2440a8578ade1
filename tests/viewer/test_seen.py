"""What is seen at a glance: robots on their field, gaps in walls, scales and legends that say what is there."""

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import is_near
from trihex.pictures import palette
from trihex.planners import make_plan

LEAKS = """async ([tessellation, width, height, barriers, rules]) => {
  const { leaksOf } = await import("./viewer.js");
  const header = { tessellation, neighbourhood: "full", corners: "allow", ...rules };
  return leaksOf({ header, width, height, barriers: Uint8Array.from(barriers) }, [0, 0, width, height]);
}"""


def gaps_of(area):
    """Return the vertices around which free cells lie in more than one arc, by the polygons of all cells."""
    cells = np.flatnonzero(~area.barriers)
    x, y = area.cell_to_xy(cells)
    around = {}
    for centre, polygon in zip(
        np.stack(area.tessellation.centre_of_cell(x, y), axis=-1), area.tessellation.polygon_of_cell(x, y), strict=True
    ):
        for corner in polygon:
            east, south = centre - corner
            around.setdefault(tuple(np.round(corner, 4)), []).append(np.degrees(np.arctan2(south, east)) % 360)
    whole = 90 if area.tessellation.name == "square" else 60
    found = []
    for corner, angles in around.items():
        turns = np.diff([*sorted(angles), min(angles) + 360])
        if np.count_nonzero(turns > whole + 1) > 1:
            found.append(corner)
    return sorted(found)


@pytest.mark.parametrize("tessellation", ["triangular", "square"])
def test_gaps_are_where_robots_squeeze_through(open_viewer, tessellation):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((2, 2))), [(0, 0)]))
    rng, count = np.random.default_rng(3), 0
    for _ in range(12):
        barriers = rng.random(rng.integers(1, 9, size=2)) < 0.4
        height, width = barriers.shape
        asked = [tessellation, width, height, barriers.ravel().astype(int).tolist(), {}]
        leaks = shown.page.evaluate(LEAKS, asked)
        assert sorted(tuple(np.round(leak, 4).tolist()) for leak in leaks) == [
            tuple(map(float, gap)) for gap in gaps_of(th.Area(tessellation, barriers))
        ]
        count += len(leaks)
        for rules in ({"corners": "no-squeeze"}, {"neighbourhood": "edge"}):
            assert shown.page.evaluate(LEAKS, [*asked[:4], rules]) == []
    assert count > 20


def test_walls_that_touch_at_a_corner_look_leaky_until_the_gaps_are_closed(open_viewer):
    barriers = np.zeros((6, 9))
    barriers[2, 3] = barriers[3, 4] = 1
    shown = open_viewer(th.Scenario(th.Area("square", barriers), [(8, 5)]))
    scale, left, top = shown.view()
    x, y = int(left + 4 * scale), int(top + 3 * scale)
    assert is_near(shown.pixels()[y, x], palette.FREE)
    shown.press("close the gaps")
    assert not is_near(shown.pixels()[y, x], palette.FREE)
    assert shown.ask("app.doc.header.corners") == "no-squeeze"
    assert not shown.page.get_by_role("button", name="close the gaps").is_visible()
    shown.press("Undo")
    assert shown.page.get_by_role("button", name="close the gaps").is_visible()
    shown.page.get_by_role("radio", name="Hexagonal").check(force=True)
    assert not shown.page.get_by_role("button", name="close the gaps").is_visible()  # there walls are tight


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_field_is_paler_where_there_are_robots_to_be_seen(open_viewer, scheme):
    scenario = th.Scenario(th.Area("hexagonal", np.zeros((6, 9))), [(8, 5)])
    shown = open_viewer(scenario, color_scheme=scheme)
    shown.page.get_by_label("Colours").check()
    shown.wait("app.fields")
    plain = shown.colours()
    shown.press("Robot")
    shown.click(2, 2)
    pale = shown.colours()
    cells = np.ones((6, 9), dtype=bool)
    cells[2, 2] = cells[5, 8] = False
    free = shown.ask("app.panes[0].palette().free")
    away = [np.abs(colours[cells].astype(int) - free).sum() for colours in (plain, pale)]
    assert away[1] < 0.6 * away[0]
    ramp = shown.page.locator(".legend .ramp").evaluate("(ramp) => ramp.style.background")
    far = shown.ask("app.panes[0].palette().distance[255]")
    assert "rgba({}, {}, {}".format(*far) in ramp or "rgb({}, {}, {}".format(*far) in ramp
    assert is_near(shown.colours()[0, 0], far)


def test_the_scale_of_a_live_run_follows_the_field(open_viewer):
    area = th.Area("square", np.zeros((3, 12)))
    shown = open_viewer(th.Scenario(area, [(11, 1)], [(0, 1), (1, 1)]))
    shown.page.get_by_label("Colours").check()
    shown.wait("app.fields")
    shown.press("Run live")
    shown.press("Pause")
    shown.wait("!app.live.isAsking && !app.live.frames.length && app.live.fraction === 1")
    legend = shown.text(".legend")
    for word in ("moving", "waiting", "arriving"):
        assert word in legend
    before = shown.ask("app.panes[0].options.most")
    for y in (0, 1):  # robots must take the last row, and some cells lie farther away
        shown.click(6, y)
    shown.wait("app.doc.barriers[6] && app.doc.barriers[18] && !app.live.isAsking && !app.live.events.length")
    most = shown.ask("Math.max(...app.live.distance.filter((value) => value < 2 ** 31 - 1))")
    assert most > before and shown.ask("app.panes[0].options.most") == most
    assert f"{most} to go" in shown.text(".legend")


def test_nobody_waits_and_the_curve_says_so(open_viewer):
    scenario = th.Scenario(th.Area("square", np.zeros((3, 9))), [(8, 1)], [(0, 1)])
    shown = open_viewer(make_plan(scenario, "greedy"))
    assert shown.page.locator(".chart figcaption").all_inner_texts() == [
        "Robots arrived\nmax 1",
        "Robots waiting (queue)\nmax 0",
    ]
