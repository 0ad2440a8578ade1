// Keys: the page without a mouse; light and dark.

import { SPEEDS } from "./panel.js";
import { TOOLS } from "./hand.js";

export const withKeys = (Base) => class extends Base {
  key(event) {
    if (event.defaultPrevented || this.dialog.open) return;
    const isText = event.target.matches?.("input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea");
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, isCommand = event.ctrlKey || event.metaKey;
    if (isCommand && this.host && !isText) {
      const does = { z: () => (event.shiftKey ? this.redo() : this.undo()), y: () => this.redo(), s: () => this.saveDialog(), o: () => this.openDialog() }[key];
      if (does) {
        event.preventDefault();
        does();
      }
      return;
    }
    if (isText || isCommand || event.altKey) return;
    if (key === " " && event.target.matches?.("button, summary, input, canvas")) return;
    const tool = this.host && TOOLS.find(([, , letter]) => letter.toLowerCase() === key);
    const does = tool ? () => this.choose(tool[0]) : {
      " ": () => this.togglePlay(), ",": () => this.seek(Math.ceil(this.clock) - 1), ".": () => this.stepForward(), l: () => this.host && (this.live ? this.leaveLive() : this.runLive()),
      "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => this.fit(), p: () => this.host && this.plan(0),
      "[": () => this.faster(-1), "]": () => this.faster(1), "?": () => this.helpDialog(), Escape: () => this.cancel(),
    }[key];
    if (!does) return;
    event.preventDefault();
    does();
  }

  faster(by) { this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.stepsPerSecond) + by))]); }

  canvasKey(event, i) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const pane = this.panes[i], { doc } = pane;
    if (step) {
      event.preventDefault();
      const by = event.shiftKey ? 10 : 1;
      const at = pane.cursor >= 0 ? pane.cursor : doc.width * Math.floor(doc.height / 2) + Math.floor(doc.width / 2);
      const clamp = (value, count) => Math.max(0, Math.min(count - 1, value));
      const x = clamp((at % doc.width) + by * step[0], doc.width), y = clamp(Math.floor(at / doc.width) + by * step[1], doc.height);
      return this.setCursor(y * doc.width + x, i);
    }
    if (event.key === "Enter" || event.key === " ") {
      if (pane.cursor < 0) return event.key === " " ? (event.preventDefault(), this.togglePlay()) : undefined;
      event.preventDefault();
      const [px, py] = pane.pointOf(pane.cursor), { cursor } = pane;
      if (i || this.tool === "move") return this.pick(i, { px, py });
      this.beginStroke(cursor, px, py);
      const { stroke } = this;
      this.stroke = null;
      this.endStroke(stroke);
      this.setCursor(cursor, i);
    }
  }

  setCursor(cell, i = 0) {
    if (!this.panes || this.panes.every((pane, k) => pane.cursor === (k === i ? cell : -1))) return;
    this.panes.forEach((pane, k) => { pane.cursor = k === i ? cell : -1; });
    if (cell >= 0) {
      this.panes[i].reveal(cell);
      this.readCell(i, cell);
    }
    this.invalidate();
  }

  isDark() { return this.theme === "dark" || (this.theme === "auto" && matchMedia("(prefers-color-scheme: dark)").matches); }

  nextTheme() {
    this.theme = this.isDark() ? "light" : "dark";
    try { localStorage.setItem("trihex-theme", this.theme); } catch { /* a page without storage */ }
    this.applyTheme();
  }

  applyTheme() {
    this.shell.dataset.theme = this.isDark() ? "dark" : "light";
    this.themeButton.textContent = this.isDark() ? "Light" : "Dark";
    this.refreshPanes();
  }
};
