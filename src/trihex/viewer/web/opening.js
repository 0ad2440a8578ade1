// Opening: files of the folder, or of this computer, that become the document.

import { h, number } from "./words.js";
import { button, check, endRow, labelled, numberField, select } from "./controls.js";
import { chosenIn, grid, inner, note, numberIn, row } from "./controls.js";
import { arraysOf } from "./documents.js";

const AS_IN_FILE = "as the file says";
const MOST_BYTES = 6e7;
const FILTER_FROM = 8; // files

// How the area of a file is read, null where nothing is said.
class Reading {
  constructor(tessellations) {
    const metres = (label, placeholder, more = {}) =>
      numberField(label, "", { min: 0, step: "any", placeholder, ...more });
    const tick = (text) => check(h("input", { type: "checkbox" }), text);
    this.cells = select("Cells", [AS_IN_FILE, ...tessellations], () => {});
    this.size = metres("Cell size in metres", "maps in metres");
    this.radius = metres("Robot radius in metres", "0");
    this.pixel = metres("Width of a pixel in metres", "images in metres");
    this.bright = metres("Free from brightness", "0.5", { max: 1 });
    this.invert = tick("dark is free");
    this.unknown = tick("unknown is free");
    this.elements = [grid(this.cells, this.size, this.radius),
      inner("Images and maps of ROS", grid(this.pixel, this.bright), row(this.invert, this.unknown))];
  }

  get wish() {
    const cells = chosenIn(this.cells);
    return {
      tessellation: cells === AS_IN_FILE ? null : cells,
      cell_size: numberIn(this.size), robot_radius: numberIn(this.radius),
      resolution: numberIn(this.pixel), threshold: numberIn(this.bright),
      invert: this.invert.firstChild.checked || null, unknown: this.unknown.firstChild.checked ? "free" : null,
    };
  }
}

export class Opening {
  constructor(app) {
    this.app = app;
  }

  // Ask which file to open.
  async open() {
    const { app } = this;
    await app.ready("Files are opened");
    const answer = await app.ask({ op: "files" }, {});
    if (!answer) return;
    const reading = new Reading(app.settings.tessellations), { files, folder } = answer.header;
    const upload = h("input", { type: "file", "aria-label": "A file of this computer",
      accept: app.settings.suffixes.join(","), onchange: () => {
        const [file] = upload.files, { wish } = reading;
        app.dialog.close();
        if (file) this.openFile(file, wish);
      } });
    app.dialog.open("Open", reading.elements, folder ? this.#listOf(files, folder, reading) : null,
      labelled("Or a file of this computer", upload));
  }

  #listOf(files, folder, reading) {
    const list = h("ul", { class: "files" });
    const choose = (name) => {
      this.app.dialog.close();
      this.#openName(name, reading.wish);
    };
    const fill = (text) => list.replaceChildren(...files
      .filter((name) => name.toLowerCase().includes(text.toLowerCase()))
      .map((name) => h("li", {}, button(name, () => choose(name)))));
    fill("");
    const filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter files",
      oninput: () => fill(filter.value) });
    const words = files.length ? `In ${folder}` : `There is nothing to open in ${folder}.`;
    return [note(words), files.length > FILTER_FROM ? filter : null, list];
  }

  #openName(name, wish) {
    const { app } = this;
    app.leaveLive();
    const request = { op: "open", name, in_folder: true, ...wish, ...app.request };
    return app.make(this.#opened(request, arraysOf(app.doc)));
  }

  async openFile(file, wish = {}) {
    const { app } = this, { name } = file;
    if (file.size > MOST_BYTES) {
      return app.say(`${name} is too large to be sent; start the viewer in its folder.`, true);
    }
    app.leaveLive();
    const content = new Uint8Array(await file.arrayBuffer());
    const request = { op: "open", name, in_folder: false, ...wish, ...app.request };
    return app.make(this.#opened(request, { ...arraysOf(app.doc), content }));
  }

  // A place in metres is covered by cells: ask of which size.
  #askSize(request, arrays) {
    const { app } = this, size = numberField("Cell size in metres", 0.5, { min: 0, step: "any" });
    const radius = numberField("Robot radius in metres", 0, { min: 0, step: "any" });
    const open = () => {
      app.dialog.close();
      app.make(this.#opened({ ...request, cell_size: numberIn(size), robot_radius: numberIn(radius) }, arrays));
    };
    app.dialog.open("How large shall cells be?",
      note(`${request.name} is a place in metres: it will be covered by cells whose centres lie so far apart. `,
        "Robots of the radius, if one is given, touch neither walls nor each other."),
      grid(size, radius), endRow(button("Open", open, { class: "primary" })));
  }

  async #opened(request, arrays) {
    const { app } = this, { name } = request, answer = await app.ask(request, arrays, `Opening ${name}…`);
    if (!answer) return;
    if (answer.header.needs === "cell_size") return this.#askSize(request, arrays);
    app.clock.rewind();
    app.followed.drop();
    app.say("");
    if (answer.header.watched) return app.livePanel.watch(answer);
    app.take(answer);
    const next = app.runs[0] ? "Press Play." : app.missing() || "Press Plan.", { width, height } = app.doc;
    app.say(`Opened ${name}: ${number(width)} × ${number(height)} cells. ${next}`);
  }
}
