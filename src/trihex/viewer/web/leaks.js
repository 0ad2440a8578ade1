// Leaks: lattice vertices at which walls touch, and robots squeeze through all the same.

import { shapeOf } from "./documents.js";

const FINEST = 1024; // places of a vertex in an edge step, so that its cells agree on it
const REACH = 2; // cells beyond the border that touch a vertex of it; outside counts as barrier

// Whether robots of a document may squeeze between walls that touch.
export const mayLeak = ({ header: { tessellation, neighbourhood, corners } }) =>
  corners === "allow" && neighbourhood === "full" && tessellation !== "hexagonal";

// The vertices, in edge steps, around which barriers and free cells change more than twice, in a part of a document.
export function leaksOf(doc, [x0, y0, x1, y1]) {
  if (!mayLeak(doc)) return [];
  const cornersAt = [0, 1].map((side) => shapeOf(doc).corners(side));
  const arms = doc.header.tessellation === "square" ? 4 : 6; // cells around a vertex
  const found = new Map(); // by vertex: its place, and of each cell around it whether it is a barrier, a bit each
  for (let y = y0 - REACH; y < y1 + REACH; y++) {
    for (let x = x0 - REACH; x < x1 + REACH; x++) {
      const isOutside = x < 0 || y < 0 || x >= doc.width || y >= doc.height;
      if (!isOutside && !doc.barriers[y * doc.width + x]) continue;
      const [cx, cy] = shapeOf(doc).centre(x, y);
      for (const [dx, dy] of cornersAt[shapeOf(doc).orientation(x, y)]) {
        const key = Math.round((cx + dx) * FINEST) * 2 ** 26 + Math.round((cy + dy) * FINEST);
        const arm = Math.round((Math.atan2(-dy, -dx) / (2 * Math.PI)) * arms * 2); // in half arms: all odd, or all even
        const bit = 1 << ((((arm + 2 * arms) % (2 * arms)) / 2) | 0);
        const known = found.get(key);
        if (known) known.bits |= bit;
        else found.set(key, { place: [cx + dx, cy + dy], bits: bit });
      }
    }
  }
  return [...found.values()].filter(({ bits }) => arcsOf(bits, arms) > 1).map(({ place }) => place);
}

// How many runs of bits there are around a circle.
function arcsOf(bits, count) {
  let arcs = 0;
  for (let k = 0; k < count; k++) if ((bits >> k) & 1 && !((bits >> ((k + 1) % count)) & 1)) arcs++;
  return arcs;
}
