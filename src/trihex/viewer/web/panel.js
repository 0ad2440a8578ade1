// Panel: what the page is made of.

import { h, title, wholeOf } from "./words.js";
import { TOOLS } from "./hand.js";

export const SPEEDS = [0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];

export const withPanel = (Base) => class extends Base {
  build() {
    const { settings } = this, can = !!this.host;
    const button = (text, onclick, more = {}) => h("button", { type: "button", onclick, ...more }, text);
    const icon = (path) => {
      const svg = h("svg", { viewBox: "0 0 18 18", "aria-hidden": "true", class: "icon" });
      svg.append(h("path", { d: path }));
      return svg;
    };
    const select = (label, names, onchange, more = {}) =>
      h("label", { class: "field" }, h("span", {}, label), h("select", { onchange, "aria-label": label, ...more }, names.map((name) => h("option", { value: name }, title(name)))));
    const numberField = (label, value, more = {}) =>
      h("label", { class: "field" }, h("span", {}, label), h("input", { type: "number", value, "aria-label": label, ...more }));
    this.parts = { button, select, numberField };

    this.undoButton = button("Undo", () => this.undo(), { title: "Ctrl+Z" });
    this.redoButton = button("Redo", () => this.redo(), { title: "Ctrl+Shift+Z" });
    this.themeButton = button("Theme", () => this.nextTheme());
    const files = [
      button("New…", () => this.newDialog(), { title: "Make an area" }), button("Open…", () => this.openDialog(), { title: "Ctrl+O" }),
      button("Save…", () => this.saveDialog(), { title: "Ctrl+S" }), this.undoButton, this.redoButton,
    ];
    const bar = h("header", { class: "bar" }, h("strong", { class: "brand" }, "trihex"), can ? files : null,
      (this.nameOfArea = h("span", { class: "name" })), this.themeButton, button("Help", () => this.helpDialog(), { title: "?" }));

    this.toolButtons = Object.fromEntries(TOOLS.map(([name, label, key, hint, path]) => {
      const element = button(icon(path), () => this.choose(name), { title: `${label} (${key}): ${hint}`, "aria-label": label, "aria-pressed": "false", "data-tool": name });
      element.append(h("span", {}, label));
      return [name, element];
    }));
    this.brush = h("input", { type: "range", min: 1, max: 9, step: 2, value: 1, "aria-label": "Width of the brush in cells", title: "Width of the brush" });
    const tools = h("div", { class: "tools", role: "toolbar", "aria-label": "Tools" }, Object.values(this.toolButtons), h("label", { class: "brush" }, h("span", {}, "Brush"), this.brush));

    this.canvases = [0, 1].map((i) => h("canvas", { tabindex: "0", role: "application", "aria-describedby": "trihex-readout", "aria-label": "Picture", "data-pane": i }));
    this.captions = [0, 1].map(() => h("div", { class: "caption" }));
    this.paneElements = [0, 1].map((i) => h("div", { class: "pane" }, this.canvases[i], this.captions[i]));
    this.paneElements[1].hidden = true;
    this.legend = h("div", { class: "legend", "aria-label": "Legend" });
    const zoom = h("div", { class: "zoom" }, button("+", () => this.zoom(1.4), { "aria-label": "Zoom in" }),
      button("−", () => this.zoom(1 / 1.4), { "aria-label": "Zoom out" }), button("Fit", () => this.fit(), { "aria-label": "Show all" }));
    this.stage = h("div", { class: "panes" }, this.paneElements);
    this.status = h("div", { class: "status", role: "status" });
    this.readout = h("div", { class: "readout", id: "trihex-readout", "aria-live": "polite" });
    const stage = h("section", { class: "stage", "aria-label": "Picture" }, this.status, h("div", { class: "view" }, this.stage), h("div", { class: "under" }, this.readout, this.legend, zoom), this.buildTransport());
    this.panel = h("aside", { class: "panel", "aria-label": "Controls" }, this.buildPanel(can));
    const main = h("main", { class: can ? "main" : "main alone" }, can ? tools : null, stage, this.panel);
    this.dialog = h("dialog", { class: "dialog" });
    this.root.replaceChildren(h("div", { class: "trihex" }, bar, main, this.dialog));
    this.shell = this.root.firstChild;
    this.listen();
    this.setSpeed(6);
  }

  buildTransport() {
    const { button } = this.parts;
    this.playButton = button("Play", () => this.togglePlay(), { class: "primary play", title: "Space" });
    this.scrubber = h("input", { type: "range", min: 0, max: 0, value: 0, step: "any", class: "scrub", "aria-label": "Step", oninput: () => this.seek(Number(this.scrubber.value)) });
    this.clockText = h("output", { class: "clock" });
    this.speed = h("input", { type: "range", min: 0, max: SPEEDS.length - 1, value: 5, "aria-label": "Steps per second", oninput: () => this.setSpeed(SPEEDS[this.speed.value]) });
    this.speedText = h("span", { class: "unit" });
    return h("div", { class: "transport", role: "group", "aria-label": "Playback" },
      button("|‹", () => this.seek(0), { "aria-label": "To the start", title: "Home" }), button("‹", () => this.seek(Math.ceil(this.clock) - 1), { "aria-label": "Step back", title: "," }),
      this.playButton, button("›", () => this.stepForward(), { "aria-label": "Step forward", title: "." }),
      button("›|", () => this.seek(this.steps), { "aria-label": "To the end", title: "End" }),
      this.scrubber, this.clockText, h("label", { class: "speed" }, h("span", {}, "Speed"), this.speed, this.speedText));
  }

  buildPanel(can) {
    const { settings } = this, { button, select, numberField } = this.parts;
    const section = (name, open, ...children) => h("details", { open, "data-section": name }, h("summary", {}, name), h("div", { class: "content" }, children));
    const parts = [];
    if (can) {
      this.tessellation = h("div", { class: "choice", role: "radiogroup", "aria-label": "Tessellation" }, settings.tessellations.map((name) =>
        h("label", {}, h("input", { type: "radio", name: "trihex-tessellation", value: name, onchange: () => this.retile({ tessellation: name }) }), title(name))));
      this.rules = {
        neighbourhood: select("Neighbours", settings.neighbourhoods, (e) => this.retile({ neighbourhood: e.target.value })),
        costs: select("Costs", settings.costs, (e) => this.retile({ costs: e.target.value })),
        corners: select("Corners", settings.corners, (e) => this.rule("corners", e.target.value)),
        crossing: select("Crossing", settings.crossings, (e) => this.rule("crossing", e.target.value)),
        waiting_cost: numberField("Waiting cost w_t", "", { min: 0, placeholder: "one edge", onchange: (e) => this.rule("waiting_cost", wholeOf(e.target)) }),
        destination_capacity: numberField("Arrivals per step and destination", "", { min: 1, placeholder: "any", onchange: (e) => this.rule("destination_capacity", wholeOf(e.target)) }),
      };
      parts.push(section("Cells and rules", true, this.tessellation, h("details", { class: "inner" }, h("summary", {}, "Rules"), h("div", { class: "grid" }, Object.values(this.rules)))));
      this.count = numberField("Robots", 60, { min: 0, max: 2097152 });
      this.seed = numberField("Seed", 1, { min: 0 });
      parts.push(section("Robots", true, h("div", { class: "row" }, this.count, this.seed, button("Scatter", () => this.scatter())),
        (this.countText = h("p", { class: "note" }))));
    }
    const toggle = (name, text, value) => h("label", { class: "check" }, (this[name] = h("input", { type: "checkbox", checked: value, onchange: () => this.fieldChanged() })), text);
    this.generationText = h("output", { class: "note" });
    this.generation = h("input", { type: "range", min: 0, max: 0, value: 0, "aria-label": "Generation", oninput: () => this.setGeneration(Number(this.generation.value)) });
    this.growButton = button("Grow the field", () => this.grow());
    parts.push(section("Distance field", true, h("div", { class: "row" }, toggle("showField", "Colours", false), can ? toggle("showArrows", "Arrows", false) : null, toggle("showNumbers", "Numbers", false)),
      can ? [h("div", { class: "row" }, this.growButton, button("‹", () => this.setGeneration(this.growth ? this.growth.generation - 1 : 0), { "aria-label": "Previous generation" }),
        button("›", () => this.nextGeneration(), { "aria-label": "Next generation" }), this.generation), this.generationText,
      h("p", { class: "note" }, "Arrows and numbers appear when cells are large: zoom in.")] : null));
    if (can) {
      const planners = Object.keys(settings.planners);
      this.planner = select("Planner", planners, () => this.showOptions());
      this.planner.lastChild.value = planners.includes("fcost") ? "fcost" : planners[0];
      this.planButton = button("Plan", () => this.plan(0), { class: "primary", title: "P" });
      this.plannerOptions = h("details", { class: "inner" }, h("summary", {}, "Options of the planner"), h("div", { class: "grid" }));
      this.otherPlanner = select("Beside it", planners, () => {}, { "aria-label": "Planner beside it" });
      this.otherPlanner.lastChild.value = planners.includes("optimal") ? "optimal" : "greedy";
      this.otherCells = select("on", ["the same cells", ...settings.tessellations], () => {}, { "aria-label": "Cells beside it" });
      this.compareButton = button("Compare", () => this.plan(1));
      this.endCompareButton = button("One picture", () => this.endCompare(), { hidden: true });
      this.progress = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
      this.progressText = h("span", { class: "note" });
      this.progressRow = h("div", { class: "row working", hidden: true }, this.progress, this.progressText, button("Cancel", () => this.cancel(), { title: "Escape" }));
      this.showOptions();
      parts.push(section("Plan", true, h("div", { class: "row" }, this.planner, this.planButton), this.plannerOptions,
        h("div", { class: "grid" }, this.otherPlanner, this.otherCells), h("div", { class: "row" }, this.compareButton, this.endCompareButton), this.progressRow));
    }
    if (can) parts.push(this.buildLive(section));
    this.results = h("div", { class: "results" });
    this.sofar = h("p", { class: "note sofar" });
    this.chart = h("div", { class: "chart" });
    this.sets = h("div", { class: "sets", "aria-label": "Robots by set" });
    parts.push(section("Result", true, this.results, this.sets, this.sofar, this.chart, can ? null : h("p", { class: "note" },
      "This page plays a plan that was made; robots that run live, while you paint walls in their way, need trihex: start trihex view.")));
    this.robotNumber = h("input", { type: "number", min: 0, "aria-label": "Number of the robot to follow", placeholder: "number", onchange: (e) => this.followRobot(e.target.value === "" ? -1 : Number(e.target.value)) });
    this.robotText = h("div", { class: "robot" });
    this.centred = h("input", { type: "checkbox" });
    parts.push(section("One robot", true, h("div", { class: "row" }, h("label", { class: "field" }, h("span", {}, "Follow robot"), this.robotNumber), button("None", () => this.followRobot(-1)),
      h("label", { class: "check" }, this.centred, "keep it in view")), this.robotText));
    return parts;
  }

  showOptions() {
    const options = this.settings.planners[this.planner.lastChild.value], grid = this.plannerOptions.lastChild;
    this.plannerOptions.hidden = !Object.keys(options).length;
    grid.replaceChildren(...Object.entries(options).map(([name, value]) => h("label", { class: "field" }, h("span", {}, name.replace(/_/g, " ")),
      typeof value === "boolean" ? h("input", { type: "checkbox", checked: value, "data-option": name }) :
        h("input", { type: typeof value === "number" ? "number" : "text", step: "any", value: value ?? "", placeholder: "default", "data-option": name }))));
  }

  chosenOptions(planner) {
    if (planner !== this.planner.lastChild.value) return {};
    const options = {}, defaults = this.settings.planners[planner];
    for (const input of this.plannerOptions.querySelectorAll("[data-option]")) {
      const name = input.dataset.option, text = input.value.trim();
      const value = input.type === "checkbox" ? input.checked : text === "" ? defaults[name] : isNaN(Number(text)) ? text : Number(text);
      if (value !== defaults[name]) options[name] = value;
    }
    return options;
  }

  listen() {
    for (const canvas of this.canvases) {
      const pane = Number(canvas.dataset.pane);
      const on = (name, does) => canvas.addEventListener(name, (event) => does.call(this, event, pane), { passive: false });
      on("pointerdown", this.pointerDown);
      on("pointermove", this.pointerMove);
      on("pointerup", this.pointerUp);
      on("pointercancel", this.pointerUp);
      on("pointerleave", (event) => { if (!this.pointers.size) this.readCell(pane, -1); });
      on("wheel", this.wheel);
      on("contextmenu", (event) => event.preventDefault());
      on("keydown", this.canvasKey);
      on("blur", () => { this.setCursor(-1); });
    }
    this.shell.addEventListener("keydown", (event) => this.key(event));
    if (this.settings.host !== "notebook") document.addEventListener("keydown", (event) => { if (!this.shell.contains(event.target)) this.key(event); }, { signal: this.listeners.signal });
    this.shell.addEventListener("dragover", (event) => event.preventDefault());
    this.shell.addEventListener("drop", (event) => {
      event.preventDefault();
      if (this.host && event.dataTransfer.files[0]) this.openFile(event.dataTransfer.files[0]);
    });
  }
};
