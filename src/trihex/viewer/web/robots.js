// Robots: discs and marks on the pixels of a pane.

import { shapeOf } from "./documents.js";
import { HIDDEN } from "./playback.js";
import { packed, isLight, mix } from "./colours.js";

// By the set that a robot belongs to, see playback.js.
export const coloursOf = ({ moving, waiting, final, stranded, late }) => [null, moving, waiting, final, stranded, late];

export function plotRobots(pane, fraction) {
  const { robots, view, frame32, canvas } = pane;
  const { width, height } = canvas, { x0, y0, x1, y1, state } = robots;
  const palette = pane.palette();
  const colours = coloursOf(palette);
  const radius = Math.max(1, view.scale * (pane.doc.header.tessellation === "triangular" ? 0.3 : 0.36));
  if (radius < 2) {
    const side = radius < 1.3 ? 2 : 3, flat = colours.map((colour) => (colour ? packed(colour) : 0));
    const { scale } = view, shiftX = view.left - side / 2 + 0.5, shiftY = view.top - side / 2 + 0.5;
    const right = width - side - 1, bottom = height - side - 1, { count } = robots;
    const place = (r) => {
      const px = (x0[r] + (x1[r] - x0[r]) * fraction) * scale + shiftX, py = (y0[r] + (y1[r] - y0[r]) * fraction) * scale + shiftY;
      return px >= 1 && py >= 1 && px < right && py < bottom ? (py | 0) * width + (px | 0) : -1;
    };
    if (pane.values) { // on the blues of a field the dots need a rim
      const rim = packed(pane.options.dark ? [12, 12, 14] : [255, 255, 255]);
      for (let r = 0; r < count; r++) {
        const p = state[r] === HIDDEN ? -1 : place(r) - width;
        if (p < 0) continue;
        for (let k = 0; k < side; k++) frame32[p + k] = frame32[p + (side + 1) * width + k] = frame32[p + (k + 1) * width - 1] = frame32[p + (k + 1) * width + side] = rim;
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
    return;
  }
  for (let r = 0; r < robots.count; r++) {
    if (state[r] === HIDDEN) continue;
    const px = (x0[r] + (x1[r] - x0[r]) * fraction) * view.scale + view.left;
    const py = (y0[r] + (y1[r] - y0[r]) * fraction) * view.scale + view.top;
    const i = Math.floor(px), j = Math.floor(py);
    if (i < -radius - 2 || j < -radius - 2 || i > width + radius + 2 || j > height + radius + 2) continue;
    stamp(frame32, width, height, i, j, sprite(pane, colours[state[r]], radius, (px - i) * 4 | 0, (py - j) * 4 | 0));
  }
}

// A disc with a rim, as pixels (dx, dy), colour and opacity, for a quarter of a pixel each way.
export function sprite(pane, colour, radius, qx, qy) {
  const key = `${colour} ${radius.toFixed(2)} ${qx} ${qy} ${pane.options.dark}`;
  const known = pane.sprites.get(key);
  if (known) return known;
  if (pane.sprites.size > 400) pane.sprites.clear();
  const rim = packed(pane.options.dark ? [12, 12, 14] : [255, 255, 255]), fill = packed(colour);
  const reach = Math.ceil(radius + 1), inner = radius - Math.max(0.9, radius * 0.13);
  const dx = [], dy = [], value = [], opacity = [];
  for (let j = -reach; j <= reach; j++) {
    for (let i = -reach; i <= reach; i++) {
      const away = Math.hypot(i + 0.5 - (qx + 0.5) / 4, j + 0.5 - (qy + 0.5) / 4);
      const cover = Math.max(0, Math.min(1, radius + 0.5 - away));
      if (cover === 0) continue;
      const share = Math.max(0, Math.min(1, inner + 0.5 - away));
      dx.push(i);
      dy.push(j);
      value.push(mix(rim, fill, Math.round(255 * share)));
      opacity.push(Math.round(255 * cover));
    }
  }
  const sprite = { reach, dx: Int32Array.from(dx), dy: Int32Array.from(dy), value: Uint32Array.from(value), opacity: Uint8Array.from(opacity) };
  pane.sprites.set(key, sprite);
  return sprite;
}

// What must stay above the robots: numbers of robots, the halo of the followed one, the cell of the keyboard.
export function drawMarks(pane, fraction) {
  const { context: c, view, robots, canvas } = pane;
  const place = (r) => [
    (robots.x0[r] + (robots.x1[r] - robots.x0[r]) * fraction) * view.scale + view.left,
    (robots.y0[r] + (robots.y1[r] - robots.y0[r]) * fraction) * view.scale + view.top,
  ];
  if (robots && view.scale >= 24 && robots.count <= 3000) {
    const colours = coloursOf(pane.palette());
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.font = `600 ${Math.min(18, view.scale * 0.3)}px system-ui, sans-serif`;
    for (let r = 0; r < robots.count; r++) {
      if (robots.state[r] === HIDDEN) continue;
      const [px, py] = place(r);
      if (px < -20 || py < -20 || px > canvas.width + 20 || py > canvas.height + 20) continue;
      c.fillStyle = isLight(colours[robots.state[r]]) ? "#101114" : "#ffffff";
      c.fillText(String(r), px, py + 1);
    }
  }
  if (robots && pane.follow >= 0 && pane.follow < robots.count && robots.state[pane.follow] !== HIDDEN) {
    const [px, py] = place(pane.follow), radius = Math.max(8, view.scale * 0.5);
    for (const [width, colour] of [[5, "#000"], [2.5, "#ffe600"]]) {
      c.beginPath();
      c.arc(px, py, radius, 0, 2 * Math.PI);
      c.lineWidth = width;
      c.strokeStyle = colour;
      c.stroke();
    }
  }
  for (const cell of pane.crosses) {
    const [px, py] = pane.pointOf(cell), reach = Math.max(5, view.scale * 0.32);
    for (const [width, colour] of [[7, "#fff"], [3.5, "#d0021b"]]) {
      c.beginPath();
      for (const side of [-1, 1]) {
        c.moveTo(px - reach, py - side * reach);
        c.lineTo(px + reach, py + side * reach);
      }
      Object.assign(c, { lineWidth: width, strokeStyle: colour });
      c.stroke();
    }
  }
  if (pane.cursor >= 0 && pane.cursor < pane.doc.barriers.length) {
    const x = pane.cursor % pane.doc.width, y = Math.floor(pane.cursor / pane.doc.width);
    const [px, py] = pane.pointOf(pane.cursor);
    for (const [width, colour] of [[4, "#000"], [2, "#ffe600"]]) {
      c.beginPath();
      for (const [dx, dy] of shapeOf(pane.doc).corners(shapeOf(pane.doc).orientation(x, y))) c.lineTo(px + dx * view.scale, py + dy * view.scale);
      c.closePath();
      c.lineWidth = width;
      c.strokeStyle = colour;
      c.stroke();
    }
  }
}

export function stamp(pixels, width, height, i, j, sprite) {
  const { dx, dy, value, opacity, reach } = sprite;
  const isInside = i >= reach && j >= reach && i + reach < width && j + reach < height;
  for (let k = 0; k < dx.length; k++) {
    const x = i + dx[k], y = j + dy[k];
    if (!isInside && (x < 0 || y < 0 || x >= width || y >= height)) continue;
    const p = y * width + x;
    pixels[p] = opacity[k] === 255 ? value[k] : mix(pixels[p], value[k], opacity[k]);
  }
}
