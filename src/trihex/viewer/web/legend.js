// Legend: what the colours of the picture mean.

import { h, number } from "./words.js";
import { css } from "./colours.js";
import { doorsOf } from "./doors.js";
import { amount } from "./layers.js";
import { STRANDED } from "./playback.js";

const TO_GO = "The least cost of a way to a destination, in time units, for a robot that nobody is in the way of.";

export class Legend {
  constructor(app) {
    this.app = app;
    this.element = h("div", { class: "legend", role: "group", "aria-label": "Legend" });
  }

  show() {
    const palette = this.app.panes[0].palette();
    const entries = this.#entries().map(([name, words, kind = "disc"]) => {
      const mark = h("i", { class: kind });
      mark.style.setProperty("--mark", css(palette[name]));
      return h("span", {}, mark, words);
    });
    this.element.replaceChildren(...entries, ...this.#ramp(palette));
  }

  #entries() {
    const { live, runs: [run], doc, field, stage } = this.app, { values } = this.app.panes[0];
    const entries = [["barrier", doc.ground ? "wall" : "barrier", "cell"], ["destination", "destination"]];
    if (doorsOf(doc).length) entries.push(["door", "door with a flow", "door"]);
    if (doc.ground) entries.splice(1, 0, ["tight", "robots do not fit", "cell"]);
    const isFoggy = live?.known || run?.playback.worlds?.knownSince;
    if (isFoggy) entries.push(["fog", "not seen", "cell"], ["fog_barrier", "barrier not seen", "cell"]);
    if (live) {
      entries.push(["moving", "moving"], ["waiting", "waiting"], ["final", "arriving"]);
      if (live.hasLate) entries.push(["late", "late"]);
      const { cut_off: cutOff, broken } = live.last, words = [cutOff && "cut off", broken && "broken"].filter(Boolean);
      if (words.length) entries.push(["stranded", words.join(" or ")]);
    } else if (run) {
      entries.push(["moving", "moving"], ["waiting", "waiting"], ["final", "arriving"]);
      if (run.summary.delays) entries.push(["late", "late"]);
    } else if (doc.robots.length) entries.push(["moving", "robot"]);
    if (this.app.panes[0].owns) entries.push(["moving", "owned by a robot", "cell owned"]);
    const isStranded = run?.summary.unreachable || stage.still?.robots.state.includes(STRANDED);
    if (!live && (isStranded || run?.summary.broken)) entries.push(["stranded", "cannot arrive"]);
    if (values && field.hasUnreached(values)) entries.push(["unreached", "not reached", "cell"]);
    return entries;
  }

  #ramp(palette) {
    const { panes, runs, layers } = this.app, [pane] = panes;
    const layer = pane.layer ?? (runs[1] ? panes[1].layer : null); // only the best plan has prices
    const scale = (shades, words, hint) => {
      const ramp = h("i", { class: "ramp" });
      const stops = [0, 64, 128, 192, 255].map((i) => css(shades[i]));
      ramp.style.background = `linear-gradient(to right, ${stops.join(",")})`;
      return [h("span", { title: hint }, "0 ", ramp, ` ${words}`)];
    };
    if (layer) return scale(palette.visits, `${amount(layer.most)} ${layer.unit}`, layers.hint);
    return pane.values ? scale(palette.distance, `${number(pane.options.most)} to go`, TO_GO) : [];
  }
}
