"""The viewer as a folder for any static host: it plays, compares and grows, and asks nobody but that host."""

from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

import numpy as np
import pytest
from click.testing import CliRunner

import trihex as th
from tests.viewer.pages import Shown
from trihex.cli import main
from trihex.planners import make_plan


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass


@contextmanager
def hosted(folder):
    """Serve a folder as any static host does; yield its address."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder))) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


def yard(**frame):
    area = th.make_rooms_area("hexagonal", 14, 20, room=4, seed=3)
    area = th.Area("hexagonal", area.barriers, "yard", th.Frame(**frame) if frame else None)
    end = np.flatnonzero(~area.barriers)[-1:]
    return th.Scenario(area, end, th.random_robots(area, 30, 1, avoid=end))


def test_a_folder_plays_and_compares_without_a_server_of_ours(browser, tmp_path):
    scenario = yard()
    files = th.write_site(scenario, tmp_path / "site")
    assert {path.name for path in files} >= {"index.html", "viewer.js", "plan-fcost-square.bin", "generations.bin"}
    asked = []
    with hosted(tmp_path / "site") as address:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.on("request", lambda request: asked.append(request.url))
        shown = Shown(page, None)
        page.goto(address)
        shown.wait("app.doc")
        for name in ("Wall", "Scatter", "Open…", "Save…", "Run live"):
            assert not page.get_by_role("button", name=name, exact=True).is_visible()
        shown.press("Grow the field")
        shown.wait("app.growth && app.growth.isComplete && !app.growth.isPlaying")
        assert shown.ask("app.growth.last") == len(list(th.distance_generations(scenario))) - 1
        page.get_by_label("Arrows").check()
        shown.wait("app.fields?.directions")
        shown.press("Plan")
        shown.wait("app.runs[0] && !app.job")
        page.get_by_label("Map", exact=True).select_option("waiting")
        shown.wait("app.panes[0].layer")
        page.get_by_label("Planner beside it").select_option("optimal")
        shown.press("Compare")
        shown.wait("app.runs[1] && !app.job && app.runs[0].summary.lower_bound_name === 'optimum'")
        totals = [make_plan(scenario, name).total_time for name in ("fcost", "optimal")]
        assert shown.table()["Total time"] == [f"{total:,}".replace(",", " ") for total in totals]
        page.get_by_label("Cells beside it").select_option("square")
        shown.press("Compare")
        shown.wait("app.runs[1]?.summary.tessellation === 'square' && !app.job")
        square = th.Scenario(th.Area("square", scenario.area.barriers), scenario.destinations, scenario.robots)
        assert shown.ask("app.runs[1].summary.total_time") == make_plan(square, "optimal").total_time
        page.keyboard.press("Space")
        shown.wait("app.clock.at > 1")
        page.keyboard.press("w")  # there is nothing to paint with
        page.keyboard.press("l")
        page.keyboard.press("Control+s")
        assert shown.ask("app.tools.chosen") == "move" and not page.get_by_role("dialog").is_visible()
        assert shown.faults == []
        page.close()
    assert asked and all(url.startswith((address, "data:")) for url in asked)


def test_a_plan_is_shown_at_once_and_places_keep_their_cells(browser, tmp_path):
    plan = make_plan(yard(cell_size=0.5), "astar")
    files = th.write_site(plan, tmp_path, planners=("greedy",))
    assert [path.name for path in files if path.name.startswith("plan-")] == ["plan-greedy-hexagonal.bin"]
    with hosted(tmp_path) as address:
        shown = Shown(browser.new_page())
        shown.page.goto(address)
        shown.wait("app.runs[0]")
        assert shown.table()["Total time"] == [f"{plan.total_time:,}".replace(",", " ")]
        shown.page.close()
    th.write_site(plan, tmp_path, planners=("greedy",))  # it is its own


def test_without_a_file_it_shows_what_the_viewer_begins_with(browser, open_viewer, tmp_path):
    th.write_site(None, tmp_path, planners=("greedy",))
    first = open_viewer()
    first.wait("app.doc.robots.length && !app.making")
    with hosted(tmp_path) as address:
        shown = Shown(browser.new_page())
        shown.page.goto(address)
        shown.wait("app.doc")
        for what in ("[...app.doc.barriers]", "[...app.doc.destinations]", "[...app.doc.robots]"):
            assert shown.ask(what) == first.ask(what)
        shown.page.close()


def test_what_cannot_be_is_told(tmp_path):
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(th.FormatError, match="holds other files"):
        th.write_site(yard(), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]
    with pytest.raises(th.ScenarioError, match="robots"):
        th.write_site(th.Scenario(yard().area, [(0, 0)]), tmp_path / "new")
    with pytest.raises(th.PlanError, match="planner must be one of"):
        th.write_site(yard(), tmp_path / "new", planners=("gready",))
    assert not (tmp_path / "new").exists()


def test_the_command_writes_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    th.write_scenario(yard(), "yard.toml")
    done = CliRunner().invoke(main, ["view", "yard.toml", "--export", "site", "--planners", "fcost"])
    assert done.exit_code == 0 and "site/index.html: 16 files" in done.output, done.output
    for words, told in (
        (["view", "--planners", "fcost"], "--planners is for --export"),
        (["view", "--export", "."], "holds other files"),
        (["view", "yard.toml", "--export", "yard.toml"], "yard.toml"),
    ):
        done = CliRunner().invoke(main, words)
        assert done.exit_code == 2 and told in done.output and done.output.count("\n") == 1, done.output
