// Live: robots run step by step on the side of the host, while a hand changes their world.
//
// The page asks for a step shortly before it is needed, so the robots of the host are at most one step ahead of those
// of the picture. What a hand does goes with the next request, at once if none is on its way. The document of the page
// is then that of the run.

import { number, plural, title } from "./words.js";
import { complaintOf } from "./hosts.js";
import { nameOfRobot } from "./names.js";
import { WAITING } from "./playback.js";
import { Runners } from "./runners.js";

const IS_BARRIER = 1, IS_DESTINATION = 2, IS_KNOWN = 4; // as in live.py
const REFUSED_FOR = 1500; // milliseconds that a cross stays on a cell
const LATE_STEPS = 10; // that a robot stands still
const MOST_EVENTS = 2000, MOST_STEPS = 8; // in one request

export class Live {
  // A run that begins with an answer of the host, on a document whose barriers come with its frames.
  constructor(app, doc, answer, { sense, delays }) {
    const cells = doc.barriers.length;
    this.app = app;
    this.name = answer.header.live;
    this.hasLate = delays > 0; // whether some robots are late now and then
    this.seconds = 0; // that it has run
    this.pace = answer.header.pace; // how many steps a move over an edge lasts
    this.doc = { ...doc, barriers: new Uint8Array(cells) };
    this.runners = new Runners();
    this.world = new Uint8Array(cells); // of each cell, what the page knows: bits as above
    this.known = sense === null ? null : new Uint8Array(cells); // of each cell, whether a robot has seen it
    this.distance = new Int32Array(cells);
    this.last = answer.header; // of the frame that is shown
    this.summary = null; // of the judge, once the run is over
    this.curves = { arrived: [0], waiting: [0] }; // by step
    this.isPlaying = true;
    this.wantsStep = false; // one, while it does not play
    this.fraction = 1; // of the step that is shown, how much has passed
    this.stride = 1; // how many steps it stands for
    this.shownStep = answer.header.step;
    this.askedStep = answer.header.step;
    this.latency = 0.02; // seconds that an answer takes
    this.isAsking = false;
    this.frames = []; // that have come and are not shown yet
    this.events = []; // that are not sent yet
    this.refused = []; // { cell, until }: crosses
    this.layers = {}; // maps of it by name, once it is over
    this.gaps = new Set(); // cells of a wall that is being painted where robots still stand
  }

  // ---- time

  toggle() { this.isPlaying = !this.isPlaying; }
  wantStep() { this.wantsStep = true; }

  // Let some seconds pass, and tell whether there will be more to see.
  tick(passed) {
    const speed = this.app.clock.stepsPerSecond * this.pace, length = this.stride / speed;
    this.fraction = Math.min(1, this.fraction + passed / length);
    if (this.isPlaying && !this.last.is_over) this.seconds += passed;
    if (this.fraction >= 1) this.runners.settle();
    while (this.frames.length && (!this.frames[0].isStep || this.fraction >= 1)) this.adopt(this.frames.shift());
    const lead = Math.min(length, 1.5 * this.latency + 0.01), isWanted = this.isPlaying || this.wantsStep;
    const isDue = isWanted && !this.last.is_over && (1 - this.fraction) * length <= lead;
    const isFree = !this.isAsking && !this.frames.length;
    if (isFree && (isDue || this.events.length)) this.#advance(isDue ? this.#stride(speed) : 0);
    this.#draw();
    const isMoving = this.fraction < 1 || this.refused.length || (this.isPlaying && !this.last.is_over);
    return isMoving || this.isAsking || this.frames.length || this.events.length;
  }

