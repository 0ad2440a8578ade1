// Planning: who plans, for this document and beside it.

import { h, number, plural, title } from "./words.js";
import { button, chosenIn, grid, inner, labelled, note, row, section, select } from "./controls.js";
import { arraysOf } from "./documents.js";
import { runOf } from "./runs.js";

const SAME_CELLS = "same cells";

// A field for an option: a menu where there are choices, each with a line.
function optionField(name, value, hints = {}) {
  const choices = Object.keys(hints).filter(Boolean), line = note(hints[""] ?? "");
  const label = title(name.replace(/_/g, " ")), more = { "aria-label": label, "data-option": name };
  if (choices.length) {
    const tell = () => { line.textContent = hints[menu.value]; };
    const menu = h("select", { ...more, onchange: tell },
      choices.map((choice) => h("option", { value: choice, title: hints[choice] }, title(choice))));
    menu.value = value;
    tell();
    return h("div", { class: "wide" }, labelled(label, menu), line);
  }
  const kind = typeof value === "string" ? "text" : "number";
  const input = typeof value === "boolean"
    ? h("input", { type: "checkbox", checked: value, ...more })
    : h("input", { type: kind, step: "any", value: value ?? "", placeholder: "as usual", ...more });
  return h("div", { class: "wide" }, labelled(label, input), line);
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
    this.asked = null; // the plan that is on its way: { doc, wish }
    const { planners, tessellations } = app.settings, names = Object.keys(planners);
    this.first = select("Planner", names, () => this.#showOptions());
    this.first.lastChild.value = names.includes("fcost") ? "fcost" : names[0];
    this.line = note();
    this.lineBeside = note();
    this.options = inner("Options of the planner", grid());
    this.beside = select("Beside it", names, () => this.#tellBeside(), { "aria-label": "Planner beside it" });
    this.beside.lastChild.value = names.includes("optimal") ? "optimal" : "greedy";
    this.cells = select("on", [SAME_CELLS, ...tessellations], () => {}, { "aria-label": "Cells beside it" });
    // It stands beside Play, where it is always in sight.
    this.button = button("Plan", () => this.plan(0), { title: "P" });
    this.endButton = button("End comparing", () => this.endCompare(), { hidden: true });
    this.element = section("Plan",
      this.first, this.line, this.options, grid(this.beside, this.cells), this.lineBeside,
      row(button("Compare", () => this.plan(1)), this.endButton));
    this.#showOptions();
    this.#tellBeside();
  }

  get planner() { return chosenIn(this.first); }

  // Choose the planner that a file names, if there is such a one.
  choose(planner) {
    if (!planner || !this.app.settings.planners[planner]) return;
    this.first.lastChild.value = planner;
    this.#showOptions();
  }

  // Choose who plans, and who beside it, if there are such planners.
  pick(first, beside) {
    this.choose(first);
    if (this.app.settings.planners[beside]) this.beside.lastChild.value = beside;
    this.#tellBeside();
  }

  #showOptions() {
    const { planners, hints } = this.app.settings, { line, options: lines } = hints[this.planner];
    const options = Object.entries(planners[this.planner]);
    this.line.textContent = line;
    this.options.hidden = !options.length;
    this.options.lastChild.replaceChildren(...options.map(([name, value]) => optionField(name, value, lines[name])));
  }

  #tellBeside() { this.lineBeside.textContent = this.app.settings.hints[chosenIn(this.beside)].line; }

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
    await app.ready("Plans are made");
    app.leaveLive();
    const missing = app.missing();
    if (missing) return app.say(missing, true);
    if (which && !app.runs[0]) {
      await this.plan(0);
      if (!app.runs[0]) return;
    }
    const { doc } = app, request = this.#request(which), wish = JSON.stringify([which, request]);
    if (app.job && this.asked?.doc === doc && this.asked.wish === wish) return; // it is on its way
    app.clock.pause();
    this.asked = { doc, wish };
    const answer = await app.ask(request, arraysOf(doc), "Planning…");
    if (this.asked?.wish === wish) this.asked = null;
    if (!answer || app.doc !== doc) return;
    // The plan plays on the very document of the page, so that an edit is noticed.
    const run = runOf(answer, which ? null : doc, doc.ground);
    app.history.keep({ doc, runs: app.runs });
    app.growing.end();
    if (!which) app.clock.rewind();
    app.set(doc, which ? [app.runs[0], run] : [run, app.runs[1]]);
    app.clock.seek(0);
    // From here on a click should follow a robot rather than paint a wall, which would undo the plan.
    app.tools.choose("move");
    app.panel.reveal(app.results.element);
    this.bound();
    const { summary } = run;
    if (run !== app.runs[which]) return;
    const words = which && !summary.conflicts ? `${app.results.verdict} Press Play.` : this.wordsOf(summary);
    app.say(words, summary.conflicts > 0);
  }

  #request(which) {
    const planner = which ? chosenIn(this.beside) : this.planner, tessellation = chosenIn(this.cells);
    const request = { op: "plan", planner, options: this.#optionsOf(planner), ...this.app.request };
    return which && tessellation !== SAME_CELLS ? { ...request, tessellation } : request;
  }

  // What there is to say of a plan, and what to do next.
  wordsOf({ planner, total_time: total, optimal, unreachable, conflicts }) {
    const stranded = unreachable ? ` ${plural(unreachable, "robot")} cannot arrive.` : "";
    const unsafe = conflicts ? ` ${plural(conflicts, "conflict")}!` : "";
    const words = `${title(planner || "plan")}: total time ${number(total)}${optimal ? ", proven optimal" : ""}.`;
    return `${words}${stranded}${unsafe} Press Play.`;
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

  show() {
    const { runs, live } = this.app;
    this.endButton.hidden = !runs[1];
    this.button.classList.toggle("primary", !runs[0] && !live);
  }
}
