// Ground: what rests below the robots and is more than the colours of cells.

import { NOT_REACHED, shapeOf } from "./documents.js";
import { packed, css, isLight, mix } from "./colours.js";
import { drawDoors } from "./doors.js";
import { leaksOf } from "./leaks.js";
import { strokeEach } from "./marks.js";

const OUTLINES_FROM = 9, ARROWS_FROM = 15, NUMBERS_FROM = 25; // device pixels an edge step
const MOST_OUTLINED = 14000; // cells
const MOST_RINGS = 500; // destinations

// Outlines, numbers and arrows where cells are large, destinations, and the path of the robot that is followed.
export function drawGround(pane, palette) {
  const cells = visibleCells(pane), { scale } = pane.view;
  if (cells && scale >= OUTLINES_FROM) drawOutlines(pane, cells);
  if (cells && scale >= OUTLINES_FROM) drawLeaks(pane, cells, palette);
  if (cells && pane.values && scale >= ARROWS_FROM) drawField(pane, cells, palette);
  drawDestinations(pane, palette);
  drawDoors(pane, palette);
  if (pane.paths) drawPaths(pane, palette);
  if (pane.track) drawTrack(pane);
}

// Where several cells share a pixel, thin walls would come and go: tint by the share of barriers instead.
export function darkenBarriers(pane, palette) {
  const { doc, view, canvas, base32 } = pane;
  const { width, height } = canvas;
  const all = new Uint8Array(base32.length), closed = new Uint8Array(base32.length);
  const { centre } = shapeOf(doc), { barriers } = doc, { scale, left, top } = view;
  for (let cell = 0, y = 0; y < doc.height; y++) {
    for (let x = 0; x < doc.width; x++, cell++) {
      const [cx, cy] = centre(x, y), i = (cx * scale + left) | 0, j = (cy * scale + top) | 0;
      if (i < 0 || j < 0 || i >= width || j >= height) continue;
      all[j * width + i]++;
      closed[j * width + i] += barriers[cell];
    }
  }
  const free = packed(palette.free), barrier = packed(palette.barrier);
  for (let p = 0; p < base32.length; p++) {
    if (!closed[p]) continue;
    const under = base32[p] === barrier ? free : base32[p];
    base32[p] = mix(under, barrier, Math.min(255, Math.round(255 * Math.sqrt(closed[p] / all[p]))));
  }
}

// Cells in view as [x, y], or null where they are too many to be drawn one by one.
function visibleCells(pane) {
  const { doc, view, canvas } = pane, { centre, extent } = shapeOf(doc);
  const across = centre(1, 0)[0] - centre(0, 0)[0], down = extent(1, 2)[1] - extent(1, 1)[1];
  const first = (edge, pitch) => Math.max(0, Math.floor(edge / pitch) - 2);
  const end = (edge, pitch, count) => Math.min(count, Math.ceil(edge / pitch) + 2);
  const x0 = first(view.x(0), across), x1 = end(view.x(canvas.width), across, doc.width);
  const y0 = first(view.y(0), down), y1 = end(view.y(canvas.height), down, doc.height);
  if ((x1 - x0) * (y1 - y0) > MOST_OUTLINED) return null;
  const cells = [];
  for (let y = y0; y < y1; y++) for (let x = x0; x < x1; x++) cells.push([x, y]);
  return cells.length ? cells : null;
}

function drawOutlines(pane, cells) {
  const { doc, view, paperContext: c } = pane;
  c.beginPath();
  for (const [x, y] of cells) {
    const [cx, cy] = shapeOf(doc).centre(x, y);
    const corners = shapeOf(doc).corners(shapeOf(doc).orientation(x, y));
    corners.forEach(([dx, dy], k) => {
      const px = (cx + dx) * view.scale + view.left, py = (cy + dy) * view.scale + view.top;
      if (k) c.lineTo(px, py);
      else c.moveTo(px, py);
    });
    c.closePath();
  }
  c.strokeStyle = pane.options.dark ? "rgba(0,0,0,0.45)" : "rgba(60,64,72,0.28)";
  c.lineWidth = 1;
  c.stroke();
}

// A gap in the wall where robots squeeze through.
function drawLeaks(pane, cells, palette) {
  const { doc, view, paperContext: c } = pane, [x0, y0] = cells[0], [x1, y1] = cells[cells.length - 1];
  const radius = Math.max(1.5, view.scale * 0.14);
  c.fillStyle = css(palette.free);
  c.beginPath();
  for (const [x, y] of leaksOf(doc, [x0, y0, x1 + 1, y1 + 1])) {
    const px = x * view.scale + view.left, py = y * view.scale + view.top;
    c.moveTo(px + radius, py);
    c.arc(px, py, radius, 0, 2 * Math.PI);
  }
  c.fill();
}

