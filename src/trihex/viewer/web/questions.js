// Questions: what the page asks its host for.

import { number, plural, title } from "./words.js";
import { arraysOf } from "./documents.js";
import { runOf } from "./runs.js";

export const withQuestions = (Base) => class extends Base {
  async ask(header, arrays, words) {
    this.cancel();
    const job = new AbortController();
    this.job = job;
    if (words) this.working(words, 0, 0);
    try {
      return await this.host.ask(header, arrays, { signal: job.signal, onFrame: (frame) => {
        if (job.signal.aborted) return;
        if (frame.header.kind === "progress") this.working(`${title(frame.header.stage)}…`, frame.header.done, frame.header.total);
        else this.onPart?.(frame);
      } });
    } catch (error) {
      if (error.name === "AbortError") this.say("Cancelled.");
      else this.say(error instanceof TypeError ? "The server does not answer; is it still running?" : error.message, true);
      return null;
    } finally {
      if (this.job === job) {
        this.job = null;
        this.progressRow.hidden = true;
      }
    }
  }

  // Better lower bounds take longer than plans: they are asked for while the plan is on the page already. Where the
  // optimum has been found meanwhile, it is the bound.
  async bound() {
    if (!this.host) return;
    for (const run of this.runs) {
      if (!run || run.summary.optimal || run.isBounding) continue;
      run.isBounding = true;
      try {
        const { header } = await this.host.ask({ op: "bound", plan: run.plan });
        Object.assign(run, { summary: header.summary });
        if (this.runs.includes(run)) this.refresh();
      } catch { /* the weaker bound holds as well */ } finally {
        run.isBounding = false;
      }
    }
  }

  working(words, done, total) {
    this.progressRow.hidden = false;
    this.progressText.textContent = total > 0 ? `${words} ${number(done)} of ${number(total)}` : words;
    if (total > 0) Object.assign(this.progress, { max: total, value: done });
    else this.progress.removeAttribute("value");
  }

  cancel() { this.job?.abort(); }

  get request() { return { document: this.doc.header }; }

  async generate(wish, isFirst = false) {
    const answer = await this.ask({ op: "generate", ...wish }, {}, "Making…");
    if (!answer) return;
    this.clock = 0;
    const size = wish.height * wish.width;
    this.count.lastChild.value = Math.max(1, Math.min(200, Math.round(size / 25)));
    if (!isFirst) return this.take(answer);
    this.count.lastChild.value = 60;
    // Something to look at for those who open the viewer without a file.
    this.take(answer, { isEdit: false });
    const free = [...this.doc.barriers.keys()].filter((cell) => !this.doc.barriers[cell]);
    const middle = free.reduce((best, cell) => (this.fromMiddle(cell) < this.fromMiddle(best) ? cell : best));
    this.set({ ...this.doc, destinations: Int32Array.of(middle) }, [null, null]);
    const drawn = await this.ask({ op: "scatter", count: 60, seed: 1, ...this.request }, arraysOf(this.doc));
    if (drawn) this.set({ ...this.doc, robots: drawn.arrays.robots.slice(), header: { ...this.doc.header, seed: 1 } }, [null, null]);
  }

  fromMiddle(cell) {
    return Math.abs((cell % this.doc.width) - this.doc.width / 2) + Math.abs(Math.floor(cell / this.doc.width) - this.doc.height / 2);
  }

  async scatter() {
    this.leaveLive();
    const count = Number(this.count.lastChild.value), seed = Number(this.seed.lastChild.value);
    const doc = this.doc, answer = await this.ask({ op: "scatter", count, seed, ...this.request }, arraysOf(doc));
    if (answer && this.doc === doc) this.change({ robots: answer.arrays.robots.slice(), header: { ...doc.header, seed } });
  }

  async plan(which) {
    this.leaveLive();
    const missing = this.missing();
    if (missing) return this.say(missing, true);
    if (which && !this.runs[0]) {
      await this.plan(0);
      if (!this.runs[0]) return;
    }
    const { doc } = this;
    const planner = (which ? this.otherPlanner : this.planner).lastChild.value;
    const tessellation = which && this.otherCells.lastChild.value;
    const request = { op: "plan", planner, options: this.chosenOptions(planner), ...this.request };
    if (tessellation && tessellation !== "the same cells") request.tessellation = tessellation;
    this.isPlaying = false;
    const answer = await this.ask(request, arraysOf(doc), "Planning…");
    if (!answer || this.doc !== doc) return;
    // The plan plays on the very document of the page, so that an edit is noticed.
    const run = runOf(answer, which ? null : doc);
    this.past.push({ doc, runs: this.runs });
    this.future = [];
    this.endGrowth();
    if (!which) this.clock = 0;
    this.set(doc, which ? [this.runs[0], run] : [run, this.runs[1]]);
    this.seek(0);
    // From here on a click should follow a robot rather than paint a wall, which would undo the plan.
    this.choose("move");
    this.results.closest("details").scrollIntoView({ block: "nearest" });
    this.bound();
    const { summary } = run;
    const stranded = summary.unreachable ? ` ${plural(summary.unreachable, "robot")} cannot arrive.` : "";
    const conflicts = summary.conflicts ? ` ${plural(summary.conflicts, "conflict")}!` : "";
    if (run === this.runs[which]) this.say(`${title(summary.planner || "plan")}: total time ${number(summary.total_time)}${summary.optimal ? ", proven optimal" : ""}.${stranded}${conflicts} Press Play.`, conflicts !== "");
  }

  endCompare() { this.set(this.doc, [this.runs[0], null]); }

  missing() {
    if (!this.doc.destinations.length) return "There is no destination yet: choose the tool Destination and click a cell.";
    if (!this.doc.robots.length) return "There are no robots yet: scatter some, or place them with the tool Robot.";
    return "";
  }
};
