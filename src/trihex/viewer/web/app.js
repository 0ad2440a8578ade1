// App: the page as a whole; each part adds the methods of one noun.

import { Pane } from "./pane.js";
import { stored } from "./storage.js";
import { withPanel } from "./panel.js";
import { withHistory } from "./history.js";
import { withQuestions } from "./questions.js";
import { withGrowth } from "./growth.js";
import { withPicture } from "./picture.js";
import { withResults } from "./results.js";
import { withClock } from "./clock.js";
import { withHand } from "./hand.js";
import { withKeys } from "./keys.js";
import { withDialogs } from "./dialogs.js";
import { withLive } from "./live.js";

const PARTS = [withPanel, withHistory, withQuestions, withGrowth, withPicture, withResults, withClock, withHand, withKeys, withDialogs, withLive];

export class App extends PARTS.reduce((Base, add) => add(Base), class {}) {
  constructor(root, settings, host, first) {
    super();
    Object.assign(this, { root, settings, host });
    this.doc = null;
    this.runs = [null, null];
    this.past = [];
    this.future = [];
    this.tool = host ? "wall" : "move";
    this.clock = 0;
    this.isPlaying = false;
    this.follow = -1;
    this.fields = null; // { doc, distance, directions }
    this.growth = null; // { doc, values, counts, cells, changes, ends, generation, isComplete, isPlaying }
    this.live = null; // a run that is under way, see live.js
    this.job = null;
    this.pointers = new Map();
    this.stroke = null;
    this.theme = stored("trihex-theme") ?? "auto";
    this.listeners = new AbortController();
    this.build();
    this.panes = [new Pane(this.canvases[0], settings.colours), new Pane(this.canvases[1], settings.colours)];
    new ResizeObserver(() => this.resize()).observe(this.stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.applyTheme(), { signal: this.listeners.signal });
    this.applyTheme();
    this.choose(this.tool);
    if (first) this.take(first);
    else this.generate({ generator: "rooms", tessellation: "hexagonal", height: 32, width: 48, seed: 1 }, true);
  }

  close() {
    this.listeners.abort();
    this.isClosed = true;
  }
}
