// Runners: the robots of a live run, from where they were to where they are.

import { centreOf, shapeOf } from "./documents.js";
import { FINAL, HIDDEN } from "./playback.js";

export class Runners {
  constructor() {
    this.count = 0;
    this.steps = 0;
    for (const name of ["x0", "y0", "x1", "y1", "bx", "by"]) this[name] = new Float32Array(0);
    this.state = new Uint8Array(0);
    this.cells = new Int32Array(0);
    this.comesFrom = null; // where moves last, or nobody follows: the cells that robots leave in the last step
    this.share = null; // and how much of those moves is done, of 255
    this.follows = true;
  }

  // Take over where they are: after some steps they come from where they were, else those that joined stand still.
  move(doc, { cells, sets: state, came_from: comesFrom = null, share = null }, steps) {
    const { count, x0, y0, x1, y1 } = this, n = cells.length;
    const x = new Float32Array(n), y = new Float32Array(n);
    for (let r = 0; r < n; r++) [x[r], y[r]] = comesFrom?.[r] >= 0 ? onWay(doc, comesFrom[r], cells[r], share[r] / 255)
      : centreOf(doc, cells[r]);
    const from = (old, to) => {
      const all = to.slice();
      all.set(old.subarray(0, Math.min(count, n)));
      return all;
    };
    Object.assign(this, { comesFrom, share, follows: doc.header.following !== "forbid" });
    const [beforeX, beforeY] = steps || !count ? [x1, y1] : [x0, y0], [bx, by] = this.#bends(doc, x, y, steps);
    Object.assign(this, { count: n, x0: from(beforeX, x), y0: from(beforeY, y), x1: x, y1: y, bx, by, cells, state });
  }

  // How far the corners that they pass in a step are from the middles of their ways.
  #bends(doc, x, y, steps) {
    const bx = new Float32Array(x.length), by = new Float32Array(x.length), { count, cells, x1, y1 } = this;
    const old = Math.min(count, x.length), { bend, orientation } = shapeOf(doc);
    const isStep = steps === 1 && doc.header.clock !== "costs"; // of moves that last, a step is but a piece
    if (!steps) {
      bx.set(this.bx.subarray(0, old));
      by.set(this.by.subarray(0, old));
    }
    for (let r = 0; isStep && r < old; r++) {
      const side = orientation(cells[r] % doc.width, Math.floor(cells[r] / doc.width));
      [bx[r], by[r]] = bend(side, x[r] - x1[r], y[r] - y1[r]);
    }
    return [bx, by];
  }

  // Those that have come to a destination are gone.
  settle() {
    for (let r = 0; r < this.count; r++) if (this.state[r] === FINAL) this.state[r] = HIDDEN;
  }

  // Where robots are, -1 for those that are gone.
  places() {
    return this.cells.map((cell, r) => (this.state[r] === HIDDEN || this.state[r] === FINAL ? -1 : cell));
  }

  // The cell that a robot owns, and the one that it enters beside; see playback.js.
  held(r) {
    const { comesFrom, share, follows, cells, state } = this;
    if (comesFrom?.[r] >= 0 && (!follows || share[r] < 128)) return comesFrom[r];
    return state[r] === FINAL ? -1 : cells[r];
  }

  alsoHeld(r) {
    const { comesFrom, follows, cells, state } = this;
    return comesFrom?.[r] >= 0 && !follows && state[r] !== FINAL ? cells[r] : -1;
  }

  seek() {}
}

// Where a robot is on its way from a cell to another, of which a share is done.
function onWay(doc, from, to, share) {
  const [x0, y0] = centreOf(doc, from), [x1, y1] = centreOf(doc, to), { bend, orientation } = shapeOf(doc);
  const [bx, by] = bend(orientation(from % doc.width, Math.floor(from / doc.width)), x1 - x0, y1 - y0);
  const bow = 1 - Math.abs(2 * share - 1);
  return [x0 + (x1 - x0) * share + bx * bow, y0 + (y1 - y0) * share + by * bow];
}
