// Live: robots run step by step on the side of the host, while a hand changes their world.
//
// The page asks for a step shortly before it is needed, so the robots of the host are at most one step ahead of those of
// the picture. What a hand does goes with the next request, at once if none is on its way. The document of the page is
// then that of the run; the one from before comes back when the run is left.

import { h, number, percent, plural } from "./words.js";
import { arraysOf, centreOf } from "./documents.js";
import { FINAL, HIDDEN, WAITING } from "./playback.js";

const IS_BARRIER = 1, IS_DESTINATION = 2, IS_KNOWN = 4; // as in live.py
const REFUSED_FOR = 1500; // milliseconds that a cross stays on a cell
const MOST_EVENTS = 2000, MOST_STEPS = 8; // in one request

// Robots of a live run, from where they were to where they are.
class Crowd {
  constructor() {
    this.count = 0;
    this.steps = 0;
    for (const name of ["x0", "y0", "x1", "y1"]) this[name] = new Float32Array(0);
    this.state = new Uint8Array(0);
    this.cells = new Int32Array(0);
  }

  move(doc, cells, state, isStep) {
    const { count, x1, y1 } = this, n = cells.length;
    const x = new Float32Array(n), y = new Float32Array(n);
    for (let r = 0; r < n; r++) [x[r], y[r]] = centreOf(doc, cells[r]);
    const from = (old, to) => {
      const all = to.slice();
      all.set(old.subarray(0, Math.min(count, n)));
      return all;
    };
    if (isStep || !count) Object.assign(this, { x0: from(x1, x), y0: from(y1, y) });
    else Object.assign(this, { x0: from(this.x0, x), y0: from(this.y0, y) });
    Object.assign(this, { count: n, x1: x, y1: y, cells, state });
  }

  // Those that have come to a destination are gone.
  settle() {
    for (let r = 0; r < this.count; r++) if (this.state[r] === FINAL) this.state[r] = HIDDEN;
  }

  // Where robots are, -1 for those that are gone.
  places() { return this.cells.map((cell, r) => (this.state[r] === HIDDEN || this.state[r] === FINAL ? -1 : cell)); }
  seek() {}
}

