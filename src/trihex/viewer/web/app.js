// App: the page as a whole: the document, the plans for it, and the parts of the page, each with the state of one noun.

import { decode } from "./bundles.js";
import { documentOf } from "./documents.js";
import { Bar } from "./bar.js";
import { Clock } from "./clock.js";
import { Dialog } from "./dialog.js";
import { Draws } from "./draws.js";
import { Field } from "./field.js";
import { Followed } from "./followed.js";
import { Guide } from "./guide.js";
import { Growing } from "./growing.js";
import { Hand } from "./hand.js";
import { History } from "./history.js";
import { Keys } from "./keys.js";
import { Layers } from "./layers.js";
import { LivePanel } from "./livepanel.js";
import { Opening } from "./opening.js";
import { Owners } from "./owners.js";
import { Panel, layOut } from "./panel.js";
import { Planning } from "./planning.js";
import { Questions } from "./questions.js";
import { Readout } from "./readout.js";
import { Results } from "./results.js";
import { Rules } from "./rules.js";
import { runOf } from "./runs.js";
import { Saving } from "./saving.js";
import { Stage } from "./stage.js";
import { Status } from "./status.js";
import { Theme } from "./theme.js";
import { Tools } from "./tools.js";
import { groundFor, undergroundOf } from "./underground.js";

export class App {
  constructor(root, settings, host, first) {
    Object.assign(this, { root, settings, host });
    this.doc = null;
    this.making = null; // settles when the document that is being made is there
    this.runs = [null, null]; // plans: for the document, and beside it
    this.listeners = new AbortController();
    this.isClosed = false;
    this.#makeParts();
    this.shell = layOut(this);
    root.replaceChildren(this.shell);
    this.#listen();
    this.theme.apply();
    this.tools.choose(this.canEdit ? "wall" : "move");
    if (first) this.take(first);
    else this.make(this.#begin());
    if (this.canEdit) this.ready("").then(() => this.questions.prepare());
  }

  // What the host has to show first; without that an area to play with.
  async #begin() {
    const { settings, status } = this, request = { op: "first" };
    const answer = settings.first ? await this.ask(request, {}, "Opening…") : null;
    if (answer) return this.take(answer, { isEdit: false });
    const why = status.isWarning ? status.text : "";
    await this.draws.begin();
    return why ? this.say(why, true) : this.guide.offer();
  }

