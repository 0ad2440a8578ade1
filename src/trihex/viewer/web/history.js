// History: the document, what it was before, and what undoing brings back.

import { decode } from "./bundles.js";
import { documentOf } from "./documents.js";
import { Playback } from "./playback.js";
import { runOf, sameField } from "./runs.js";

export const withHistory = (Base) => class extends Base {
  get steps() { return this.live ? this.live.last.step : Math.max(0, ...this.runs.map((run) => (run ? run.playback.steps : 0))); }

  // Take an answer of the host: a document, and the plan for it if there is one.
  take({ header, arrays }, { isEdit = true } = {}) {
    const doc = documentOf(header.document, arrays);
    const run = header.summary ? { ...header, playback: new Playback({ header, arrays }, doc), doc } : null;
    // A file may hold the plan beside it as well.
    const beside = arrays.beside ? runOf(decode(arrays.beside.slice())) : null;
    if (header.planner && this.planner && this.settings.planners[header.planner]) this.planner.lastChild.value = header.planner;
    if (isEdit) this.edit(doc, [run, beside]);
    else this.set(doc, [run, beside]);
    if (run) {
      this.choose("move");
      this.say("Press Play.");
      this.bound();
    }
  }

  edit(doc, runs = [null, null]) {
    this.leaveLive();
    if (this.doc) {
      this.past.push({ doc: this.doc, runs: this.runs });
      let bytes = 0, count = 0; // what the past may hold
      for (let i = this.past.length - 1; i >= 0 && bytes < 2 ** 28 && count < 300; i--, count++) bytes += this.past[i].doc.barriers.length;
      this.past = this.past.slice(this.past.length - count);
    }
    this.future = [];
    this.set(doc, runs);
  }

  set(doc, runs) {
    const isSame = this.doc && doc.barriers === this.doc.barriers;
    this.doc = doc;
    this.runs = runs;
    if (runs[0]) this.fields = { doc, distance: runs[0].playback.distance, directions: null };
    else if (!this.fields || !sameField(this.fields.doc, doc)) this.fields = null;
    if (this.growth && !sameField(this.growth.doc, doc)) this.endGrowth();
    this.clock = Math.min(this.clock, this.steps);
    if (!runs[0]) this.isPlaying = false;
    if (!isSame || this.follow >= doc.robots.length) this.follow = Math.min(this.follow, doc.robots.length - 1);
    this.refresh();
    this.fieldChanged();
  }

  undo() { this.travel(this.past, this.future); }
  redo() { this.travel(this.future, this.past); }
  travel(from, to) {
    this.leaveLive();
    const state = from.pop();
    if (!state) return;
    to.push({ doc: this.doc, runs: this.runs });
    this.set(state.doc, state.runs);
  }

  change(changes) {
    this.leaveLive();
    this.edit({ ...this.doc, ...changes });
  }
  rule(name, value) { this.change({ header: { ...this.doc.header, [name]: value } }); }
  retile(changes) {
    const header = { ...this.doc.header, ...changes };
    if (header.frame && (changes.tessellation || changes.neighbourhood)) {
      this.refresh();
      return this.say("This area lies in the world in metres: open its file again with other cells.", true);
    }
    // A cost of waiting in the old unit would mean something else.
    if (changes.costs) header.waiting_cost = null;
    this.change({ header });
  }
};
