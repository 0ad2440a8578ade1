// Saving: what is on the page as a file, in the folder or as a download.

import { h } from "./words.js";
import { button, endRow, grid, labelled } from "./controls.js";
import { arraysOf } from "./documents.js";
import { download } from "./storage.js";

const EXPORT_WORDS = {
  scenario: "Scenario: area, destinations, robots, rules",
  area: "Area: barriers only",
  field: "Field: the distance of each cell",
  starts: "Starts: cells of the robots",
  plan: "Plan: what each robot does at each step",
  page: "Page: one HTML file that plays anywhere, to share; both plans if there are two",
  movie: "Movie",
  picture: "Picture",
  waypoints: "Waypoints in metres",
  summary: "Summary: the numbers of the plan",
  run: "Live run: all that happened, for trihex run --resume",
  run_page: "Page of the live run: one HTML file that plays anywhere",
  run_waypoints: "Waypoints of the live run in metres",
  run_movie: "Movie of the live run",
  run_picture: "Picture of the live run: what was seen when",
};

export class Saving {
  constructor(app) {
    this.app = app;
    this.exports = app.settings.exports; // by what is saved: its suffixes, and what it needs
    this.what = h("select", { "aria-label": "What to save", onchange: () => this.#fillSuffixes() });
    this.suffix = h("select", { "aria-label": "Format", onchange: () => this.#rename() });
    this.name = h("input", { type: "text", "aria-label": "Name", value: "" });
    this.message = h("p", { class: "note", role: "status" });
  }

  // Ask what to save, and how.
  async open() {
    await this.app.ready("Files are saved");
    const { exports } = this, { live, runs: [run], settings, dialog } = this.app;
    const can = { draft: true, run: !!live?.last.step, plan: !!run?.plan };
    this.what.replaceChildren(...Object.entries(exports).map(([name, { needs }]) =>
      h("option", { value: name, disabled: !can[needs] }, EXPORT_WORDS[name])));
    this.what.value = can.run ? "run" : can.plan ? "plan" : "scenario";
    if (run && exports.plan.suffixes.includes(".npz")) {
      exports.plan.suffixes.sort((a, b) => (b === ".npz") - (a === ".npz"));
    }
    this.#fillSuffixes();
    this.message.textContent = "";
    const end = endRow(settings.folder ? button("Save in folder", () => this.#save(true)) : null,
      button("Download", () => this.#save(false), { class: "primary" }));
    dialog.open("Save", grid(labelled("What", this.what, "field wide"), labelled("Format", this.suffix),
      labelled("Name", this.name, "field wide")), this.message, end);
  }

  get #needs() { return this.exports[this.what.value].needs; }
  get #doc() { return this.app.live ? this.app.livePanel.before.doc : this.app.doc; }

  #fillSuffixes() {
    const { suffixes } = this.exports[this.what.value];
    this.suffix.replaceChildren(...suffixes.map((one) => h("option", { value: one }, one)));
    this.#rename();
  }

  #rename() {
    const base = (this.#doc.header.name || "area").replace(/[^\w-]+/g, "-").replace(/^-|-$/g, "") || "area";
    const planner = this.app.runs[0]?.summary.planner || "plan";
    this.name.value = `${base}${{ plan: `-${planner}`, run: "-run", draft: "" }[this.#needs]}${this.suffix.value}`;
  }

  #request(inFolder, overwrite) {
    const { runs: [run, beside], live, planning, request } = this.app, what = this.what.value;
    const isOfPlan = run?.plan && (this.#needs === "plan" || what === "picture");
    return {
      op: "save", what, name: this.name.value, in_folder: inFolder, overwrite,
      plan: isOfPlan ? run.plan : null, beside: what === "page" ? beside?.plan ?? null : null,
      live: this.#needs === "run" ? live.name : null, planner: planning.planner, ...request,
    };
  }

  async #save(inFolder, overwrite = false) {
    const { app, message } = this, name = this.name.value;
    message.textContent = "Saving…";
    const answer = await app.ask(this.#request(inFolder, overwrite), arraysOf(this.#doc));
    if (!answer) return void (message.textContent = app.status.text);
    if (answer.header.exists) {
      message.replaceChildren(`${name} is there already. `, button("Replace it", () => this.#save(true, true)));
      return;
    }
    if (answer.arrays.content) download(answer.header.name, answer.arrays.content);
    app.say(`Saved ${answer.header.saved ?? answer.header.name}.`);
    app.dialog.close();
  }
}
