// Help: how the page works, and its keys.

import { h } from "./words.js";
import { button, note } from "./controls.js";

const STORY = [
  "Paint walls, or open an area.",
  "Set a destination and place robots; all robots go to the nearest destination.",
  "Grow the field: an automaton computes how far each cell is from the destinations.",
  "Plan: every robot gets a path; no two ever collide.",
  "Play, and compare with the optimum or with other cells.",
];
const TIMES = "Time t of a robot is the cost of its moves d and of its waits w. A planner keeps the sum over all " +
  "robots small; the lower bound tells how small it could be at all.";
const KEYS = [
  ["Space", "play, pause"],
  [", .", "step back, forward"],
  ["Home End", "to the start, to the end"],
  ["[ ]", "slower, faster"],
  ["+ − 0", "zoom in, out, show all"],
  ["P", "plan"],
  ["L", "run live, leave"],
  ["V W E D R", "tools; B T break and delay robots that run live"],
  ["Arrows, Enter", "move the cursor, use the tool (Shift: ten cells)"],
  ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
  ["Ctrl+O, Ctrl+S", "open, save"],
  ["Escape", "cancel"],
];

export function showHelp({ dialog, guide }) {
  const keys = KEYS.map(([key, words]) => h("tr", {}, h("th", { scope: "row" }, key), h("td", {}, words)));
  dialog.open("How it works", h("ol", {}, STORY.map((line) => h("li", {}, line))),
    guide && button("Show me: a guided minute", () => { dialog.close(); guide.begin(); }),
    h("p", {}, TIMES),
    h("table", { class: "keys" }, keys),
    note("Wheel or pinch to zoom; drag with the right button, Shift or two fingers to move the picture."));
}
