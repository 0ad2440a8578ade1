// Underground: what stands in the world beneath the cells, pixel by pixel, as pictures show it.

import { packed } from "./colours.js";

// What an answer says of it, with the barriers that it led to; null if nothing.
export function undergroundOf({ ground }, arrays, barriers) {
  return ground ? { ...ground, occupied: arrays.ground.slice(), barriers } : null;
}

// What stands beneath a document that says nothing of it, such as that of a plan, if it is of the place of another one.
export function groundFor(doc, other) {
  const placeOf = ({ header: { frame, tessellation }, height, width }) =>
    JSON.stringify([frame, tessellation, height, width]);
  return doc.header.frame && other?.ground && placeOf(doc) === placeOf(other) ? other.ground : null;
}

// Write walls as they are over the cells; barriers where nothing stands are places where robots do not fit. Cells that
// a hand has changed since are drawn as such, and so are barriers of which a map tells something.
export function drawUnderground({ doc, view, layer, base32, cellOfPixel, canvas: { width, height } }, palette) {
  const { rows, columns, square, corner, occupied, barriers } = doc.ground;
  const wall = packed(palette.barrier), tight = packed(palette.tight);
  const column = Int32Array.from({ length: width }, (_, i) => Math.floor((view.x(i + 0.5) + corner[0]) / square));
  for (let j = 0, p = 0; j < height; j++) {
    const row = Math.floor((view.y(j + 0.5) + corner[1]) / square), isRow = row >= 0 && row < rows;
    for (let i = 0; i < width; i++, p++) {
      const cell = cellOfPixel[p], was = cell >= 0 && barriers[cell], is = cell >= 0 && doc.barriers[cell];
      if (is !== was || (is && layer?.values[cell] > 0)) continue;
      const k = row * columns + column[i], isInside = isRow && column[i] >= 0 && column[i] < columns;
      if (isInside && (occupied[k >> 3] >> (7 - (k & 7))) & 1) base32[p] = wall;
      else if (is) base32[p] = tight;
    }
  }
}
