// Layers: maps of the plans over their cells, one at a time: where time is lost, where robots crowd.

import { durationOf, h, number } from "./words.js";
import { labelled } from "./controls.js";
import { complaintOf } from "./hosts.js";

const NONE_OPTIMAL = "Prices are those of the best plan: plan, or compare, with Optimal.";

const greatestAmong = (values) => values.reduce((most, value) => (value > most ? value : most), 0);

// A map as an answer tells it.
export const layerOf = (told, values) => ({ ...told, values, most: greatestAmong(values) });

// A value as people read it.
export const amount = (value) => (value >= 100 ? number(value) : String(Number(value.toPrecision(2))));

export class Layers {
  constructor(app) {
    this.app = app;
    this.kinds = app.settings.layers ?? {};
    this.isFetching = false;
    const option = ([name, { label, hint }]) => h("option", { value: name, title: hint }, label);
    const plain = ["", { label: "None", hint: "" }];
    this.menu = h("select", { "aria-label": "Map", onchange: () => this.changed() },
      [plain, ...Object.entries(this.kinds)].map(option));
    this.element = labelled("Map over the cells", this.menu);
  }

  get hint() { return this.kinds[this.menu.value]?.hint; }

  // The map of a plan that is wanted, null if there is none.
  of(run) { return run?.layers[this.menu.value] ?? null; }

  // The plans that are shown, or the live run once it is over.
  get #shown() {
    const { live, runs } = this.app;
    return (live ? [live.last.is_over ? live : null] : runs).filter(Boolean);
  }

  // The greatest value of all plans that are shown, so that they are coloured alike.
  get most() { return Math.max(0, ...this.#shown.map((run) => this.of(run)?.most ?? 0)); }

  // What a map says of a cell, in words; "" if nothing.
  wordsOf(run, cell) {
    const layer = this.of(run), value = layer?.values[cell];
    if (!(value > 0)) return "";
    if (!layer.sentence) return `${amount(value)} ${layer.unit}`;
    return layer.sentence.replace("{}", layer.are_seconds ? durationOf(value) : `${amount(value)} time units`);
  }

  // Only the best plan has prices, and they take long.
  get #isSlow() { return this.kinds[this.menu.value]?.is_of_optimum; }

  // The plans that have a map of the wanted kind which is not here; a run that is over has all its maps with it.
  get #lacking() {
    const { menu: { value: layer } } = this, isKept = (run) => run.plan || run.name;
    const isLacking = (run) => isKept(run) && !run.layers[layer] && (!this.#isSlow || run.summary?.optimal);
    return layer ? this.#shown.filter(isLacking) : [];
  }

  // Another map is wanted, or there are other plans.
  async changed() {
    const { app } = this;
    app.stage.show();
    if (this.#isSlow && !this.#lacking.length && !this.most) app.say(NONE_OPTIMAL, true);
    if (!app.host || this.isFetching) return;
    this.isFetching = true;
    while (this.#lacking.length) await this.#fetch(this.#lacking[0], this.menu.value); // meanwhile that may be another
    this.isFetching = false;
  }

  // Ask for a map; what takes long can be cancelled, and is not asked for again by itself.
  async #fetch(run, layer) {
    const { app } = this, { layers } = run; // others, if the run goes on meanwhile
    const request = { op: "layer", layer, ...(run.plan ? { plan: run.plan } : { live: run.name }) };
    try {
      const answer = this.#isSlow ? await app.ask(request, {}, "Pricing…") : await app.host.ask(request, {});
      if (!answer) return this.#choose("");
      layers[layer] = layerOf(answer.header, answer.arrays.values);
      if (this.#shown.includes(run)) app.stage.show();
    } catch (error) {
      app.say(complaintOf(error), true);
      this.#choose("");
    }
  }

  // What cannot be had is not asked for again by itself.
  #choose(layer) {
    this.menu.value = layer;
    this.app.stage.show();
  }

  show() {
    this.element.hidden = !this.#shown.length || !Object.keys(this.kinds).length;
    if (this.#lacking.length) this.changed();
  }
}
