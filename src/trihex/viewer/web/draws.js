// Draws: areas and robots that the host draws by a seed.

import { plural } from "./words.js";
import { button, chosenIn, endRow, grid, note, numberField, row, section, select } from "./controls.js";
import { arraysOf } from "./documents.js";

// What those see who open the viewer without a file, as in site.py: rooms in which queues form, so that plans differ.
const FIRST = { generator: "rooms", tessellation: "hexagonal", height: 32, width: 48, seed: 7 };
const FIRST_ROBOTS = 120, FIRST_SEED = 1;
const EMPTY = "empty"; // a generator that draws nothing

// The free cell nearest to the middle.
function middleOf({ barriers, width, height }) {
  const away = (cell) => Math.abs((cell % width) - width / 2) + Math.abs(Math.floor(cell / width) - height / 2);
  const free = [...barriers.keys()].filter((cell) => !barriers[cell]);
  return free.reduce((best, cell) => (away(cell) < away(best) ? cell : best));
}

export class Draws {
  constructor(app) {
    this.app = app;
    this.count = numberField("Robots", FIRST_ROBOTS, { min: 0, max: 2097152 });
    this.seed = numberField("Seed", FIRST_SEED, { min: 0 });
    this.text = note();
    this.element = section("Robots", row(this.count, this.seed, button("Scatter", () => this.scatter())), this.text);
  }

  // Ask which area to make.
  async open() {
    const { app } = this, { generators, tessellations } = app.settings;
    await app.ready("Areas are made");
    const kind = select("Kind", generators, () => { seed.hidden = chosenIn(kind) === EMPTY; });
    const cells = select("Cells", tessellations, () => {});
    const side = { min: 1, max: 4096 }, width = numberField("Width", 48, side);
    const height = numberField("Height", 32, side), seed = numberField("Seed", 1, { min: 0 });
    cells.lastChild.value = app.doc.header.tessellation;
    seed.hidden = chosenIn(kind) === EMPTY; // nothing is drawn by chance
    const make = () => {
      app.dialog.close();
      this.generate({ generator: chosenIn(kind), tessellation: chosenIn(cells), width: Number(chosenIn(width)),
        height: Number(chosenIn(height)), seed: Number(chosenIn(seed)) });
    };
    const end = endRow(button("Make", make, { class: "primary" }));
    app.dialog.open("New area", grid(kind, cells, width, height, seed), end);
  }

  async generate(wish) {
    const answer = await this.app.make(this.#made(wish));
    if (!answer) return;
    this.count.lastChild.value = Math.max(1, Math.min(200, Math.round((wish.height * wish.width) / 25)));
    this.app.take(answer);
  }

  async begin() {
    const { app } = this, answer = await this.#made(FIRST);
    if (!answer) return;
    app.take(answer, { isEdit: false });
    app.set({ ...app.doc, destinations: Int32Array.of(middleOf(app.doc)) }, [null, null]);
    const robots = await this.#robots(FIRST_ROBOTS, FIRST_SEED);
    const drawn = { seed: FIRST_SEED, start_times: null, slowness: null };
    if (robots) app.set({ ...app.doc, robots, header: { ...app.doc.header, ...drawn } }, [null, null]);
  }

  async scatter() {
    const { app } = this;
    await app.ready("Robots are drawn");
    app.leaveLive();
    const { doc } = app, count = Number(chosenIn(this.count)), seed = Number(chosenIn(this.seed));
    const robots = await app.make(this.#robots(count, seed));
    const drawn = { seed, start_times: null, slowness: null };
    if (robots && app.doc === doc) app.change({ robots, header: { ...doc.header, ...drawn } });
  }

  async #made(wish) {
    const answer = await this.app.ask({ op: "generate", ...wish }, {}, "Making…");
    if (answer) this.app.clock.rewind();
    return answer;
  }

  // Robots drawn at random, null if there is no answer.
  async #robots(count, seed) {
    const { app } = this;
    const answer = await app.ask({ op: "scatter", count, seed, ...app.request }, arraysOf(app.doc));
    return answer && answer.arrays.robots.slice();
  }

  show() {
    const { robots, destinations } = this.app.doc;
    const robotsThere = plural(robots.length, "robot"), ends = plural(destinations.length, "destination");
    this.text.textContent = `${robotsThere}, ${ends} in the area.`;
  }
}
