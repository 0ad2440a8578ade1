"""The story of a user, in a browser, for each tessellation: from opening a file to saving the plan."""

import numpy as np
import pytest

import trihex as th
from tests.sweeps import swept
from tests.viewer.pages import is_near
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures import palette
from trihex.planners import make_plan

AREA = """type octile
height 20
width 30
map
..............................
.@@@@@..@@@@@....@@@@@@@@@....
.@....................@.......
.@....................@.......
.@.....@@@@@.....@....@.......
.@.....@...@.....@....@@@@@...
.......@...@.....@............
.......@...@.....@............
.@@@@..@...@.....@....@@@@@...
......................@...@...
......................@...@...
.@@@@@@@@.....@@@@....@.......
..............@.......@...@...
..............@.......@@@@@...
....@@@@@.....@...............
....@...................@@@...
....@......@@@@@@.......@.....
....@@@@@.......@.......@.....
................@.............
..............................
"""
WALL = [(12, 5), (13, 5), (14, 5), (15, 5), (16, 5)]
DESTINATION = (19, 9)
BESIDE = (0, -0.2)  # on the disc of a robot, beside its number
ROBOTS = [palette.MOVING, palette.WAITING, palette.FINAL, palette.STRANDED]


def grouped(number):
    return f"{number:,}".replace(",", " ")


def show_step(shown, step):
    shown.page.locator(".scrub").fill(str(step))
    shown.wait(f"app.runs[0].playback.step === {step}")


WINDOWS = {"triangular": (1400, 900), "hexagonal": (1024, 768), "square": (1280, 800)}


