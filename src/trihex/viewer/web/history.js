// History: what a document and its plans were before, and what undoing brings back.

const MOST_STATES = 300, MOST_CELLS = 2 ** 28; // that are kept

export class History {
  constructor() {
    this.past = [];
    this.future = [];
  }

  // Keep a state; what comes after it is another future.
  keep(state) {
    this.past.push(state);
    let cells = 0, count = 0;
    for (let i = this.past.length - 1; i >= 0 && cells < MOST_CELLS && count < MOST_STATES; i--, count++) {
      cells += this.past[i].doc.barriers.length;
    }
    this.past = this.past.slice(this.past.length - count);
    this.future = [];
  }

  // The state before or after the one of now, undefined if there is none.
  back(now) { return this.#travel(this.past, this.future, now); }
  forth(now) { return this.#travel(this.future, this.past, now); }

  #travel(from, to, now) {
    const state = from.pop();
    if (state) to.push(now);
    return state;
  }
}
