"""Live runs: driven step by step through the desk, and painted into in a browser."""

import numpy as np
import pytest

import trihex as th
from tests.sweeps import swept
from tests.viewer.pages import Shown, is_near
from trihex.kernels.codes import LATE
from trihex.pictures import FOG, FOG_BARRIER, palette
from trihex.running import GOING, Execution, Trial
from trihex.viewer.bundle import decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.document import document_of
from trihex.viewer.folder import Folder

TESSELLATIONS = ["triangular", "hexagonal", "square"]
BARRIER, DESTINATION, KNOWN = 1, 2, 4
HIDDEN, MOVING, WAITING, FINAL, STRANDED, IS_LATE = range(6)


def house(tessellation, robots=30):
    area = th.make_rooms_area(tessellation, 16, 20, room=5, seed=4)
    end = np.flatnonzero(~area.barriers)[-1:]
    return th.Scenario(area, end, th.random_robots(area, robots, 1, avoid=end), seed=1)


class Page:
    """A page without a browser: asks a desk, and keeps what it is told of the world and the robots."""

    def __init__(self, scenario, folder=None, **wish):
        self.desk = Desk(folder)
        document, arrays = document_of(th.formats.draft.draft_of(scenario))
        first = self.ask({"op": "live", "planner": "fcost", "document": document, **wish}, arrays)
        self.name = first.header["live"]
        self.world = np.zeros(scenario.area.cell_count, dtype=np.uint8)
        self.distance = np.full(scenario.area.cell_count, -1)
        self.take(first)

    def answer(self, header, arrays=None):
        frames = []
        self.desk.answer(encode(header, arrays or {}), frames.append)
        return decode(frames[-1])

    def ask(self, header, arrays=None):
        answer = self.answer(header, arrays)
        assert answer.header["kind"] == "result", answer.header
        return answer

    def take(self, frame):
        self.header, self.cells, self.sets = frame.header, frame.arrays["cells"], frame.arrays["sets"]
        self.world[frame.arrays["world_cells"]] = frame.arrays["world"]
        self.distance[frame.arrays["distance_cells"]] = frame.arrays["distance"]

    def advance(self, steps=1, *events):
        self.take(self.ask({"op": "advance", "live": self.name, "steps": steps, "events": list(events)}))
        return self.header


@pytest.mark.parametrize("tessellation", TESSELLATIONS)
def test_a_page_is_told_all_that_a_trial_does(tessellation):
    scenario = house(tessellation)
    page = Page(scenario, sense=2.0, delays=0.1)
    trial = Trial(scenario, sensor=2.0, delay=0.1, seed=1)
    np.testing.assert_array_equal(page.world & KNOWN, 0)
    spent, steps = 0, 0
    while not trial.is_over:
        going = trial.execution.state_of_robot == GOING
        action = trial.step()
        steps += 1
        header = page.advance()
        for robot in np.flatnonzero(going):
            costs = scenario.area.tessellation.cost_of_direction
            spent += costs[action[robot]] if action[robot] < LATE else scenario.waiting_cost
        assert (header["step"], header["spent"]) == (steps, spent)
        there = trial.execution.state_of_robot == GOING
        np.testing.assert_array_equal(page.cells[there], trial.execution.cell_of_robot[there])
        np.testing.assert_array_equal(page.sets[there & (action < LATE)], MOVING)
        np.testing.assert_array_equal(page.sets[there & (action == LATE)], IS_LATE)
        np.testing.assert_array_equal(page.sets[going & ~there], FINAL)
        np.testing.assert_array_equal(page.sets[~going], HIDDEN)
        np.testing.assert_array_equal(page.world & KNOWN > 0, trial.known.reshape(-1))
        np.testing.assert_array_equal(page.distance, trial.execution.field.distance.reshape(-1))
    assert header["is_over"] and header["arrived"] == scenario.robot_count and steps > 10
    np.testing.assert_array_equal(page.world & BARRIER > 0, scenario.area.barriers.reshape(-1))
    assert page.advance()["step"] == steps  # over is over
    summary = page.ask({"op": "judge", "live": page.name}).header["summary"]
    assert summary["conflicts"] == 0 and summary["total_time"] == trial.record().total_time == spent


