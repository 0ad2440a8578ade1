// Questions: what the page asks its host for, one at a time, and how far the answer is.

import { h, number, title } from "./words.js";
import { button } from "./controls.js";
import { complaintOf } from "./hosts.js";

const COMPILING = "trihex compiles its code for this computer, once, in up to a minute; then what you asked for " +
  "is done.";
const PARTS = "Compiling kernels, once:";

export class Questions {
  constructor(app) {
    this.app = app;
    this.job = null; // aborts the question that is asked now
    this.compiled = null; // beside all questions: parts that are done, and of how many
    this.progress = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
    this.text = h("span", { class: "note" });
    this.cancelButton = button("Cancel", () => this.cancel(), { title: "Escape" });
    this.element = h("div", { class: "working", hidden: true }, this.progress, this.text, this.cancelButton);
  }

  // The answer, or null if there is none; `words` say what is done meanwhile, `onPart` takes the frames before it.
  async ask(header, arrays, words = "", onPart = null) {
    this.cancel();
    const job = this.job = new AbortController();
    if (words) this.#show(words, 0, 0);
    const onFrame = (frame) => {
      const { kind, stage, done, total } = frame.header;
      if (job.signal.aborted) return;
      if (kind !== "progress") return onPart?.(frame);
      if (stage === "compiling") this.app.say(COMPILING);
      return this.#show(stage === "compiling" ? PARTS : `${title(stage)}…`, done, total);
    };
    try {
      return await this.app.host.ask(header, arrays, { signal: job.signal, onFrame });
    } catch (error) {
      if (error.name === "AbortError") this.app.say("Cancelled.");
      else this.app.say(complaintOf(error), true);
      return null;
    } finally {
      if (this.job === job) {
        this.job = null;
        this.#rest();
      }
    }
  }

  // Have the host compile what most clicks need, before anybody clicks.
  async prepare() {
    const { host, listeners: { signal } } = this.app;
    const onFrame = ({ header: { done, total } }) => {
      this.compiled = [done, total];
      if (!this.job) this.#rest();
    };
    try {
      await host.ask({ op: "prepare" }, {}, { signal, onFrame });
    } catch { /* each question has compiled what it needs */ }
    this.compiled = null;
    if (!this.job) this.#rest();
  }

  // Nothing is asked.
  #rest() {
    this.element.hidden = true;
    if (!this.compiled) return;
    this.#show(PARTS, ...this.compiled);
    this.cancelButton.hidden = true;
  }

  cancel() { this.job?.abort(); }

  #show(words, done, total) {
    this.element.hidden = this.cancelButton.hidden = false;
    this.text.textContent = total > 0 ? `${words} ${number(done)} of ${number(total)}` : words;
    if (total > 0) Object.assign(this.progress, { max: total, value: done });
    else this.progress.removeAttribute("value");
  }
}
