// Planning: who plans, for this document and beside it.

import { h, number, plural, title } from "./words.js";
import { button, chosenIn, grid, inner, labelled, row, section, select } from "./controls.js";
import { arraysOf } from "./documents.js";
import { runOf } from "./runs.js";

const SAME_CELLS = "the same cells";

function optionField(name, value) {
  const kind = typeof value === "number" ? "number" : "text";
  const input = typeof value === "boolean"
    ? h("input", { type: "checkbox", checked: value, "data-option": name })
    : h("input", { type: kind, step: "any", value: value ?? "", placeholder: "default", "data-option": name });
  return labelled(name.replace(/_/g, " "), input);
}

function optionIn(input, usual) {
  const text = input.value.trim();
  if (input.type === "checkbox") return input.checked;
  if (text === "") return usual;
  return isNaN(Number(text)) ? text : Number(text);
}

export class Planning {
  constructor(app) {
    this.app = app;
    const { planners, tessellations } = app.settings, names = Object.keys(planners);
    this.first = select("Planner", names, () => this.#showOptions());
    this.first.lastChild.value = names.includes("fcost") ? "fcost" : names[0];
    this.options = inner("Options of the planner", grid());
    this.beside = select("Beside it", names, () => {}, { "aria-label": "Planner beside it" });
    this.beside.lastChild.value = names.includes("optimal") ? "optimal" : "greedy";
    this.cells = select("on", [SAME_CELLS, ...tessellations], () => {}, { "aria-label": "Cells beside it" });
    this.endButton = button("One picture", () => this.endCompare(), { hidden: true });
    this.element = section("Plan",
      row(this.first, button("Plan", () => this.plan(0), { class: "primary", title: "P" })), this.options,
      grid(this.beside, this.cells), row(button("Compare", () => this.plan(1)), this.endButton), app.questions.element);
    this.#showOptions();
  }

  get planner() { return chosenIn(this.first); }

  // Choose the planner that a file names, if there is such a one.
  choose(planner) {
    if (planner && this.app.settings.planners[planner]) this.first.lastChild.value = planner;
  }

  #showOptions() {
    const options = Object.entries(this.app.settings.planners[this.planner]);
    this.options.hidden = !options.length;
    this.options.lastChild.replaceChildren(...options.map(([name, value]) => optionField(name, value)));
  }

  // The options of a planner that are not as usual; there are fields for the first planner only.
  #optionsOf(planner) {
    if (planner !== this.planner) return {};
    const options = {}, usual = this.app.settings.planners[planner];
    for (const input of this.options.querySelectorAll("[data-option]")) {
      const name = input.dataset.option, value = optionIn(input, usual[name]);
      if (value !== usual[name]) options[name] = value;
    }
    return options;
  }

  // Plan for the document (0), or beside it (1).
  async plan(which) {
    const { app } = this;
    app.leaveLive();
    const missing = app.missing();
    if (missing) return app.say(missing, true);
    if (which && !app.runs[0]) {
      await this.plan(0);
      if (!app.runs[0]) return;
    }
    const { doc } = app, request = this.#request(which);
    app.clock.pause();
    const answer = await app.ask(request, arraysOf(doc), "Planning…");
    if (!answer || app.doc !== doc) return;
    // The plan plays on the very document of the page, so that an edit is noticed.
    const run = runOf(answer, which ? null : doc);
    app.history.keep({ doc, runs: app.runs });
    app.growing.end();
    if (!which) app.clock.rewind();
    app.set(doc, which ? [app.runs[0], run] : [run, app.runs[1]]);
    app.clock.seek(0);
    // From here on a click should follow a robot rather than paint a wall, which would undo the plan.
    app.tools.choose("move");
    app.results.element.scrollIntoView({ block: "nearest" });
    this.bound();
    if (run === app.runs[which]) this.#tell(run.summary);
  }

  #request(which) {
    const planner = which ? chosenIn(this.beside) : this.planner, tessellation = chosenIn(this.cells);
    const request = { op: "plan", planner, options: this.#optionsOf(planner), ...this.app.request };
    return which && tessellation !== SAME_CELLS ? { ...request, tessellation } : request;
  }

  #tell({ planner, total_time: total, optimal, unreachable, conflicts }) {
    const stranded = unreachable ? ` ${plural(unreachable, "robot")} cannot arrive.` : "";
    const unsafe = conflicts ? ` ${plural(conflicts, "conflict")}!` : "";
    const words = `${title(planner || "plan")}: total time ${number(total)}${optimal ? ", proven optimal" : ""}.`;
    this.app.say(`${words}${stranded}${unsafe} Press Play.`, unsafe !== "");
  }

  // Better lower bounds take longer than plans: they are asked for while the plan is on the page already. Where the
  // optimum has been found meanwhile, it is the bound.
  async bound() {
    const { app } = this;
    for (const run of app.runs) {
      if (!run?.plan || run.summary.optimal || run.isBounding) continue; // a run that is over has no name
      run.isBounding = true;
      try {
        const { header } = await app.host.ask({ op: "bound", plan: run.plan });
        Object.assign(run, { summary: header.summary });
        if (app.runs.includes(run)) app.refresh();
      } catch { /* the weaker bound holds as well */ } finally {
        run.isBounding = false;
      }
    }
  }

  endCompare() { this.app.set(this.app.doc, [this.app.runs[0], null]); }

  show() { this.endButton.hidden = !this.app.runs[1]; }
}
