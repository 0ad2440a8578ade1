// Documents: never changed; an edit makes another one that shares what is the same.

import { SHAPES } from "./shapes.js";

export const NOT_REACHED = 2 ** 31 - 1;

export function documentOf(header, arrays) {
  const { height, width } = header;
  const barriers = new Uint8Array(height * width);
  const bits = arrays.barriers;
  for (let cell = 0; cell < barriers.length; cell++) barriers[cell] = (bits[cell >> 3] >> (7 - (cell & 7))) & 1;
  return { header, height, width, barriers, destinations: arrays.destinations.slice(), robots: arrays.robots.slice() };
}

export function arraysOf(doc) {
  const bits = new Uint8Array((doc.barriers.length + 7) >> 3);
  for (let cell = 0; cell < doc.barriers.length; cell++) if (doc.barriers[cell]) bits[cell >> 3] |= 128 >> (cell & 7);
  return { barriers: bits, destinations: doc.destinations, robots: doc.robots };
}

export const without = (cells, gone) => cells.filter((cell) => !gone.has(cell));
export const plus = (cells, more) => Int32Array.from([...cells, ...more]);
export const shapeOf = (doc) => SHAPES[doc.header.tessellation];
export const centreOf = (doc, cell) => shapeOf(doc).centre(cell % doc.width, Math.floor(cell / doc.width));