  // Where answers come slower than steps are wanted, an answer is for several steps.
  #stride(speed) {
    if (this.wantsStep) return 1;
    return Math.max(1, Math.min(MOST_STEPS, Math.round(speed * Math.max(1 / 30, 1.2 * this.latency))));
  }

  #draw() {
    const [pane] = this.app.panes, now = performance.now();
    this.refused = this.refused.filter(({ until }) => until > now);
    pane.take({ crosses: this.refused.map(({ cell }) => cell) });
    pane.draw(this.fraction);
  }

  async #advance(steps) {
    const { app } = this, events = this.events.splice(0, MOST_EVENTS), begin = performance.now();
    this.isAsking = true;
    this.wantsStep = false;
    try {
      const frame = await app.host.ask({ op: "advance", live: this.name, steps, events });
      this.latency += ((performance.now() - begin) / 1000 - this.latency) / 8;
      frame.isStep = frame.header.step !== this.askedStep;
      this.askedStep = frame.header.step;
      this.frames.push(frame);
    } catch (error) {
      this.isPlaying = false;
      if (app.live === this) app.say(complaintOf(error), true);
    } finally {
      this.isAsking = false;
      if (app.live === this) app.stage.invalidate();
    }
  }

  // ---- the world

  // Take a frame of the host: robots, and the cells that are not as they were.
  adopt({ header, arrays, isStep }) {
    const { world_cells: cells, world, distance_cells: farther, distance } = arrays, { last } = this;
    this.last = header;
    for (let i = 0; i < farther.length; i++) this.distance[farther[i]] = distance[i];
    if (farther.length) this.app.field.forget();
    if (cells.length) this.#adoptWorld(cells, world);
    this.runners.move(this.doc, arrays, isStep ? header.step - this.shownStep : 0);
    this.doc = { ...this.doc, robots: this.runners.places() };
    if (isStep) this.#adoptStep(header, arrays.sets);
    this.app.replace(this.doc);
    this.app.stage.showWorld(this, cells.length > 0 || farther.length > 0);
    if (this.gaps.size) this.#closeGaps();
    this.#tellRefused(header);
    if (header.is_over && !last.is_over && header.step) this.#end();
    if (!header.is_over) this.summary = null;
    if (last.is_over && header !== last) this.#dropLayers();
    if (!last.cut_off !== !header.cut_off || !last.broken !== !header.broken) this.app.stage.legend.show();
    this.app.showNumbers();
  }

  #adoptStep({ step, arrived }, sets) {
    Object.assign(this, { fraction: 0, stride: step - this.shownStep, shownStep: step });
    const waiting = sets.reduce((count, set) => count + (set === WAITING), 0), { curves } = this;
    while (curves.arrived.length <= step) {
      curves.arrived.push(arrived);
      curves.waiting.push(waiting);
    }
  }

  #adoptWorld(cells, world) {
    const barriers = this.doc.barriers.slice();
    let { destinations } = this.doc, isOther = false;
    for (let i = 0; i < cells.length; i++) {
      const cell = cells[i], bits = world[i];
      if ((this.world[cell] ^ bits) & IS_DESTINATION) isOther = true;
      this.world[cell] = bits;
      barriers[cell] = bits & IS_BARRIER;
      if (this.known) this.known[cell] = bits & IS_KNOWN;
    }
    if (isOther) {
      const ends = [];
      for (let cell = 0; cell < this.world.length; cell++) if (this.world[cell] & IS_DESTINATION) ends.push(cell);
      destinations = Int32Array.from(ends);
    }
    this.doc = { ...this.doc, barriers, destinations };
  }

  #tellRefused({ refused, refused_count: count }) {
    const until = performance.now() + REFUSED_FOR, isWall = this.#isPaintingWall();
    if (!count) return;
    for (const { cell, kind } of refused) {
      if (!cell) continue;
      const place = cell[1] * this.doc.width + cell[0];
      this.refused.push({ cell: place, until });
      if (kind === "barrier" && isWall && this.doc.robots.includes(place)) this.gaps.add(place);
    }
    this.app.say(`Not done: ${refused[0].why}${count > 1 ? `, and ${number(count - 1)} more` : ""}.`, true);
  }

  #isPaintingWall() { return this.app.hand.stroke?.kind === "wall"; }

  // While the hand holds the tool down, its wall closes as soon as those who stood in it have gone.
  #closeGaps() {
    const { gaps } = this, taken = new Set(this.doc.robots);
    if (!this.#isPaintingWall()) return gaps.clear();
    for (const cell of gaps) {
      if (taken.has(cell)) continue;
      gaps.delete(cell);
      this.tell("barrier", cell);
    }
  }

  // It goes on, or its world is another one.
  #dropLayers() {
    this.layers = {};
    this.app.layers.show();
    this.app.stage.show();
  }

  async #end() {
    this.app.layers.show();
    const { app } = this, { cut_off: cutOff, broken } = this.last, hasEnd = this.doc.destinations.length;
    const next = hasEnd ? "erase a wall to open a way" : "there is no destination; set one";
    if (cutOff) app.say(`${plural(cutOff, "robot")} ${cutOff === 1 ? "is" : "are"} cut off: ${next}.`, true);
    else app.say(`${broken ? "All but the broken" : "All robots"} have arrived. Save the run, or let others join.`);
    try {
      const { header } = await app.host.ask({ op: "judge", live: this.name });
      if (app.live !== this || !this.last.is_over) return;
      this.summary = { ...header.summary, told: header.conflicts };
      app.showNumbers();
    } catch { /* the run is over all the same */ }
  }

  // ---- the hand

  // Tell the host of an event, in a cell or null for none.
  tell(kind, cell, { to, ...more } = {}) {
    const place = (one) => [one % this.doc.width, Math.floor(one / this.doc.width)];
    const where = { ...(cell === null ? {} : { cell: place(cell) }), ...(to === undefined ? {} : { to: place(to) }) };
    this.events.push({ kind, ...where, ...more });
    this.app.stage.invalidate();
  }

  // What a tool does to a robot.
  strike(robot, tool) {
    const { app } = this, name = title(nameOfRobot(robot, this.doc.robots.length)), isLate = tool === "late";
    this.tell(tool, null, isLate ? { robot, steps: LATE_STEPS } : { robot });
    if (isLate) this.hasLate = true;
    app.say(isLate ? `${name} stands still for ${LATE_STEPS} steps.` : `${name} breaks down: a barrier to all others.`);
    app.stage.legend.show();
  }

  // What a tool does to a cell of the running world; the host may refuse it.
  touch(cell, tool) {
    const { doc } = this, robot = doc.robots.indexOf(cell), isEnd = doc.destinations.includes(cell);
    const leave = () => this.tell("leave", null, { robot });
    if (tool === "wall" && !doc.barriers[cell]) this.tell("barrier", cell);
    else if (tool === "erase") {
      if (doc.barriers[cell]) this.tell("clear", cell);
      else if (robot >= 0) leave();
      else if (isEnd) this.tell("close", cell);
    } else if (tool === "destination") this.tell(isEnd ? "close" : "open", cell);
    else if (tool === "robot") robot >= 0 ? leave() : this.tell("join", cell);
  }
}
