// Dialog: the one window above the page.

import { h } from "./words.js";
import { button } from "./controls.js";

export class Dialog {
  constructor() {
    this.element = h("dialog", { class: "dialog" });
  }

  get isOpen() { return this.element.open; }

  open(heading, ...children) {
    const head = h("div", { class: "heading" }, h("h2", {}, heading),
      button("×", () => this.close(), { "aria-label": "Close" }));
    this.element.replaceChildren(h("form", { method: "dialog" }, head, children));
    if (!this.isOpen) this.element.showModal();
  }

  close() { this.element.close(); }
}
