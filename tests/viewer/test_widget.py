"""The viewer in a notebook: the module in a browser, the widget in Python, and messages between them."""

import base64
import json
import threading

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import Shown, is_near
from trihex.pictures import palette
from trihex.planners import make_plan

# What anywidget does in a notebook: hand over a model, carry messages with buffers to Python and back.
NOTEBOOK = """<!DOCTYPE html><title>notebook</title><style>body { margin: 0 } CSS</style><div id="trihex-cell"></div>
<script type="module">
import viewer from "./viewer.js";
const bytes = (text) => new DataView(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
const traits = { _settings: SETTINGS, _first: bytes("FIRST"), height: 700 }, listeners = [];
const model = {
  get: (name) => traits[name],
  on: (event, listener) => listeners.push(listener),
  send: async (message, _, buffers = []) => {
    const letters = (buffer) => Array.from(new Uint8Array(buffer), (byte) => String.fromCharCode(byte)).join("");
    const text = buffers.map((buffer) => btoa(letters(buffer)));
    for (const [answer, frame] of await window.toPython(JSON.stringify(message), text))
      for (const listener of listeners) listener(answer, [bytes(frame)]);
  },
};
const el = document.getElementById("trihex-cell");
window.close_widget = viewer.render({ model, el });
el.id = "trihex";
</script>"""


@pytest.fixture
def in_notebook(browser):
    """Show a widget as a notebook does."""
    contexts = []

    def show(widget):
        context = browser.new_context(viewport={"width": 1200, "height": 760})
        contexts.append(context)
        page, sent = context.new_page(), []
        widget.send = lambda message, buffers: sent.append((message, base64.b64encode(buffers[0]).decode()))

        def to_python(message, buffers):
            before = set(threading.enumerate())
            widget._handle_custom_msg(json.loads(message), [memoryview(base64.b64decode(text)) for text in buffers])
            for thread in set(threading.enumerate()) - before:
                thread.join()
            answers, sent[:] = sent[:], []
            return answers

        page.expose_function("toPython", to_python)
        html = NOTEBOOK.replace("CSS", widget._css).replace("SETTINGS", json.dumps(widget._settings))
        html = html.replace("FIRST", base64.b64encode(widget._first).decode())
        answers = {"/": ("text/html", html), "/viewer.js": ("text/javascript", widget._esm)}

        def fulfil(route):
            kind, body = answers["/" + route.request.url.rsplit("/", 1)[1]]
            route.fulfill(content_type=kind, body=body)

        page.route("http://notebook.test/**", fulfil)
        shown = Shown(page)
        page.goto("http://notebook.test/")
        shown.wait("app.doc && !app.job")
        return shown

    yield show
    for context in contexts:
        context.close()


def test_a_scenario_is_planned_in_the_notebook_and_had_back(in_notebook):
    area = th.make_caves_area("triangular", 16, 30, seed=2)
    free = np.flatnonzero(~area.barriers)
    scenario = th.Scenario(area, free[:1], th.random_robots(area, 20, 4, avoid=free[:1]))
    widget = th.make_widget(scenario, height=700)
    assert widget.plan is None and widget.scenario is None
    shown = in_notebook(widget)
    np.testing.assert_array_equal(is_near(shown.colours(), palette.BARRIER), area.barriers)
    shown.page.get_by_label("Planner", exact=True).select_option("greedy")
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    wanted = make_plan(scenario, "greedy")
    assert shown.table()["Total time"] == [f"{wanted.total_time:,}".replace(",", " ")]
    np.testing.assert_array_equal(widget.plan.actions, wanted.actions)
    assert widget.scenario == scenario
    assert shown.faults == []
    shown.page.evaluate("() => window.close_widget()")


def test_a_live_run_is_driven_in_the_notebook_and_had_back(in_notebook):
    area = th.Area("triangular", np.zeros((4, 16)))
    widget = th.make_widget(th.Scenario(area, [(15, 2)], [(0, 0), (1, 3)]), height=700)
    assert widget.run is None
    shown = in_notebook(widget)
    shown.page.get_by_label("Steps per second").fill("1")  # one step a second
    shown.press("Run live")
    shown.press("Pause")
    shown.wait("app.live && app.live.last.step && app.live.fraction === 1 && !app.live.isAsking")
    shown.press("Wall")
    shown.click(8, 2)
    shown.wait("app.doc.barriers[2 * 16 + 8]")
    shown.page.get_by_label("Steps per second").fill("13")
    shown.press("Play")
    shown.wait("app.live.summary")
    run = widget.run
    assert run.arrived.all() and th.audit_run(run).is_clean
    assert [one.blocked for one in run.occurrences] == [(2 * 16 + 8,)] and shown.faults == []


def test_a_plan_is_shown_and_mistakes_are_told(in_notebook):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    plan = make_plan(scenario, "greedy")
    widget = th.make_widget(plan)
    assert widget.plan == plan
    shown = in_notebook(widget)
    assert shown.table()["Steps"] == ["2"]
    shown.page.get_by_label("Robots", exact=True).fill("99")
    shown.press("Scatter")
    shown.page.wait_for_function("() => document.querySelector('.status.warning')")
    assert "robots must be at most" in shown.text(".status")


def test_a_widget_needs_no_record():
    widget = th.make_widget()
    assert widget._first == b"" and widget.height == 720
    assert set(widget._settings["planners"]) >= {"greedy", "fcost"}
