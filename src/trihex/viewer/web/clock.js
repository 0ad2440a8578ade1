// Clock: playing, and the frames of the screen.

import { SPEEDS } from "./panel.js";

export const withClock = (Base) => class extends Base {
  setSpeed(speed) {
    this.stepsPerSecond = speed;
    this.speed.value = SPEEDS.indexOf(speed);
    this.speedText.textContent = `${speed}/s`;
    this.speed.setAttribute("aria-valuetext", `${speed} steps per second`);
  }

  stepForward() {
    if (!this.live) return this.seek(Math.floor(this.clock) + 1);
    this.live.wantsStep = true;
    this.invalidate();
  }

  togglePlay() {
    if (this.live) {
      this.live.isPlaying = !this.live.isPlaying;
      this.showClock();
      return this.invalidate();
    }
    if (!this.runs[0]) return this.host ? this.say(this.missing() || "Press Plan first.", true) : undefined;
    if (!this.isPlaying && this.clock >= this.steps) this.clock = 0;
    this.isPlaying = !this.isPlaying;
    if (this.isPlaying) this.say("Playing. Click a robot to follow it.");
    this.showClock();
    this.invalidate();
  }

  seek(clock) {
    if (this.live) return;
    this.clock = Math.max(0, Math.min(clock, this.steps));
    this.showClock();
    this.invalidate();
  }

  invalidate() {
    if (this.isWaiting || this.isClosed) return;
    this.isWaiting = true;
    requestAnimationFrame((time) => this.tick(time));
  }

  tick(time) {
    this.isWaiting = false;
    if (!this.panes || !this.doc || !this.shell.isConnected) return;
    const passed = Math.min(0.25, (time - (this.lastTick ?? time)) / 1000);
    this.lastTick = time;
    const isRunning = this.live && this.liveTick(passed);
    if (this.isPlaying) {
      this.clock = Math.min(this.steps, this.clock + passed * this.stepsPerSecond);
      if (this.clock >= this.steps) {
        this.isPlaying = false;
        this.say("The last robot has arrived.");
      }
      this.showClock();
    }
    if (this.growth?.isPlaying) this.growTick(passed);
    const step = Math.floor(this.clock);
    this.panes.forEach((pane, i) => {
      if (this.live || (i && !this.runs[1])) return;
      this.runs[i]?.playback.seek(step);
      pane.draw(step >= (this.runs[i]?.playback.steps ?? 0) ? 0 : this.clock - step);
    });
    if (this.panes.some((pane) => pane.isRough)) {
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.settle(), 150);
    }
    if (this.isPlaying || this.growth?.isPlaying || isRunning) this.invalidate();
    else this.lastTick = undefined;
  }

  settle() {
    for (const pane of this.panes) {
      if (!pane.isRough) continue;
      pane.isRough = false;
      if (pane.view.scale < 1) pane.changed("map");
    }
    this.invalidate();
  }

  growTick(passed) {
    const { growth } = this, last = growth.ends.length - 1;
    // The whole field in some four seconds.
    const edge = growth.doc.header.costs === "euclidean" ? 1000 : 10;
    const rate = Math.max(8, this.panes[0].options.most / edge / 4);
    growth.at = Math.min(last, growth.at + passed * rate);
    const isEnd = growth.isComplete && growth.at >= last;
    if (Math.floor(growth.at) !== growth.generation || isEnd) {
      const { at } = growth;
      this.setGeneration(Math.floor(growth.at));
      growth.at = at;
    }
    if (isEnd) {
      growth.isPlaying = false;
      this.refresh();
    }
  }
};
