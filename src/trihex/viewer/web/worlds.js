// Worlds: barriers and destinations of a run as they were in each step, and what robots had seen by then.

export class Worlds {
  constructor(doc, changes, knownSince) {
    this.knownSince = knownSince ?? null;
    this.docs = [{ step: 0, doc }];
    for (const { step, blocked, freed, destinations } of changes) {
      const barriers = this.docs.at(-1).doc.barriers.slice();
      for (const cell of blocked) barriers[cell] = 1;
      for (const cell of freed) barriers[cell] = 0;
      this.docs.push({ step, doc: { ...doc, barriers, destinations: Int32Array.from(destinations) } });
    }
    this.last = null; // what was told last
  }

  // The document of a step and its known cells, null for all; the same object as long as nothing changes.
  at(step) {
    const { knownSince, last } = this, { doc } = this.docs.findLast((one) => one.step <= step);
    if (last && last.doc === doc && (last.step === step || !knownSince)) return last;
    const known = knownSince && Uint8Array.from(knownSince, (since) => since >= 0 && since <= step);
    return (this.last = { step, doc, known });
  }
}
