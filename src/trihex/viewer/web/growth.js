// Growth: the field of a document, generation by generation.

import { NOT_REACHED } from "./documents.js";

export class Growth {
  constructor(doc) {
    this.doc = doc;
    this.values = new Int32Array(doc.barriers.length); // of each cell in the generation that is shown
    this.cells = []; // that change from a generation to the next
    this.changes = []; // and what they change to
    this.isComplete = false;
    this.isPlaying = true;
    this.#begin();
  }

  get last() { return this.cells.length; }
  get isAtEnd() { return this.isComplete && this.generation === this.last; }

  #begin() {
    this.values.fill(NOT_REACHED);
    for (const cell of this.doc.destinations) this.values[cell] = 0;
    this.generation = 0;
    this.at = 0; // the generation, and the share of the next that has passed
  }

  // Take more generations: how many cells change in each, which, and to what.
  add({ counts, cells, values }) {
    let at = 0;
    for (const count of counts) {
      this.cells.push(cells.slice(at, at + count));
      this.changes.push(values.slice(at, at + count));
      at += count;
    }
  }

  complete() { this.isComplete = true; }
  pause() { this.isPlaying = false; }
  toggle() { this.isPlaying = !this.isPlaying; }

  // Let some generations pass, by shares of them; at the end it rests.
  advance(by) {
    const at = Math.min(this.last, this.at + by);
    this.seek(Math.floor(at));
    this.at = at;
    if (this.isAtEnd) this.isPlaying = false;
  }

  seek(generation) {
    generation = Math.max(0, Math.min(generation, this.last));
    if (generation < this.generation) this.#begin();
    for (; this.generation < generation; this.generation++) {
      const cells = this.cells[this.generation], values = this.changes[this.generation];
      for (let i = 0; i < cells.length; i++) this.values[cells[i]] = values[i];
    }
    this.at = generation;
  }
}