@pytest.mark.parametrize("tessellation", list(WINDOWS)[: swept(3)])
def test_the_story(open_viewer, tmp_path, tessellation):
    (tmp_path / "yard.map").write_text(AREA)
    barriers = np.array([list(row) for row in AREA.splitlines()[4:]]) == "@"
    width, height = WINDOWS[tessellation]
    shown = open_viewer(viewport={"width": width, "height": height})
    page = shown.page

    # open an area
    shown.press("Open…")
    page.get_by_role("dialog").get_by_label("Cells").select_option(tessellation)
    shown.press("yard.map")
    shown.wait("app.doc.header.name === 'yard'")
    assert shown.text(".name") == f"yard · 30 × 20 {tessellation}"  # noqa: RUF001
    assert "Opened yard.map" in shown.text(".status") and "no destination" in shown.text(".status")
    assert page.get_by_role("radio", name=tessellation.title()).is_checked()
    np.testing.assert_array_equal(is_near(shown.colours(), palette.BARRIER), barriers)

    # paint a wall
    shown.press("Wall")
    shown.drag(WALL)
    for x, y in WALL:
        barriers[y, x] = True
    np.testing.assert_array_equal(is_near(shown.colours(), palette.BARRIER), barriers)

    # scatter 200 robots
    page.get_by_label("Robots", exact=True).fill("200")
    page.get_by_label("Seed", exact=True).fill("5")
    shown.press("Scatter")
    shown.wait("app.doc.robots.length === 200")
    assert "200 robots, 0 destinations" in page.locator("[data-section=Robots]").inner_text()
    blue = is_near(shown.colours(shift=BESIDE), palette.MOVING)
    assert np.count_nonzero(blue) == 200 and not (blue & barriers).any()
    starts = np.array(shown.ask("[...app.doc.robots]"))
    np.testing.assert_array_equal(np.flatnonzero(blue), np.sort(starts))

    # set D, on a cell that may hold a robot: it goes
    shown.press("Erase")
    shown.click(*DESTINATION)
    shown.press("Destination")
    shown.click(*DESTINATION)
    shown.wait("app.doc.destinations.length === 1")
    page.mouse.move(*map(float, shown.place(*DESTINATION)))
    assert shown.text(".readout") == f"cell {DESTINATION} · destination"
    starts = starts[starts != DESTINATION[1] * 30 + DESTINATION[0]]
    scenario = th.Scenario(th.Area(tessellation, barriers, "yard"), [DESTINATION], starts)

    # watch the field grow
    shown.press("Grow the field")
    shown.wait("app.growth && app.growth.generation > 2")
    assert "Generation" in page.locator("[data-section='Distance field']").inner_text()
    shown.wait("app.growth.isComplete && !app.growth.isPlaying")
    generations = [states.copy() for states in th.distance_generations(scenario)]
    words = page.locator("[data-section='Distance field'] output").inner_text()
    last = len(generations) - 1
    assert words == f"Generation {last} of {last}: nothing changes any more, this is the N-scheme."
    shown.keep(f"story-{tessellation}-field")
    is_empty = ~barriers
    is_empty.flat[[*starts, scenario.destinations[0]]] = False
    for generation in (4, last, 1):
        page.get_by_label("Generation", exact=True).fill(str(generation))
        coloured = ~is_near(shown.colours(), palette.FREE)
        reached = generations[generation] != NOT_REACHED
        np.testing.assert_array_equal(coloured[is_empty], reached[is_empty])

    # plan
    page.get_by_label("Planner", exact=True).select_option("greedy")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    plan = make_plan(scenario, "greedy")
    report = th.make_report(plan)
    assert shown.text(".status").startswith(f"Greedy: total time {grouped(plan.total_time)}.")
    table = shown.table()
    assert table["Total time"] == [grouped(plan.total_time)]
    assert table["Steps"] == [grouped(plan.steps)]
    assert table["Moves d"] == [grouped(report.total_distance)]
    assert table["Waiting w"] == [grouped(report.total_waiting)]
    assert table["Arrived"] == [f"{report.arrived_count} of {starts.size}"]
    assert table["Conflicts"] == ["none"]

    # play: each step shows each robot where the plan has it
    cells = list(plan.cells_by_step())
    for step in (0, 7, plan.steps // 2, plan.steps - 1):
        show_step(shown, step)
        assert shown.text(".clock") == f"step {step} / {plan.steps}"
        colours, seen = shown.colours(shift=BESIDE), np.zeros(barriers.size, dtype=bool)
        for colour in ROBOTS:
            seen |= is_near(colours, colour).ravel()
        # Robots that stand on no cell any more have arrived.
        np.testing.assert_array_equal(np.flatnonzero(seen), np.unique(cells[step][cells[step] >= 0]))
        sets = plan.sets_at(step + 1)
        assert f"{sets.filled.size} moving" in shown.text(".sets")
        assert f"{np.count_nonzero(cells[step] < 0)} arrived" in shown.text(".sets")
    show_step(shown, 0)
    page.get_by_label("Steps per second").fill("4")  # slow enough that a busy machine looks before it ends
    shown.press("Play")
    shown.wait("app.clock.at > 1")
    assert shown.text(".play") == "Pause"
    page.get_by_label("Steps per second").fill("30")
    shown.wait("!app.clock.isPlaying")
    assert shown.text(".status") == "The last robot has arrived."
    assert f"{report.arrived_count} arrived" in shown.text(".sets")
    assert shown.text(".sofar") == f"All {grouped(plan.total_time)} time units are used."

    # compare with the optimum
    page.get_by_label("Planner beside it").select_option("optimal")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job && app.runs[0].summary.lower_bound_name === 'optimum'")
    beside = make_plan(scenario, "optimal")
    optimum = beside.total_time
    table = shown.table()
    assert table["Total time"] == [grouped(plan.total_time), grouped(optimum)]
    assert table["Lower bound"] == [f"{grouped(optimum)} (optimum)"] * 2
    gap = 100 * (plan.total_time / optimum - 1)
    assert table["Gap to the optimum"] == [f"{gap:.{2 if gap < 10 else 1}f} %", "0, proven"]
    assert "proven optimal" in page.locator(".caption").nth(1).inner_text()
    show_step(shown, 5)
    shown.keep(f"story-{tessellation}-compare")
    for pane, planner in ((0, plan), (1, beside)):
        there = next(c for step, c in enumerate(planner.cells_by_step()) if step == 5)
        colours = shown.colours(pane)
        seen = sum(is_near(colours, colour, 40).ravel() for colour in ROBOTS[:3]) > 0
        assert set(np.unique(there[there >= 0])) <= set(np.flatnonzero(seen))

    # save, in the folder and as a download
    shown.press("Save…")
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("What to save").select_option("plan")
    dialog.get_by_label("Format").select_option(".npz")
    dialog.get_by_label("Name").fill("yard.npz")
    shown.press("Save in folder")
    page.wait_for_function("() => document.querySelector('.status').textContent === 'Saved yard.npz.'")
    saved = th.read_plan(tmp_path / "yard.npz")
    np.testing.assert_array_equal(saved.actions, plan.actions)
    shown.press("Save…")
    dialog.get_by_label("What to save").select_option("scenario")
    with page.expect_download() as download:
        shown.press("Download")
    download.value.save_as(tmp_path / "download.toml")
    again = th.read_scenario(tmp_path / "download.toml")
    np.testing.assert_array_equal(again.robots, scenario.robots)
    np.testing.assert_array_equal(again.area.barriers, barriers)
    assert again.area.tessellation == scenario.area.tessellation
    assert shown.faults == []