function drawField(pane, cells, palette) {
  const { doc, view, values, directions, paperContext: c, options } = pane;
  const hasNumbers = options.numbers && view.scale >= NUMBERS_FROM, hasArrows = options.arrows && directions;
  c.textAlign = "center";
  c.textBaseline = "middle";
  const size = Math.min(16, Math.max(9, view.scale * (doc.header.tessellation === "triangular" ? 0.3 : 0.34)));
  c.font = `${size}px system-ui, sans-serif`;
  for (const [x, y] of cells) {
    const cell = y * doc.width + x;
    if (doc.barriers[cell] || values[cell] === NOT_REACHED || values[cell] === undefined) continue;
    const shade = palette.distance[Math.min(255, ((values[cell] * 255) / Math.max(options.most, 1)) | 0)];
    c.fillStyle = c.strokeStyle = isLight(shade) ? "#202124" : "#ffffff";
    const [cx, cy] = pane.pointOf(cell);
    if (hasArrows) drawArrows(pane, cell, x, y, cx, cy);
    if (hasNumbers && values[cell] > 0) c.fillText(String(values[cell]), cx, cy + (hasArrows ? view.scale * 0.25 : 0));
  }
}

function drawArrows(pane, cell, x, y, cx, cy) {
  const { doc, view, directions, paperContext: c, options } = pane;
  const orientation = shapeOf(doc).orientation(x, y), steps = options.steps[orientation];
  const up = options.numbers && view.scale >= NUMBERS_FROM ? -view.scale * 0.2 : 0;
  const unit = view.scale * (up ? 0.2 : 0.34), head = Math.max(2.5, unit * 0.34), bits = directions[cell];
  const gap = bits & (bits - 1) ? unit * 0.35 : 0; // arrows 30 degrees apart, on triangles, would look like one
  c.lineWidth = Math.max(1, view.scale / 22);
  for (let k = 0; k < steps.length; k++) {
    if (!((bits >> k) & 1)) continue;
    const [tx, ty] = shapeOf(doc).centre(x + steps[k][0], y + steps[k][1]), [sx, sy] = shapeOf(doc).centre(x, y);
    const angle = Math.atan2(ty - sy, tx - sx), far = Math.hypot(tx - sx, ty - sy);
    const length = unit * (far > 1.9 ? 1.8 : far > 1.1 ? 1.2 : 1); // as long as there is room for in the cell
    const ex = cx + length * Math.cos(angle), ey = cy + up + length * Math.sin(angle);
    c.beginPath();
    c.moveTo(cx + gap * Math.cos(angle), cy + up + gap * Math.sin(angle));
    c.lineTo(ex, ey);
    c.moveTo(ex - head * Math.cos(angle - 0.5), ey - head * Math.sin(angle - 0.5));
    c.lineTo(ex, ey);
    c.lineTo(ex - head * Math.cos(angle + 0.5), ey - head * Math.sin(angle + 0.5));
    c.stroke();
  }
}

// A ring makes destinations visible at any zoom, unless they are many.
function drawDestinations(pane, palette) {
  const { doc, view, paperContext: c } = pane;
  if (doc.destinations.length > MOST_RINGS) return;
  const radius = Math.max(5, view.scale * 0.36);
  for (const cell of doc.destinations) {
    const [px, py] = pane.pointOf(cell);
    c.beginPath();
    c.arc(px, py, radius, 0, 2 * Math.PI);
    c.fillStyle = css(palette.destination);
    c.fill();
    c.lineWidth = Math.max(1.5, radius * 0.14);
    c.strokeStyle = "#ffffff";
    c.stroke();
    c.beginPath();
    c.arc(px, py, radius * 0.38, 0, 2 * Math.PI);
    c.fillStyle = "#ffffff";
    c.fill();
  }
}

function drawTrack(pane) {
  const { view, paperContext: c, track } = pane;
  c.lineJoin = c.lineCap = "round";
  const [below, above] = pane.options.dark ? ["#000", "#ffb000"] : ["#fff", "#b3005e"];
  const width = (least) => Math.max(least, view.scale * 0.04 * least), lines = [[width(5), below], [width(2.5), above]];
  strokeEach(c, lines, () => layWay(pane, track));
}

// All ways, each so faint that one sees where many go.
function drawPaths(pane, palette) {
  const { paths, view, paperContext: c } = pane, shade = css(palette.path, paths.length > 200 ? 0.25 : 0.45);
  c.lineJoin = c.lineCap = "round";
  for (const way of paths) strokeEach(c, [[Math.max(1.2, view.scale * 0.08), shade]], () => layWay(pane, way));
}

// The line of a way from cell to cell, through the corners that it passes.
function layWay(pane, way) {
  const { doc, view, paperContext: c } = pane;
  way.forEach((cell, k) => {
    const [px, py] = pane.pointOf(cell);
    if (!k) return c.moveTo(px, py);
    const [qx, qy] = pane.pointOf(way[k - 1]), before = way[k - 1], { bend, orientation } = shapeOf(doc);
    const side = orientation(before % doc.width, Math.floor(before / doc.width));
    const [bx, by] = bend(side, (px - qx) / view.scale, (py - qy) / view.scale);
    if (bx || by) c.lineTo((px + qx) / 2 + bx * view.scale, (py + qy) / 2 + by * view.scale);
    return c.lineTo(px, py);
  });
}
