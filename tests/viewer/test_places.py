"""Places in metres: the page asks how large cells shall be, shows the ground under them, and tells metres."""

import numpy as np
import pytest
from click.testing import CliRunner
from fuzz.seeds import make_seeds

import trihex as th
from tests.viewer.pages import Shown, is_near
from trihex.cli import main
from trihex.formats import read_draft
from trihex.pictures import palette
from trihex.planners import make_plan

HALF = {"cell_size": 0.5, "robot_radius": 0.0}


@pytest.fixture
def folder(tmp_path):
    for name, content in make_seeds().items():
        (tmp_path / name).write_bytes(content)
    return tmp_path


def open_house(shown, name, size="0.5"):
    shown.press("Open…")
    shown.press(name)
    dialog = shown.page.get_by_role("dialog")
    dialog.get_by_text("is a place in metres").wait_for()
    assert name in dialog.inner_text()
    dialog.get_by_label("Cell size in metres").fill(size)
    dialog.get_by_role("button", name="Open", exact=True).click()
    shown.wait("app.doc.header.frame && !app.job")


@pytest.mark.parametrize("name", ["house.yaml", "house.geojson", "house.wkt"])
def test_a_place_without_a_size_asks_for_it_and_shows_its_ground(open_viewer, folder, name):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((3, 4))), [(0, 0)]))
    open_house(shown, name)
    draft = read_draft(folder / name, **HALF)
    assert shown.ask("[app.doc.width, app.doc.height]") == [draft.area.width, draft.area.height]
    shown.keep(f"place-{name.rpartition('.')[2]}")
    # What is drawn over the whole area, at points that are clear of outlines.
    rng = np.random.default_rng(2)
    scale, left, top = shown.view()
    pixels, found = shown.pixels(), {"wall": 0, "tight": 0, "free": 0}
    tessellation = draft.area.tessellation
    marked = [cell for cells in (draft.destinations, draft.robots) if cells is not None for cell in cells]
    for _ in range(4000):
        px, py = rng.random(2) * (draft.area.width, draft.area.height)
        x, y = tessellation.cell_at_point(px, py)
        if not (0 <= x < draft.area.width and 0 <= y < draft.area.height) or y * draft.area.width + x in marked:
            continue
        near = draft.area.ground.occupied_at(
            *draft.area.metres.point_to_metres(
                px + 0.06 * np.array([-1, 0, 1, 0, 0]), py + 0.06 * np.array([0, -1, 0, 1, 0])
            )
        )
        others = tessellation.cell_at_point(px + 0.06 * np.array([-1, 0, 1, 0]), py + 0.06 * np.array([0, -1, 0, 1]))
        if near.any() != near.all() or np.ptp(others[0]) or np.ptp(others[1]):
            continue
        wanted = "wall" if near[0] else "tight" if draft.area.barriers[y, x] else "free"
        colour = {"wall": palette.BARRIER, "tight": palette.TIGHT, "free": palette.FREE}[wanted]
        assert is_near(pixels[int(top + py * scale), int(left + px * scale)], colour), (px, py, wanted)
        found[wanted] += 1
    assert found["wall"] > 20 and found["free"] > 100
    for word in ("wall", "robots do not fit"):
        assert word in shown.text(".legend")
    assert shown.faults == []


def drawn_of_ground(shown):
    """Return how much is drawn of walls within cells, and of places where robots do not fit."""
    pixels = shown.pixels()
    return [int(np.count_nonzero(is_near(pixels, colour, 0))) for colour in (palette.BARRIER, palette.TIGHT)]


