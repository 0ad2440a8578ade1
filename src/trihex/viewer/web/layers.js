// Layers: maps of the plans over their cells, one at a time: where time is lost, where robots crowd.

import { h, number } from "./words.js";
import { labelled } from "./controls.js";
import { complaintOf } from "./hosts.js";

const greatestAmong = (values) => values.reduce((most, value) => (value > most ? value : most), 0);

// A map as an answer tells it.
export const layerOf = ({ unit }, values) => ({ unit, values, most: greatestAmong(values) });

// A value as people read it.
export const amount = (value) => (value >= 100 ? number(value) : String(Number(value.toPrecision(2))));

export class Layers {
  constructor(app) {
    this.app = app;
    this.kinds = app.settings.layers ?? {};
    const option = ([name, { label, hint }]) => h("option", { value: name, title: hint }, label);
    const plain = ["", { label: "None", hint: "" }];
    this.menu = h("select", { "aria-label": "Map", onchange: () => this.changed() },
      [plain, ...Object.entries(this.kinds)].map(option));
    this.element = labelled("Map over the cells", this.menu);
  }

  get hint() { return this.kinds[this.menu.value]?.hint; }

  // The map of a plan that is wanted, null if there is none.
  of(run) { return run?.layers[this.menu.value] ?? null; }

  // The greatest value of all plans that are shown, so that they are coloured alike.
  get most() { return Math.max(0, ...this.app.runs.map((run) => this.of(run)?.most ?? 0)); }

  // What a map says of a cell, in words; "" if nothing.
  wordsOf(run, cell) {
    const layer = this.of(run), value = layer?.values[cell];
    return value > 0 ? `${amount(value)} ${layer.unit}` : "";
  }

  // Another map is wanted, or there are other plans.
  async changed() {
    const { app } = this, layer = this.menu.value, { host } = app;
    app.stage.show();
    if (!layer || !host) return;
    for (const run of app.runs) {
      if (!run?.plan || run.layers[layer]) continue; // a run that is over has its maps with it
      try {
        const { header, arrays } = await host.ask({ op: "layer", plan: run.plan, layer });
        run.layers[layer] = layerOf(header, arrays.values);
        if (app.runs.includes(run)) app.stage.show();
      } catch (error) {
        app.say(complaintOf(error), true);
      }
    }
  }

  show() {
    const { live, runs } = this.app;
    this.element.hidden = !!live || !runs[0] || !Object.keys(this.kinds).length;
    if (runs.some((run) => run && !this.of(run))) this.changed();
  }
}
