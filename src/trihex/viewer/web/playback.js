// Playback: where robots are between two steps, and the set that each belongs to.

import { R3 } from "./shapes.js";
import { NOT_REACHED, centreOf, shapeOf } from "./documents.js";
import { Worlds } from "./worlds.js";

const WAIT = 255, JUMP = 254, LATE = 253; // as in codes.py

export const HIDDEN = 0, MOVING = 1, WAITING = 2, FINAL = 3, STRANDED = 4, LATE_SET = 5;

const MOST_DRAWN = 500000; // actions of robots whose paths are drawn

const KEPT = ["site", "index", "begun"]; // where each robot is along its actions
const CURVES = ["moving", "waiting", "arrived", "spent", "least_total"]; // by step; a run has no last one

// Where the robots of a document stand before there is a plan.
export class Still {
  constructor(doc, distance) {
    const n = doc.robots.length;
    this.steps = 0;
    this.count = n;
    this.x0 = new Float32Array(n);
    this.y0 = new Float32Array(n);
    this.state = new Uint8Array(n).fill(MOVING);
    for (let r = 0; r < n; r++) {
      [this.x0[r], this.y0[r]] = centreOf(doc, doc.robots[r]);
      if (distance && distance[doc.robots[r]] === NOT_REACHED) this.state[r] = STRANDED;
    }
    this.x1 = this.x0;
    this.y1 = this.y0;
    this.bx = this.by = new Float32Array(n);
  }
  seek() {}
  held() { return -1; }
  alsoHeld() { return -1; }
}

// Robots of a plan between `step` and the next: from (x0, y0) to (x1, y1), how far the corner that it
// passes is from the middle, (bx, by), and the set that each belongs to. Moves may last several steps (ticks).
export class Playback {
  constructor({ header, arrays }, doc) {
    Object.assign(this, { header, doc, steps: header.steps, count: doc.robots.length });
    this.actions = arrays.actions;
    this.first = arrays.first_action;
    this.hasArrived = arrays.has_arrived;
    const none = new Int32Array(this.count);
    this.joined = arrays.joined ?? none; // the step after which each robot is there: those of a run may come later
    this.hasLeft = arrays.has_left ?? none;
    this.cutOffSince = arrays.cut_off_since ?? none.map(() => -1);
    this.worlds = header.worlds ? new Worlds(doc, header.worlds, arrays.known_since) : null;
    this.jumpAt = arrays.jump_at;
    this.jumpTo = arrays.jump_to;
    this.curves = {};
    for (const name of CURVES) this.curves[name] = arrays[`${name}_by_step`];
    this.distance = arrays.distance;
    this.slowness = arrays.slowness ?? none.map(() => 1); // how many times as long the moves of each last
    const { origin, pitch, offsets, durations } = header.layout;
    this.duration = new Int32Array(256).fill(1); // of actions, by their bytes
    this.duration.set(durations);
    this.follows = doc.header.following !== "forbid";
    this.pace = Math.min(...durations);
    this.hasSteps = durations.every((duration) => duration === 1) && !arrays.slowness;
    this.offsets = offsets.map((row) => Int32Array.from(row));
    const siteOf = (cell) => origin + Math.floor(cell / doc.width) * pitch + (cell % doc.width);
    const start = Int32Array.from(doc.robots, siteOf);
    this.site = start; // whose centre each was at last
    this.index = this.first.slice(0, this.count); // of the action that it does
    this.begun = Int32Array.from(this.joined); // when it began it
    this.next = new Int32Array(this.count); // the site to which that leads
    // Every so many steps one is kept: as many as fit into some 64 MB.
    this.every = Math.max(32, Math.ceil((KEPT.length * this.steps * this.count) / 2 ** 24));
    this.kept = [];
    this.#keep();
    for (const name of ["x0", "y0", "x1", "y1", "bx", "by"]) this[name] = new Float32Array(this.count);
    this.state = new Uint8Array(this.count);
    this.step = 0;
    this.#locate(this.site, this.x0, this.y0);
    this.#lookAhead();
  }

