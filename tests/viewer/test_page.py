"""A plan as one HTML file that plays without a network."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import trihex as th
from tests.running.test_run_outputs import a_run_with_changes
from tests.viewer.pages import Shown, is_near
from trihex.cli import main
from trihex.kernels.codes import LATE
from trihex.pictures import palette
from trihex.planners import make_plan
from trihex.viewer import script
from trihex.viewer.script import module, parts, source_of

WEB = Path(script.__file__).parent / "web"
NAME = "</script><script>document.title='evil'</script>"


@pytest.fixture
def plan():
    area = th.make_rooms_area("hexagonal", 14, 20, room=4, seed=3)
    area = th.Area("hexagonal", area.barriers, NAME)
    corner = np.flatnonzero(~area.barriers)[-1:]
    return make_plan(th.Scenario(area, corner, th.random_robots(area, 30, 1, avoid=corner)), "greedy")


def test_it_plays_offline_and_asks_nobody(browser, tmp_path, plan):
    th.write_page(plan, tmp_path / "plan.html")
    context = browser.new_context(offline=True, viewport={"width": 1100, "height": 700})
    page = context.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    shown = Shown(page)
    page.goto((tmp_path / "plan.html").as_uri())
    shown.wait("app.doc")
    assert page.title().startswith("greedy on </script>") and shown.faults == []
    assert shown.text(".status") == "Press Play."
    report = th.make_report(plan)
    table = shown.table()
    assert table["Total time"] == [f"{plan.total_time:,}".replace(",", " ")]
    assert table["Lower bound"][0].startswith(f"{report.lower_bound:,}".replace(",", " "))
    for button in ("Plan", "Save…", "Wall", "Scatter"):
        assert not page.get_by_role("button", name=button, exact=True).is_visible()
    page.get_by_label("Colours").check()
    cells = list(plan.cells_by_step())
    page.locator(".scrub").fill("6")
    shown.wait("app.runs[0].playback.step === 6")
    colours = shown.colours(shift=(0, -0.2))
    seen = sum(is_near(colours, colour).ravel() for colour in (palette.MOVING, palette.WAITING, palette.FINAL)) > 0
    np.testing.assert_array_equal(np.flatnonzero(seen), np.unique(cells[6][cells[6] >= 0]))
    shown.artefacts = None
    page.get_by_label("Steps per second").fill("13")
    shown.press("Play")
    shown.wait("app.clock.at === app.steps && !app.clock.isPlaying")
    assert "30 arrived" in shown.text(".sets")
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    assert len([url for url in asked if url.startswith("file:")]) == 1
    context.close()


def test_a_run_plays_in_the_world_of_each_step(browser, tmp_path):
    """Robots are where they were, late ones in their colour, walls and destinations come and go, seconds are told."""
    run = a_run_with_changes()
    th.write_page(run, tmp_path / "run.html")
    shown = Shown(browser.new_page(viewport={"width": 1100, "height": 700}))
    shown.page.goto((tmp_path / "run.html").as_uri())
    shown.wait("app.doc")
    report = th.make_run_report(run)
    assert shown.table()["Total time"] == [f"{run.total_time:,}".replace(",", " ")]
    assert "Gap to the optimum" not in shown.table() and shown.table()["Events"] == ["6"]
    worlds = [(run.scenario.area.barriers, run.scenario.destinations), *run.worlds()]
    sets = (palette.MOVING, palette.WAITING, palette.FINAL, palette.STRANDED, palette.SERIES[1])
    for step, cells in enumerate(run.cells_by_step()):
        shown.page.locator(".scrub").fill(str(step))
        shown.wait(f"app.runs[0].playback.step === {step}")
        barriers, destinations = worlds[step]
        corners = shown.colours(shift=(0.38, 0.38))
        np.testing.assert_array_equal(is_near(corners, palette.BARRIER), barriers)
        ends = np.flatnonzero(is_near(corners, palette.DESTINATION))
        assert ends.tolist() == np.sort(destinations).tolist()
        colours = shown.colours(shift=(0.29, 0))  # beside the letters
        seen = sum(is_near(colours, colour).ravel() for colour in sets) > 0
        np.testing.assert_array_equal(np.flatnonzero(seen), np.unique(cells[cells >= 0]))
        at, end = (number * report.step_seconds for number in (step, run.steps))
        assert shown.text(".clock") == f"step {step} / {run.steps} · {at:.1f} s of {end:.1f} s"
    late = int(np.flatnonzero((run.actions == LATE).any(axis=1))[0])
    shown.page.locator(".scrub").fill(str(late))
    shown.wait(f"app.runs[0].playback.step === {late}")
    assert is_near(shown.colours(shift=(0.29, 0)), palette.SERIES[1]).any()
    assert shown.faults == []


def test_the_viewer_opens_a_run(open_viewer, tmp_path):
    """As a file of its folder or as what it is started with; planning there makes a plan of what the run began with."""
    run = a_run_with_changes()
    th.write_run(run, tmp_path / "run.npz")
    shown = open_viewer(run)
    shown.wait("app.runs[0]")
    assert shown.table()["Total time"] == [f"{run.total_time:,}".replace(",", " ")]
    shown.press("Save…")
    dialog = shown.page.get_by_role("dialog")
    assert dialog.get_by_label("What to save").locator("option[value=plan]").is_disabled()
    shown.page.keyboard.press("Escape")
    shown.press("Open…")
    shown.press("run.npz")
    shown.wait("app.live && !app.job")  # what it did is done again, live, and can be led another way
    assert shown.faults == []


def test_two_plans_are_shared_side_by_side(open_viewer, browser, tmp_path, plan):
    """The viewer saves both; the file plays them on one clock."""
    shown = open_viewer(plan)
    shown.page.get_by_label("Planner beside it").select_option("fcost")
    shown.page.get_by_label("Cells beside it").select_option("square")
    shown.press("Compare")
    shown.wait("app.runs[1] && !app.job")
    table = shown.table()
    shown.press("Save…")
    shown.page.get_by_role("dialog").get_by_label("What to save").select_option("page")
    shown.page.get_by_role("dialog").get_by_label("Name").fill("both.html")
    shown.press("Save in folder")
    shown.wait("document.querySelector('.status').textContent === 'Saved both.html.'")
    alone = Shown(browser.new_page(viewport={"width": 1100, "height": 700}), shown.artefacts)
    alone.page.goto((tmp_path / "both.html").as_uri())
    alone.wait("app.runs[1]")
    assert alone.table()["Total time"] == table["Total time"] and len(table["Total time"]) == 2
    alone.page.locator(".scrub").fill("4")
    alone.wait("app.runs.every((run) => run.playback.step === 4)")
    area = th.Area("square", plan.scenario.area.barriers)
    other = make_plan(th.Scenario(area, plan.scenario.destinations, plan.scenario.robots))
    for pane, one in ((0, plan), (1, other)):
        there = next(cells for step, cells in enumerate(one.cells_by_step()) if step == 4)
        seen = (
            sum(is_near(alone.colours(pane, (0, -0.2)), c, 40).ravel() for c in (palette.MOVING, palette.WAITING)) > 0
        )
        assert set(np.flatnonzero(seen)) <= set(there) and np.count_nonzero(seen) > 10
    alone.keep("page-of-two-plans")
    assert alone.faults == shown.faults == []
    alone.page.close()


def test_the_file_obeys_a_policy_and_holds_no_foreign_address(tmp_path, plan):
    th.write_page(plan, tmp_path / "plan.html")
    text = (tmp_path / "plan.html").read_text()
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)[1]
    assert "default-src 'none'" in policy and "connect-src 'none'" in policy and "unsafe" not in policy
    assert set(re.findall(r"https?://[\w./]*", text)) == {"http://www.w3.org/2000/svg"}  # a name, never fetched
    assert text.count("</script>") == 3 and NAME not in text
    th.write_page(plan, tmp_path / "again.html")
    assert (tmp_path / "again.html").read_text() == text


def test_the_command_writes_it(tmp_path, plan):
    th.write_plan(plan, tmp_path / "plan.npz")
    done = CliRunner().invoke(main, ["animate", str(tmp_path / "plan.npz"), "--out", str(tmp_path / "plan.html")])
    assert done.exit_code == 0, done.output
    th.write_page(plan, tmp_path / "same.html")
    assert (tmp_path / "plan.html").read_bytes() == (tmp_path / "same.html").read_bytes()
    th.write_plan(make_plan(plan.scenario, "fcost"), tmp_path / "other.npz")
    both = ["animate", str(tmp_path / "plan.npz"), "--beside", str(tmp_path / "other.npz"), "--out"]
    done = CliRunner().invoke(main, [*both, str(tmp_path / "both.html")])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "both.html").stat().st_size > (tmp_path / "plan.html").stat().st_size
    done = CliRunner().invoke(main, [*both, str(tmp_path / "both.gif")])
    assert done.exit_code == 2 and "--beside is for pages (.html)" in done.output
    with pytest.raises(th.FormatError, match="suffix of a page"):
        th.write_page(plan, tmp_path / "plan.pdf")


def test_the_module_is_joined_from_files_that_import_from_those_before_them():
    exported = {}
    for name in parts():
        text = source_of(name)
        for words, other in re.findall(r'^import \{ ([^}]*) \} from "\./([\w-]+\.js)";$', text, re.MULTILINE):
            assert {word.strip() for word in words.split(",")} <= exported[other], (name, other)
        assert text.count("\n") <= 300 and text.startswith("// ")
        given = re.findall(r"^export (?:async )?(?:class|function|const) (\w+)", text, re.MULTILINE)
        given += re.findall(r"(?<=, )(\w+) = \d", "".join(re.findall(r"^export const .*", text, re.MULTILINE)))
        assert not any(word in names for word in given for names in exported.values()), name
        exported[name] = set(given)
    assert "\nimport " not in module() and set(parts()) == {path.name for path in WEB.glob("*.js")}


def test_lines_of_the_page_fit_an_editor():
    for path in WEB.iterdir():
        long = [number for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > 120]
        assert not long, (path.name, long)


def test_what_an_object_holds_is_written_by_no_other_file():
    """State of one noun has one owner; what is written elsewhere belongs to elements and to records in the making."""
    holders = {}
    for name in parts():
        for body in re.split(r"^(?:export )?class ", source_of(name), flags=re.MULTILINE)[1:]:
            for field in re.findall(r"^ +this\.(\w+) = ", body, re.MULTILINE):
                holders.setdefault(field, set()).add(name)
    assert {"app", "at", "isPlaying", "known", "stroke"} <= holders.keys()
    assignment = re.compile(r"(\w+)\.(\w+)(?: (?:[-+*/]|\?\?)?= |\+\+|--)")
    for name in parts():
        for holder, field in assignment.findall(source_of(name)):
            if holder not in ("this", "changed", "dataset", "root", "el"):
                assert field not in holders or name in holders[field], f"{name}: {holder}.{field}"
