"""What a user sees while the page waits: clicks that come early are not lost, and compiling is told."""

from concurrent.futures import ThreadPoolExecutor
from threading import Event, Thread

import numpy as np
import pytest

import trihex as th
from trihex.formats import Draft
from trihex.kernels import preparing
from trihex.kernels.needs import kernels_of
from trihex.planners import make_plan
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


# The host holds back the first document and the usual kernels, as if they were compiled.
HELD = """window.held = {};
const ask = window.fetch;
window.fetch = async (where, more) => {
  const op = where === "ask" && JSON.parse(new TextDecoder().decode(more.body).match(/\\{.*\\}/)[0]).header.op;
  if (op !== "first" && op !== "prepare") return ask(where, more);
  const text = JSON.stringify({ header: { kind: "progress", stage: "compiling", done: 1, total: 9 }, arrays: {} });
  const bytes = new Uint8Array(20 + Math.ceil(text.length / 8) * 8), view = new DataView(bytes.buffer);
  bytes.set(new TextEncoder().encode("trihex1\\n"), 4);
  view.setUint32(0, bytes.length - 4, true);
  view.setUint32(12, text.length, true);
  bytes.set(new TextEncoder().encode(text), 20);
  const answer = ask(where, more);
  return new Response(new ReadableStream({ async start(stream) {
    stream.enqueue(bytes);
    await new Promise((done) => { window.held[op] = done; });
    const reader = (await answer).body.getReader();
    for (let part = await reader.read(); !part.done; part = await reader.read()) stream.enqueue(part.value);
    stream.close();
  } }));
};"""


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
    total = len(kernels_of(["greedy", "audit"]))
    assert [frame["stage"] for frame in frames] == ["compiling"] * 5
    assert [frame["done"] for frame in frames] == [0, 0, 1, 2, 3]  # the first before the first worker has begun
    assert {frame["total"] for frame in frames} == {total}
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


def test_who_waits_is_told_how_far_the_other_is_and_has_the_next_turn(nothing_compiled, monkeypatch):
    """What most clicks need is compiled in stages; a request that comes meanwhile does not wait for all of them."""
    is_told, may_go, compiled = Event(), Event(), []

    def prepare(*uses):
        compiled.append(uses)
        preparing.watch(1, 2)
        if len(compiled) == 1:
            is_told.set()
            may_go.wait(60)

    monkeypatch.setattr(preparing, "prepare", prepare)
    frames = []

    def waiting():
        if frames:
            may_go.set()
        return False

    with ThreadPoolExecutor() as pool:
        usual = pool.submit(compiling.prepare_usual, call([]))
        is_told.wait(60)
        pool.submit(compiling.prepare_for, call(frames, waiting), "astar").result(60)
        usual.result(60)
    usual = compiling.USUAL
    assert compiled == [usual[0], ("astar",), *usual[1:]]
    total = len(kernels_of([use for stage in usual for use in stage]))
    assert (frames[0]["stage"], frames[0]["done"], frames[0]["total"]) == ("compiling", 1, total)


def test_what_a_page_shows_first_waits_for_what_it_needs_and_the_page_does_not(nothing_compiled):
    area = th.Area("square", np.zeros((3, 5)))
    scenario = th.Scenario(area, [(4, 1)], [(0, 1)])
    plan = make_plan(scenario, "greedy")
    desk = Desk(first=plan)
    drawn = Draft(area, destinations=scenario.destinations, random_count=2)
    assert not desk.can_show_at_once(plan) and not desk.can_show_at_once(drawn)
    assert desk.can_show_at_once(scenario) and desk.can_show_at_once(area)
    sent = []
    desk.answer(encode({"op": "first"}), sent.append)
    frames = [decode(frame).header for frame in sent]
    assert frames[0]["stage"] == "compiling" and frames[-1]["summary"]["total_time"] == plan.total_time
    assert desk.can_show_at_once(plan)
    sent.clear()
    Desk().answer(encode({"op": "first"}), sent.append)
    assert decode(sent[-1]).header["kind"] == "error"


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
    assert shown.text(".working .note") == "Compiling kernels, once: 3 of 17"
    bar = shown.page.get_by_role("progressbar")
    assert bar.is_visible() and bar.evaluate("(bar) => [bar.value, bar.max]") == [3, 17]


def test_a_page_comes_at_once_says_what_is_compiled_and_keeps_clicks(open_viewer):
    """A page whose first plan needs kernels that are not there yet, and that has its usual ones compiled meanwhile."""
    scenario = th.Scenario(th.Area("square", np.zeros((6, 9))), [(8, 5)], [(0, 0)])
    shown = open_viewer(asked=scenario, script=HELD)
    page = shown.page
    page.wait_for_function("() => window.held?.first")
    assert shown.text(".working .note") == "Compiling kernels, once: 1 of 9" and shown.ask("app.doc") is None
    page.mouse.click(400, 400)  # on nothing yet
    page.keyboard.press("ArrowLeft")
    shown.press("Plan")
    shown.press("New…")
    assert shown.text(".status") == "Areas are made as soon as the area and its robots are there."
    page.evaluate("held.first()")
    shown.wait("app.runs[0] && !app.job")  # it was not lost
    page.get_by_role("dialog").wait_for()
    page.keyboard.press("Escape")
    page.wait_for_function("() => window.held.prepare")
    assert shown.text(".working .note") == "Compiling kernels, once: 1 of 9"
    assert not page.get_by_role("button", name="Cancel").is_visible()
    page.evaluate("held.prepare()")
    page.locator(".working").wait_for(state="hidden")
    assert shown.faults == []


def test_what_cannot_be_shown_first_is_told_beside_an_area_to_play_with(open_viewer):
    shown = open_viewer(asked=Draft(th.Area("square", np.zeros((2, 2))), np.array([0]), random_count=9))
    shown.wait("app.doc.robots.length === 120 && app.status.isWarning")
    assert "9" in shown.text(".status") and not shown.page.locator(".guide").is_visible()


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
