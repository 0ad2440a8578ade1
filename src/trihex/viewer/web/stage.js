// Stage: the two panes, what they show, and when they are drawn.

import { h, number, plural, title, gapWords } from "./words.js";
import { button } from "./controls.js";
import { Legend } from "./legend.js";
import { shapeOf } from "./documents.js";
import { Pane } from "./pane.js";
import { Still } from "./playback.js";

const LONGEST = 0.25; // seconds between two frames that count: a page that was hidden does not jump
const REST = 150; // milliseconds until a picture that was moved is drawn well

const makeCanvas = (i) => h("canvas", { tabindex: "0", role: "application", "aria-describedby": "trihex-readout",
  "aria-label": "Picture", "data-pane": i });

export class Stage {
  constructor(app) {
    this.app = app;
    this.panes = [0, 1].map((i) => new Pane(makeCanvas(i), app.settings.colours));
    this.captions = this.panes.map(() => h("div", { class: "caption" }));
    this.frames = this.panes.map((pane, i) => h("div", { class: "pane" }, this.captions[i],
      h("div", { class: "hold" }, pane.canvas)));
    this.frames[1].hidden = true;
    this.element = h("div", { class: "panes" }, this.frames);
    this.legend = new Legend(app);
    this.zoomButtons = h("div", { class: "zoom" }, button("+", () => this.zoom(1.4), { "aria-label": "Zoom in" }),
      button("−", () => this.zoom(1 / 1.4), { "aria-label": "Zoom out" }),
      button("Show all", () => this.fit(), { title: "0: the whole area" }));
    this.still = null; // the robots of a document that has no plan, { doc, distance, robots }
    this.isWaiting = false; // for the next frame of the screen
    this.lastTick = undefined; // when the last one was, if this one follows it
    this.resting = 0; // the timer of a picture that was moved
  }

  // ---- when

  invalidate() {
    if (this.isWaiting || this.app.isClosed) return;
    this.isWaiting = true;
    requestAnimationFrame((time) => this.#tick(time));
  }

  #tick(time) {
    const { app } = this;
    this.isWaiting = false;
    if (!app.doc || !app.shell.isConnected) return;
    const passed = Math.min(LONGEST, (time - (this.lastTick ?? time)) / 1000);
    this.lastTick = time;
    const isRunning = app.live?.tick(passed);
    app.clock.tick(passed);
    app.growing.tick(passed);
    if (!app.live) this.#draw();
    if (this.panes.some((pane) => pane.isRough)) {
      clearTimeout(this.resting);
      this.resting = setTimeout(() => this.#settle(), REST);
    }
    if (app.clock.isPlaying || app.growth?.isPlaying || isRunning) this.invalidate();
    else this.lastTick = undefined;
  }

  #draw() {
    const { runs, clock } = this.app, { step } = clock;
    this.panes.forEach((pane, i) => {
      if (i && !runs[1]) return;
      runs[i]?.playback.seek(step);
      this.#showStep(pane, runs[i]?.playback.worlds?.at(step));
      pane.draw(step >= (runs[i]?.playback.steps ?? 0) ? 0 : clock.at - step);
    });
  }

