"""Maps over the cells: where time is lost, where robots crowd; in colours, in words, beside each other and alone."""

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import Shown, is_near
from trihex.pictures import palette
from trihex.planners import make_plan
from trihex.viewer.bundle import Bundle, decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.layers import LAYERS, make_layer, with_layers

SHADES = palette.visits_ramp(256)


def queueing(tessellation="hexagonal", capacity=1, **more):
    """Return a plan of robots that wait at a door, and for the destination if few may enter."""
    barriers = np.zeros((7, 12), dtype=bool)
    barriers[:, 6] = True
    barriers[3, 6] = False
    area = th.Area(tessellation, barriers, **more)
    robots = [(x, y) for x in range(5) for y in range(7)]
    return make_plan(th.Scenario(area, [(10, 3)], robots, destination_capacity=capacity), "greedy")


def shown_by(colours, values, most):
    """Tell of which cells the colours are those of a map."""
    there = np.asarray(values) > 0
    expected = SHADES[np.rint(np.asarray(values)[there] * (255 / most)).astype(int)]
    return is_near(colours[there], expected, 3)


def test_layers_are_the_maps_of_the_plan_in_words_that_fit():
    plan = queueing()
    lost, crowd = make_layer("waiting", plan), make_layer("density", plan)
    np.testing.assert_array_equal(lost.arrays["values"].reshape(7, 12), th.make_waiting_map(plan))
    np.testing.assert_array_equal(crowd.arrays["values"].reshape(7, 12), th.make_density_map(plan))
    assert (lost.header["unit"], crowd.header["unit"]) == ("steps lost", "robots")
    timed = queueing("square", frame=th.Frame(0.5))
    lost = make_layer("waiting", timed)
    step = th.make_report(timed).step_seconds
    np.testing.assert_allclose(lost.arrays["values"].reshape(7, 12), th.make_waiting_map(timed) * step)
    assert lost.header["unit"] == "s lost" and "square metre" in make_layer("density", timed).header["unit"]


def test_prices_are_those_of_the_best_plan():
    best = make_plan(queueing(capacity=None).scenario, "optimal")
    walls, chokes = (make_layer(name, best).arrays["values"].reshape(7, 12) for name in ("walls", "chokes"))
    prices = th.make_prices(best)
    np.testing.assert_array_equal(walls, np.maximum(0, prices.price_of_cell("barrier")))
    np.testing.assert_array_equal(chokes, np.maximum(0, prices.price_of_cell("choke")))
    assert (walls > 0)[best.scenario.area.barriers].any() and not (walls > 0)[~best.scenario.area.barriers].any()
    door = make_layer("door", best)
    assert best.scenario.area.cell_to_xy(int(door.arrays["values"].argmax())) == prices.best_door
    assert door.header["unit"] == "time units saved by a door" and not door.header["are_seconds"]
    told, page = [], with_layers(Bundle({}, {}), best)
    make_layer("walls", best, lambda done, total: told.append((done, total)))
    assert told and sorted(page.header["layers"]) == ["density", "waiting"]  # what takes long is not made unasked


def test_prices_in_metres_are_seconds():
    area = th.Area(th.Tessellation("square", "edge"), [[0, 1, 0], [0, 1, 0], [0, 0, 0]], frame=th.Frame(20.0))
    best = make_plan(th.Scenario(area, [(2, 0)], [(0, 0), (0, 1)], following="allow"), "optimal")
    walls = make_layer("walls", best)
    assert walls.arrays["values"].reshape(3, 3)[:, 1].tolist() == [120, 80, 0]
    assert walls.header["unit"] == "s saved if open" and walls.header["are_seconds"]


def test_the_desk_has_layers_of_its_plans_and_says_what_there_is_not():
    plan = queueing()
    desk, frames = Desk(), []
    name = desk.show(plan).header["plan"]
    for wish in ({"plan": name, "layer": "prices?"}, {"plan": "plan-9", "layer": "waiting"}):
        desk.answer(encode({"op": "layer", **wish}), frames.append)
        assert decode(frames[-1]).header["kind"] == "error"
    desk.answer(encode({"op": "layer", "plan": name, "layer": "waiting"}), frames.append)
    assert decode(frames[-1]).arrays["values"].sum() == th.make_waiting_map(plan).sum()


@pytest.mark.parametrize("is_run", [False, True])
def test_a_page_alone_has_its_maps_with_it(browser, tmp_path, is_run):
    plan = queueing("square")
    record = th.Trial(plan.scenario).run() if is_run else plan
    th.write_page(record, tmp_path / "page.html")
    page = browser.new_page(viewport={"width": 1000, "height": 800})
    shown = Shown(page)
    page.goto((tmp_path / "page.html").as_uri())
    shown.wait("app.doc && app.runs[0]")
    page.get_by_label("Map", exact=True).select_option("waiting")
    page.keyboard.press("End")
    values = th.make_waiting_map(record)
    assert shown_by(shown.colours(shift=(0.3, 0.3)), values, values.max()).all()
    assert f"{values.max()} steps lost" in shown.text(".legend") and shown.faults == []
    page.close()


