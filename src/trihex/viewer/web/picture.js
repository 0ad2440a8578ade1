// Picture: what the panes show, and what their colours mean.

import { h, number, plural, title, gapWords } from "./words.js";
import { NOT_REACHED } from "./documents.js";
import { STRANDED, Still } from "./playback.js";
import { css } from "./colours.js";

export const withPicture = (Base) => class extends Base {
  say(words, isWarning = false) {
    this.status.textContent = words;
    this.status.classList.toggle("warning", isWarning);
  }

  refresh() {
    const { doc } = this, { header } = doc;
    this.nameOfArea.textContent = `${header.name || "area"} · ${doc.width} × ${doc.height} ${header.tessellation}`;
    this.undoButton.disabled = !this.past.length;
    this.redoButton.disabled = !this.future.length;
    if (this.host) {
      for (const input of this.tessellation.querySelectorAll("input")) input.checked = input.value === header.tessellation;
      for (const [name, field] of Object.entries(this.rules)) field.lastChild.value = header[name] ?? "";
      this.countText.textContent = `${plural(doc.robots.length, "robot")}, ${plural(doc.destinations.length, "destination")} in the area.`;
      this.growButton.textContent = this.growth?.isPlaying ? "Pause" : this.growth && !this.growth.isComplete ? "Growing…" : "Grow the field";
      this.endCompareButton.hidden = !this.runs[1];
      this.compareButton.disabled = this.planButton.disabled = false;
      if (this.live) this.endCompareButton.hidden = true;
      else if (!this.runs[0] && !this.status.classList.contains("warning")) this.say(this.missing() || "Press Plan to find paths for all robots.");
      else if (!this.runs[0] && !this.missing()) this.say("Press Plan to find paths for all robots.");
    }
    if (this.runs[0] && !this.status.textContent) this.say("Press Play.");
    if (this.host) {
      this.liveButton.textContent = this.live ? "Stop" : "Run live";
      this.keepButton.hidden = !this.live;
      for (const field of this.liveFields.querySelectorAll("input, select")) field.disabled = !!this.live;
    }
    this.refreshPanes();
    this.showResults();
    this.followRobot(this.follow);
    this.showClock();
  }

  refreshPanes() {
    if (!this.doc || !this.panes) return;
    const isSplit = !!this.runs[1];
    if (this.paneElements[1].hidden === isSplit) {
      this.paneElements[1].hidden = !isSplit;
      this.stage.classList.toggle("split", isSplit);
      this.resize();
    }
    const wanted = this.showField.checked;
    const values = !wanted ? null : this.growth ? this.growth.values : this.fields?.distance ?? null;
    const dark = this.isDark();
    this.panes.forEach((pane, i) => {
      const run = this.runs[i];
      if (i && !run) return;
      const doc = run ? run.doc : this.doc;
      const own = i ? (wanted ? run.playback.distance : null) : values;
      const directions = i ? null : this.fields?.directions ?? null;
      pane.values = own;
      pane.directions = this.growth ? null : directions;
      pane.options = { dark, growing: !i && !!this.growth, most: this.farthest(i ? run.playback.distance : this.fields?.distance ?? own), arrows: this.showArrows?.checked, numbers: this.showNumbers.checked, steps: this.settings.steps?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`] };
      pane.follow = this.follow;
      pane.track = this.follow >= 0 && run && this.follow < run.playback.count ? run.playback.robot(this.follow).rows.map((row) => row.cell) : null;
      pane.known = this.live?.known ?? null;
      pane.crosses = [];
      if (!run && !this.live && (this.still?.doc !== doc || this.still.distance !== this.fields?.distance)) this.still = { doc, distance: this.fields?.distance, robots: new Still(doc, this.fields?.distance) };
      pane.show(doc, run ? run.playback : this.live ? this.live.crowd : this.still.robots);
      pane.changed("base");
      const kind = `${title(doc.header.tessellation)} area of ${doc.width} by ${doc.height} cells, ${plural(doc.robots.length, "robot")}, ${plural(doc.destinations.length, "destination")}.`;
      this.canvases[i].setAttribute("aria-label", `${kind} ${this.host && !i ? "Arrow keys move the cursor, Enter uses the tool." : "Arrow keys move the cursor."}`);
      this.captions[i].textContent = run && isSplit ? `${run.summary.planner} · ${doc.header.tessellation} · total time ${number(run.summary.total_time)} · ${gapWords(run.summary)}` : "";
    });
    this.showLegend(!!values);
    this.invalidate();
  }

  farthest(distance) {
    if (!distance) return 1;
    if (this.most?.distance !== distance) {
      let most = 1, unreached = -this.doc.barriers.reduce((count, barrier) => count + barrier, 0);
      for (const value of distance) {
        if (value === NOT_REACHED) unreached++;
        else if (value > most) most = value;
      }
      this.most = { distance, most, unreached };
    }
    return this.most.most;
  }

  showLegend(hasField) {
    const palette = this.panes[0].palette();
    const entry = (name, words, kind = "disc") => {
      const mark = h("i", { class: kind });
      mark.style.background = css(palette[name]);
      return h("span", {}, mark, words);
    };
    const entries = [entry("barrier", "barrier", "cell"), entry("destination", "destination")];
    if (this.live?.known) entries.push(entry("fog", "not seen", "cell"), entry("fog_barrier", "barrier not seen", "cell"));
    if (this.live) {
      entries.push(entry("moving", "moving"), entry("waiting", "waiting"));
      if (this.live.delays) entries.push(entry("late", "late"));
      if (this.live.last.cut_off) entries.push(entry("stranded", "cut off"));
    } else if (this.runs[0]) entries.push(entry("moving", "moving"), entry("waiting", "waiting"), entry("final", "arriving"));
    else if (this.doc.robots.length) entries.push(entry("moving", "robot"));
    if (!this.live && (this.runs[0]?.summary.unreachable || this.still?.robots.state.includes(STRANDED))) entries.push(entry("stranded", "cannot arrive"));
    if (hasField) {
      const ramp = h("i", { class: "ramp" });
      ramp.style.background = `linear-gradient(to right, ${[0, 64, 128, 192, 255].map((i) => css(palette.distance[i])).join(",")})`;
      if (this.most?.distance === this.panes[0].values && this.most.unreached > 0) entries.push(entry("unreached", "not reached", "cell"));
      entries.push(h("span", {}, "0 ", ramp, ` ${number(this.panes[0].options.most)} to go`));
    }
    this.legend.replaceChildren(...entries);
  }
};
