// Theme: light or dark.

import { button } from "./controls.js";
import { keep, stored } from "./storage.js";

const DARK_QUERY = "(prefers-color-scheme: dark)";

export class Theme {
  constructor(app) {
    this.app = app;
    this.name = stored("trihex-theme") ?? "auto";
    this.button = button("Theme", () => this.next());
    matchMedia(DARK_QUERY).addEventListener("change", () => this.apply(), { signal: app.listeners.signal });
  }

  get isDark() { return this.name === "dark" || (this.name === "auto" && matchMedia(DARK_QUERY).matches); }

  next() {
    this.name = this.isDark ? "light" : "dark";
    keep("trihex-theme", this.name);
    this.apply();
  }

  apply() {
    this.app.shell.dataset.theme = this.isDark ? "dark" : "light";
    this.button.textContent = this.isDark ? "Light" : "Dark";
    this.app.stage.show();
  }
}
