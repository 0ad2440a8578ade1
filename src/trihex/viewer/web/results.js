// Results: the numbers of plans, their curves, and one robot.

import { h, number, percent, title } from "./words.js";
import { NOT_REACHED } from "./documents.js";

export const withResults = (Base) => class extends Base {
  showResults() {
    if (this.live) return this.showLive();
    const runs = this.runs.filter(Boolean);
    if (!runs.length) {
      this.results.replaceChildren(h("p", { class: "note" }, "No plan yet."));
      this.sets.replaceChildren();
      this.sofar.textContent = "";
      this.chart.replaceChildren();
      return;
    }
    const rows = [
      ["Total time", (s) => number(s.total_time)], ["Lower bound", (s) => `${number(s.lower_bound)} (${s.lower_bound_name})`],
      ["Gap to the optimum", (s) => (s.gap === null ? "–" : s.gap === 0 ? "0, proven" : s.lower_bound_name === "optimum" ? percent(s.gap) : `at most ${percent(s.gap)}`)], ["Steps", (s) => number(s.steps)],
      ["Moves d", (s) => number(s.total_distance)], ["Waiting w", (s) => number(s.total_waiting)], ["Longest t", (s) => number(s.longest_time)],
      ["Arrived", (s) => `${number(s.arrived)} of ${number(s.robots)}`], ["Conflicts", (s) => (s.conflicts ? number(s.conflicts) : "none")],
      ["Planned in", (s) => (s.seconds.plan === null ? "–" : `${s.seconds.plan.toPrecision(2)} s`)],
    ];
    const name = (run) => `${run.summary.planner || "plan"}${runs.length > 1 && run.summary.tessellation !== this.doc.header.tessellation ? ` (${run.summary.tessellation})` : ""}`;
    const table = h("table", {}, h("thead", {}, h("tr", {}, h("td"), runs.map((run, i) => h("th", { scope: "col", class: `run${i}` }, name(run))))),
      h("tbody", {}, rows.map(([label, of]) => h("tr", {}, h("th", { scope: "row" }, label), runs.map((run) => h("td", {}, of(run.summary)))))));
    const conflicts = runs.flatMap((run) => run.conflicts).slice(0, 5).map(({ step, text }) => h("li", {}, h("button", { type: "button", class: "link", onclick: () => this.seek(step - 1) }, text)));
    this.results.replaceChildren(...[table, this.verdict(runs), conflicts.length ? h("ul", { class: "conflicts" }, conflicts) : null].filter(Boolean));
    this.drawChart(runs);
  }

  // One sentence on what two plans differ in.
  verdict(runs) {
    if (runs.length < 2) return null;
    const [one, two] = runs.map((run) => run.summary), share = two.total_time ? one.total_time / two.total_time - 1 : 0;
    const isSame = one.tessellation === two.tessellation;
    const names = [one, two].map((summary) => `${summary.planner}${isSame ? "" : ` on ${summary.tessellation} cells`}`);
    const text = Math.abs(share) < 5e-5 ? `${title(names[0])} and ${names[1]} take the same total time.` :
      `${title(names[0])} takes ${percent(Math.abs(share))} ${share > 0 ? "more" : "less"} time than ${names[1]}.`;
    return h("p", { class: "verdict" }, text);
  }

  drawChart(runs) {
    const width = 300, height = 120, steps = Math.max(1, this.steps);
    const draw = (label, of, last) => {
      const most = Math.max(1, ...runs.map((run) => { let m = 0; for (const v of of(run)) if (v > m) m = v; return m; }));
      const svg = h("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${label} by step, at most ${number(most)}`, preserveAspectRatio: "none" });
      svg.append(h("line", { x1: 0, y1: height - 1, x2: width, y2: height - 1, class: "axis" }));
      runs.forEach((run, i) => {
        const curve = of(run), every = Math.max(1, Math.floor(curve.length / 600)), points = [];
        for (let s = 0; s < curve.length; s += every) points.push(`${((s / steps) * width).toFixed(1)},${(height - 2 - (curve[s] / most) * (height - 6)).toFixed(1)}`);
        if (last) points.push(`${((curve.length - 1) / steps) * width},${height - 2 - (curve[curve.length - 1] / most) * (height - 6)}`, `${width},${height - 2 - (curve[curve.length - 1] / most) * (height - 6)}`);
        svg.append(h("polyline", { points: points.join(" "), class: `run${i}` }));
      });
      const cursor = h("line", { x1: 0, x2: 0, y1: 0, y2: height, class: "cursor" });
      svg.append(cursor);
      svg.addEventListener("pointerdown", (event) => {
        const box = svg.getBoundingClientRect();
        this.seek(((event.clientX - box.left) / box.width) * steps);
      });
      this.cursors.push(cursor);
      return h("figure", {}, h("figcaption", {}, h("span", {}, label), h("span", {}, `max ${number(most)}`)), svg);
    };
    this.cursors = [];
    this.chartWidth = width;
    this.chart.replaceChildren(draw("Robots arrived", (run) => run.playback.curves.arrived, true), draw("Robots waiting (queue)", (run) => run.playback.curves.waiting, false));
  }

  showClock() {
    const { steps } = this, step = Math.floor(this.clock);
    this.scrubber.max = steps;
    this.scrubber.value = this.clock;
    this.scrubber.disabled = !this.runs[0];
    this.playButton.disabled = !this.runs[0] && !this.live;
    this.scrubber.setAttribute("aria-valuetext", `step ${step} of ${steps}`);
    this.playButton.textContent = this.isPlaying || this.live?.isPlaying ? "Pause" : "Play";
    this.clockText.textContent = this.live ? `step ${number(steps)}, live` : this.runs[0] ? `step ${number(step)} / ${number(steps)}` : "no plan";
    const runs = this.runs.filter(Boolean);
    if (!runs.length) return;
    for (const cursor of this.cursors ?? []) for (const end of ["x1", "x2"]) cursor.setAttribute(end, (this.clock / Math.max(1, steps)) * this.chartWidth);
    const key = `${step} ${runs.map((run) => run.plan + run.summary.planner)}`;
    if (this.clockKey === key && this.clockDoc === this.doc) return;
    this.clockKey = key;
    this.clockDoc = this.doc;
    const now = (run, name) => run.playback.curves[name][Math.min(step, run.playback.steps)];
    const ahead = (run, name) => (step < run.playback.steps ? run.playback.curves[name][step + 1] : 0);
    this.sets.replaceChildren(...runs.map((run, i) => h("p", { class: `note run${i}` }, runs.length > 1 ? `${run.summary.planner}: ` : "",
      `${number(ahead(run, "moving"))} moving · ${number(ahead(run, "waiting"))} waiting · ${number(now(run, "arrived"))} arrived`)));
    this.sofar.textContent = runs.map((run) => {
      const least = now(run, "least_total"), { lower_bound: bound, gap } = run.summary;
      const over = gap === null || !bound ? "" : least <= bound ? ", not above the lower bound so far" : `, ${percent(least / bound - 1)} above the lower bound`;
      return `${runs.length > 1 ? `${title(run.summary.planner)}: ` : ""}${number(now(run, "spent"))} spent, ${number(least)} at least in the end${over}.`;
    }).join(" ");
    if (this.follow >= 0) this.showRobot();
  }

  followRobot(robot) {
    const count = this.doc.robots.length;
    robot = Number.isInteger(robot) && robot >= 0 && robot < count ? robot : -1;
    const isNew = robot !== this.follow;
    this.follow = robot;
    this.robotNumber.value = robot < 0 ? "" : robot;
    this.robotNumber.max = count - 1;
    this.tracks = robot < 0 ? [] : this.runs.map((run) => (run && robot < run.playback.count ? run.playback.robot(robot) : null));
    if (isNew) this.refreshPanes();
    this.showRobot();
  }

  showRobot() {
    if (this.follow < 0) return this.robotText.replaceChildren(h("p", { class: "note" }, "Click a robot to see its path, its moves d, its waits w and its time t."));
    const runs = this.runs.map((run, i) => [run, this.tracks[i]]).filter(([run, track]) => run && track);
    const place = (doc, cell) => `(${cell % doc.width}, ${Math.floor(cell / doc.width)})`;
    const here = this.doc.robots[this.follow];
    if (this.live) return this.robotText.replaceChildren(h("p", { class: "note" }, here < 0 ? `Robot ${this.follow} has gone.` : `Robot ${this.follow} is at ${place(this.doc, here)}${this.live.distance[here] < NOT_REACHED ? `, ${number(this.live.distance[here])} to go as far as is known` : ", cut off"}.`));
    if (!runs.length) return this.robotText.replaceChildren(h("p", { class: "note" }, `Robot ${this.follow} starts at ${place(this.doc, this.doc.robots[this.follow])}.`));
    const step = Math.floor(this.clock);
    this.robotText.replaceChildren(...runs.map(([run, track], i) => {
      const { rows, hasArrived } = track, now = rows[Math.min(step, rows.length - 1)], last = rows[rows.length - 1];
      const next = rows[step + 1], doing = next ? `next ${next.action}` : hasArrived ? `arrived at step ${rows.length - 1}` : "cannot arrive";
      const line = (label, of) => h("tr", {}, h("th", { scope: "row" }, label), h("td", {}, number(of(now))), h("td", {}, number(of(last))));
      return h("div", {}, h("p", { class: `note run${i}` }, `${runs.length > 1 ? `${run.summary.planner}: ` : ""}robot ${this.follow} at ${place(run.doc, now.cell)}, ${doing}`),
        h("table", {}, h("thead", {}, h("tr", {}, h("td"), h("th", { scope: "col" }, "so far"), h("th", { scope: "col" }, "in the end"))),
          h("tbody", {}, line("moves d", (row) => row.d), line("waits w", (row) => row.w), line("time t = d + w", (row) => row.d + row.w))));
    }));
    if (this.centred.checked) runs.forEach(([run, track]) => this.panes[this.runs.indexOf(run)].reveal(track.rows[Math.min(step, track.rows.length - 1)].cell));
  }
};
