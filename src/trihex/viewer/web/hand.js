// Hand: pointers on the panes, and what they do there with a tool.

import { HIDDEN, Still } from "./playback.js";
import { nameOfCell } from "./names.js";
import { pointOfRobot } from "./robots.js";
import { Stroke, brushed, isSameDocument } from "./stroke.js";

const SLACK = 6; // pixels that a click may move
const NOT_CARRIED = "Robots that run cannot be carried; take one away with Erase, and let another join.";

export class Hand {
  constructor(app) {
    this.app = app;
    this.pointers = new Map(); // that are down: where they are, and on which pane
    this.pinch = null; // of two pointers: how far apart they are, and where their middle is
    this.stroke = null; // of one pointer: a Stroke, or { kind: "pan" or "carry", ... }
    app.panes.forEach(({ canvas }, i) => this.#listen(canvas, i));
  }

  #listen(canvas, i) {
    const act = (does) => (event) => { if (this.app.panes[i].doc) does(event); }; // there may be nothing yet
    const on = (name, does) => canvas.addEventListener(name, act(does), { passive: false });
    on("pointerdown", (event) => this.#down(event, i));
    on("pointermove", (event) => this.#move(event, i));
    on("pointerup", (event) => this.#up(event, i));
    on("pointercancel", (event) => this.#up(event, i));
    on("pointerleave", () => { if (!this.pointers.size) this.app.readout.show(i, -1); });
    on("wheel", (event) => this.#wheel(event, i));
    on("contextmenu", (event) => event.preventDefault());
  }

  #pointOf(event, i) {
    const { canvas } = this.app.panes[i], box = canvas.getBoundingClientRect();
    const px = ((event.clientX - box.left) * canvas.width) / box.width;
    return [px, ((event.clientY - box.top) * canvas.height) / box.height];
  }

  #down(event, i) {
    const { app } = this, pane = app.panes[i], { button, pointerId, shiftKey } = event, tool = app.tools.chosen;
    event.preventDefault();
    pane.canvas.focus({ preventScroll: true });
    try { pane.canvas.setPointerCapture(pointerId); } catch { /* a pointer of a test */ }
    const [px, py] = this.#pointOf(event, i);
    this.pointers.set(pointerId, { px, py, i });
    app.keys.setCursor(-1);
    if (this.pointers.size === 2) return this.#beginPinch();
    const isPan = button === 1 || button === 2 || shiftKey || i === 1 || tool === "move";
    const cell = pane.cellAt(px, py);
    if (!isPan && app.tools.strikes) return this.#strike(px, py);
    if (!isPan) return this.#beginStroke(cell, px, py);
    const canHold = i === 0 && button === 0 && app.canEdit && tool === "move" && cell >= 0;
    const held = canHold ? this.#thingAt(cell) : null;
    this.stroke = { kind: held && app.clock.at === 0 ? "carry" : "pan", px, py, cell, held, moved: 0 };
  }

  #move(event, i) {
    const { app, stroke } = this, pane = app.panes[i];
    const [px, py] = this.#pointOf(event, i), before = this.pointers.get(event.pointerId);
    if (!before) return app.readout.show(i, pane.cellAt(px, py));
    const dx = px - before.px, dy = py - before.py;
    Object.assign(before, { px, py });
    if (this.pinch) return this.#movePinch(i);
    if (!stroke) return;
    const cell = pane.cellAt(px, py);
    if (stroke.kind === "carry") stroke.target = cell;
    else if (stroke.kind === "pan") this.#pan(pane, dx, dy);
    else this.#paintTo(px, py);
    app.readout.show(i, cell);
  }

  #up(event, i) {
    const { stroke } = this;
    this.pointers.delete(event.pointerId);
    if (this.pinch) {
      if (!this.pointers.size) this.pinch = null;
      return;
    }
    this.stroke = null;
    if (!stroke) return;
    if (stroke.kind === "carry") this.#drop(stroke);
    else if (stroke.kind !== "pan") this.#endStroke(stroke);
    else if (stroke.moved <= SLACK) this.pick(i, stroke);
  }

  // ---- moving the picture

  #pan(pane, dx, dy) {
    this.stroke.moved += Math.abs(dx) + Math.abs(dy);
    if (this.stroke.moved <= SLACK) return;
    pane.pan(dx, dy);
    this.app.stage.invalidate();
  }

