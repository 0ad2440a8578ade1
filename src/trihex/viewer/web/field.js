// Field: the distance of each cell from the destinations and the best directions, and whether they are shown.

import { h } from "./words.js";
import { check, row } from "./controls.js";
import { NOT_REACHED, arraysOf } from "./documents.js";
import { sameField } from "./runs.js";

export class Field {
  constructor(app) {
    this.app = app;
    this.known = null; // { doc, distance, directions }
    this.timer = 0; // until it is asked for
    this.looked = null; // what was found in the distances looked at last
    const toggle = () => h("input", { type: "checkbox", onchange: () => this.changed() });
    this.colours = toggle();
    this.arrows = app.host ? toggle() : null;
    this.numbers = toggle();
    this.element = row(check(this.colours, "Colours"), this.arrows && check(this.arrows, "Arrows"),
      check(this.numbers, "Numbers"));
  }

  get isShown() { return this.colours.checked; }

  // Take over what a plan knows of the field of a document, and drop what belongs to another one.
  adopt(doc, run) {
    if (run) this.known = { doc, distance: run.playback.distance, directions: null };
    else if (!this.known || !sameField(this.known.doc, doc)) this.known = null;
  }

  replace(known) { this.known = known; }

  // Have it shown, as if its box had been ticked.
  want() { this.colours.checked = true; }

  // Document or wishes have changed: get what is wanted and not known.
  changed() {
    const { app, colours, arrows, numbers, known } = this;
    const isWanted = colours.checked || arrows?.checked || numbers.checked;
    if (isWanted) this.want();
    const isKnown = known && (known.directions || !arrows?.checked);
    clearTimeout(this.timer);
    if (isWanted && !isKnown && !app.live && app.host && app.doc.destinations.length) {
      this.timer = setTimeout(() => this.fetch(), app.hand.stroke ? 60 : 0);
    }
    app.stage.show();
  }

  async fetch() {
    const { app } = this, { doc } = app;
    if (app.job) return void (this.timer = setTimeout(() => this.fetch(), 100));
    const answer = await app.ask({ op: "fields", ...app.request }, arraysOf(doc));
    if (!answer || !sameField(doc, app.doc)) return;
    this.known = { doc, ...answer.arrays };
    app.refresh();
  }

  // The distances that were looked at have changed.
  forget() { this.looked = null; }

  // The greatest of some distances, at least 1.
  farthest(distance) {
    if (!distance) return 1;
    if (this.looked?.distance !== distance) {
      let most = 1, unreached = -this.app.doc.barriers.reduce((count, barrier) => count + barrier, 0);
      for (const value of distance) {
        if (value === NOT_REACHED) unreached++;
        else if (value > most) most = value;
      }
      this.looked = { distance, most, hasUnreached: unreached > 0 };
    }
    return this.looked.most;
  }

  // Whether these distances, looked at last, have free cells from which no destination can be reached.
  hasUnreached(distance) { return this.looked?.distance === distance && this.looked.hasUnreached; }
}
