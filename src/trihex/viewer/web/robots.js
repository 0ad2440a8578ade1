// Robots: dots and discs on the pixels of a pane.

import { HIDDEN } from "./playback.js";
import { packed, mix } from "./colours.js";

const MOST_SPRITES = 400; // that a pane keeps
const SMALL = 14; // device pixels an edge step
const RIM = { dark: [12, 12, 14], light: [255, 255, 255] };

const rimOf = (pane) => packed(pane.options.dark ? RIM.dark : RIM.light);

// By the set that a robot belongs to, see playback.js.
export const coloursOf = ({ moving, waiting, final, stranded, late }) => [null, moving, waiting, final, stranded, late];

// How much of its bend a way has, when a fraction of the step has passed: all of it in the middle, at the corner.
const bowAt = (fraction) => 1 - Math.abs(2 * fraction - 1);

// Where a robot is on the canvas, when a fraction of the step has passed.
export function pointOfRobot({ robots: { x0, y0, x1, y1, bx, by }, view: { scale, left, top } }, r, fraction) {
  const bow = bowAt(fraction);
  return [(x0[r] + (x1[r] - x0[r]) * fraction + bx[r] * bow) * scale + left,
    (y0[r] + (y1[r] - y0[r]) * fraction + by[r] * bow) * scale + top];
}

export function plotRobots(pane, fraction) {
  const isNarrow = pane.doc.header.tessellation === "triangular";
  const { scale } = pane.view, share = scale < SMALL ? 0.44 : isNarrow ? 0.3 : 0.36; // small ones fill their cell
  const radius = Math.max(1, scale * share);
  if (radius < 2) plotDots(pane, fraction, radius < 1.3 ? 2 : 3);
  else plotDiscs(pane, fraction, radius);
}

// Squares of two or three pixels.
function plotDots(pane, fraction, side) {
  const { robots: { x0, y0, x1, y1, bx, by, state, count }, view, frame32, canvas: { width, height } } = pane;
  const bow = bowAt(fraction), flat = coloursOf(pane.palette()).map((colour) => (colour ? packed(colour) : 0));
  const { scale } = view, shiftX = view.left - side / 2 + 0.5, shiftY = view.top - side / 2 + 0.5;
  const right = width - side - 1, bottom = height - side - 1;
  const place = (r) => {
    const px = (x0[r] + (x1[r] - x0[r]) * fraction + bx[r] * bow) * scale + shiftX;
    const py = (y0[r] + (y1[r] - y0[r]) * fraction + by[r] * bow) * scale + shiftY;
    return px >= 1 && py >= 1 && px < right && py < bottom ? (py | 0) * width + (px | 0) : -1;
  };
  if (pane.values || pane.layer) { // on the colours of a field the dots need a rim
    const rim = rimOf(pane);
    for (let r = 0; r < count; r++) {
      const p = state[r] === HIDDEN ? -1 : place(r) - width;
      if (p < 0) continue;
      for (let k = 0; k < side; k++) {
        frame32[p + k] = frame32[p + (side + 1) * width + k] = rim;
        frame32[p + (k + 1) * width - 1] = frame32[p + (k + 1) * width + side] = rim;
      }
    }
  }
  for (let r = 0; r < count; r++) {
    const p = state[r] === HIDDEN ? -1 : place(r);
    if (p < 0) continue;
    const colour = flat[state[r]];
    frame32[p] = frame32[p + 1] = frame32[p + width] = frame32[p + width + 1] = colour;
    if (side < 3) continue;
    frame32[p + 2] = frame32[p + width + 2] = colour;
    frame32[p + 2 * width] = frame32[p + 2 * width + 1] = frame32[p + 2 * width + 2] = colour;
  }
}

function plotDiscs(pane, fraction, radius) {
  const { robots: { x0, y0, x1, y1, bx, by, state, count }, view, frame32, canvas: { width, height } } = pane;
  const colours = coloursOf(pane.palette()), bow = bowAt(fraction);
  for (let r = 0; r < count; r++) {
    if (state[r] === HIDDEN) continue;
    const px = (x0[r] + (x1[r] - x0[r]) * fraction + bx[r] * bow) * view.scale + view.left;
    const py = (y0[r] + (y1[r] - y0[r]) * fraction + by[r] * bow) * view.scale + view.top;
    const i = Math.floor(px), j = Math.floor(py);
    if (i < -radius - 2 || j < -radius - 2 || i > width + radius + 2 || j > height + radius + 2) continue;
    const disc = spriteOf(pane, colours[state[r]], radius, (px - i) * 4 | 0, (py - j) * 4 | 0);
    stamp(frame32, width, height, i, j, disc);
  }
}

// A disc with a rim, as pixels (dx, dy), colour and opacity, for a quarter of a pixel each way.
function spriteOf(pane, colour, radius, qx, qy) {
  const key = `${colour} ${radius.toFixed(2)} ${qx} ${qy} ${pane.options.dark}`;
  const known = pane.sprites.get(key);
  if (known) return known;
  if (pane.sprites.size > MOST_SPRITES) pane.sprites.clear();
  const rim = rimOf(pane), fill = packed(colour);
  const reach = Math.ceil(radius + 1), inside = radius - Math.max(0.9, radius * 0.13);
  const dx = [], dy = [], value = [], opacity = [];
  for (let j = -reach; j <= reach; j++) {
    for (let i = -reach; i <= reach; i++) {
      const away = Math.hypot(i + 0.5 - (qx + 0.5) / 4, j + 0.5 - (qy + 0.5) / 4);
      const cover = Math.max(0, Math.min(1, radius + 0.5 - away));
      if (cover === 0) continue;
      const share = Math.max(0, Math.min(1, inside + 0.5 - away));
      dx.push(i);
      dy.push(j);
      value.push(mix(rim, fill, Math.round(255 * share)));
      opacity.push(Math.round(255 * cover));
    }
  }
  const sprite = { reach, dx: Int32Array.from(dx), dy: Int32Array.from(dy), value: Uint32Array.from(value),
    opacity: Uint8Array.from(opacity) };
  pane.sprites.set(key, sprite);
  return sprite;
}

function stamp(pixels, width, height, i, j, { dx, dy, value, opacity, reach }) {
  const isInside = i >= reach && j >= reach && i + reach < width && j + reach < height;
  for (let k = 0; k < dx.length; k++) {
    const x = i + dx[k], y = j + dy[k];
    if (!isInside && (x < 0 || y < 0 || x >= width || y >= height)) continue;
    const p = y * width + x;
    pixels[p] = opacity[k] === 255 ? value[k] : mix(pixels[p], value[k], opacity[k]);
  }
}
