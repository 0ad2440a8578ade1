"""More to see: all paths, clocks, robots that are struck in a live run, runs that are watched again."""

import re

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import is_near
from tests.viewer.test_live import Page, house
from trihex.pictures import palette
from trihex.planners import make_plan
from trihex.running import Event, Trial
from trihex.viewer.bundle import decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.folder import Folder, holds_run


def eventful(tessellation, **more):
    """Return a run with a wall, a robot that joins, one that breaks down and one that is late."""
    scenario = house(tessellation)
    free = np.setdiff1d(np.flatnonzero(~scenario.area.barriers), [*scenario.robots, *scenario.destinations])
    x, y = (axis.tolist() for axis in scenario.area.cell_to_xy(free[[3, 40]]))
    events = [
        Event(2, "barrier", cell=(x[0], y[0])),
        Event(3, "join", cell=(x[1], y[1])),
        Event(4, "break", robot=5),
        Event(5, "late", robot=6, steps=4),
    ]
    return Trial(scenario, events=events, seed=1, **more).run()


def opened(desk, name):
    frames = []
    desk.answer(encode({"op": "open", "name": name}), frames.append)
    answer = decode(frames[-1])
    assert answer.header["kind"] == "result", answer.header
    return answer


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal", "square"])
def test_a_run_is_watched_as_it_was(tmp_path, tessellation):
    run = eventful(tessellation, sensor=2.0, delay=0.1)
    th.write_run(run, tmp_path / "run.npz")
    page = Page.__new__(Page)
    page.desk = Desk(Folder(tmp_path))
    first = opened(page.desk, "run.npz")
    assert first.header["watched"] == {"sense": 2.0, "delays": 0.1, "steps": run.steps}
    page.name = first.header["live"]
    cells = run.scenario.area.cell_count
    page.world, page.distance = np.zeros(cells, dtype=np.uint8), np.full(cells, -1)
    page.take(first)
    for step, there in enumerate(run.cells_by_step()):
        if step:
            page.advance()
        there = there[: page.cells.size]  # who joins before the next step is told of with it
        np.testing.assert_array_equal(page.cells[there >= 0], there[there >= 0])
    assert page.header["step"] == run.steps and page.header["broken"] == 1 and page.header["is_over"]
    again = page.desk.last_run
    np.testing.assert_array_equal(again.actions, run.actions)
    np.testing.assert_array_equal(again.state_of_robot, run.state_of_robot)
    assert again.occurrences == run.occurrences


def test_a_run_that_is_changed_goes_another_way(tmp_path):
    run = eventful("square")
    th.write_run(run, tmp_path / "run.npz")
    desk = Desk(Folder(tmp_path))
    page = Page.__new__(Page)
    page.desk, page.name = desk, opened(desk, "run.npz").header["live"]
    page.world, page.distance = np.zeros(320, dtype=np.uint8), np.full(320, -1)
    page.advance(6)
    there = page.cells[page.sets == 1]
    page.advance(1, {"kind": "late", "robot": int(np.flatnonzero(page.sets == 1)[0]), "steps": 30})
    while not page.header["is_over"]:
        page.advance(16)
    again = desk.last_run
    np.testing.assert_array_equal(again.actions[:6], run.actions[:6])
    assert there.size and again.steps > 30 and th.audit_run(again).is_clean


def test_archives_of_plans_and_of_nothing_are_no_runs(tmp_path):
    th.write_plan(make_plan(house("square"), "greedy"), tmp_path / "plan.npz")
    (tmp_path / "none.npz").write_bytes(b"PK\x03\x04")
    assert not holds_run(tmp_path / "plan.npz") and not holds_run(tmp_path / "none.npz")
    frames = []
    Desk(Folder(tmp_path)).answer(encode({"op": "open", "name": "none.npz"}), frames.append)
    assert decode(frames[-1]).header["kind"] == "error"


