// Live panel: how robots are to run live, and the document and the plans to come back to.

import { h, number } from "./words.js";
import { button, check, chosenIn, grid, note, numberField, numberIn, row, section, select } from "./controls.js";
import { arraysOf } from "./documents.js";
import { Live } from "./live.js";

const HINT_OF_LIVE = "Robots run while you paint walls in their way, move their destinations, or let others join.";
const HINT_OF_KEEPING = "Leave the run, and keep its walls and destinations";

export class LivePanel {
  constructor(app) {
    this.app = app;
    this.run = null; // that is under way
    this.before = null; // { doc, runs, known } from before it
    const planners = Object.keys(app.settings.planners);
    const optional = (label, max, placeholder) => numberField(label, "", { min: 0, max, step: "any", placeholder });
    this.planner = select("Who decides", planners, () => {});
    this.planner.lastChild.value = planners.includes("fcost") ? "fcost" : planners[0];
    this.sense = optional("Sensing, in cells", 100, "all known");
    this.late = optional("Late robots in %", 90, "0");
    this.budget = numberField("Seconds for a plan", 0.2, { min: 0.01, step: "any" });
    this.sight = h("input", { type: "checkbox" });
    this.replan = h("input", { type: "checkbox" });
    this.fields = grid(this.planner, this.sense, this.late, this.budget, check(this.sight, "line of sight"),
      check(this.replan, "plan at each change"));
    this.#explain();
    this.button = button("Run live", () => this.toggle(), { class: "primary", title: "L" });
    this.keepButton = button("Keep this world", () => this.keep(), { hidden: true, title: HINT_OF_KEEPING });
    this.element = section("Live", note(HINT_OF_LIVE), this.fields, row(this.button, this.keepButton));
  }

  get #wish() {
    const sense = numberIn(this.sense);
    return {
      planner: chosenIn(this.planner), sense, line_of_sight: sense !== null && this.sight.checked,
      delays: (numberIn(this.late) ?? 0) / 100, replan: this.replan.checked, budget: numberIn(this.budget),
    };
  }

  #explain() {
    for (const [field, hint] of [
      [this.planner, "Who decides what robots do next: fcost and greedy step by step, others by plans."],
      [this.sense, "How far robots see around them; empty: they know the whole area."],
      [this.late, "How many robots in a hundred stand still in each step, by chance."],
      [this.budget, "How long a plan may take before robots go on step by step."],
      [this.sight.parentElement, "Robots do not see through walls."],
      [this.replan.parentElement, "Also fcost and greedy make a whole plan whenever the world has changed."],
    ]) field.setAttribute("title", hint);
  }

  toggle() { return this.run ? this.leave() : this.#start(); }

  async #start() {
    const { app } = this;
    await app.ready("Robots run");
    const missing = app.missing();
    if (missing) return app.say(missing, true);
    const { doc, runs, fields: known } = app, wish = this.#wish;
    app.growing.end();
    const answer = await app.ask({ op: "live", ...wish, ...app.request }, arraysOf(doc), "Starting…");
    if (!answer || app.doc !== doc) return;
    this.#begin(answer, wish, { doc, runs, known });
    app.say("Robots are running: paint walls in their way.");
  }

  // Watch a run of a file again: the robots do what they did, until a hand changes something.
  watch(answer) {
    const { app } = this, { watched } = answer.header;
    app.take(answer);
    this.#begin(answer, watched, { doc: app.doc, runs: app.runs, known: app.fields });
    app.say(`This run of ${number(watched.steps)} steps is played again. Change something, and it goes another way.`);
  }

  #begin(answer, wish, before) {
    const { app } = this, { doc } = before;
    this.before = before;
    app.clock.rewind();
    app.clock.pause();
    this.run = new Live(app, doc, answer, wish);
    app.replace(this.run.doc, [null, null]);
    this.run.adopt(answer);
    app.field.replace({ doc: app.doc, distance: this.run.distance, directions: null });
    app.tools.choose("wall");
    app.refresh();
    app.panel.reveal(app.results.element);
  }

  // Back to the document and the plans from before.
  leave() {
    const { app, run, before } = this;
    if (!run) return;
    this.run = this.before = null;
    app.replace(before.doc, before.runs);
    app.field.replace(before.known);
    app.followed.fit(before.doc);
    app.say("");
    app.refresh();
  }

  // Leave the run, but stay in its world.
  keep() {
    const { app } = this, { barriers, destinations } = app.doc;
    this.leave();
    app.change({ barriers, destinations, robots: app.doc.robots.filter((cell) => !barriers[cell]) });
  }

  show() {
    this.button.textContent = this.run ? "Stop" : "Run live";
    this.keepButton.hidden = !this.run;
    for (const field of this.fields.querySelectorAll("input, select")) field.disabled = !!this.run;
  }
}
