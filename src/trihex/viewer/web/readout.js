// Readout: what is known of the cell under the pointer.

import { h, number } from "./words.js";
import { NOT_REACHED, shapeOf } from "./documents.js";

export class Readout {
  constructor(app) {
    this.app = app;
    this.element = h("div", { class: "readout", id: "trihex-readout", "aria-live": "polite" });
  }

  // Tell of a cell of a pane, -1 for none.
  show(i, cell) {
    const { doc } = this.app.panes[i];
    if (!doc || cell < 0) {
      this.element.textContent = "";
      this.element.removeAttribute("data-cell");
      return;
    }
    const words = [...this.#there(doc, cell), ...this.#ahead(doc, i, cell)];
    this.element.textContent = words.join(" · ");
    this.element.dataset.cell = cell;
  }

  #there(doc, cell) {
    const words = [`cell (${cell % doc.width}, ${Math.floor(cell / doc.width)})`];
    if (doc.barriers[cell]) words.push("barrier");
    else words.push(doc.destinations.includes(cell) ? "destination" : "free");
    const robot = this.app.clock.at === 0 ? doc.robots.indexOf(cell) : -1;
    if (robot >= 0) words.push(`robot ${robot}`);
    return words;
  }

  #ahead(doc, i, cell) {
    const { live, runs, fields, settings } = this.app, words = [];
    const isRun = runs[i]?.playback.worlds, distance = i ? runs[1]?.playback.distance : fields?.distance;
    if (live?.known && !live.known[cell]) words.push("not seen");
    if (distance && !isRun && !doc.barriers[cell]) {
      words.push(distance[cell] === NOT_REACHED ? "not reached" : `${number(distance[cell])} to go`);
    }
    const names = settings.names?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`];
    if (i || !fields?.directions || !names) return words;
    const orientation = shapeOf(doc).orientation(cell % doc.width, Math.floor(cell / doc.width));
    const best = names[orientation].filter((_, k) => (fields.directions[cell] >> k) & 1);
    if (best.length) words.push(`best ${best.join(", ")}`);
    return words;
  }
}
