// Results: the numbers of plans, or of a run that is under way.

import { h, number, percent, secondsOf, title } from "./words.js";
import { check, note, row, section } from "./controls.js";
import { Chart } from "./chart.js";
import { OF_BOUNDS, OF_LIVE, OF_PLAN, OF_SETS, UNITS } from "./sentences.js";

const SO_FAR = "The time that robots have used until this step, and the least that the total can still become: that " +
  "time, and the shortest way of each robot from where it is.";
const ALONE = "This page plays a plan that was made; robots that run live, while you paint walls in their way, need " +
  "trihex: start trihex view.";

function gapOf({ gap, lower_bound_name: bound }) {
  if (gap === null) return "–";
  if (gap === 0) return "0, proven";
  return bound === "optimum" ? percent(gap) : `at most ${percent(gap)}`;
}

// What the unit of all times is.
function unitsOf({ summary: { waiting_cost: wait }, edge_cost: edge }) {
  return `${UNITS} ${number(edge)}, a wait ${number(wait)}. Point at a number to read what it means.`;
}

const BOUND = "Lower bound";

// What a row is called, of what it tells, and what it says of the summary of a plan or a run.
const ROWS = [
  ["Total time", "total_time", (summary) => number(summary.total_time)],
  ["With full knowledge, no events", "reference_time", (summary) => number(summary.reference_time)],
  ["Price", "price", ({ price }) => (price === null ? "–" : percent(price))],
  [BOUND, "lower_bound", (summary) => `${number(summary.lower_bound)} (${summary.lower_bound_name})`],
  ["Gap to the optimum", "total_distance", gapOf],
  ["Steps", "steps", (summary) => number(summary.steps)],
  ["Last arrival", "last_arrival_seconds", (summary) => secondsOf(summary.last_arrival_seconds)],
  ["Moves d", "total_distance", (summary) => number(summary.total_distance)],
  ["Waiting w", "total_waiting", (summary) => number(summary.total_waiting)],
  ["Longest t", "longest_time", (summary) => number(summary.longest_time)],
  ["Arrived", "arrived", (summary) => `${number(summary.arrived)} of ${number(summary.robots)}`],
  ["Events", "events", (summary) => number(summary.events)],
  ["Conflicts", "conflicts", (summary) => (summary.conflicts ? number(summary.conflicts) : "none")],
  ["Moves past corners", "corner_moves", ({ corner_moves: moves }) => (moves ? number(moves) : "none")],
  ["Planned in", "seconds", ({ seconds }) => (seconds.plan === null ? "–" : `${seconds.plan.toPrecision(2)} s`)],
];

const has = (summary, key) => summary[key] !== undefined && (summary[key] !== null || key === "price");

function rowsOfLive({ last, summary, known }) {
  const [now, median, worst] = last.milliseconds.map((value) => value.toFixed(1));
  const rows = [
    ["Step", number(last.step)],
    ["Arrived", `${number(last.arrived)} of ${number(last.robots)}`],
    ["On the way", `${number(last.going)}${last.cut_off ? `, ${number(last.cut_off)} cut off` : ""}`],
    ["Total time so far", number(last.spent)],
    ["Milliseconds a step", last.step ? `${median} (now ${now}, worst ${worst})` : "–"],
    ["Repairs of the field", number(last.repairs)],
    ["Cells they touched", number(last.touched)],
  ];
  if (known) rows.push(["Known", percent(last.known)]);
  if (!summary) return rows;
  rows.push(["With full knowledge, no events", number(summary.reference_time)]);
  if (summary.price !== null) rows.push(["Price", percent(summary.price)]);
  rows.push(["Conflicts", summary.conflicts ? number(summary.conflicts) : "none"]);
  return rows;
}

