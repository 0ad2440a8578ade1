"""What a user sees while the page waits: clicks that come early are not lost, and compiling is told."""

from concurrent.futures import ThreadPoolExecutor
from threading import Event, Thread

import numpy as np
import pytest

import trihex as th
from trihex.kernels import preparing
from trihex.viewer import compiling
from trihex.viewer.bundle import decode, encode
from trihex.viewer.call import Call, CancelledError
from trihex.viewer.desk import Desk

SLOW = """(op) => {
  const { host } = document.querySelector('#trihex').app, ask = host.ask.bind(host);
  window.asked = [];
  host.ask = async (header, arrays, more) => {
    window.asked.push(header.op);
    if (header.op === op) await new Promise((done) => { window.release = done; });
    return ask(header, arrays, more);
  };
}"""


@pytest.fixture
def nothing_compiled(monkeypatch):
    """As on the first start: no kernel is on disk; what `prepare` would compile is only told."""
    monkeypatch.setattr(compiling, "_prepared", set())
    monkeypatch.setattr(compiling, "is_marked", lambda kernels: False)

    def prepare(*uses):
        for done in range(4):
            preparing.watch(done, 3)

    monkeypatch.setattr(preparing, "prepare", prepare)


def call(frames, is_cancelled=lambda: False):
    return Call({}, lambda frame: frames.append(decode(frame).header), is_cancelled)


def test_a_page_is_told_how_many_parts_are_compiled(nothing_compiled):
    frames, before = [], preparing.watch
    compiling.prepare_for(call(frames), "greedy", "audit")
    assert [frame["stage"] for frame in frames] == ["compiling"] * 5
    assert frames[0]["done"] == 0 and frames[0]["total"] > 3  # before the first worker has begun
    assert [(frame["done"], frame["total"]) for frame in frames[1:]] == [(0, 3), (1, 3), (2, 3), (3, 3)]
    assert preparing.watch is before
    compiling.prepare_for(call(frames), "audit")
    assert len(frames) == 5  # that is there now


def test_compiling_ends_when_the_page_has_gone(nothing_compiled):
    with pytest.raises(CancelledError):
        compiling.prepare_for(call([], lambda: True), "greedy")
    frames = []
    compiling.prepare_for(call(frames), "greedy")
    assert frames


def test_a_second_request_waits_for_the_first_and_compiles_nothing_again(nothing_compiled, monkeypatch):
    is_compiling, may_end, compiled = Event(), Event(), []

    def prepare(*uses):
        compiled.append(uses)
        is_compiling.set()
        may_end.wait(60)

    monkeypatch.setattr(preparing, "prepare", prepare)
    with ThreadPoolExecutor() as pool:
        first = pool.submit(compiling.prepare_for, call([]), "greedy")
        is_compiling.wait(60)
        second = pool.submit(compiling.prepare_for, call([]), "greedy")
        gone = pool.submit(compiling.prepare_for, call([], lambda: True), "greedy")
        assert isinstance(gone.exception(60), CancelledError)  # it need not wait to the end
        may_end.set()
        first.result(60)
        second.result(60)
    assert len(compiled) == 1


def test_another_thread_that_compiles_does_not_tell_the_page(nothing_compiled, monkeypatch):
    frames = []

    def prepare(*uses):
        other = Thread(target=preparing.watch, args=(7, 9))
        other.start()
        other.join()

    monkeypatch.setattr(preparing, "prepare", prepare)
    compiling.prepare_for(call(frames), "greedy")
    assert 9 not in [frame["total"] for frame in frames]


def test_every_request_that_computes_is_prepared(nothing_compiled):
    from trihex.formats import draft_of
    from trihex.viewer.document import document_of

    area = th.make_rooms_area("square", 14, 20, room=4, seed=3)
    end = np.flatnonzero(~area.barriers)[-1:]  # in a corner: no bound that is had at once proves this plan
    scenario = th.Scenario(area, end, th.random_robots(area, 30, 1, avoid=end))
    document, arrays = document_of(draft_of(scenario))
    wishes = [
        {"op": "generate", "generator": "maze", "tessellation": "square", "width": 9, "height": 9, "seed": 1},
        {"op": "scatter", "count": 1, "seed": 1},
        {"op": "fields"},
        {"op": "generations"},
        {"op": "plan", "planner": "greedy"},
        {"op": "bound", "plan": "plan-1"},
        {"op": "live", "planner": "fcost"},
    ]
    desk = Desk()
    for wish in wishes:
        compiling._prepared.clear()
        sent = []
        own = {} if wish["op"] in ("generate", "bound") else {"document": document}
        desk.answer(encode({**wish, **own}, arrays), sent.append)
        frames = [decode(frame).header for frame in sent]
        assert frames[-1]["kind"] == "result", frames[-1]
        assert "compiling" in [frame.get("stage") for frame in frames], wish


def test_a_click_on_plan_while_robots_are_drawn_is_not_lost(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((6, 9))), [(8, 5)], [(0, 0)]))
    page = shown.page
    page.evaluate(SLOW, "scatter")
    page.get_by_label("Robots", exact=True).fill("12")
    shown.press("Scatter")
    page.wait_for_function("() => window.release")
    shown.press("Plan")
    shown.press("Plan")  # who waits clicks again
    assert shown.text(".status") == "Plans are made as soon as the area and its robots are there."
    assert page.evaluate("window.asked") == ["scatter"]
    page.evaluate("window.release()")
    shown.wait("app.runs[0] && !app.job")
    assert shown.ask("app.runs[0].summary.robots") == 12
    assert page.evaluate("window.asked.filter((op) => op === 'plan').length") == 1
    assert shown.faults == []


def test_compiling_is_told_in_words(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((6, 9))), [(8, 5)], [(0, 0)]))
    shown.page.evaluate(
        """() => {
          const { app } = document.querySelector('#trihex');
          app.host.ask = (header, arrays, { onFrame }) => new Promise(() => {
            onFrame({ header: { kind: "progress", stage: "compiling", done: 3, total: 17 }, arrays: {} });
          });
        }"""
    )
    shown.press("Plan")
    assert "once" in shown.text(".status") and "compiles" in shown.text(".status")
    assert shown.text(".working .note") == "Compiling, once: 3 of 17"
    bar = shown.page.get_by_role("progressbar")
    assert bar.is_visible() and bar.evaluate("(bar) => [bar.value, bar.max]") == [3, 17]


def test_undo_and_redo_say_where_one_is(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("square", np.zeros((6, 9))), [(8, 5)], [(0, 0)]))
    shown.press("Plan")
    shown.wait("app.runs[0] && !app.job")
    told = shown.text(".status")
    assert told.startswith("Fcost: total time") and told.endswith("Press Play.")
    shown.press("Undo")
    assert shown.text(".status") == "Press Plan to find paths for all robots."
    shown.press("Redo")
    assert shown.text(".status") == told
