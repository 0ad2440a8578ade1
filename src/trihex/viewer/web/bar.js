// Bar: the head of the page with its name, files, undoing and help.

import { h } from "./words.js";
import { button } from "./controls.js";
import { showHelp } from "./help.js";

export class Bar {
  constructor(app) {
    this.app = app;
    this.undo = button("Undo", () => app.undo(), { title: "Ctrl+Z" });
    this.redo = button("Redo", () => app.redo(), { title: "Ctrl+Shift+Z" });
    this.name = h("span", { class: "name" });
    const files = app.canEdit && [
      button("New…", () => app.draws.open(), { title: "Make an area" }),
      button("Open…", () => app.opening.open(), { title: "Ctrl+O" }),
      button("Save…", () => app.saving.open(), { title: "Ctrl+S" }), this.undo, this.redo,
    ];
    this.element = h("header", { class: "bar" }, h("strong", { class: "brand" }, "trihex"), files || null, this.name,
      app.panel.button, app.theme.button, button("Help", () => showHelp(app), { title: "?" }));
  }

  show() {
    const { doc, history } = this.app, { header } = doc;
    this.name.textContent = `${header.name || "area"} · ${doc.width} × ${doc.height} ${header.tessellation}`;
    this.undo.disabled = !history.past.length;
    this.redo.disabled = !history.future.length;
  }
}