@pytest.mark.parametrize("tessellation", TESSELLATIONS)
def test_a_hand_that_paints_at_random_makes_no_unsafe_run(tmp_path, tessellation):
    scenario, rng = house(tessellation), np.random.default_rng(5)
    page = Page(scenario, Folder(tmp_path), sense=None if tessellation == "square" else 3.0)
    refused = 0
    for _ in range(40):
        events = []
        for cell in rng.integers(scenario.area.cell_count, size=6):
            kinds = ("clear",) if page.world[cell] & BARRIER else ("barrier", "barrier", "join", "open")
            kind = "close" if page.world[cell] & DESTINATION else str(rng.choice(kinds))
            events.append({"kind": kind, "cell": [int(cell) % 20, int(cell) // 20]})
        page.advance(0, *events)
        refused += page.header["refused_count"]
        assert all(one["why"] and one["cell"] for one in page.header["refused"])
        page.advance(1)
    assert refused > 0
    while not page.header["is_over"]:
        page.advance(16)
    save = {"op": "save", "what": "run", "name": "run.npz", "in_folder": True, "live": page.name}
    assert page.ask(save).header["saved"] == "run.npz"
    run = th.read_run(tmp_path / "run.npz")
    assert th.audit_run(run).is_clean and run.robots.size > 30 and run.steps > 30
    barriers, ends = list(run.worlds())[-1]
    np.testing.assert_array_equal(page.world & BARRIER > 0, barriers.reshape(-1))
    np.testing.assert_array_equal(np.flatnonzero(page.world & DESTINATION), ends)


def test_what_cannot_be_is_refused_with_its_reason_and_the_world_stays():
    page = Page(th.Scenario(th.Area("square", np.zeros((3, 6))), [(5, 1)], [(0, 1), (1, 1)]))
    page.advance(0, *({"kind": "barrier", "cell": cell} for cell in ([1, 1], [5, 1], [9, 9], [3, 0])))
    assert [one["why"] for one in page.header["refused"]] == [
        "robot 1 stands at (1, 1)", "(5, 1) is a destination, close it first", "(9, 9) lies outside the area",
    ]  # fmt: skip
    assert np.flatnonzero(page.world & BARRIER).tolist() == [3]
    page.advance(0, {"kind": "close", "cell": [5, 1]})
    assert page.header["is_over"] and page.header["cut_off"] == 2 and page.sets.tolist() == [STRANDED, STRANDED]
    page.advance(1, {"kind": "open", "cell": [1, 1]})
    assert page.header["arrived"] == 2 and page.header["is_over"]
    for wrong in (
        {"kind": "flood", "cell": [0, 0]},
        {"kind": "barrier"},
        {"kind": "leave", "robot": 0, "cell": [0, 0]},
    ):
        answer = page.answer({"op": "advance", "live": page.name, "events": [wrong]})
        assert answer.header["kind"] == "error" and "event" in answer.header["message"]
    assert "run again" in page.answer({"op": "advance", "live": "live-9"}).header["message"]
    assert (
        "plan"
        in page.answer({"op": "save", "what": "plan", "name": "a.npz", "in_folder": False, "live": page.name}).header[
            "message"
        ]
    )


def test_the_optimum_decides_within_its_budget_and_is_fallen_back_from():
    scenario = house("hexagonal")
    page = Page(scenario, planner="optimal", budget=60.0)
    wall = {"kind": "barrier", "cell": [int(x) for x in divmod(int(np.flatnonzero(page.world == KNOWN)[0]), 20)[::-1]]}
    page.advance(1)
    page.advance(1, wall)
    while not page.header["is_over"]:
        page.advance(8)
    assert page.header["arrived"] == 30
    hurried = Page(scenario, planner="optimal", budget=1e-9)
    stepped = Execution(scenario, "fcost")
    while not stepped.is_over:
        stepped.step()
    while not hurried.header["is_over"]:
        hurried.advance(8)
    assert hurried.header["step"] == stepped.steps_done


def barriers_of(shown):
    return is_near(shown.colours(), palette.BARRIER)


@pytest.mark.parametrize("tessellation", TESSELLATIONS[: swept(3)])
def test_walls_are_painted_while_robots_run(open_viewer, tmp_path, tessellation):
    scenario = house(tessellation)
    shown = open_viewer(scenario)
    page = shown.page
    page.get_by_label("Steps per second").fill("2")  # slow enough that a busy machine pauses it before it ends
    shown.press("Run live")
    shown.wait("app.live && app.live.last.step > 3")
    assert shown.text(".clock").endswith("live") and shown.text(".play") == "Pause"
    shown.press("Pause")
    shown.wait("!app.live.isAsking && !app.live.frames.length && app.live.fraction === 1")
    robots = np.array(shown.ask("[...app.doc.robots]"))
    there = np.unique(robots[robots >= 0])
    colours = shown.colours(shift=(0, -0.2)).reshape(-1, 3)
    seen = is_near(colours, palette.MOVING) | is_near(colours, palette.WAITING)
    np.testing.assert_array_equal(np.flatnonzero(seen), there)

    # a free cell becomes a barrier at once; one with a robot does not, and the page says why
    free = np.flatnonzero(~scenario.area.barriers.reshape(-1))
    free = np.setdiff1d(free, [*there, *scenario.destinations])[3]
    shown.click(int(free) % 20, int(free) // 20)
    shown.wait(f"app.doc.barriers[{free}]")
    assert barriers_of(shown).reshape(-1)[free]
    taken = int(there[0])
    shown.click(taken % 20, taken // 20)
    shown.wait("document.querySelector('.status').classList.contains('warning')")
    assert "stands at" in shown.text(".status") and not shown.ask(f"app.doc.barriers[{taken}]")
    last = int(scenario.destinations[0])
    shown.click(last % 20, last // 20)
    shown.wait("document.querySelector('.status').textContent.includes('is a destination')")

    # one robot joins, one is taken away; a step is done by hand
    shown.press("Robot")
    shown.click(int(free) % 20, int(free) // 20)
    shown.wait("document.querySelector('.status').textContent.includes('is a barrier')")
    shown.press("Erase")
    shown.click(int(free) % 20, int(free) // 20)
    shown.wait(f"!app.doc.barriers[{free}]")
    shown.press("Robot")
    shown.click(int(free) % 20, int(free) // 20)
    shown.wait("app.live.runners.count === 31")
    step = shown.ask("app.live.last.step")
    shown.press("Step forward")
    shown.wait(f"app.live.last.step === {step + 1} && app.live.fraction === 1")
    page.get_by_label("Steps per second").fill("13")
    shown.press("Play")
    shown.wait("app.live.last.is_over && app.live.summary")
    table = shown.table()
    assert shown.ask("app.live.summary.told") == []
    assert table["Arrived"] == ["31 of 31"] and table["Conflicts"] == ["none"]
    shown.keep(f"live-{tessellation}")

    # the run is saved, and the judge reads it
    shown.press("Save…")
    page.get_by_role("dialog").get_by_label("Name").fill("run.npz")
    shown.press("Save in folder")
    shown.wait("document.querySelector('.status').textContent === 'Saved run.npz.'")
    run = th.read_run(tmp_path / "run.npz")
    assert th.audit_run(run).is_clean and run.arrived.all() and run.robots.size == 31
    assert table["Total time so far"] == [f"{run.total_time:,}".replace(",", " ")]
    shown.press("Stop")
    assert shown.ask("[...app.doc.robots]") == scenario.robots.tolist() and shown.text(".results") == "No plan yet."
    assert shown.faults == []


def test_a_wall_that_is_held_closes_when_the_robot_in_it_has_gone(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((3, 60))), [(59, 1)], [(1, 1), (0, 1)]))
    shown.press("Run live")
    shown.press("Pause")
    shown.wait("!app.live.isAsking && !app.live.frames.length && app.live.fraction === 1")
    first = shown.ask("app.doc.robots[0]") % 60
    shown.page.mouse.move(*map(float, shown.place(first, 1)))
    shown.page.mouse.down()
    shown.wait("document.querySelector('.status').textContent.includes('stands at')")
    for behind in (1, 0):  # the second robot comes into the cell, then it is free
        assert not shown.ask(f"app.doc.barriers[60 + {first}]")
        step = shown.ask("app.live.last.step")
        shown.page.keyboard.press(".")
        shown.wait(f"app.live.last.step === {step + 1} && app.live.fraction === 1 && !app.live.events.length")
        assert shown.ask(f"app.doc.robots.includes(60 + {first})") == bool(behind)
    shown.wait(f"app.doc.barriers[60 + {first}]")
    shown.page.mouse.up()
    assert shown.faults == []


def test_fog_lifts_where_robots_come_and_the_changed_world_can_be_kept(open_viewer):
    scenario = house("hexagonal", robots=2)
    shown = open_viewer(scenario)
    shown.page.get_by_label("Sensing, in cells").fill("1.5")
    shown.page.get_by_label("Steps per second").fill("2")
    shown.press("Run live")
    shown.press("Pause")
    shown.wait("!app.live.isAsking && app.live.last.step >= 1 && app.live.fraction === 1")
    known = np.array(shown.ask("[...app.live.known]")) > 0
    assert 3 < known.sum() < 100
    robots = np.array(shown.ask("[...app.doc.robots]"))
    colours = shown.colours().reshape(-1, 3)
    is_fog = is_near(colours, FOG) | is_near(colours, FOG_BARRIER)
    plain = np.setdiff1d(np.arange(known.size), [*robots, *scenario.destinations])
    np.testing.assert_array_equal(is_fog[plain], ~known[plain])
    hidden = int(np.setdiff1d(plain, np.flatnonzero(known | scenario.area.barriers.reshape(-1)))[0])
    shown.click(hidden % 20, hidden // 20)  # nobody sees it
    shown.wait(f"app.doc.barriers[{hidden}]")
    assert is_near(shown.colours(), FOG_BARRIER).reshape(-1)[hidden]
    shown.press("Keep this world")
    assert shown.ask("!app.live") and shown.ask(f"app.doc.barriers[{hidden}]")
    shown.press("Undo")
    assert not shown.ask(f"app.doc.barriers[{hidden}]") and shown.faults == []


def test_the_file_plays_without_the_live_mode_and_says_so(browser, tmp_path):
    th.write_page(th.make_plan(house("square"), "greedy"), tmp_path / "plan.html")
    shown = Shown(browser.new_page())
    shown.page.goto((tmp_path / "plan.html").as_uri())
    shown.wait("app.doc")
    assert shown.page.get_by_role("button", name="Run live").count() == 0
    assert "start trihex view" in shown.text("[data-section=Result]")
    shown.page.close()
