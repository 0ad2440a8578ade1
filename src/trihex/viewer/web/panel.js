// Panel: where the parts of the page stand, and whether the controls beside the picture are folded away.

import { h } from "./words.js";
import { button, section } from "./controls.js";

const FOLDED_TO = 860, BELOW_TO = 760; // pixels: windows so narrow begin folded; narrower ones have the panel below

export class Panel {
  constructor(app) {
    this.app = app;
    this.button = button("Controls", () => this.fold(!this.isFolded),
      { class: "fold", "aria-controls": "trihex-panel" });
    this.element = h("aside", { class: "panel", id: "trihex-panel", "aria-label": "Controls", tabindex: "-1" });
    const width = app.root.clientWidth;
    this.fold(width > BELOW_TO && width <= FOLDED_TO);
  }

  // Scroll to a section, but not away from the picture where the panel stands below it.
  reveal(element) {
    if (getComputedStyle(this.element).overflowY !== "visible") element.scrollIntoView({ block: "nearest" });
  }

  fold(isFolded) {
    this.isFolded = isFolded;
    this.element.hidden = isFolded;
    this.button.setAttribute("aria-expanded", !isFolded);
    this.button.setAttribute("title", isFolded ? "Show the controls" : "Hide the controls: more room for the picture");
  }
}

// The element that holds the page of an app.
export function layOut(app) {
  const { canEdit, bar, tools, dialog, panel } = app;
  panel.element.replaceChildren(...sectionsOf(app));
  const main = h("main", { class: canEdit ? "main" : "main alone" }, canEdit ? tools.element : null, stageOf(app),
    panel.element);
  return h("div", { class: "trihex" }, bar.element, main, dialog.element);
}

function stageOf({ status, questions, stage, readout, clock, planning, guide }) {
  const head = h("div", { class: "head" }, status.element, questions.element);
  const under = h("div", { class: "under" }, readout.element,
    h("div", { class: "beside" }, stage.legend.element, stage.zoomButtons));
  if (planning) clock.element.prepend(planning.button);
  return h("section", { class: "stage", "aria-label": "Picture" }, head,
    h("div", { class: "view" }, stage.element, guide?.element), under, clock.element);
}

function sectionsOf({ host, rules, draws, field, growing, planning, livePanel, results, followed }) {
  const distances = { element: section("Distance field", field.element, host ? growing.controls : null) };
  const parts = [rules, draws, distances, planning, livePanel, results, followed];
  return parts.filter(Boolean).map(({ element }) => element);
}
