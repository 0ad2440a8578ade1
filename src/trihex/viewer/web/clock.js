// Clock: which step is shown, how fast it goes on, and the controls for it.

import { h, number, secondsOf } from "./words.js";
import { button } from "./controls.js";

const SPEEDS = [0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96]; // steps per second

const HINT_OF_STEP = "The step that is shown, of all steps: in each, every robot moves or waits.";

const minutes = (seconds) =>
  `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;

export class Clock {
  constructor(app) {
    this.app = app;
    this.at = 0; // a step, and the share of the next that has passed
    this.isPlaying = false;
    this.shown = null; // the step and the document that the page tells of
    this.playButton = button("Play", () => this.toggle(), { class: "play", title: "Space" });
    this.scrubber = h("input", { type: "range", min: 0, max: 0, value: 0, step: "any", class: "scrub",
      "aria-label": "Step", oninput: () => this.seek(Number(this.scrubber.value)) });
    this.text = h("output", { class: "clock", title: HINT_OF_STEP });
    this.speed = h("input", { type: "range", min: 0, max: SPEEDS.length - 1, value: 5,
      "aria-label": "Steps per second", oninput: () => this.setSpeed(SPEEDS[this.speed.value]) });
    this.speedText = h("span", { class: "unit" });
    this.element = h("div", { class: "transport", role: "group", "aria-label": "Playback" },
      button("|‹", () => this.seek(0), { "aria-label": "To the start", title: "Home" }),
      button("‹", () => this.back(), { "aria-label": "Step back", title: "," }), this.playButton,
      button("›", () => this.forth(), { "aria-label": "Step forward", title: "." }),
      button("›|", () => this.seek(app.steps), { "aria-label": "To the end", title: "End" }),
      this.scrubber, this.text, h("label", { class: "speed" }, h("span", {}, "Speed"), this.speed, this.speedText));
    this.setSpeed(6);
  }

  // How many steps a move over an edge lasts: where moves last, speeds are of such moves, not of ticks.
  get pace() { return this.app.live?.pace ?? this.app.runs[0]?.playback.pace ?? 1; }
  get #word() { return this.pace > 1 ? "tick" : "step"; }
  get step() { return Math.floor(this.at); }

  setSpeed(speed) {
    this.stepsPerSecond = speed;
    this.speed.value = SPEEDS.indexOf(speed);
    this.speedText.textContent = `${speed}/s`;
    this.speed.setAttribute("aria-valuetext", `${speed} steps per second`);
  }

  faster(by) {
    const wanted = SPEEDS.indexOf(this.stepsPerSecond) + by;
    this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, wanted))]);
  }

  back() { this.seek(Math.ceil(this.at) - 1); }

  forth() {
    const { live, stage } = this.app;
    if (!live) return this.seek(this.step + 1);
    live.wantStep();
    stage.invalidate();
  }

  seek(at) {
    const { live, steps, stage } = this.app;
    if (live) return;
    this.at = Math.max(0, Math.min(at, steps));
    this.show();
    stage.invalidate();
  }

  toggle() {
    const { app } = this, { live } = app;
    if (live) {
      live.toggle();
      this.show();
      return app.stage.invalidate();
    }
    if (!app.runs[0]) return app.host ? app.say(app.missing() || "Press Plan first.", true) : undefined;
    if (!this.isPlaying && this.at >= app.steps) this.at = 0;
    this.isPlaying = !this.isPlaying;
    if (this.isPlaying) app.say("Playing. Click a robot to follow it.");
    this.show();
    app.stage.invalidate();
  }

  rewind() { this.at = 0; }
  pause() { this.isPlaying = false; }

  // Keep within what is shown now.
  fit() {
    this.at = Math.min(this.at, this.app.steps);
    if (!this.app.runs[0]) this.isPlaying = false;
  }

  // Let some seconds pass.
  tick(passed) {
    const { app } = this;
    if (!this.isPlaying) return;
    this.at = Math.min(app.steps, this.at + passed * this.stepsPerSecond * this.pace);
    if (this.at >= app.steps) {
      this.isPlaying = false;
      app.say(app.runs[0]?.playback.worlds ? "The run is over." : "The last robot has arrived.");
    }
    this.show();
  }

  show() {
    const { live, runs, steps } = this.app;
    this.scrubber.max = steps;
    this.scrubber.value = this.at;
    this.scrubber.disabled = !runs[0];
    this.scrubber.setAttribute("aria-valuetext", `${this.#word} ${this.step} of ${steps}`);
    this.playButton.disabled = !runs[0] && !live;
    this.playButton.classList.toggle("primary", !this.playButton.disabled);
    this.playButton.textContent = this.isPlaying || live?.isPlaying ? "Pause" : "Play";
    if (live) this.text.textContent = `${this.#word} ${number(steps)} · ${minutes(live.seconds)} live`;
    else if (!runs[0]) this.text.textContent = "no plan";
    else this.text.textContent = `${this.#word} ${number(this.step)} / ${number(steps)}${this.#seconds}`;
    this.#showStep(runs.filter(Boolean));
  }

  // How long robots are on their way in the world, where all areas are in metres and their steps last alike.
  get #seconds() {
    const { runs, steps } = this.app, [one, other] = runs.map((run) => run?.step_seconds);
    return one && (other ?? one) === one ? ` · ${secondsOf(this.at * one)} of ${secondsOf(steps * one)}` : "";
  }

  // What depends on the step is made anew only where there is another one.
  #showStep(runs) {
    const { doc, steps, results, followed } = this.app;
    if (!runs.length) return;
    results.chart.show(this.at / Math.max(1, steps));
    const step = `${this.step} ${runs.map((run) => run.plan + run.summary.planner)}`;
    if (this.shown?.step === step && this.shown.doc === doc) return;
    this.shown = { step, doc };
    results.showStep(this.step);
    if (followed.robot >= 0) followed.show();
  }
}