export class Results {
  constructor(app) {
    this.app = app;
    this.table = h("div", { class: "results" });
    this.sofar = h("div", { class: "sofar", title: SO_FAR });
    this.chart = new Chart(app);
    this.sets = h("div", { class: "sets", role: "group", "aria-label": "Robots by set", title: OF_SETS });
    const alone = app.canEdit ? null : note(ALONE);
    this.paths = h("input", { type: "checkbox", onchange: () => this.#showPaths() });
    this.pathsField = check(this.paths, "All paths");
    const shown = row(app.layers.element, this.pathsField, app.owners.element);
    this.element = section("Result", shown, this.table, this.sets, this.sofar, this.chart.element, alone);
  }

  get hasPaths() { return this.paths.checked; }
  get #runs() { return this.app.runs.filter(Boolean); }

  show() {
    const runs = this.#runs;
    this.pathsField.hidden = !runs.length;
    if (this.app.live) return this.#showLive(this.app.live);
    if (runs.length) return this.#showRuns(runs);
    this.table.replaceChildren(note("No plan yet."));
    this.sets.replaceChildren();
    this.sofar.textContent = "";
    this.chart.clear();
  }

  #showRuns(runs) {
    const name = ({ summary: { planner, tessellation } }) => `${planner || "plan"}` +
      `${runs.length > 1 && tessellation !== this.app.doc.header.tessellation ? ` (${tessellation})` : ""}`;
    const heads = runs.map((run, i) => h("th", { scope: "col", class: `run${i}` }, name(run)));
    const rows = ROWS.filter(([, key]) => runs.some(({ summary }) => has(summary, key)));
    const lines = rows.map(([label, key, of]) => h("tr", { title: OF_PLAN[label] }, h("th", { scope: "row" }, label),
      runs.map(({ summary }) => h("td", { title: label === BOUND && OF_BOUNDS[summary.lower_bound_name] },
        has(summary, key) ? of(summary) : "–"))));
    const conflicts = runs.flatMap((run) => run.conflicts).slice(0, 5).map(({ step, text }) => h("li", {},
      h("button", { type: "button", class: "link", onclick: () => this.app.clock.seek(step - 1) }, text)));
    this.table.replaceChildren(...[
      h("table", {}, h("thead", {}, h("tr", {}, h("td"), heads)), h("tbody", {}, lines)),
      note(unitsOf(runs[0])), this.verdict ? h("p", { class: "verdict" }, this.verdict) : null,
      this.#why ? note(this.#why) : null,
      conflicts.length ? h("ul", { class: "conflicts" }, conflicts) : null,
    ].filter(Boolean));
    this.chart.draw(runs.map(({ playback }) => playback.curves));
  }

  #showPaths() {
    const { app } = this;
    if (this.hasPaths && this.#runs.some(({ playback }) => !playback.paths())) {
      app.say("These are too many paths to be drawn all: follow one robot.", true);
    }
    app.stage.show();
  }

  // One sentence on what two plans differ in.
  get verdict() {
    const runs = this.#runs;
    if (runs.length < 2) return "";
    const [one, two] = runs.map((run) => run.summary), isSame = one.tessellation === two.tessellation;
    const share = two.total_time ? one.total_time / two.total_time - 1 : 0;
    const nameIn = ({ planner, tessellation }) => `${planner}${isSame ? "" : ` on ${tessellation} cells`}`;
    const first = title(nameIn(one));
    if (Math.abs(share) < 5e-5) return `${first} and ${nameIn(two)} take the same total time.`;
    return `${first} takes ${percent(Math.abs(share))} ${share > 0 ? "more" : "less"} time than ${nameIn(two)}.`;
  }

  // What the difference between two plans is made of.
  get #why() {
    const runs = this.#runs, [one, two] = runs.map((run) => run.summary);
    if (runs.length < 2 || one.total_time === two.total_time || one.tessellation !== two.tessellation) return "";
    const more = (what, key) => {
      const by = one[key] - two[key];
      return by ? `${what} ${number(Math.abs(by))} ${by > 0 ? "more" : "less"}` : `${what} as much`;
    };
    const parts = `${more("wait", "total_waiting")} and ${more("move", "total_distance")}`;
    return `Its robots ${parts}, in time units all together; the map of time lost shows where.`;
  }

  #showLive(live) {
    const lines = rowsOfLive(live).map(([label, text]) =>
      h("tr", { title: OF_LIVE[label] }, h("th", { scope: "row" }, label), h("td", {}, text)));
    this.table.replaceChildren(h("table", { class: "live" }, h("tbody", {}, lines)));
    this.sets.replaceChildren();
    this.sofar.textContent = "";
    if (live.last.step) this.chart.draw([live.curves]);
  }

  // What robots do in a step of the plans, and what they have spent until then.
  showStep(step) {
    const runs = this.#runs, isOne = runs.length === 1;
    this.sets.replaceChildren(...runs.map((run, i) =>
      h("p", { class: `note run${i}` }, isOne ? "" : `${run.summary.planner}: `, this.#setsOf(run.playback, step))));
    this.sofar.replaceChildren(...runs.map((run) =>
      note(`${isOne ? "" : `${title(run.summary.planner || "plan")}: `}${this.#spentIn(run, step)}`)));
  }

  #setsOf({ curves, steps }, step) {
    const ahead = (curve) => number(step < steps ? curve[step + 1] : 0);
    const arrived = number(curves.arrived[Math.min(step, steps)]);
    return `${ahead(curves.moving)} moving · ${ahead(curves.waiting)} waiting · ${arrived} arrived`;
  }

  #spentIn({ playback: { curves, steps }, summary: { total_time: total } }, step) {
    const now = Math.min(step, steps), spent = curves.spent[now], least = curves.least_total?.[now];
    if (now === steps) return `All ${number(total)} time units are used.`;
    const used = `${number(spent)} of ${number(total)} time units used`;
    if (least === undefined) return `${used}.`; // in a run the world may change
    if (least === total) return `${used}; nobody waits or makes way any more.`;
    return `${used}. If nobody had to wait or make way from here on, it would be ${number(least)} in the end.`;
  }
}
