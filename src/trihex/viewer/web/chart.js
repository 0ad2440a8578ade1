// Chart: curves by step, one below the other, and a cursor at the step that is shown.

import { h, number } from "./words.js";

const WIDTH = 300, HEIGHT = 120, MOST_POINTS = 600;

function greatestOf(curves) {
  let most = 0;
  for (const curve of curves) for (const value of curve) if (value > most) most = value;
  return most;
}

export class Chart {
  constructor(app) {
    this.app = app;
    this.element = h("div", { class: "chart" });
    this.cursors = [];
  }

  // Draw the curves of some runs, each with `arrived` and `waiting`.
  draw(runs) {
    this.cursors = [];
    this.element.replaceChildren(
      this.#figure("Robots arrived", runs.map(({ arrived }) => arrived), true),
      this.#figure("Robots waiting (queue)", runs.map(({ waiting }) => waiting), false));
  }

  // Move the cursor to a share of all steps.
  show(share) {
    for (const cursor of this.cursors) for (const end of ["x1", "x2"]) cursor.setAttribute(end, share * WIDTH);
  }

  clear() { this.element.replaceChildren(); }

  // `lasts` where a curve stays what it is at its end.
  #figure(label, curves, lasts) {
    const steps = Math.max(1, this.app.steps), most = greatestOf(curves), scale = Math.max(1, most);
    const svg = h("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", preserveAspectRatio: "none",
      "aria-label": `${label} by step, at most ${number(most)}` });
    svg.append(h("line", { x1: 0, y1: HEIGHT - 1, x2: WIDTH, y2: HEIGHT - 1, class: "axis" }));
    const x = (step) => (step / steps) * WIDTH, y = (value) => HEIGHT - 2 - (value / scale) * (HEIGHT - 6);
    curves.forEach((curve, i) => {
      const every = Math.max(1, Math.floor(curve.length / MOST_POINTS)), points = [], last = curve.length - 1;
      for (let step = 0; step < curve.length; step += every) {
        points.push(`${x(step).toFixed(1)},${y(curve[step]).toFixed(1)}`);
      }
      if (lasts) points.push(`${x(last)},${y(curve[last])}`, `${WIDTH},${y(curve[last])}`);
      svg.append(h("polyline", { points: points.join(" "), class: `run${i}` }));
    });
    const cursor = h("line", { x1: 0, x2: 0, y1: 0, y2: HEIGHT, class: "cursor" });
    svg.append(cursor);
    svg.addEventListener("pointerdown", (event) => {
      const box = svg.getBoundingClientRect();
      this.app.clock.seek(((event.clientX - box.left) / box.width) * steps);
    });
    this.cursors.push(cursor);
    const hint = `${label}, step by step; the line across is the step that is shown. Click to go to one.`;
    const head = h("figcaption", {}, h("span", {}, label), h("span", {}, `max ${number(most)}`));
    return h("figure", { title: hint }, head, svg);
  }
}
