// Hand: pointers, strokes, and what they do to the document.

import { number } from "./words.js";
import { NOT_REACHED, without, plus, shapeOf, centreOf } from "./documents.js";
import { HIDDEN, Still } from "./playback.js";

export const TOOLS = [
  ["move", "Move", "V", "Drag a robot or a destination to another cell; drag the ground to move the picture; click a robot to follow it.", "M9 3v12M3 9h12M9 3l-2 2M9 3l2 2M9 15l-2-2M9 15l2-2M3 9l2-2M3 9l2 2M15 9l-2-2M15 9l-2 2"],
  ["wall", "Wall", "W", "Paint barriers.", "M2 4h14v4H2zM2 8h14v4H2zM7 4v4M12 8v4M6 8v4M10 12v3H2v-3M10 12h6v3h-6"],
  ["erase", "Erase", "E", "Remove barriers, robots and destinations.", "M7 15h9M3 11l7-7 5 5-6 6H6z"],
  ["destination", "Destination", "D", "Click a cell to set a destination there, or to take it away.", "M9 16s-5-5-5-9a5 5 0 0 1 10 0c0 4-5 9-5 9zM9 7.5v-.1"],
  ["robot", "Robot", "R", "Click free cells to place robots, or to take them away.", "M4 9a5 5 0 1 0 10 0a5 5 0 1 0-10 0M7 8v1M11 8v1"],
];

