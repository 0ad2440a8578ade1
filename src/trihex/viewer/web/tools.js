// Tools: what a hand does with the picture, and the brush.

import { h } from "./words.js";
import { button } from "./controls.js";

// Name, label, key, hint, picture.
const MOVE = "M9 3v12M3 9h12M9 3l-2 2M9 3l2 2M9 15l-2-2M9 15l2-2M3 9l2-2M3 9l2 2M15 9l-2-2M15 9l-2 2";
const WALL = "M2 4h14v4H2zM2 8h14v4H2zM7 4v4M12 8v4M6 8v4M10 12v3H2v-3M10 12h6v3h-6";
// They strike a robot of a live run.
const STRIKES = [
  ["break", "Break", "B", "Click a robot: it breaks down, and its cell becomes a barrier.",
    "M9 2l-2 5h4l-4 9 1-6H5l2-8z"],
  ["late", "Delay", "T", "Click a robot: it stands still for ten steps.",
    "M3 9a6 6 0 1 0 12 0a6 6 0 1 0-12 0M9 6v3l2 2"],
];
const TOOLS = [
  ["move", "Move", "V", "Drag a robot or a destination to another cell; drag the ground to move the picture; " +
    "click a robot to follow it.", MOVE],
  ["wall", "Wall", "W", "Paint barriers.", WALL],
  ["erase", "Erase", "E", "Remove barriers, robots and destinations.", "M7 15h9M3 11l7-7 5 5-6 6H6z"],
  ["destination", "Destination", "D", "Click a cell to set a destination there, or to take it away.",
    "M9 16s-5-5-5-9a5 5 0 0 1 10 0c0 4-5 9-5 9zM9 7.5v-.1"],
  ["robot", "Robot", "R", "Click free cells to place robots, or to take them away.",
    "M4 9a5 5 0 1 0 10 0a5 5 0 1 0-10 0M7 8v1M11 8v1"],
  ...STRIKES,
];

function icon(path) {
  const svg = h("svg", { viewBox: "0 0 18 18", "aria-hidden": "true", class: "icon" });
  svg.append(h("path", { d: path }));
  return svg;
}

export class Tools {
  constructor(app) {
    this.app = app;
    this.chosen = "";
    this.buttons = Object.fromEntries(TOOLS.map(([name, label, key, hint, path]) => {
      const element = button(icon(path), () => this.choose(name), { title: `${label} (${key}): ${hint}`,
        "aria-label": label, "aria-pressed": "false", "data-tool": name });
      element.append(h("span", {}, label));
      return [name, element];
    }));
    this.brush = h("input", { type: "range", min: 1, max: 9, step: 2, value: 1,
      "aria-label": "Width of the brush in cells", title: "Width of the brush" });
    this.element = h("div", { class: "tools", role: "toolbar", "aria-label": "Tools" }, Object.values(this.buttons),
      h("label", { class: "brush" }, h("span", {}, "Brush"), this.brush));
  }

  get isBroad() { return this.chosen === "wall" || this.chosen === "erase"; }
  get width() { return this.isBroad ? Number(this.brush.value) : 1; }

  // Whether the tool strikes robots that run live.
  get strikes() { return STRIKES.some(([name]) => name === this.chosen); }

  // Tools for robots that run live are there while some do.
  show() {
    for (const [name] of STRIKES) this.buttons[name].hidden = !this.app.live;
    if (this.strikes && !this.app.live) this.choose("wall");
  }

  choose(name) {
    this.chosen = name;
    for (const [other, element] of Object.entries(this.buttons)) element.setAttribute("aria-pressed", other === name);
    for (const { canvas } of this.app.panes) canvas.dataset.tool = name;
    this.brush.parentElement.hidden = !this.isBroad;
    if (this.app.doc) this.app.say(TOOLS.find(([other]) => other === name)[3]);
  }

  // The tool of a key, undefined if there is none.
  ofKey(key) {
    const name = TOOLS.find(([, , letter]) => letter.toLowerCase() === key)?.[0];
    return name && !this.buttons[name].hidden ? name : undefined;
  }
}