def test_a_plan_that_is_read_shows_the_ground_under_its_cells(open_viewer, folder, browser, monkeypatch):
    """From Python, as a page alone, beside its area on the command line, and opened where its area is open already."""
    area = read_draft(folder / "house.geojson", cell_size=0.3, robot_radius=0.1).area
    free = np.flatnonzero(~area.barriers)
    plan = make_plan(th.Scenario(area, free[:1], free[-5:]), "greedy")
    th.write_plan(plan, folder / "plan.csv")
    shown = open_viewer(plan)
    walls, tight = drawn_of_ground(shown)
    assert walls > 500 and tight > 500 and "robots do not fit" in shown.text(".legend")
    th.write_page(plan, folder / "plan.html")
    alone = Shown(browser.new_page(viewport={"width": 1280, "height": 800}))
    alone.page.goto((folder / "plan.html").as_uri())
    alone.wait("app.runs[0]")
    assert min(drawn_of_ground(alone)) > 500 and alone.faults == []
    alone.page.close()
    th.write_plan(plan, folder / "plan.npz")  # it says nothing of the ground
    shown_first = []
    monkeypatch.chdir(folder)
    monkeypatch.setattr("trihex.viewer.launch.make_viewing", lambda desk, first, port: shown_first.append(first))
    measures = ["--cell-size", "0.3", "--robot-radius", "0.1"]
    for name in ("plan.csv", "plan.npz"):
        told = ["--destination", "{},{}".format(*np.ravel(area.cell_to_xy(free[:1])))] if name == "plan.csv" else []
        CliRunner().invoke(main, ["view", name, "house.geojson", *measures, *told])
    assert [first.header["ground"] is not None for first in shown_first] == [True, True]
    there = open_viewer(th.Scenario(area, free[:1]))
    there.press("Open…")
    there.press("plan.npz")
    there.wait("app.runs[0] && !app.job")
    assert drawn_of_ground(there) == pytest.approx([walls, tight], rel=0.01) and there.faults == []


def test_a_wall_that_is_painted_or_erased_is_seen(open_viewer, folder):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((3, 4))), [(0, 0)]))
    open_house(shown, "house.geojson")
    area = read_draft(folder / "house.geojson", **HALF).area
    y, x = np.argwhere(area.barriers)[0].tolist()
    shown.press("Erase")
    shown.click(x, y)
    assert is_near(shown.colours(shift=(0.2, 0.2))[y, x], palette.FREE)
    y, x = np.argwhere(~area.barriers)[0].tolist()
    shown.press("Wall")
    shown.click(x, y)
    assert is_near(shown.colours(shift=(0.2, 0.2))[y, x], palette.BARRIER)


def test_metres_are_told_and_measured(open_viewer):
    frame = th.Frame(0.5, origin=(10.0, 20.0), yaw=0.3)
    area = th.Area("hexagonal", np.zeros((20, 30)), frame=frame)
    shown = open_viewer(th.Scenario(area, [(0, 0)]))
    shown.page.mouse.move(*map(float, shown.place(7, 4)))
    x, y = frame.centre_of_cell(area.tessellation, 7, 4)
    assert shown.text(".readout") == f"cell (7, 4) · free · x {x:.2f} m, y {y:.2f} m"
    # The bar at the lower right: so long as it says.
    box = shown.page.locator("canvas").first.bounding_box()
    row = shown.pixels()[int(box["y"] + box["height"]) - 16, int(box["x"]) : int(box["x"] + box["width"])]
    black = np.flatnonzero(is_near(row, (0, 0, 0), 20))
    metres = (black[-1] - black[0]) / shown.view()[0] * frame.cell_size
    assert metres == pytest.approx(2, rel=0.05) or metres == pytest.approx(1, rel=0.05)
    assert black[0] > box["width"] - 300 and shown.faults == []


LENGTHS = "async (scales) => { const { lengthOf } = await import('./viewer.js'); return scales.map(lengthOf); }"


def test_the_scale_bar_takes_round_lengths(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((3, 4))), [(0, 0)]))
    scales = [0.01, 1, 7, 35, 36, 100, 6000]
    assert shown.page.evaluate(LENGTHS, scales) == pytest.approx([10000, 100, 10, 2, 2, 1, 0.02])
