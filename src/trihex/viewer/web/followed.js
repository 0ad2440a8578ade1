// Followed: one robot, its path, and its times so far and in the end.

import { h, number, title } from "./words.js";
import { button, check, labelled, note, row, section } from "./controls.js";
import { NOT_REACHED } from "./documents.js";
import { nameOfCell, nameOfRobot } from "./names.js";
import { OF_ROBOT } from "./sentences.js";

const HINT = "Click a robot to see its path, its moves d, its waits w and its time t.";

// The row that a robot has reached by a step.
const indexAt = (rows, step) => rows.findLastIndex((row) => row.step <= step);

export class Followed {
  constructor(app) {
    this.app = app;
    this.robot = -1;
    this.tracks = []; // of each plan, cells and times of the robot
    this.field = h("input", { type: "number", min: 0, placeholder: "number",
      "aria-label": "Number of the robot to follow", onchange: () => this.follow(this.#wanted) });
    this.text = h("div", { class: "robot" });
    this.centred = h("input", { type: "checkbox" });
    this.element = section("One robot", row(labelled("Follow robot", this.field), button("None", () => this.follow(-1)),
      check(this.centred, "keep it in view")), this.text);
  }

  get #name() { return nameOfRobot(this.robot, this.app.doc.robots.length); }
  get #wanted() { return this.field.value === "" ? -1 : Number(this.field.value); }

  follow(robot) {
    const { doc, runs, stage } = this.app, count = doc.robots.length;
    robot = Number.isInteger(robot) && robot >= 0 && robot < count ? robot : -1;
    const isNew = robot !== this.robot;
    this.robot = robot;
    this.field.value = robot < 0 ? "" : robot;
    this.field.max = count - 1;
    const trackIn = (run) => (run && robot < run.playback.count ? run.playback.robot(robot) : null);
    this.tracks = robot < 0 ? [] : runs.map(trackIn);
    if (isNew) stage.show();
    this.show();
  }

  drop() { this.robot = -1; }

  // Keep to the robots that a document has.
  fit(doc) { this.robot = Math.min(this.robot, doc.robots.length - 1); }

  show() {
    const { app, robot } = this, { doc, live, runs } = app;
    if (robot < 0) return this.#tell(HINT);
    if (live) return this.#tell(this.#wordsOfLive(live));
    const shown = runs.map((run, i) => ({ run, track: this.tracks[i], pane: app.panes[i] }))
      .filter(({ run, track }) => run && track);
    if (!shown.length) return this.#tell(`${title(this.#name)} starts at ${nameOfCell(doc, doc.robots[robot])}.`);
    this.text.replaceChildren(...shown.map(({ run, track }, i) => this.#tableOf(run, track, i, shown.length > 1)));
    if (!this.centred.checked) return;
    for (const { track: { rows }, pane } of shown) pane.reveal(rows[indexAt(rows, app.clock.step)].cell);
  }

  // Keep a robot that runs live in view.
  centre() {
    const { doc, panes } = this.app, cell = doc.robots[this.robot];
    if (this.centred.checked && this.robot >= 0 && cell >= 0) panes[0].reveal(cell);
  }

  #tell(words) { this.text.replaceChildren(note(words)); }

  #wordsOfLive({ distance }) {
    const { doc } = this.app, cell = doc.robots[this.robot];
    if (cell < 0) return `${title(this.#name)} has gone.`;
    const ahead = distance[cell] < NOT_REACHED ? `${number(distance[cell])} to go as far as is known` : "cut off";
    return `${title(this.#name)} is at ${nameOfCell(doc, cell)}, ${ahead}.`;
  }

  #tableOf(run, { rows, hasArrived }, i, isNamed) {
    const k = indexAt(rows, this.app.clock.step), now = rows[k], last = rows[rows.length - 1];
    const end = hasArrived ? `arrived at step ${last.step}` : "cannot arrive";
    const doing = rows[k + 1] ? `next ${rows[k + 1].action}` : end;
    const words = `${this.#name} at ${nameOfCell(run.doc, now.cell)}, ${doing}`;
    const line = (label, of) => h("tr", { title: OF_ROBOT[label] }, h("th", { scope: "row" }, label),
      h("td", {}, number(of(now))), h("td", {}, number(of(last))));
    const heads = ["so far", "in the end"].map((head) => h("th", { scope: "col" }, head));
    return h("div", {},
      h("p", { class: `note run${i}` }, `${isNamed ? `${run.summary.planner}: ` : ""}${words}`),
      h("table", {}, h("thead", {}, h("tr", {}, h("td"), heads)),
        h("tbody", {}, line("moves d", (at) => at.d), line("waits w", (at) => at.w),
          line("time t = d + w", (at) => at.d + at.w))));
  }
}