export const withLive = (Base) => class extends Base {
  get fraction() { return this.live ? this.live.fraction : this.clock - Math.floor(this.clock); }

  buildLive(section) {
    const { button, select, numberField } = this.parts, planners = Object.keys(this.settings.planners);
    this.liveButton = button("Run live", () => (this.live ? this.leaveLive() : this.runLive()), { class: "primary", title: "L" });
    this.livePlanner = select("Who decides", planners, () => {});
    this.livePlanner.lastChild.value = planners.includes("fcost") ? "fcost" : planners[0];
    this.sense = numberField("Sensing, in cells", "", { min: 0, max: 100, step: "any", placeholder: "all known" });
    this.sight = h("input", { type: "checkbox" });
    this.late = numberField("Late robots in %", "", { min: 0, max: 90, step: "any", placeholder: "0" });
    this.budget = numberField("Seconds for a plan", 0.2, { min: 0.01, step: "any" });
    this.replan = h("input", { type: "checkbox" });
    this.liveFields = h("div", { class: "grid" }, this.livePlanner, this.sense, this.late, this.budget,
      h("label", { class: "check" }, this.sight, "line of sight"), h("label", { class: "check" }, this.replan, "plan at each change"));
    this.keepButton = button("Keep this world", () => this.keepWorld(), { hidden: true, title: "Leave the run, and keep its walls and destinations" });
    return section("Live", true, h("p", { class: "note" }, "Robots run while you paint walls in their way, move their destinations, or let others join."),
      this.liveFields, h("div", { class: "row" }, this.liveButton, this.keepButton));
  }

  async runLive() {
    const missing = this.missing();
    if (missing) return this.say(missing, true);
    const { doc, runs, fields } = this, valueOf = (field) => (field.lastChild.value === "" ? null : Number(field.lastChild.value));
    const sense = valueOf(this.sense), delays = (valueOf(this.late) ?? 0) / 100, cells = doc.barriers.length;
    const wish = { planner: this.livePlanner.lastChild.value, sense, line_of_sight: sense !== null && this.sight.checked, delays, replan: this.replan.checked, budget: valueOf(this.budget) };
    this.endGrowth();
    const answer = await this.ask({ op: "live", ...wish, ...this.request }, arraysOf(doc), "Starting…");
    if (!answer || this.doc !== doc) return;
    this.live = {
      name: answer.header.live, before: { doc, runs, fields }, delays, last: answer.header, askedStep: answer.header.step, summary: null,
      crowd: new Crowd(), world: new Uint8Array(cells), distance: new Int32Array(cells), known: sense === null ? null : new Uint8Array(cells),
      events: [], frames: [], refused: [], gaps: new Set(), curves: { arrived: [0], waiting: [0] },
      fraction: 1, stride: 1, shownStep: answer.header.step, latency: 0.02, isPlaying: true, isAsking: false, wantsStep: false,
    };
    Object.assign(this, { runs: [null, null], clock: 0, isPlaying: false, doc: { ...doc, barriers: new Uint8Array(cells) } });
    this.adopt(answer);
    this.fields = { doc: this.doc, distance: this.live.distance, directions: null };
    this.most = null;
    this.choose("wall");
    this.say("Robots are running: paint walls in their way.");
    this.refresh();
  }

  // Back to the document and the plans from before.
  leaveLive() {
    if (!this.live) return;
    const { before } = this.live;
    this.live = null;
    Object.assign(this, before);
    this.follow = Math.min(this.follow, this.doc.robots.length - 1);
    this.say("");
    this.refresh();
  }

  keepWorld() {
    const { barriers, destinations } = this.doc;
    this.leaveLive();
    this.change({ barriers, destinations, robots: this.doc.robots.filter((cell) => !barriers[cell]) });
  }

  // ---- time

  liveTick(passed) {
    // Where answers come slower than steps are wanted, an answer is for several steps.
    const { live } = this, length = live.stride / this.stepsPerSecond;
    const stride = Math.max(1, Math.min(MOST_STEPS, Math.round(this.stepsPerSecond * Math.max(1 / 30, 1.2 * live.latency))));
    live.fraction = Math.min(1, live.fraction + passed / length);
    if (live.fraction >= 1) live.crowd.settle();
    while (live.frames.length && (!live.frames[0].isStep || live.fraction >= 1)) this.adopt(live.frames.shift());
    const lead = Math.min(length, 1.5 * live.latency + 0.01), isDue = (live.isPlaying || live.wantsStep) && !live.last.is_over && (1 - live.fraction) * length <= lead;
    if (!live.isAsking && !live.frames.length && (isDue || live.events.length)) this.advance(isDue ? (live.wantsStep ? 1 : stride) : 0);
    const now = performance.now();
    live.refused = live.refused.filter(({ until }) => until > now);
    this.panes[0].crosses = live.refused.map(({ cell }) => cell);
    this.panes[0].draw(live.fraction);
    const isBusy = live.isAsking || live.frames.length || live.events.length || live.fraction < 1 || live.refused.length;
    return isBusy || (live.isPlaying && !live.last.is_over);
  }

  async advance(steps) {
    const { live } = this, events = live.events.splice(0, MOST_EVENTS), begin = performance.now();
    live.isAsking = true;
    live.wantsStep = false;
    try {
      const frame = await this.host.ask({ op: "advance", live: live.name, steps, events });
      live.latency += ((performance.now() - begin) / 1000 - live.latency) / 8;
      frame.isStep = frame.header.step !== live.askedStep;
      live.askedStep = frame.header.step;
      live.frames.push(frame);
    } catch (error) {
      live.isPlaying = false;
      if (this.live === live) this.say(error instanceof TypeError ? "The server does not answer; is it still running?" : error.message, true);
    } finally {
      live.isAsking = false;
      if (this.live === live) this.invalidate();
    }
  }

  // Take a frame of the host: robots, and the cells that are not as they were.
  adopt({ header, arrays, isStep }) {
    const { live } = this, { world_cells: cells, world, distance_cells: farther, distance } = arrays;
    const wasOver = live.last.is_over, isOtherLegend = !live.last.cut_off !== !header.cut_off;
    live.last = header;
    for (let i = 0; i < farther.length; i++) live.distance[farther[i]] = distance[i];
    if (cells.length) this.adoptWorld(cells, world);
    live.crowd.move(this.doc, arrays.cells, arrays.sets, isStep);
    this.doc = { ...this.doc, robots: live.crowd.places() };
    if (isStep) {
      Object.assign(live, { fraction: 0, stride: header.step - live.shownStep, shownStep: header.step });
      const waiting = arrays.sets.reduce((count, set) => count + (set === WAITING), 0);
      while (live.curves.arrived.length <= header.step) {
        live.curves.arrived.push(header.arrived);
        live.curves.waiting.push(waiting);
      }
    }
    const pane = this.panes[0];
    pane.doc = this.doc;
    pane.known = live.known;
    if (cells.length || farther.length) pane.changed("base");
    if (live.gaps.size) this.closeGaps();
    this.tellRefused(header);
    if (header.is_over && !wasOver && header.step) this.liveIsOver();
    if (!header.is_over && wasOver) Object.assign(live, { summary: null });
    if (isOtherLegend) this.showLegend(!!pane.values);
    this.showLive();
  }

  adoptWorld(cells, world) {
    const { live } = this, barriers = this.doc.barriers.slice();
    let { destinations } = this.doc, isOther = false;
    for (let i = 0; i < cells.length; i++) {
      const cell = cells[i], bits = world[i];
      if ((live.world[cell] ^ bits) & IS_DESTINATION) isOther = true;
      live.world[cell] = bits;
      barriers[cell] = bits & IS_BARRIER;
      if (live.known) live.known[cell] = bits & IS_KNOWN;
    }
    if (isOther) {
      const ends = [];
      for (let cell = 0; cell < live.world.length; cell++) if (live.world[cell] & IS_DESTINATION) ends.push(cell);
      destinations = Int32Array.from(ends);
    }
    this.doc = { ...this.doc, barriers, destinations };
  }

  tellRefused({ refused, refused_count: count }) {
    const { live } = this, until = performance.now() + REFUSED_FOR;
    if (!count) return;
    for (const { cell, kind } of refused) {
      if (!cell) continue;
      const place = cell[1] * this.doc.width + cell[0];
      live.refused.push({ cell: place, until });
      if (kind === "barrier" && this.stroke?.kind === "wall" && this.doc.robots.includes(place)) live.gaps.add(place);
    }
    this.say(`Not done: ${refused[0].why}${count > 1 ? `, and ${number(count - 1)} more` : ""}.`, true);
  }

  // While the hand holds the tool down, its wall closes as soon as those who stood in it have gone.
  closeGaps() {
    const { gaps } = this.live, taken = new Set(this.doc.robots);
    if (this.stroke?.kind !== "wall") return gaps.clear();
    for (const cell of gaps) {
      if (taken.has(cell)) continue;
      gaps.delete(cell);
      this.tell("barrier", cell);
    }
  }

  async liveIsOver() {
    const { live } = this, { cut_off: cutOff } = live.last, hasEnd = this.doc.destinations.length;
    if (cutOff) this.say(`${plural(cutOff, "robot")} ${cutOff === 1 ? "is" : "are"} cut off: ${hasEnd ? "erase a wall to open a way" : "there is no destination; set one"}.`, true);
    else this.say("All robots have arrived. Save the run, or let others join.");
    try {
      const { header } = await this.host.ask({ op: "judge", live: live.name });
      if (this.live !== live || !live.last.is_over) return;
      live.summary = { ...header.summary, told: header.conflicts };
      this.showLive();
    } catch { /* the run is over all the same */ }
  }

  // ---- the hand

  tell(kind, cell, more = {}) {
    const place = (one) => [one % this.doc.width, Math.floor(one / this.doc.width)];
    this.live.events.push({ kind, ...(cell === null ? {} : { cell: place(cell) }), ...("to" in more ? { to: place(more.to) } : more) });
    this.invalidate();
  }

  // What a tool does to a cell of the running world; the host may refuse it.
  touch(cell) {
    const { tool, doc } = this, robot = doc.robots.indexOf(cell), isEnd = doc.destinations.includes(cell);
    if (tool === "wall" && !doc.barriers[cell]) this.tell("barrier", cell);
    else if (tool === "erase") {
      if (doc.barriers[cell]) this.tell("clear", cell);
      else if (robot >= 0) this.tell("leave", null, { robot });
      else if (isEnd) this.tell("close", cell);
    } else if (tool === "destination") this.tell(isEnd ? "close" : "open", cell);
    else if (tool === "robot") robot >= 0 ? this.tell("leave", null, { robot }) : this.tell("join", cell);
  }

  // ---- what is shown

  showLive() {
    const { live } = this, { last, summary } = live, ms = last.milliseconds;
    const rows = [
      ["Step", number(last.step)], ["Arrived", `${number(last.arrived)} of ${number(last.robots)}`], ["On the way", `${number(last.going)}${last.cut_off ? `, ${number(last.cut_off)} cut off` : ""}`],
      ["Total time so far", number(last.spent)], ["Milliseconds a step", last.step ? `${ms[1].toFixed(1)} (now ${ms[0].toFixed(1)}, worst ${ms[2].toFixed(1)})` : "–"],
      ["Repairs of the field", number(last.repairs)], ["Cells they touched", number(last.touched)], live.known ? ["Known", percent(last.known)] : null,
      summary ? ["With full knowledge, no events", number(summary.reference_time)] : null, summary && summary.price !== null ? ["Price", percent(summary.price)] : null,
      summary ? ["Conflicts", summary.conflicts ? number(summary.conflicts) : "none"] : null,
    ].filter(Boolean);
    const body = h("tbody", {}, rows.map(([label, text]) => h("tr", {}, h("th", { scope: "row" }, label), h("td", {}, text))));
    this.results.replaceChildren(h("table", { class: "live" }, body));
    this.sets.replaceChildren();
    this.sofar.textContent = "";
    if (last.step) this.drawChart([{ playback: { curves: live.curves } }]);
    this.showClock();
    this.showRobot();
    if (this.centred.checked && this.follow >= 0 && this.doc.robots[this.follow] >= 0) this.panes[0].reveal(this.doc.robots[this.follow]);
    this.invalidate();
  }
};