def test_maps_are_seen_and_told_and_two_plans_have_colours_alike(open_viewer):
    plan = queueing()
    shown = open_viewer(plan)
    page, menu = shown.page, shown.page.get_by_label("Map", exact=True)
    assert menu.locator("option").all_inner_texts() == ["None", *(layer.label for layer in LAYERS.values())]
    plain = shown.colours()
    menu.select_option("waiting")
    shown.wait("app.panes[0].layer")
    page.keyboard.press("End")
    values = th.make_waiting_map(plan)
    assert values.max() > 3 and shown_by(shown.colours(), values, values.max()).all()
    assert f"{values.max()} steps lost" in shown.text(".legend")
    y, x = np.argwhere(values == values.max())[0]
    page.mouse.move(*map(float, shown.place(x, y)))
    assert f"{values.max()} steps lost" in shown.text(".readout")
    page.get_by_label("Planner beside it").select_option("optimal")
    shown.press("Compare")
    shown.wait("app.runs[1] && app.panes[1].layer && !app.job")
    page.keyboard.press("End")
    beside = th.make_waiting_map(make_plan(plan.scenario, "optimal"))
    most = max(values.max(), beside.max())
    assert shown_by(shown.colours(0), values, most).all() and shown_by(shown.colours(1), beside, most).all()
    shown.keep("map-of-two-plans")
    shown.press("End comparing")
    menu.select_option("")
    page.keyboard.press("Home")
    np.testing.assert_array_equal(shown.colours(), plain)
    menu.select_option("density")
    shown.wait("app.panes[0].layer?.unit === 'robots'")
    shown.press("Run live")
    shown.wait("app.live")
    assert shown.ask("app.panes[0].layer") is None and not menu.is_visible()
    shown.press("Stop")
    assert menu.is_visible() and shown.ask("app.panes[0].layer.unit") == "robots" and shown.faults == []


def test_a_run_that_is_watched_has_its_maps_when_it_is_over(open_viewer, tmp_path):
    run = th.Trial(queueing("square").scenario).run()
    th.write_run(run, tmp_path / "run.npz")
    shown = open_viewer()
    page, menu = shown.page, shown.page.get_by_label("Map", exact=True)
    page.get_by_label("Steps per second").fill("30")
    shown.press("Open…")
    shown.press("run.npz")
    shown.wait("app.live && app.live.last.is_over && app.live.fraction === 1 && !app.live.isAsking")
    menu.select_option("waiting")
    shown.wait("app.panes[0].layer")
    values = th.make_waiting_map(run)
    assert values.max() > 3 and shown_by(shown.colours(shift=(0.3, 0.3)), values, values.max()).all()
    y, x = np.argwhere(values == values.max())[0]
    page.mouse.move(*map(float, shown.place(x, y)))
    assert all(f"{values.max()} steps lost" in shown.text(place) for place in (".readout", ".legend"))
    shown.keep("map-of-a-run")
    shown.press("Robot")
    page.get_by_label("Steps per second").fill("1")
    shown.click(0, 3)  # one that joins: it goes on
    shown.wait("!app.live.last.is_over")
    assert shown.ask("app.panes[0].layer") is None and not menu.is_visible()
    page.get_by_label("Steps per second").fill("30")
    shown.wait("app.live.last.is_over && app.panes[0].layer")
    lost = shown.ask("app.panes[0].layer.values.reduce((a, b) => a + b)")
    assert lost == values.sum() and menu.is_visible() and shown.faults == []


def test_prices_are_seen_beside_a_plan_that_has_none(open_viewer):
    area = th.make_rooms_area("hexagonal", 12, 16, room=4, seed=2)
    end = np.flatnonzero(~area.barriers)[60:61]
    plan = make_plan(th.Scenario(area, end, th.random_robots(area, 40, 1, avoid=end)), "greedy")
    shown = open_viewer(plan)
    menu = shown.page.get_by_label("Map", exact=True)
    menu.select_option("walls")
    assert "plan, or compare, with Optimal" in shown.text(".status")
    shown.page.get_by_label("Planner beside it").select_option("optimal")
    shown.press("Compare")
    shown.wait("app.runs[1] && app.panes[1].layer && !app.job")
    shown.page.keyboard.press("End")
    values = np.maximum(0, th.make_prices(make_plan(plan.scenario, "optimal")).price_of_cell("barrier"))
    assert shown_by(shown.colours(1), values, values.max()).all() and shown.ask("app.panes[0].layer") is None
    assert "time units saved if open" in shown.text(".legend")
    y, x = np.argwhere(values == values.max())[0]
    shown.page.mouse.move(*map(float, shown.place(x, y, 1)))
    assert f"opening this wall saves {values.max()} time units for all together" in shown.text(".readout")
    layer = "{values: [9.5, 200], are_seconds: true, sentence: 'saves {}'}"
    told = shown.ask(f"[0, 1].map((cell) => app.layers.wordsOf({{layers: {{walls: {layer}}}}}, cell))")
    assert told == ["saves 9.5 s", "saves 3 min 20 s"]
    shown.keep("prices-of-walls")
    menu.select_option("waiting")  # another one is wanted while the first is on its way
    shown.ask("app.layers.menu.value = 'density', app.layers.changed(), 0")
    shown.wait("app.panes[0].layer?.unit === 'robots' && app.panes[1].layer?.unit === 'robots'")
    assert shown.faults == []


def test_what_cannot_be_had_is_told(open_viewer):
    shown = open_viewer(queueing())
    shown.ask("app.runs[0].plan = 'plan-99'")
    shown.page.get_by_label("Map", exact=True).select_option("waiting")
    shown.wait("app.status.isWarning")
    assert "not kept any more" in shown.text(".status")