  seek(step) {
    step = Math.max(0, Math.min(step, this.steps));
    if (step === this.step) return;
    const isNext = this.step + 1 === step;
    if (step < this.step || step - this.step > this.every) {
      const near = Math.min(Math.floor(step / this.every), this.kept.length - 1);
      if (step < this.step || near * this.every > this.step) {
        this.step = near * this.every;
        for (const name of KEPT) this[name].set(this.kept[near][name]);
        this.#aim();
      }
    }
    while (this.step < step) {
      this.step++;
      this.#finish();
      if (this.kept.length === this.step / this.every) this.#keep();
      if (this.step < step) this.#aim();
    }
    if (isNext && this.hasSteps) [this.x0, this.y0, this.x1, this.y1] = [this.x1, this.y1, this.x0, this.y0];
    else this.#locate(this.site, this.x0, this.y0);
    this.#lookAhead();
  }

  #lookAhead() {
    this.#aim();
    this.#locate(this.next, this.x1, this.y1);
    const { actions, index, site, x0, y0, x1, y1 } = this, { bend } = shapeOf(this.doc);
    for (let r = 0; r < this.count; r++) {
      const isMove = this.#acts(r) && actions[index[r]] < LATE;
      [this.bx[r], this.by[r]] = isMove ? bend(site[r] & 1, x1[r] - x0[r], y1[r] - y0[r]) : [0, 0];
      this.state[r] = this.#setOf(r);
    }
    if (!this.hasSteps) this.#cut();
  }

  // How long lasts what a robot does.
  #lasts(r, action) { return this.duration[action] * (action < LATE ? this.slowness[r] : 1); }

  // Whether a robot does something in the step after `step`: it is there, and has something more to do.
  #acts(r) { return this.step >= this.joined[r] && this.index[r] < this.first[r + 1]; }

  #setOf(r) {
    const { first, actions, index, step, cutOffSince, hasArrived, hasLeft } = this, i = index[r];
    if (step < this.joined[r]) return HIDDEN;
    if (i === first[r + 1]) return hasArrived[r] || hasLeft[r] ? HIDDEN : STRANDED;
    if (cutOffSince[r] >= 0 && cutOffSince[r] <= step) return STRANDED;
    if (hasArrived[r] && i + 1 === first[r + 1]) return FINAL;
    return actions[i] === LATE ? LATE_SET : actions[i] === WAIT ? WAITING : MOVING;
  }

  // The cell that a robot owns, -1 for none: where others follow, the one that it leaves for half of its move, then the
  // one that it enters; destinations are nobody's.
  held(r, fraction) {
    const { site, next, step, begun, actions, index, follows } = this;
    if (next[r] === site[r] || !follows) return this.#cellOf(site[r]);
    if ((step + fraction - begun[r]) * 2 < this.#lasts(r, actions[index[r]])) return this.#cellOf(site[r]);
    return this.state[r] === FINAL ? -1 : this.#cellOf(next[r]);
  }

  // And the one that it enters, where nobody follows.
  alsoHeld(r) {
    const { site, next, follows, state } = this;
    return follows || next[r] === site[r] || state[r] === FINAL ? -1 : this.#cellOf(next[r]);
  }

  #cellOf(site) {
    const { origin, pitch } = this.header.layout, y = Math.floor((site - origin) / pitch);
    return y * this.doc.width + (site - origin - y * pitch);
  }

  // Cut from the whole ways what robots do of them from this step to the next.
  #cut() {
    const { actions, index, first, begun, step } = this;
    const at = (from, way, corner, share) => from + share * way + (1 - Math.abs(2 * share - 1)) * corner;
    for (const [from, to, bend] of [[this.x0, this.x1, this.bx], [this.y0, this.y1, this.by]]) {
      for (let r = 0; r < this.count; r++) {
        const lasts = index[r] < first[r + 1] ? this.#lasts(r, actions[index[r]]) : 1, done = step - begun[r];
        if (lasts === 1) continue;
        const start = from[r], way = to[r] - start, corner = bend[r];
        from[r] = at(start, way, corner, done / lasts);
        to[r] = at(start, way, corner, (done + 1) / lasts);
        bend[r] = at(start, way, corner, (done + 0.5) / lasts) - (from[r] + to[r]) / 2;
      }
    }
  }

  // Where what each does leads.
  #aim() {
    const { actions, index, site, next } = this, [even, odd] = this.offsets;
    for (let r = 0; r < this.count; r++) {
      const i = index[r], at = site[r];
      if (!this.#acts(r)) next[r] = at;
      else if (actions[i] < LATE) next[r] = at + (at & 1 ? odd : even)[actions[i]];
      else next[r] = actions[i] === JUMP ? this.jumpTo[this.#jumpOf(i)] : at;
    }
  }

  // What ends in this step.
  #finish() {
    const { first, actions, index, begun, site, next, step } = this;
    for (let r = 0; r < this.count; r++) {
      const i = index[r];
      if (i === first[r + 1] || begun[r] + this.#lasts(r, actions[i]) > step) continue;
      site[r] = next[r];
      index[r] = i + 1;
      begun[r] = step;
    }
  }

  #keep() { this.kept.push(Object.fromEntries(KEPT.map((name) => [name, this[name].slice()]))); }

  #jumpOf(i) {
    let low = 0, high = this.jumpAt.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.jumpAt[middle] < i) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  #locate(site, x, y) {
    const { origin, pitch } = this.header.layout;
    const shape = this.doc.header.tessellation;
    for (let r = 0; r < this.count; r++) {
      const cy = ((site[r] - origin) / pitch) | 0, cx = site[r] - origin - cy * pitch;
      if (shape === "hexagonal") {
        x[r] = (1.5 * cx + 1) / R3;
        y[r] = cy + 0.5 + 0.5 * (cx & 1);
      } else if (shape === "triangular") {
        x[r] = ((cx + 1) * R3) / 2;
        y[r] = 1.5 * cy + 1 - 0.5 * ((cx + cy) & 1);
      } else {
        x[r] = cx + 0.5;
        y[r] = cy + 0.5;
      }
    }
  }

  // The cells of the way of each robot, without its waits; null where they would be too many to be drawn.
  paths() {
    if (this.actions.length > MOST_DRAWN) return null;
    this.ways ??= Array.from({ length: this.count }, (_, r) => {
      const cells = this.robot(r).rows.map(({ cell }) => cell);
      return cells.filter((cell, k) => !k || cell !== cells[k - 1]);
    });
    return this.ways;
  }

  // Cells and times of one robot, from its start to its last action.
  robot(r) {
    const { costs, names } = this.header.layout, wait = this.header.summary.waiting_cost;
    let site = this.kept[0].site[r], d = 0, w = 0, step = this.joined[r];
    // Before it joins it stands where it will.
    const rows = [{ step: 0, cell: this.#cellOf(site), d, w, action: "start" }];
    for (let i = this.first[r]; i < this.first[r + 1]; i++) {
      const action = this.actions[i], parity = site & 1;
      if (action === WAIT || action === LATE) w += wait;
      else if (action === JUMP) site = this.jumpTo[this.#jumpOf(i)];
      else {
        d += costs[action] * this.slowness[r];
        site += this.offsets[parity][action];
      }
      const name = { [WAIT]: "wait", [JUMP]: "jump", [LATE]: "late" }[action] ?? names[parity][action];
      step += this.#lasts(r, action);
      rows.push({ step, cell: this.#cellOf(site), d, w, action: name });
    }
    return { rows, hasArrived: !!this.hasArrived[r] };
  }
}
