// Keys: the page without a mouse, and the cursor that stands in for it.

import { showHelp } from "./help.js";

const TEXTS = "input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea";
const PRESSED = "button, summary, select, input[type=checkbox], input[type=radio]"; // what the space bar presses itself
const WRITTEN = "input[type=text], input[type=search], textarea"; // where it writes
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Keys {
  constructor(app) {
    this.app = app;
    this.isTabbing = false; // whether the focus went where it is by the keyboard
    this.isHeld = false; // whether the space bar is down, and has been answered
    app.panes.forEach(({ canvas }, i) => {
      canvas.addEventListener("keydown", (event) => this.#onCanvas(event, i));
      canvas.addEventListener("blur", () => this.setCursor(-1));
    });
  }

  // Hear all of the page; in a notebook only what is pressed in the viewer.
  listen() {
    const { shell, settings, listeners: { signal } } = this.app;
    shell.addEventListener("keydown", (event) => this.#onPage(event));
    shell.addEventListener("keyup", (event) => this.#onRelease(event));
    shell.addEventListener("pointerdown", () => { this.isTabbing = false; });
    if (settings.host === "notebook") return;
    const outside = (event) => { if (!shell.contains(event.target)) this.#onPage(event); };
    document.addEventListener("keydown", outside, { signal });
  }

  #onPage(event) {
    const { app } = this, { target, altKey } = event;
    if (event.defaultPrevented || app.dialog.isOpen) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const isText = target.matches?.(TEXTS), isCommand = event.ctrlKey || event.metaKey;
    let does;
    if (key === "Tab") this.isTabbing = true;
    if (isCommand) does = app.canEdit && !isText ? this.#command(key, event.shiftKey) : undefined;
    else if (!altKey && (key === " " ? this.#isFree(target) : !isText)) does = this.#action(key);
    if (!does) return;
    event.preventDefault();
    this.isHeld = key === " ";
    does();
  }

  // The space bar plays, whatever was clicked last; only who came to a control by the keyboard presses it.
  #isFree(target) { return !target.matches?.(WRITTEN) && !(this.isTabbing && target.matches?.(PRESSED)); }

  // Some browsers press a button when the bar is released.
  #onRelease(event) {
    if (event.key !== " " || !this.isHeld) return;
    this.isHeld = false;
    event.preventDefault();
  }

  #command(key, hasShift) {
    const { app } = this;
    return {
      z: () => (hasShift ? app.redo() : app.undo()), y: () => app.redo(),
      s: () => app.saving.open(), o: () => app.opening.open(),
    }[key];
  }

  #action(key) {
    const { app } = this, { clock, stage, host, canEdit } = app, tool = canEdit && app.tools.ofKey(key);
    if (tool) return () => app.tools.choose(tool);
    return {
      " ": () => clock.toggle(), ",": () => clock.back(), ".": () => clock.forth(),
      "[": () => clock.faster(-1), "]": () => clock.faster(1),
      "+": () => stage.zoom(1.4), "=": () => stage.zoom(1.4), "-": () => stage.zoom(1 / 1.4), 0: () => stage.fit(),
      p: () => host && app.planning.plan(0), l: () => canEdit && app.livePanel.toggle(),
      Home: () => clock.seek(0), End: () => clock.seek(app.steps),
      "?": () => showHelp(app), Escape: () => app.questions.cancel(),
    }[key];
  }

  #onCanvas(event, i) {
    const { app } = this, pane = app.panes[i], { cursor } = pane, step = ARROWS[event.key];
    if (!pane.doc) return;
    if (step) {
      event.preventDefault();
      return this.setCursor(this.#moved(pane, step, event.shiftKey ? 10 : 1), i);
    }
    if (event.key !== "Enter" || cursor < 0) return;
    event.preventDefault();
    const [px, py] = pane.pointOf(cursor);
    if (i || app.tools.chosen === "move") return app.hand.pick(i, { px, py });
    app.hand.tap(cursor, px, py);
    this.setCursor(cursor, i);
  }

  // The cell so many steps from the cursor, or from the middle if there is none.
  #moved({ doc, cursor }, [dx, dy], by) {
    const at = cursor >= 0 ? cursor : doc.width * Math.floor(doc.height / 2) + Math.floor(doc.width / 2);
    const clamp = (value, count) => Math.max(0, Math.min(count - 1, value));
    const x = clamp((at % doc.width) + by * dx, doc.width), y = clamp(Math.floor(at / doc.width) + by * dy, doc.height);
    return y * doc.width + x;
  }

  // Put the cursor on a cell of a pane, -1 for none.
  setCursor(cell, i = 0) {
    const { panes, readout, stage } = this.app;
    if (panes.every((pane, k) => pane.cursor === (k === i ? cell : -1))) return;
    panes.forEach((pane, k) => pane.take({ cursor: k === i ? cell : -1 }));
    if (cell >= 0) {
      panes[i].reveal(cell);
      readout.show(i, cell);
    }
    stage.invalidate();
  }
}
