// Panel: where the parts of the page stand.

import { h } from "./words.js";
import { section } from "./controls.js";

// The element that holds the page of an app.
export function layOut(app) {
  const { host, bar, tools, dialog } = app;
  const panel = h("aside", { class: "panel", "aria-label": "Controls" }, sectionsOf(app));
  const main = h("main", { class: host ? "main" : "main alone" }, host ? tools.element : null, stageOf(app), panel);
  return h("div", { class: "trihex" }, bar.element, main, dialog.element);
}

function stageOf({ status, questions, stage, readout, clock }) {
  const head = h("div", { class: "head" }, status.element, questions.element);
  const under = h("div", { class: "under" }, readout.element, stage.legend.element, stage.zoomButtons);
  return h("section", { class: "stage", "aria-label": "Picture" }, head,
    h("div", { class: "view" }, stage.element), under, clock.element);
}

function sectionsOf({ host, rules, draws, field, growing, planning, livePanel, results, followed }) {
  const distances = section("Distance field", field.element, host ? growing.controls : null);
  if (!host) return [distances, results.element, followed.element];
  return [rules, draws, { element: distances }, planning, livePanel, results, followed].map(({ element }) => element);
}
