// Guide: a minute in four steps for who opens the viewer for the first time; it uses the page as a hand would.

import { h } from "./words.js";
import { button } from "./controls.js";
import { keep, stored } from "./storage.js";

const SEEN = "trihex-guide";

// Heading, words, and what the page does meanwhile.
const STEPS = [
  ["New here?", "Four steps of a few seconds each show what this is.", () => {}],
  ["1 of 4: The field grows", "From the destination on, every cell learns from its neighbours how far it is: " +
    "yellow is near, blue is far.", (app) => app.growing.toggle()],
  ["2 of 4: Robots follow it", "Each goes where it comes nearer. Where it is narrow they wait, in orange. " +
    "No two ever collide.", (app) => planAndPlay(app, 0)],
  ["3 of 4: How good is that?", "Beside it plays the optimum: no plan for these robots takes less time. " +
    "The line above each picture tells the difference.", (app) => planAndPlay(app, 1)],
  ["4 of 4: Your turn", "Robots run live now. Drag across the picture to paint a wall in their way: they find " +
    "another one at once.", (app) => (app.live ? null : app.livePanel.toggle())],
];

async function planAndPlay({ planning, clock, runs }, which) {
  if (!which) planning.pick("fcost", "optimal");
  const before = runs[which];
  await planning.plan(which);
  if (planning.app.runs[which] !== before && !clock.isPlaying) clock.toggle();
}

export class Guide {
  constructor(app) {
    this.app = app;
    this.at = -1; // the step that is shown; -1 for none
    this.heading = h("strong");
    this.text = h("p", { class: "note" });
    this.skip = button("Skip", () => this.leave());
    this.next = button("Start", () => this.forth(), { class: "primary" });
    this.element = h("div", { class: "guide", role: "region", "aria-label": "A guided minute", hidden: true },
      this.heading, this.text, h("div", { class: "row end" }, this.skip, this.next));
  }

  // Offer it to who has not seen it.
  offer() { if (!stored(SEEN)) this.#show(0); }

  // From the first step, on what there is, or on the first area if something is missing.
  async begin() {
    const { app } = this;
    app.leaveLive();
    if (app.missing()) await app.make(app.draws.begin());
    app.growing.end();
    app.set(app.doc, [null, null]);
    this.#show(1);
  }

  forth() {
    if (this.at === 0) return this.begin();
    if (this.at + 1 < STEPS.length) return this.#show(this.at + 1);
    return this.leave();
  }

  // Who begins to do something else is not guided any more.
  leave() {
    if (this.at < 0) return;
    keep(SEEN, "seen");
    this.at = -1;
    this.element.hidden = true;
  }

  #show(at) {
    const [heading, words, does] = STEPS[at];
    this.at = at;
    this.heading.textContent = heading;
    this.text.textContent = words;
    this.next.textContent = at === 0 ? "Start" : at + 1 < STEPS.length ? "Next" : "Done";
    this.skip.hidden = at + 1 === STEPS.length;
    this.element.hidden = false;
    if (at) keep(SEEN, "seen");
    does(this.app);
  }
}