def test_a_run_is_opened_played_and_left(open_viewer, tmp_path):
    run = eventful("hexagonal")
    th.write_run(run, tmp_path / "run.npz")
    shown = open_viewer(house("square"))
    shown.press("Open…")
    shown.press("run.npz")
    shown.wait("app.live && app.live.last.step > 1")
    assert shown.text(".status").startswith(f"This run of {run.steps} steps is played again")
    shown.wait(f"app.live.last.step === {run.steps} && app.live.summary")
    table = shown.table()
    assert table["Arrived"] == [f"{np.count_nonzero(run.arrived)} of {run.robots.size}"]
    assert table["Total time so far"] != [] and table["Conflicts"] == ["none"]
    assert "broken" in shown.text(".legend") and "arriving" in shown.text(".legend")
    shown.keep("run-watched")
    shown.press("Stop")
    assert shown.ask("[...app.doc.robots]") == run.scenario.robots.tolist() and shown.faults == []


def test_robots_are_broken_and_delayed_by_a_click(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((4, 40))), [(39, 2)], [(0, 1), (2, 2), (4, 3)]))
    for name in ("Break", "Delay"):
        assert not shown.page.get_by_role("button", name=name, exact=True).is_visible()
    shown.page.keyboard.press("b")
    assert shown.ask("app.tools.chosen") == "wall"
    shown.press("Run live")
    shown.press("Pause")
    shown.wait("!app.live.isAsking && !app.live.frames.length && app.live.fraction === 1")

    def cell_of(robot):
        cell = shown.ask(f"app.doc.robots[{robot}]")
        return cell % 40, cell // 40

    shown.press("Break")
    shown.click(30, 0)
    assert "no robot" in shown.text(".status")
    broken = cell_of(0)
    shown.click(*broken)
    shown.wait("app.live.last.broken === 1")
    assert "Robot a (number 0) breaks down" in shown.text(".status") and "broken" in shown.text(".legend")
    shown.page.keyboard.press("t")
    shown.click(*cell_of(1))
    shown.wait("!app.live.events.length && !app.live.isAsking")
    late = cell_of(1)
    for _ in range(3):
        step = shown.ask("app.live.last.step")
        shown.page.keyboard.press(".")
        shown.wait(f"app.live.last.step === {step + 1} && app.live.fraction === 1")
    assert cell_of(1) == late and cell_of(0) == broken and "late" in shown.text(".legend")
    assert re.fullmatch(r"step \d+ · 0:\d\d live", shown.text(".clock"))
    shown.press("Play")
    shown.wait("app.live.last.is_over")
    assert shown.table()["Arrived"] == ["2 of 3"]
    shown.press("Stop")
    assert shown.ask("app.tools.chosen") == "wall" and shown.faults == []


@pytest.mark.parametrize("tessellation", ["triangular", "square"])
def test_all_paths_are_drawn_where_robots_go(open_viewer, tessellation):
    scenario = th.Scenario(th.Area(tessellation, np.zeros((7, 16))), [(15, 3)], [(0, 1), (1, 5), (3, 3)])
    plan = make_plan(scenario, "greedy")
    shown = open_viewer(plan)
    shown.page.keyboard.press("End")
    plain = shown.colours()
    shown.page.get_by_label("All paths").check()
    drawn = (shown.colours() != plain).any(axis=-1)
    visited = np.zeros(drawn.shape, dtype=bool)
    for cells in plan.cells_by_step():
        visited.flat[cells[cells >= 0]] = True
    visited.flat[scenario.destinations] = False
    drawn.flat[scenario.destinations] = False
    np.testing.assert_array_equal(drawn & visited, visited)
    assert np.count_nonzero(drawn & ~visited) <= (0 if tessellation == "square" else 6)  # ways may pass over a centre
    shown.keep(f"all-paths-{tessellation}")
    shown.page.get_by_label("All paths").uncheck()
    np.testing.assert_array_equal(shown.colours(), plain)


def test_seconds_are_told_where_there_are_metres(open_viewer):
    area = th.Area("square", np.zeros((3, 9)), frame=th.Frame(0.5))
    shown = open_viewer(make_plan(th.Scenario(area, [(8, 1)], [(0, 1)]), "greedy"))
    shown.page.locator(".scrub").fill("4")
    assert shown.text(".clock") == f"step 4 / 8 · {4 * 0.5 * 2**0.5:.1f} s of {8 * 0.5 * 2**0.5:.1f} s"
    assert is_near(shown.colours(shift=(0.3, 0))[1, 4], palette.MOVING)
