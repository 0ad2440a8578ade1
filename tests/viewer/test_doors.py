"""Doors with a flow and start times in the viewer: opened, drawn, told, and handed on to plans, runs and files."""

from fractions import Fraction

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import Shown, is_near
from tests.viewer.test_live import Page
from trihex.formats import draft_of
from trihex.planners import make_plan
from trihex.viewer.bundle import decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.document import document_of, draft_of_document

FRAME = (112, 48, 208)  # of doors, as in colours.js


def hall(shape="square", **more):
    """Return a hall with a door between two rooms, one robot in two steps, and a door to leave by."""
    barriers = np.zeros((7, 13), dtype=bool)
    barriers[[0, 1, 2, 4, 5, 6], 6] = True
    area = th.Area(shape, barriers, "hall", zones=(th.Zone("cloakroom", np.array([3 * 13 + 6])),))
    robots = [(x, y) for x in range(2) for y in range(7)]
    doors = [("cloakroom", "1/2"), ([(12, 2), (12, 3), (12, 4)], 2)]
    ends = [(12, 2), (12, 3), (12, 4)]
    return th.Scenario(area, ends, robots, doors=doors, start_times=[0, 11] + [0] * 12, **more)


def door_facts(scenario):
    return [(door.name, door.cells.tolist(), door.flow) for door in scenario.doors]


@pytest.mark.parametrize("shape", ["square", "hexagonal", "triangular"])
def test_a_document_holds_all_that_a_plan_with_doors_needs(shape):
    scenario = hall(shape, destination_capacity="1/3")
    header, arrays = document_of(draft_of(scenario))
    assert header["destination_capacity"] == "1/3"
    again = draft_of_document(header, arrays).complete()
    assert door_facts(again) == door_facts(scenario) and again.destination_capacity == Fraction(1, 3)
    np.testing.assert_array_equal(again.start_times, scenario.start_times)
    plans = [make_plan(one, "fcost") for one in (scenario, again)]
    np.testing.assert_array_equal(*(plan.actions for plan in plans))
    assert plans[0].steps > make_plan(scenario.__class__(scenario.area, scenario.destinations, scenario.robots)).steps


def test_flows_are_told_in_robots_a_second_where_there_are_metres_else_a_step():
    def words(flow, clock="steps", **frame):
        area = th.Area("hexagonal", np.zeros((2, 3)), frame=th.Frame(**frame) if frame else None)
        scenario = th.Scenario(area, [(2, 0)], doors=[((2, 0), flow)], clock=clock)
        return document_of(draft_of(scenario)).header["doors"][0]["words"]

    assert words("1/2") == "lets in one robot in 2 steps" and words(1) == "lets in one robot a step"
    assert words("3/2") == "lets in 3 robots in 2 steps" and words(2, "costs") == "lets in 2 robots a tick"
    assert words("1.6/s", cell_size=0.5) == "lets in 1.6 robots a second at 1 m/s"


def test_walls_over_a_door_leave_the_rest_of_it():
    header, arrays = document_of(draft_of(hall()))
    barriers = hall().area.barriers.copy()
    barriers[2, 12] = barriers[3, 6] = True
    arrays = {**arrays, "barriers": np.packbits(barriers), "destinations": arrays["destinations"][1:]}
    again = draft_of_document(header, arrays).complete()
    assert door_facts(again) == [("", [51, 64], Fraction(2))]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"flow": "0"}, "capacity"),
        ({"flow": "many"}, "capacity"),
        ({"cells": [700]}, "700"),
        ({"cells": "all"}, "doors.0.cells"),
        ({"name": "a\x00b"}, "name of a zone"),
    ],
)
def test_wrong_doors_of_a_page_are_refused(wrong, message):
    header, arrays = document_of(draft_of(hall()))
    header = {**header, "doors": [{**header["doors"][0], **wrong}]}
    frames = []
    Desk().answer(encode({"op": "plan", "planner": "fcost", "document": header}, arrays), frames.append)
    answer = decode(frames[-1]).header
    assert answer["kind"] == "error" and message in answer["message"] and "fault" not in answer["message"]


def test_a_live_run_keeps_to_the_doors():
    page = Page(hall())
    while not page.header["is_over"]:
        page.advance(8)
    run = page.desk.last_run
    assert door_facts(run.scenario) == door_facts(hall()) and th.audit_run(run).is_clean


