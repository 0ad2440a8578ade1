// Owners: who owns which cells now, where robots own more than the cell on which they are.

import { h } from "./words.js";
import { check } from "./controls.js";
import { mix, packed } from "./colours.js";
import { shapeOf } from "./documents.js";
import { HIDDEN } from "./playback.js";
import { coloursOf } from "./robots.js";

const SMALLEST = 6; // device pixels an edge step
const CELL_REACH = { square: 0.71, hexagonal: 0.58, triangular: 1 }; // of a cell from its centre, in edge steps
const TINT = 100; // of 255
const HINT_OF_OWNING = "A robot that moves owns the cell that it leaves, then or meanwhile the one that it enters, " +
  "as the rules say: nobody else may come there.";

export class Owners {
  constructor(app) {
    this.app = app;
    this.box = h("input", { type: "checkbox", checked: true, onchange: () => app.stage.show() });
    this.element = check(this.box, "Cells they own");
    this.element.setAttribute("title", HINT_OF_OWNING);
  }

  // Whether cells that are owned are drawn in a document.
  areShown(doc) { return this.box.checked && this.#areOwned(doc); }

  // Whether robots own a cell from one step to the next: where nobody follows, or moves last several.
  #areOwned({ header: { following } }) {
    const { live, runs: [run], clock } = this.app;
    return !!(live || run) && (following === "forbid" || clock.pace > 1);
  }

  show() { this.element.hidden = !this.#areOwned(this.app.doc); }
}

// The robot that owns a cell of a pane, -1 if nobody does.
export function ownerOf({ robots }, cell, fraction) {
  for (let r = 0; r < robots.count; r++) {
    if (robots.state[r] !== HIDDEN && (robots.held(r, fraction) === cell || robots.alsoHeld(r) === cell)) return r;
  }
  return -1;
}

// Tint the cells that robots own, each in the colour of its robot.
export function plotOwned(pane, fraction) {
  const { robots: { count, state }, robots, view } = pane;
  if (view.scale < SMALLEST) return;
  const colours = coloursOf(pane.palette()).map((colour) => (colour ? packed(colour) : 0));
  for (let r = 0; r < count; r++) {
    if (state[r] === HIDDEN) continue;
    tint(pane, robots.held(r, fraction), colours[state[r]]);
    tint(pane, robots.alsoHeld(r), colours[state[r]]);
  }
}

function tint({ doc, view, canvas: { width, height }, cellOfPixel, frame32 }, cell, colour) {
  if (cell < 0) return;
  const [x, y] = shapeOf(doc).centre(cell % doc.width, Math.floor(cell / doc.width));
  const reach = CELL_REACH[doc.header.tessellation] * view.scale + 1, px = x * view.scale + view.left;
  const py = y * view.scale + view.top, right = Math.min(width, px + reach), bottom = Math.min(height, py + reach);
  for (let j = Math.max(0, Math.floor(py - reach)); j < bottom; j++) {
    for (let i = Math.max(0, Math.floor(px - reach)), p = j * width + i; i < right; i++, p++) {
      if (cellOfPixel[p] === cell) frame32[p] = mix(frame32[p], colour, TINT);
    }
  }
}
