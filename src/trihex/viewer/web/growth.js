// Growth: the field, generation by generation.

import { number } from "./words.js";
import { NOT_REACHED, arraysOf } from "./documents.js";
import { sameField } from "./runs.js";

export const withGrowth = (Base) => class extends Base {
  fieldChanged() {
    const wanted = this.showField.checked || this.showArrows?.checked || this.showNumbers.checked;
    if (wanted && !this.showField.checked) this.showField.checked = true;
    const hasAll = this.fields && (this.fields.directions || !this.showArrows?.checked);
    clearTimeout(this.fieldTimer);
    if (wanted && !hasAll && !this.live && this.host && this.doc.destinations.length) this.fieldTimer = setTimeout(() => this.fetchFields(), this.stroke ? 60 : 0);
    this.refreshPanes();
  }

  async fetchFields() {
    const doc = this.doc;
    if (this.job) return (this.fieldTimer = setTimeout(() => this.fetchFields(), 100));
    const answer = await this.ask({ op: "fields", ...this.request }, arraysOf(doc));
    if (!answer || !sameField(doc, this.doc)) return;
    this.fields = { doc, ...answer.arrays };
    this.refresh();
  }

  async grow() {
    this.leaveLive();
    const { growth } = this;
    if (growth && sameField(growth.doc, this.doc)) {
      if (growth.isComplete && growth.generation === growth.ends.length - 1) this.setGeneration(0);
      growth.isPlaying = !growth.isPlaying;
      return this.refresh();
    }
    if (!this.doc.destinations.length) return this.say(this.missing(), true);
    this.showField.checked = true;
    if (!this.fields) await this.fetchFields();
    if (!this.fields) return;
    const doc = this.doc, values = new Int32Array(doc.barriers.length).fill(NOT_REACHED);
    for (const cell of doc.destinations) values[cell] = 0;
    this.growth = { doc, values, cells: [], changes: [], ends: [0], generation: 0, isComplete: false, isPlaying: true, at: 0 };
    this.refresh();
    this.onPart = ({ arrays }) => this.addGenerations(arrays);
    const answer = await this.ask({ op: "generations", ...this.request }, arraysOf(doc), "Growing…");
    this.onPart = null;
    if (!answer) return this.endGrowth();
    if (this.growth?.doc !== doc) return;
    this.addGenerations(answer.arrays);
    this.growth.isComplete = true;
    this.refresh();
  }

  addGenerations({ counts, cells, values }) {
    const { growth } = this;
    if (!growth) return;
    let at = 0;
    for (const count of counts) {
      growth.cells.push(cells.slice(at, at + count));
      growth.changes.push(values.slice(at, at + count));
      growth.ends.push(growth.ends.length);
      at += count;
    }
    this.generation.max = growth.ends.length - 1;
    this.invalidate();
  }

  setGeneration(generation) {
    const { growth } = this;
    if (!growth) return;
    generation = Math.max(0, Math.min(generation, growth.ends.length - 1));
    if (generation < growth.generation) {
      growth.values.fill(NOT_REACHED);
      for (const cell of growth.doc.destinations) growth.values[cell] = 0;
      growth.generation = 0;
    }
    while (growth.generation < generation) {
      const cells = growth.cells[growth.generation], values = growth.changes[growth.generation];
      for (let i = 0; i < cells.length; i++) growth.values[cells[i]] = values[i];
      growth.generation++;
    }
    growth.at = generation;
    this.generation.value = generation;
    const isLast = growth.isComplete && generation === growth.ends.length - 1;
    this.generationText.textContent = `Generation ${number(generation)}${growth.isComplete ? ` of ${number(growth.ends.length - 1)}` : ""}` +
      (isLast ? ": nothing changes any more, this is the N-scheme." : "");
    this.refreshPanes();
  }

  async nextGeneration() {
    if (!this.growth) {
      await this.grow();
      if (!this.growth) return;
    }
    this.growth.isPlaying = false;
    this.setGeneration(this.growth.generation + 1);
    this.refresh();
  }

  endGrowth() {
    this.growth = null;
    this.generationText.textContent = "";
    this.generation.value = this.generation.max = 0;
  }
};