  // The world of a run as it was in the step that is shown.
  #showStep(pane, world) {
    if (!world || pane.world === world) return;
    pane.take({ world, doc: world.doc, known: world.known });
    pane.changed("base");
  }

  #settle() {
    for (const pane of this.panes) pane.settle();
    this.invalidate();
  }

  // ---- where

  resize() {
    this.#arrange();
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.panes.forEach((pane, i) => {
      if (this.frames[i].hidden) return;
      const box = pane.canvas.getBoundingClientRect(), pixels = (side) => Math.max(16, Math.round(side * ratio));
      pane.resize(pixels(box.width), pixels(box.height));
    });
    this.invalidate();
  }

  // Two plans stand side by side, or one above the other where that is larger.
  #arrange() {
    const { doc, runs } = this.app, { width, height } = this.element.getBoundingClientRect();
    if (!doc || !runs[1]) return;
    const [across, down] = shapeOf(doc).extent(doc.width, doc.height);
    const beside = Math.min(width / 2 / across, height / down), above = Math.min(width / across, height / 2 / down);
    this.element.classList.toggle("stacked", above > beside);
  }

  zoom(factor) {
    for (const pane of this.panes) if (pane.doc) pane.zoom(factor, pane.canvas.width / 2, pane.canvas.height / 2);
    this.invalidate();
  }

  fit() {
    for (const pane of this.panes) pane.fit();
    this.invalidate();
  }

  // ---- what

  show() {
    const { doc, runs } = this.app, isSplit = !!runs[1];
    if (!doc) return;
    if (this.frames[1].hidden === isSplit) {
      this.frames[1].hidden = !isSplit;
      this.element.classList.toggle("split", isSplit);
      this.resize();
    }
    if (isSplit) this.#arrange();
    this.#showFirst();
    if (isSplit) this.#showBeside();
    this.legend.show();
    this.invalidate();
  }

  // The document with its field, and robots that rest, run live, or follow their plan.
  #showFirst() {
    const { runs: [run], doc, fields, growth, live, field } = this.app, [pane] = this.panes;
    const distance = fields?.distance, values = growth ? growth.values : distance ?? null;
    const layer = growth ? null : this.#layerOf(run ?? live);
    pane.take({
      layer, // it takes the place of the field; the field of a run changes with its world
      values: field.isShown && !layer && !run?.playback.worlds ? values : null,
      directions: growth ? null : fields?.directions ?? null,
      known: live?.known ?? null,
      world: null,
    });
    this.#showPane(0, run, !!growth, field.farthest(distance ?? pane.values));
    if (run) pane.show(run.doc, run.playback);
    else pane.show(doc, live ? live.runners : this.#still(doc, distance));
  }

  // The world of a live run has changed, its cells or only its robots.
  showWorld({ doc, known, distance }, isOther) {
    const [pane] = this.panes, { field } = this.app;
    pane.take({ doc, known });
    if (!isOther) return;
    pane.changed("base");
    const most = field.isShown ? field.farthest(distance) : pane.options.most;
    if (most === pane.options.most) return;
    pane.take({ options: { ...pane.options, most } });
    this.legend.show();
  }

  // The map that is wanted of a plan, with colours for all plans alike.
  #layerOf(run) {
    const { layers } = this.app, layer = layers.of(run);
    return layer && { ...layer, most: layers.most };
  }

  #showBeside() {
    const { runs: [, run], field } = this.app, [, pane] = this.panes, { distance } = run.playback;
    const layer = this.#layerOf(run), isStill = field.isShown && !layer && !run.playback.worlds;
    pane.take({ layer, values: isStill ? distance : null, known: null, world: null });
    this.#showPane(1, run, false, field.farthest(distance));
    pane.show(run.doc, run.playback);
  }

  #showPane(i, run, growing, most) {
    const { doc: own, runs, settings, theme, field, followed: { robot }, results, canEdit, owners } = this.app;
    const pane = this.panes[i];
    const doc = run ? run.doc : own, { tessellation, neighbourhood } = doc.header;
    const isThere = run && robot >= 0 && robot < run.playback.count;
    pane.take({
      options: { dark: theme.isDark, growing, most, arrows: field.arrows?.checked, numbers: field.numbers.checked,
        steps: settings.steps?.[`${tessellation} ${neighbourhood}`] },
      follow: robot,
      track: isThere ? run.playback.robot(robot).rows.map(({ cell }) => cell) : null,
      paths: run && results.hasPaths ? run.playback.paths() : null,
      crosses: [],
      owns: owners.areShown(doc),
    });
    const things = `${plural(doc.robots.length, "robot")}, ${plural(doc.destinations.length, "destination")}`;
    const area = `${title(tessellation)} area of ${doc.width} by ${doc.height} cells, ${things}`;
    const use = canEdit && !i ? ", Enter uses the tool" : "";
    pane.canvas.setAttribute("aria-label", `${area}. Arrow keys move the cursor${use}.`);
    this.#caption(i, run && runs[1] ? run.summary : null);
  }

  // What stands above a plan that is compared.
  #caption(i, summary) {
    const { runs } = this.app, isSame = runs[0]?.summary.tessellation === runs[1]?.summary.tessellation;
    const words = summary ? [summary.planner || "plan", isSame ? "" : summary.tessellation,
      `total time ${number(summary.total_time)}`, gapWords(summary)].filter(Boolean).join(" · ") : "";
    this.captions[i].textContent = words.replace(/(\d) (?=\d)/g, "$1\u00a0"); // a number is not parted
    this.captions[i].setAttribute("title", words);
  }

  #still(doc, distance) {
    if (this.still?.doc !== doc || this.still.distance !== distance) {
      this.still = { doc, distance, robots: new Still(doc, distance) };
    }
    return this.still.robots;
  }
}