def seen(shown, cells, width):
    """Tell of each cell whether there is a frame of a door round it: just inside of the edges of its cell."""
    colours = shown.pixels()
    found = []
    for cell in cells:
        x, y = map(int, shown.place(cell % width, cell // width))
        reach = int(shown.view()[0] * 0.6)
        found.append(bool(is_near(colours[y - reach : y + reach, x - reach : x + reach], FRAME, 12).any()))
    return found


def test_doors_are_opened_drawn_told_planned_and_saved(open_viewer, tmp_path):
    scenario = hall()
    th.write_scenario(scenario, tmp_path / "hall.toml")
    shown = open_viewer(color_scheme="light")
    page = shown.page
    shown.press("Open…")
    shown.press("hall.toml")
    shown.wait("app.doc.width === 13 && !app.job")
    door = scenario.doors[0].cells.tolist()
    exits = scenario.doors[1].cells.tolist()
    assert seen(shown, [*door, *exits, 5 * 13 + 9, 10], 13) == [True] * 4 + [False] * 2
    assert "door with a flow" in shown.text(".legend")
    page.mouse.move(*map(float, shown.place(6, 3)))
    assert shown.text(".readout").startswith("cell (6, 3) · free · door 'cloakroom': lets in one robot in 2 steps")
    page.mouse.move(*map(float, shown.place(12, 4)))
    assert "destination · door: lets in 2 robots a step" in shown.text(".readout")
    page.mouse.move(*map(float, shown.place(0, 1)))
    assert shown.text(".readout").startswith("cell (0, 1) · free · robot b (number 1) · may begin to move in step 12")
    page.mouse.move(*map(float, shown.place(0, 2)))
    assert "may begin" not in shown.text(".readout")
    shown.keep("doors-opened")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    wanted = make_plan(scenario, "fcost")
    assert shown.ask("app.runs[0].summary.total_time") == wanted.total_time
    assert shown.ask("app.runs[0].summary.conflicts") == 0
    for step, is_late in ((10, True), (11, False)):
        shown.ask(f"app.clock.seek({step}), 0")
        page.mouse.move(*map(float, shown.place(1, 1)))
        page.mouse.move(*map(float, shown.place(0, 1)))
        assert ("may begin to move in step 12" in shown.text(".readout")) is is_late
    assert seen(shown, [*door, 10], 13) == [True, False]
    shown.keep("doors-planned")
    shown.press("Save…")
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("What").select_option("scenario")
    dialog.get_by_label("Name").fill("again.toml")
    shown.press("Save in folder")
    shown.wait("document.querySelector('.status').textContent === 'Saved again.toml.'")
    again = th.read_scenario(tmp_path / "again.toml")
    assert door_facts(again) == door_facts(scenario)
    assert shown.faults == []


def test_a_fraction_is_a_rule_and_the_clock_of_doors_stays(open_viewer):
    shown = open_viewer(hall())
    page = shown.page
    page.get_by_text("Rules", exact=True).click()
    field = page.get_by_label("Arrivals per step and destination")
    for text, flow in (("0.5", "0.5"), (" 1/3 ", "1/3"), ("2", 2), ("", None)):
        field.fill(text)
        field.press("Enter")
        assert shown.ask("app.doc.header.destination_capacity") == flow
    field.fill("no")
    field.press("Enter")
    shown.press("Plan")
    shown.wait("app.status.isWarning")
    assert "destination_capacity must be a number" in shown.text(".status")
    field.fill("")
    field.press("Enter")
    page.get_by_label("Clock").select_option("costs")
    assert "doors let in so many" in shown.text(".status") and shown.ask("app.doc.header.clock") == "steps"
    assert page.get_by_label("Clock").input_value() == "steps" and shown.faults == []


def test_a_page_alone_draws_the_doors_of_a_run(browser, tmp_path):
    run = th.Trial(hall()).run()
    th.write_page(run, tmp_path / "run.html")
    page = browser.new_page(viewport={"width": 900, "height": 700}, color_scheme="light")
    shown = Shown(page)
    page.goto((tmp_path / "run.html").as_uri())
    shown.wait("app.doc && app.runs[0]")
    assert seen(shown, [45, 10], 13) == [True, False] and "door with a flow" in shown.text(".legend")
    page.mouse.move(*map(float, shown.place(0, 1)))
    assert "may begin to move in step 12" in shown.text(".readout") and shown.faults == []
    page.close()


def test_a_folder_for_a_static_host_has_doors(tmp_path):
    th.write_site(hall("hexagonal"), tmp_path / "site", planners=("greedy",))
    answer = (tmp_path / "site" / "answers" / "plan-greedy-hexagonal.bin").read_bytes()
    assert len(decode(answer[4:]).header["document"]["doors"]) == 2
