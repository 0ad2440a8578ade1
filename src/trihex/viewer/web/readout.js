// Readout: what is known of the cell under the pointer.

import { h, number } from "./words.js";
import { wordsOfDoor } from "./doors.js";
import { NOT_REACHED, centreOf, shapeOf } from "./documents.js";
import { ownerOf } from "./owners.js";
import { nameOfCell, nameOfRobot } from "./names.js";

// Where the centre of a cell lies in the world.
function metresOf(doc, cell) {
  const [px, py] = centreOf(doc, cell), { cell_size: size, origin, yaw } = doc.header.frame;
  const east = px * size, north = -py * size, cos = Math.cos(yaw), sin = Math.sin(yaw);
  const x = origin[0] + east * cos - north * sin, y = origin[1] + east * sin + north * cos;
  return `x ${x.toFixed(2)} m, y ${y.toFixed(2)} m`;
}

export class Readout {
  constructor(app) {
    this.app = app;
    this.element = h("div", { class: "readout", id: "trihex-readout", "aria-live": "polite" });
  }

  // Tell of a cell of a pane, -1 for none.
  show(i, cell) {
    const { doc } = this.app.panes[i];
    if (!doc || cell < 0) {
      this.element.textContent = "";
      this.element.removeAttribute("data-cell");
      return;
    }
    const layer = this.app.panes[i].layer ? this.app.layers.wordsOf(this.app.runs[i] ?? this.app.live, cell) : "";
    const more = [this.#ownerIn(this.app.panes[i], cell), layer].filter(Boolean);
    const words = [...this.#there(doc, cell), ...more, ...this.#ahead(doc, i, cell)];
    this.element.textContent = words.join(" · ");
    this.element.dataset.cell = cell;
  }

  // Who owns a cell, where that is told.
  #ownerIn(pane, cell) {
    const robot = pane.owns && pane.robots ? ownerOf(pane, cell, this.app.fraction) : -1;
    return robot < 0 ? "" : `owned by ${nameOfRobot(robot, pane.robots.count)}`;
  }

  #there(doc, cell) {
    const words = [`cell ${nameOfCell(doc, cell)}`];
    if (doc.barriers[cell]) words.push("barrier");
    else words.push(doc.destinations.includes(cell) ? "destination" : "free");
    words.push(wordsOfDoor(doc, cell));
    const robot = this.app.clock.at === 0 ? doc.robots.indexOf(cell) : -1;
    if (robot >= 0) words.push(nameOfRobot(robot, doc.robots.length));
    words.push(this.#startAt(doc, cell));
    if (doc.header.frame) words.push(metresOf(doc, cell));
    return words.filter(Boolean);
  }

  // When the robot on a cell may begin to move, as long as it may not; until then it stands where it starts.
  #startAt({ header, robots, destinations }, cell) {
    const { live, clock } = this.app, step = live ? live.last.step : clock.step;
    const [, time] = header.start_times?.find(([start]) => start === cell) ?? [];
    if (!(time > step) || !robots.includes(cell) || destinations.includes(cell)) return "";
    return `may begin to move in ${header.clock === "costs" ? "tick" : "step"} ${time + 1}`;
  }

  #ahead(doc, i, cell) {
    const { live, runs, fields, settings } = this.app, words = [];
    const isRun = runs[i]?.playback.worlds, distance = i ? runs[1]?.playback.distance : fields?.distance;
    if (live?.known && !live.known[cell]) words.push("not seen");
    if (distance && !isRun && !doc.barriers[cell]) {
      words.push(distance[cell] === NOT_REACHED ? "not reached" : `${number(distance[cell])} to go`);
    }
    const names = settings.names?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`];
    if (i || !fields?.directions || !names) return words;
    const orientation = shapeOf(doc).orientation(cell % doc.width, Math.floor(cell / doc.width));
    const best = names[orientation].filter((_, k) => (fields.directions[cell] >> k) & 1);
    if (best.length) words.push(`best ${best.join(", ")}`);
    return words;
  }
}