export const withHand = (Base) => class extends Base {
  resize() {
    if (!this.panes) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.panes.forEach((pane, i) => {
      if (this.paneElements[i].hidden) return;
      const box = this.canvases[i].getBoundingClientRect();
      pane.resize(Math.max(16, Math.round(box.width * ratio)), Math.max(16, Math.round(box.height * ratio)));
    });
    this.invalidate();
  }

  place(event, i) {
    const canvas = this.canvases[i], box = canvas.getBoundingClientRect();
    return [((event.clientX - box.left) * canvas.width) / box.width, ((event.clientY - box.top) * canvas.height) / box.height];
  }

  pointerDown(event, i) {
    event.preventDefault();
    this.canvases[i].focus({ preventScroll: true });
    try { this.canvases[i].setPointerCapture(event.pointerId); } catch { /* a pointer of a test */ }
    const [px, py] = this.place(event, i);
    this.pointers.set(event.pointerId, { px, py, i });
    this.setCursor(-1);
    if (this.pointers.size === 2) return this.beginPinch(i);
    const isPan = event.button === 1 || event.button === 2 || event.shiftKey || i === 1 || this.tool === "move";
    const cell = this.panes[i].cellAt(px, py);
    if (!isPan) return this.beginStroke(cell, px, py);
    const held = i === 0 && event.button === 0 && this.host && this.tool === "move" && cell >= 0 ? this.thingAt(cell) : null;
    this.stroke = { kind: held && this.clock === 0 ? "carry" : "pan", i, px, py, cell, held, moved: 0 };
  }

  pointerMove(event, i) {
    const [px, py] = this.place(event, i), known = this.pointers.get(event.pointerId);
    if (!known) return this.readCell(i, this.panes[i].cellAt(px, py));
    const [dx, dy] = [px - known.px, py - known.py];
    Object.assign(known, { px, py });
    if (this.pinch) return this.movePinch(i);
    const { stroke } = this;
    if (!stroke) return;
    const cell = this.panes[i].cellAt(px, py);
    if (stroke.kind === "pan") {
      stroke.moved += Math.abs(dx) + Math.abs(dy);
      if (stroke.moved > 6) {
        this.panes[i].pan(dx, dy);
        this.invalidate();
      }
    } else if (stroke.kind === "carry") stroke.target = cell;
    else {
      // Every cell between two reports of a fast hand.
      const [lx, ly] = stroke.last, pieces = Math.max(1, Math.ceil(Math.hypot(px - lx, py - ly) / Math.max(2, this.panes[0].view.scale / 3)));
      for (let k = 1; k <= pieces; k++) this.apply(this.panes[0].cellAt(lx + ((px - lx) * k) / pieces, ly + ((py - ly) * k) / pieces));
      stroke.last = [px, py];
      this.showStroke();
    }
    this.readCell(i, cell);
  }

  pointerUp(event, i) {
    this.pointers.delete(event.pointerId);
    if (this.pinch) {
      if (!this.pointers.size) this.pinch = null;
      return;
    }
    const { stroke } = this;
    this.stroke = null;
    if (!stroke) return;
    if (stroke.kind === "carry") {
      if (stroke.target !== undefined && stroke.target >= 0 && stroke.target !== stroke.cell) this.carry(stroke);
      else if (stroke.held.robot !== undefined) this.followRobot(stroke.held.robot);
    } else if (stroke.kind === "pan") {
      if (stroke.moved <= 6) this.pick(i, stroke);
    } else this.endStroke(stroke);
  }

  beginPinch(i) {
    if (this.stroke && this.stroke.kind !== "pan") this.refreshPanes();
    this.stroke = null;
    const [a, b] = [...this.pointers.values()];
    this.pinch = { length: Math.hypot(a.px - b.px, a.py - b.py), x: (a.px + b.px) / 2, y: (a.py + b.py) / 2 };
  }

  movePinch(i) {
    if (this.pointers.size < 2) return;
    const [a, b] = [...this.pointers.values()], { pinch } = this;
    const length = Math.hypot(a.px - b.px, a.py - b.py), x = (a.px + b.px) / 2, y = (a.py + b.py) / 2;
    this.panes[i].pan(x - pinch.x, y - pinch.y);
    this.panes[i].zoom(length / Math.max(1, pinch.length), x, y);
    Object.assign(pinch, { length, x, y });
    this.invalidate();
  }

  wheel(event, i) {
    event.preventDefault();
    const [px, py] = this.place(event, i);
    this.panes[i].zoom(Math.exp(-Math.max(-120, Math.min(120, event.deltaY)) * 0.0025), px, py);
    this.invalidate();
  }

  zoom(factor) {
    for (const pane of this.panes) if (pane.doc) pane.zoom(factor, pane.canvas.width / 2, pane.canvas.height / 2);
    this.invalidate();
  }

  fit() {
    for (const pane of this.panes) pane.fit();
    this.invalidate();
  }

  // Click: the robot nearest to the pointer, if it is near.
  pick(i, { px, py }) {
    const pane = this.panes[i], { robots, view } = pane;
    if (!robots) return;
    const { fraction } = this, reach = Math.max(10, view.scale * 0.6);
    let best = -1, least = reach * reach;
    for (let r = 0; r < robots.count; r++) {
      if (robots.state[r] === HIDDEN) continue;
      const dx = (robots.x0[r] + (robots.x1[r] - robots.x0[r]) * fraction) * view.scale + view.left - px;
      const dy = (robots.y0[r] + (robots.y1[r] - robots.y0[r]) * fraction) * view.scale + view.top - py;
      if (dx * dx + dy * dy < least) [best, least] = [r, dx * dx + dy * dy];
    }
    this.followRobot(best);
  }

  thingAt(cell) {
    const robot = this.doc.robots.indexOf(cell);
    if (robot >= 0) return { robot };
    return this.doc.destinations.includes(cell) ? { destination: cell } : null;
  }

  carry({ held, target, cell }) {
    const { doc } = this;
    if (this.live) return held.robot === undefined ? this.tell("move", cell, { to: target }) : this.say("Robots that run cannot be carried; take one away with Erase, and let another join.", true);
    if (doc.barriers[target] || doc.robots.includes(target) || doc.destinations.includes(target)) return this.say("That cell is taken.", true);
    if (held.robot !== undefined) this.change({ robots: doc.robots.map((other, r) => (r === held.robot ? target : other)), header: { ...doc.header, seed: null } });
    else this.change({ destinations: doc.destinations.map((other) => (other === cell ? target : other)) });
  }

  beginStroke(cell, px, py) {
    this.stroke = { kind: this.tool, last: [px, py], touched: new Set(), isRemoving: false };
    if (cell >= 0) {
      if (this.tool === "robot") this.stroke.isRemoving = this.doc.robots.includes(cell);
      if (this.tool === "destination") this.stroke.isRemoving = this.doc.destinations.includes(cell);
    }
    this.apply(cell);
    this.showStroke();
  }

  // The cells of the brush around a cell: those whose centres lie within its half width.
  brushed(cell) {
    const width = this.tool === "wall" || this.tool === "erase" ? Number(this.brush.value) : 1;
    if (width === 1) return [cell];
    const { doc } = this, [cx, cy] = centreOf(doc, cell), x = cell % doc.width, y = Math.floor(cell / doc.width), reach = 2 * width, cells = [];
    for (let j = Math.max(0, y - width); j <= Math.min(doc.height - 1, y + width); j++) {
      for (let i = Math.max(0, x - reach); i <= Math.min(doc.width - 1, x + reach); i++) {
        const [px, py] = shapeOf(doc).centre(i, j);
        if (Math.hypot(px - cx, py - cy) < width / 2) cells.push(j * doc.width + i);
      }
    }
    return cells;
  }

  apply(cell) {
    if (cell < 0) return;
    for (const one of this.brushed(cell)) {
      if (this.live && !this.stroke.touched.has(one)) this.touch(one);
      this.stroke.touched.add(one);
    }
  }

  // What the document is after a stroke.
  stroked({ kind, touched, isRemoving }) {
    const { doc } = this, changed = { ...doc };
    if (kind === "wall" || kind === "erase") {
      changed.barriers = doc.barriers.slice();
      for (const cell of touched) changed.barriers[cell] = kind === "wall" ? 1 : 0;
    }
    const isKept = (cells) => !cells.some((cell) => touched.has(cell));
    if (kind === "wall" || kind === "erase" || isRemoving) {
      if (kind !== "destination" && !isKept(doc.robots)) changed.robots = without(doc.robots, touched);
      if (kind !== "robot" && !isKept(doc.destinations)) changed.destinations = without(doc.destinations, touched);
    } else {
      const name = kind === "robot" ? "robots" : "destinations", there = new Set(doc[name]), other = new Set(kind === "robot" ? doc.destinations : doc.robots);
      changed[name] = plus(doc[name], [...touched].filter((cell) => !doc.barriers[cell] && !there.has(cell) && !other.has(cell)));
    }
    if (changed.robots !== doc.robots) changed.header = { ...doc.header, seed: null };
    return changed;
  }

  showStroke() {
    if (this.live) return;
    const doc = this.stroked(this.stroke);
    this.panes[0].show(doc, doc.robots === this.doc.robots ? this.panes[0].robots : new Still(doc, null));
    this.invalidate();
  }

  endStroke(stroke) {
    if (this.live) return;
    const doc = this.stroked(stroke);
    const isSame = ["barriers", "robots", "destinations"].every((name) => doc[name] === this.doc[name] || (doc[name].length === this.doc[name].length && doc[name].every((value, k) => value === this.doc[name][k])));
    if (isSame) {
      this.refresh();
      const [cell] = stroke.touched;
      if (cell !== undefined && this.doc.barriers[cell] && stroke.kind !== "wall") this.say(`Cell (${cell % this.doc.width}, ${Math.floor(cell / this.doc.width)}) is a barrier: erase it first.`, true);
      return;
    }
    this.say("");
    this.clock = 0;
    this.edit(doc);
  }

  readCell(i, cell) {
    const pane = this.panes[i], { doc } = pane;
    if (!doc || cell < 0) {
      this.readout.textContent = "";
      this.readout.removeAttribute("data-cell");
      return;
    }
    const words = [`cell (${cell % doc.width}, ${Math.floor(cell / doc.width)})`];
    if (doc.barriers[cell]) words.push("barrier");
    else if (doc.destinations.includes(cell)) words.push("destination");
    else words.push("free");
    const robot = this.clock === 0 ? doc.robots.indexOf(cell) : -1;
    if (robot >= 0) words.push(`robot ${robot}`);
    const distance = i ? this.runs[1]?.playback.distance : this.fields?.distance;
    if (this.live?.known && !this.live.known[cell]) words.push("not seen");
    if (distance && !doc.barriers[cell]) words.push(distance[cell] === NOT_REACHED ? "not reached" : `${number(distance[cell])} to go`);
    const names = this.settings.names?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`];
    if (!i && this.fields?.directions && names) {
      const bits = this.fields.directions[cell], row = names[shapeOf(doc).orientation(cell % doc.width, Math.floor(cell / doc.width))];
      const best = row.filter((_, k) => (bits >> k) & 1);
      if (best.length) words.push(`best ${best.join(", ")}`);
    }
    this.readout.textContent = words.join(" · ");
    this.readout.dataset.cell = cell;
  }

  choose(tool) {
    this.tool = tool;
    for (const [name, button] of Object.entries(this.toolButtons)) button.setAttribute("aria-pressed", name === tool);
    for (const canvas of this.canvases) canvas.dataset.tool = tool;
    this.brush.parentElement.hidden = tool !== "wall" && tool !== "erase";
    if (this.doc) this.say(TOOLS.find(([name]) => name === tool)[3]);
  }
};
