// Growing: the growth of the field as it is watched, and the controls for it.

import { h, number } from "./words.js";
import { button, note, row } from "./controls.js";
import { arraysOf } from "./documents.js";
import { Growth } from "./growth.js";
import { sameField } from "./runs.js";

const SECONDS = 4; // that the whole field takes, about
const SLOWEST = 8; // generations a second

export class Growing {
  constructor(app) {
    this.app = app;
    this.growth = null;
    this.text = h("output", { class: "note" });
    this.slider = h("input", { type: "range", min: 0, max: 0, value: 0, "aria-label": "Generation",
      oninput: () => this.seek(Number(this.slider.value)) });
    this.button = button("Grow the field", () => this.toggle());
    this.controls = [
      row(this.button, button("‹", () => this.back(), { "aria-label": "Previous generation" }),
        button("›", () => this.forth(), { "aria-label": "Next generation" }), this.slider),
      this.text, note("Arrows and numbers appear when cells are large: zoom in."),
    ];
  }

  async toggle() {
    const { app } = this;
    await app.ready("The field grows");
    app.leaveLive();
    const { growth } = this;
    if (!growth || !sameField(growth.doc, app.doc)) return this.#begin();
    if (growth.isAtEnd) this.seek(0);
    growth.toggle();
    app.refresh();
  }

  async #begin() {
    const { app } = this, { field } = app;
    if (!app.doc.destinations.length) return app.say(app.missing(), true);
    field.want();
    if (!field.known) await field.fetch();
    if (!field.known) return;
    const { doc } = app;
    this.growth = new Growth(doc);
    app.refresh();
    const request = { op: "generations", ...app.request };
    const answer = await app.ask(request, arraysOf(doc), "Growing…", ({ arrays }) => this.#add(arrays));
    if (!answer) return this.end();
    if (this.growth?.doc !== doc) return;
    this.#add(answer.arrays);
    this.growth.complete();
    app.refresh();
  }

  #add(arrays) {
    if (!this.growth) return;
    this.growth.add(arrays);
    this.slider.max = this.growth.last;
    this.app.stage.invalidate();
  }

  back() { this.seek(this.growth ? this.growth.generation - 1 : 0); }

  async forth() {
    if (!this.growth) {
      await this.toggle();
      if (!this.growth) return;
    }
    this.growth.pause();
    this.seek(this.growth.generation + 1);
    this.app.refresh();
  }

  seek(generation) {
    if (!this.growth) return;
    this.growth.seek(generation);
    this.#tell();
  }

  #tell() {
    const { generation, isComplete, isAtEnd, last } = this.growth;
    this.slider.value = generation;
    this.text.textContent = `Generation ${number(generation)}${isComplete ? ` of ${number(last)}` : ""}` +
      (isAtEnd ? ": nothing changes any more, this is the N-scheme." : "");
    this.app.stage.show();
  }

  // Let some seconds pass.
  tick(passed) {
    const { growth, app } = this;
    if (!growth?.isPlaying) return;
    const { generation, doc } = growth, edge = doc.header.costs === "euclidean" ? 1000 : 10;
    growth.advance(passed * Math.max(SLOWEST, app.panes[0].options.most / edge / SECONDS));
    if (growth.generation !== generation || growth.isAtEnd) this.#tell();
    if (!growth.isPlaying) app.refresh();
  }

  // Drop a growth that is not that of the document.
  fit(doc) {
    if (this.growth && !sameField(this.growth.doc, doc)) this.end();
  }

  end() {
    this.growth = null;
    this.text.textContent = "";
    this.slider.value = this.slider.max = 0;
  }

  show() {
    const { growth } = this;
    if (growth?.isPlaying) this.button.textContent = "Pause";
    else this.button.textContent = growth && !growth.isComplete ? "Growing…" : "Grow the field";
  }
}
