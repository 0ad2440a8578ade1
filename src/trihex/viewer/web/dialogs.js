// Dialogs: new areas, files to open and to save, help.

import { h, EXPORT_WORDS, number } from "./words.js";
import { arraysOf } from "./documents.js";
import { download } from "./storage.js";

export const withDialogs = (Base) => class extends Base {
  open(heading, ...children) {
    const { button } = this.parts;
    this.dialog.replaceChildren(h("form", { method: "dialog" }, h("div", { class: "heading" }, h("h2", {}, heading), button("×", () => this.dialog.close(), { "aria-label": "Close" })), children));
    if (!this.dialog.open) this.dialog.showModal();
  }

  newDialog() {
    const { button, select, numberField } = this.parts, { header } = this.doc;
    const kind = select("Kind", this.settings.generators, () => {}), cells = select("Cells", this.settings.tessellations, () => {});
    const width = numberField("Width", 48, { min: 1, max: 4096 }), height = numberField("Height", 32, { min: 1, max: 4096 }), seed = numberField("Seed", 1, { min: 0 });
    cells.lastChild.value = header.tessellation;
    this.open("New area", h("div", { class: "grid" }, kind, cells, width, height, seed), h("div", { class: "row end" }, button("Make", () => {
      this.dialog.close();
      this.generate({ generator: kind.lastChild.value, tessellation: cells.lastChild.value, width: Number(width.lastChild.value), height: Number(height.lastChild.value), seed: Number(seed.lastChild.value) });
    }, { class: "primary" })));
  }

  async openDialog() {
    const { button, select, numberField } = this.parts;
    const answer = await this.ask({ op: "files" }, {});
    if (!answer) return;
    const { files, folder } = answer.header;
    const cells = select("Cells", ["as the file says", ...this.settings.tessellations], () => {});
    const size = numberField("Cell size in metres", "", { min: 0, step: "any", placeholder: "maps in metres" }), radius = numberField("Robot radius in metres", "", { min: 0, step: "any", placeholder: "0" });
    const pixel = numberField("Width of a pixel in metres", "", { min: 0, step: "any", placeholder: "images in metres" }), bright = numberField("Free from brightness", "", { min: 0, max: 1, step: "any", placeholder: "0.5" });
    const check = (text) => h("label", { class: "check" }, h("input", { type: "checkbox" }), text);
    const invert = check("dark is free"), unknown = check("unknown is free");
    const numberOf = (field) => (field.lastChild.value === "" ? null : Number(field.lastChild.value));
    const wish = () => ({
      tessellation: cells.lastChild.value === "as the file says" ? null : cells.lastChild.value,
      cell_size: numberOf(size), robot_radius: numberOf(radius), resolution: numberOf(pixel), threshold: numberOf(bright),
      invert: invert.firstChild.checked || null, unknown: unknown.firstChild.checked ? "free" : null,
    });
    const list = h("ul", { class: "files" });
    const fill = (text) => list.replaceChildren(...files.filter((name) => name.toLowerCase().includes(text.toLowerCase())).map((name) =>
      h("li", {}, h("button", { type: "button", onclick: () => { this.dialog.close(); this.openName(name, wish()); } }, name))));
    fill("");
    const filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter files", oninput: (event) => fill(event.target.value) });
    const upload = h("input", { type: "file", "aria-label": "A file of this computer", accept: this.settings.suffixes.join(","), onchange: (event) => {
      const [file] = event.target.files, options = wish();
      this.dialog.close();
      if (file) this.openFile(file, options);
    } });
    this.open("Open", h("div", { class: "grid" }, cells, size, radius),
      h("details", { class: "inner" }, h("summary", {}, "Images and maps of ROS"), h("div", { class: "grid" }, pixel, bright), h("div", { class: "row" }, invert, unknown)),
      folder ? [h("p", { class: "note" }, files.length ? `In ${folder}` : `There is nothing to open in ${folder}.`), files.length > 8 ? filter : null, list] : null,
      h("label", { class: "field" }, h("span", {}, "Or a file of this computer"), upload));
  }

  openName(name, wish = {}) {
    this.leaveLive();
    return this.opened({ op: "open", name, in_folder: true, ...wish, ...this.request }, arraysOf(this.doc), name);
  }
  async openFile(file, wish = {}) {
    if (file.size > 6e7) return this.say(`${file.name} is too large to be sent; start the viewer in its folder.`, true);
    this.leaveLive();
    const content = new Uint8Array(await file.arrayBuffer());
    return this.opened({ op: "open", name: file.name, in_folder: false, ...wish, ...this.request }, { ...arraysOf(this.doc), content }, file.name);
  }
  async opened(request, arrays, name) {
    const answer = await this.ask(request, arrays, `Opening ${name}…`);
    if (!answer) return;
    this.clock = 0;
    this.follow = -1;
    this.say("");
    this.take(answer);
    const missing = this.missing();
    this.say(`Opened ${name}: ${number(this.doc.width)} × ${number(this.doc.height)} cells. ${this.runs[0] ? "Press Play." : missing || "Press Plan."}`);
  }

  saveDialog() {
    const { button } = this.parts, { exports } = this.settings, { live } = this, run = this.runs[0], doc = live ? live.before.doc : this.doc;
    const can = ({ needs }) => needs === "draft" || (needs === "run" ? !!live?.last.step : !!run);
    const what = h("select", { "aria-label": "What to save", onchange: () => update() }, Object.keys(exports).map((name) => h("option", { value: name, disabled: !can(exports[name]) }, EXPORT_WORDS[name])));
    const suffix = h("select", { "aria-label": "Format", onchange: () => rename() }), name = h("input", { type: "text", "aria-label": "Name", value: "" });
    const base = (doc.header.name || "area").replace(/[^\w-]+/g, "-").replace(/^-|-$/g, "") || "area";
    const rename = () => { name.value = `${base}${{ plan: `-${run?.summary.planner || "plan"}`, run: "-run", draft: "" }[exports[what.value].needs]}${suffix.value}`; };
    const update = () => {
      suffix.replaceChildren(...exports[what.value].suffixes.map((one) => h("option", { value: one }, one)));
      rename();
    };
    what.value = live?.last.step ? "run" : run ? "plan" : "scenario";
    if (run && exports.plan.suffixes.includes(".npz")) exports.plan.suffixes.sort((a, b) => (b === ".npz") - (a === ".npz"));
    update();
    const message = h("p", { class: "note", role: "status" });
    const save = async (inFolder, overwrite = false) => {
      const plan = run && (exports[what.value].needs === "plan" || what.value === "picture") ? run.plan : null;
      const beside = what.value === "page" ? this.runs[1]?.plan ?? null : null;
      const request = { op: "save", what: what.value, name: name.value, in_folder: inFolder, overwrite, plan, beside, live: exports[what.value].needs === "run" ? live.name : null, planner: this.planner.lastChild.value, ...this.request };
      message.textContent = "Saving…";
      const answer = await this.ask(request, arraysOf(doc));
      if (!answer) return void (message.textContent = this.status.textContent);
      if (answer.header.exists) {
        message.replaceChildren(`${name.value} is there already. `, button("Replace it", () => save(true, true)));
        return;
      }
      if (answer.arrays.content) download(answer.header.name, answer.arrays.content);
      this.say(`Saved ${answer.header.saved ?? answer.header.name}.`);
      this.dialog.close();
    };
    this.open("Save", h("div", { class: "grid" }, h("label", { class: "field wide" }, h("span", {}, "What"), what), h("label", { class: "field" }, h("span", {}, "Format"), suffix), h("label", { class: "field wide" }, h("span", {}, "Name"), name)), message,
      h("div", { class: "row end" }, this.settings.folder ? button("Save in folder", () => save(true)) : null, button("Download", () => save(false), { class: "primary" })));
  }

  helpDialog() {
    const keys = [["Space", "play, pause"], [", .", "step back, forward"], ["[ ]", "slower, faster"], ["+ − 0", "zoom in, out, show all"], ["P", "plan"], ["L", "run live, leave"], ["V W E D R", "tools"],
      ["Arrows, Enter", "move the cursor, use the tool (Shift: ten cells)"], ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"], ["Ctrl+O, Ctrl+S", "open, save"], ["Escape", "cancel"]];
    this.open("How it works", h("ol", {}, ["Paint walls, or open an area.", "Set a destination and place robots; all robots go to the nearest destination.", "Grow the field: an automaton computes how far each cell is from the destinations.",
      "Plan: every robot gets a path; no two ever collide.", "Play, and compare with the optimum or with other cells."].map((line) => h("li", {}, line))),
    h("p", {}, "Time t of a robot is the cost of its moves d and of its waits w. A planner keeps the sum over all robots small; the lower bound tells how small it could be at all."),
    h("table", { class: "keys" }, keys.map(([key, words]) => h("tr", {}, h("th", { scope: "row" }, key), h("td", {}, words)))),
    h("p", { class: "note" }, "Wheel or pinch to zoom; drag with the right button, Shift or two fingers to move the picture."));
  }
};