  #makeParts() {
    this.history = new History();
    this.status = new Status();
    this.dialog = new Dialog();
    this.theme = new Theme(this);
    this.questions = new Questions(this);
    this.clock = new Clock(this);
    this.field = new Field(this);
    this.growing = new Growing(this);
    this.followed = new Followed(this);
    this.layers = new Layers(this);
    this.owners = new Owners(this);
    this.results = new Results(this);
    this.readout = new Readout(this);
    this.stage = new Stage(this);
    this.tools = new Tools(this);
    this.hand = new Hand(this);
    this.keys = new Keys(this);
    this.panel = new Panel(this);
    this.bar = new Bar(this);
    // What there is to be asked of a host, and what takes one that does more than hand out answers.
    const editing = (Part) => (this.canEdit ? new Part(this) : null);
    this.rules = editing(Rules);
    this.draws = editing(Draws);
    this.planning = this.host && new Planning(this);
    this.livePanel = editing(LivePanel);
    this.opening = editing(Opening);
    this.saving = editing(Saving);
    this.guide = editing(Guide);
  }

  #listen() {
    this.keys.listen();
    this.shell.addEventListener("dragover", (event) => event.preventDefault());
    this.shell.addEventListener("drop", (event) => {
      event.preventDefault();
      if (event.dataTransfer.files[0]) this.opening?.openFile(event.dataTransfer.files[0]);
    });
    const sizes = new ResizeObserver(() => this.stage.resize());
    for (const element of [this.stage.element, ...this.panes.map(({ canvas }) => canvas)]) sizes.observe(element);
  }

  close() {
    this.listeners.abort();
    this.isClosed = true;
  }

  // ---- what the parts hold

  get canEdit() { return this.host?.canEdit ?? false; }
  get panes() { return this.stage.panes; }
  get job() { return this.questions.job; }
  get fields() { return this.field.known; }
  get growth() { return this.growing.growth; }
  get live() { return this.livePanel?.run ?? null; }
  get steps() {
    return this.live ? this.live.last.step : Math.max(0, ...this.runs.map((run) => run?.playback.steps ?? 0));
  }
  get fraction() { return this.live ? this.live.fraction : this.clock.at - this.clock.step; }
  get request() { return { document: this.doc.header }; }

  // Make another document: what needs one waits until it is there.
  async make(work) {
    const making = this.making = work.finally(() => { if (this.making === making) this.making = null; });
    return making;
  }

  // Until the document is there that is being made.
  async ready(what) {
    while (this.making) {
      if (what) this.say(`${what} as soon as the area and its robots are there.`);
      await this.making;
    }
  }

  say(words, isWarning) { this.status.say(words, isWarning); }
  ask(header, arrays, words, onPart) { return this.questions.ask(header, arrays, words, onPart); }
  leaveLive() { this.livePanel?.leave(); }

  // What a plan needs and the document lacks, in words; "" if nothing.
  missing() {
    const { destinations, robots } = this.doc;
    if (!destinations.length) return "There is no destination yet: choose the tool Destination and click a cell.";
    if (!robots.length) return "There are no robots yet: scatter some, or place them with the tool Robot.";
    return "";
  }

  // ---- the document and its plans

  // Take an answer of the host: a document, and the plan for it if there is one.
  take({ header, arrays }, { isEdit = true } = {}) {
    const plain = documentOf(header.document, arrays);
    const doc = { ...plain, ground: undergroundOf(header, arrays, plain.barriers) ?? groundFor(plain, this.doc) };
    const run = header.summary ? runOf({ header, arrays }, doc) : null;
    // A file may hold the plan beside it as well.
    const beside = arrays.beside ? runOf(decode(arrays.beside.slice())) : null;
    this.planning?.choose(header.planner);
    if (isEdit) this.edit(doc, [run, beside]);
    else this.set(doc, [run, beside]);
    if (!run) return;
    this.tools.choose("move");
    this.say(this.#wordsOf(run));
    this.planning?.bound();
  }

  // Change some of the document.
  change(changes) {
    this.leaveLive();
    this.edit({ ...this.doc, ...changes });
  }

  // Go on with another document, in a way that can be undone.
  edit(doc, runs = [null, null]) {
    this.leaveLive();
    this.guide?.leave();
    if (this.doc) this.history.keep({ doc: this.doc, runs: this.runs });
    this.set(doc, runs);
  }

  undo() { this.#travel((now) => this.history.back(now)); }
  redo() { this.#travel((now) => this.history.forth(now)); }
  #travel(find) {
    this.leaveLive();
    const state = find({ doc: this.doc, runs: this.runs });
    if (!state) return;
    this.say("");
    this.set(state.doc, state.runs);
  }

  // Show another document and its plans, and drop what belonged to the one before.
  set(doc, runs) {
    this.replace(doc, runs);
    this.field.adopt(doc, runs[0]);
    this.growing.fit(doc);
    this.clock.fit();
    this.followed.fit(doc);
    this.refresh();
    this.field.changed();
  }

  replace(doc, runs = this.runs) { Object.assign(this, { doc, runs }); }

  // ---- what is shown

  refresh() {
    const { bar, tools, rules, draws, growing, planning, layers, owners } = this;
    for (const part of [bar, tools, rules, draws, growing, planning, layers, owners]) part?.show();
    this.#sayNext();
    this.livePanel?.show();
    this.stage.show();
    this.showNumbers();
    this.followed.follow(this.followed.robot);
    this.clock.show();
  }

  // What to do next, unless there is a warning to be read first.
  #sayNext() {
    const { host, live, runs, status } = this;
    if (host && !live && !runs[0]) {
      const missing = this.missing();
      if (!status.isWarning || !missing) this.say(missing || "Press Plan to find paths for all robots.");
    }
    if (runs[0] && !status.text) this.say(this.#wordsOf(runs[0]));
  }

  // What there is to say of a plan that has come.
  #wordsOf({ summary }) { return this.planning ? this.planning.wordsOf(summary) : "Press Play."; }

  showNumbers() {
    this.results.show();
    if (!this.live) return;
    this.clock.show();
    this.followed.show();
    this.followed.centre();
    this.stage.invalidate();
  }
}