  #between() {
    const [a, b] = [...this.pointers.values()];
    return { length: Math.hypot(a.px - b.px, a.py - b.py), x: (a.px + b.px) / 2, y: (a.py + b.py) / 2 };
  }

  #beginPinch() {
    if (this.stroke && this.stroke.kind !== "pan") this.app.stage.show();
    this.stroke = null;
    this.pinch = this.#between();
  }

  #movePinch(i) {
    if (this.pointers.size < 2) return;
    const { length, x, y } = this.#between(), { pinch } = this, pane = this.app.panes[i];
    pane.pan(x - pinch.x, y - pinch.y);
    pane.zoom(length / Math.max(1, pinch.length), x, y);
    this.pinch = { length, x, y };
    this.app.stage.invalidate();
  }

  #wheel(event, i) {
    event.preventDefault();
    const [px, py] = this.#pointOf(event, i), by = Math.max(-120, Math.min(120, event.deltaY));
    this.app.panes[i].zoom(Math.exp(-by * 0.0025), px, py);
    this.app.stage.invalidate();
  }

  // ---- robots and destinations

  // Click: follow the robot nearest to the pointer, if it is near.
  pick(i, { px, py }) {
    if (this.app.panes[i].robots) this.app.followed.follow(this.#nearest(i, px, py));
  }

  // Break or delay the robot of a live run that is nearest.
  #strike(px, py) {
    const { app } = this, robot = this.#nearest(0, px, py);
    if (robot < 0) return app.say("There is no robot: click one.", true);
    return app.live.strike(robot, app.tools.chosen);
  }

  #nearest(i, px, py) {
    const pane = this.app.panes[i], { robots, view } = pane, { fraction } = this.app;
    const { state } = robots, reach = Math.max(10, view.scale * 0.6);
    let best = -1, least = reach * reach;
    for (let r = 0; r < robots.count; r++) {
      if (state[r] === HIDDEN) continue;
      const [x, y] = pointOfRobot(pane, r, fraction), dx = x - px, dy = y - py;
      if (dx * dx + dy * dy < least) [best, least] = [r, dx * dx + dy * dy];
    }
    return best;
  }

  #thingAt(cell) {
    const { robots, destinations } = this.app.doc, robot = robots.indexOf(cell);
    if (robot >= 0) return { robot };
    return destinations.includes(cell) ? { destination: cell } : null;
  }

  #drop({ held, target, cell }) {
    if (target !== undefined && target >= 0 && target !== cell) this.#carry(held, cell, target);
    else if (held.robot !== undefined) this.app.followed.follow(held.robot);
  }

  #carry({ robot }, from, to) {
    const { app } = this, { doc, live } = app, { barriers, robots, destinations } = doc;
    if (live && robot === undefined) return live.tell("move", from, { to });
    if (live) return app.say(NOT_CARRIED, true);
    if (barriers[to] || robots.includes(to) || destinations.includes(to)) return app.say("That cell is taken.", true);
    if (robot === undefined) app.change({ destinations: destinations.map((other) => (other === from ? to : other)) });
    else {
      const moved = robots.map((other, r) => (r === robot ? to : other));
      app.change({ robots: moved, header: { ...doc.header, seed: null } });
    }
  }

  // ---- painting

  // Use the tool on one cell.
  tap(cell, px, py) {
    if (this.app.tools.strikes) return this.#strike(px, py);
    this.#beginStroke(cell, px, py);
    const { stroke } = this;
    this.stroke = null;
    return this.#endStroke(stroke);
  }

  #beginStroke(cell, px, py) {
    this.stroke = new Stroke(this.app.tools.chosen, this.app.doc, cell, [px, py]);
    this.#touch(cell);
    this.#showStroke();
  }

  // Every cell between two reports of a fast hand.
  #paintTo(px, py) {
    const [pane] = this.app.panes, [lx, ly] = this.stroke.last, length = Math.hypot(px - lx, py - ly);
    const pieces = Math.max(1, Math.ceil(length / Math.max(2, pane.view.scale / 3)));
    for (let k = 1; k <= pieces; k++) {
      this.#touch(pane.cellAt(lx + ((px - lx) * k) / pieces, ly + ((py - ly) * k) / pieces));
    }
    this.stroke.moveTo([px, py]);
    this.#showStroke();
  }

  #touch(cell) {
    const { doc, live, tools } = this.app, { touched } = this.stroke;
    if (cell < 0) return;
    for (const one of brushed(doc, cell, tools.width)) {
      if (live && !touched.has(one)) live.touch(one, tools.chosen);
      touched.add(one);
    }
  }

  #showStroke() {
    const { live, doc, panes: [pane], stage } = this.app;
    if (live) return;
    const after = this.stroke.on(doc);
    pane.show(after, after.robots === doc.robots ? pane.robots : new Still(after, null));
    stage.invalidate();
  }

  #endStroke(stroke) {
    const { app } = this, { doc } = app;
    if (app.live) return;
    const after = stroke.on(doc);
    if (!isSameDocument(after, doc)) {
      app.say("");
      app.clock.rewind();
      return app.edit(after);
    }
    app.refresh();
    const [cell] = stroke.touched, place = nameOfCell(doc, cell);
    if (cell === undefined || !doc.barriers[cell] || stroke.kind === "wall") return;
    app.say(`Cell ${place} is a barrier: erase it first.`, true);
  }
}
