// Status: the one line that says what happened and what to do next.

import { h } from "./words.js";

export class Status {
  constructor() {
    this.element = h("div", { class: "status", role: "status" });
  }

  get text() { return this.element.textContent; }
  get isWarning() { return this.element.classList.contains("warning"); }

  say(words, isWarning = false) {
    this.element.textContent = words;
    this.element.classList.toggle("warning", isWarning);
  }
}
