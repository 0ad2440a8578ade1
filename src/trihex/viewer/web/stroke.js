// Stroke: the cells that a tool has touched since the hand came down, and what the document is after it.

import { centreOf, plus, shapeOf, without } from "./documents.js";

// The cells of a brush around a cell: those whose centres lie within half its width.
export function brushed(doc, cell, width) {
  if (width === 1) return [cell];
  const [cx, cy] = centreOf(doc, cell), x = cell % doc.width, y = Math.floor(cell / doc.width), reach = 2 * width;
  const cells = [];
  for (let j = Math.max(0, y - width); j <= Math.min(doc.height - 1, y + width); j++) {
    for (let i = Math.max(0, x - reach); i <= Math.min(doc.width - 1, x + reach); i++) {
      const [px, py] = shapeOf(doc).centre(i, j);
      if (Math.hypot(px - cx, py - cy) < width / 2) cells.push(j * doc.width + i);
    }
  }
  return cells;
}

export class Stroke {
  // It begins at a cell, which says whether things are placed or taken away, and at a point of the picture.
  constructor(kind, doc, cell, point) {
    this.kind = kind;
    this.last = point;
    this.touched = new Set();
    const things = { robot: doc.robots, destination: doc.destinations }[kind];
    this.isRemoving = cell >= 0 && !!things?.includes(cell);
  }

  moveTo(point) { this.last = point; }

  get isBroad() { return this.kind === "wall" || this.kind === "erase"; }

  // The document after the stroke.
  on(doc) {
    const { kind, touched } = this, changed = { ...doc };
    if (this.isBroad) {
      changed.barriers = doc.barriers.slice();
      for (const cell of touched) changed.barriers[cell] = kind === "wall" ? 1 : 0;
    }
    if (this.isBroad || this.isRemoving) {
      const isHit = (cells) => cells.some((cell) => touched.has(cell));
      if (kind !== "destination" && isHit(doc.robots)) changed.robots = without(doc.robots, touched);
      if (kind !== "robot" && isHit(doc.destinations)) changed.destinations = without(doc.destinations, touched);
    } else {
      const name = kind === "robot" ? "robots" : "destinations";
      const taken = new Set([...doc.robots, ...doc.destinations]);
      changed[name] = plus(doc[name], [...touched].filter((cell) => !doc.barriers[cell] && !taken.has(cell)));
    }
    if (changed.robots !== doc.robots) changed.header = { ...doc.header, seed: null };
    return changed;
  }
}

export const isSameDocument = (one, other) => ["barriers", "robots", "destinations"].every((name) =>
  one[name] === other[name] ||
  (one[name].length === other[name].length && one[name].every((value, k) => value === other[name][k])));
