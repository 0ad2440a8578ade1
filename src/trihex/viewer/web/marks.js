// Marks: what must stay above the robots.

import { shapeOf } from "./documents.js";
import { isLight } from "./colours.js";
import { HIDDEN } from "./playback.js";
import { signOf } from "./names.js";
import { coloursOf, pointOfRobot } from "./robots.js";

const NAMED_FROM = 24; // device pixels an edge step
const MOST_NAMED = 3000; // robots

// Names of robots, the halo of the followed one, what was refused, the cell of the keyboard.
export function drawMarks(pane, fraction) {
  const { robots, view, follow, crosses, cursor, doc } = pane;
  if (robots && view.scale >= NAMED_FROM && robots.count <= MOST_NAMED) drawNames(pane, fraction);
  if (robots && follow >= 0 && follow < robots.count && robots.state[follow] !== HIDDEN) drawHalo(pane, fraction);
  for (const cell of crosses) drawCross(pane, cell);
  if (cursor >= 0 && cursor < doc.barriers.length) drawCursor(pane);
}

// Draw a path in each of some widths and colours, the broad ones below.
export function strokeEach(context, lines, path) {
  for (const [width, colour] of lines) {
    context.beginPath();
    path();
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.stroke();
  }
}

function drawNames(pane, fraction) {
  const { context: c, view, robots: { count, state }, canvas: { width, height } } = pane;
  const colours = coloursOf(pane.palette());
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.font = `600 ${Math.min(18, view.scale * 0.3)}px system-ui, sans-serif`;
  for (let r = 0; r < count; r++) {
    if (state[r] === HIDDEN) continue;
    const [px, py] = pointOfRobot(pane, r, fraction);
    if (px < -20 || py < -20 || px > width + 20 || py > height + 20) continue;
    c.fillStyle = isLight(colours[state[r]]) ? "#101114" : "#ffffff";
    c.fillText(signOf(r, count), px, py + 1);
  }
}

function drawHalo(pane, fraction) {
  const { context: c, view, follow } = pane;
  const [px, py] = pointOfRobot(pane, follow, fraction), radius = Math.max(8, view.scale * 0.5);
  strokeEach(c, [[5, "#000"], [2.5, "#ffe600"]], () => c.arc(px, py, radius, 0, 2 * Math.PI));
}

function drawCross(pane, cell) {
  const { context: c, view } = pane, [px, py] = pane.pointOf(cell), reach = Math.max(5, view.scale * 0.32);
  strokeEach(c, [[7, "#fff"], [3.5, "#d0021b"]], () => {
    for (const side of [-1, 1]) {
      c.moveTo(px - reach, py - side * reach);
      c.lineTo(px + reach, py + side * reach);
    }
  });
}

function drawCursor(pane) {
  const { context: c, view, cursor, doc } = pane, [px, py] = pane.pointOf(cursor), shape = shapeOf(doc);
  const corners = shape.corners(shape.orientation(cursor % doc.width, Math.floor(cursor / doc.width)));
  strokeEach(c, [[4, "#000"], [2, "#ffe600"]], () => {
    for (const [dx, dy] of corners) c.lineTo(px + dx * view.scale, py + dy * view.scale);
    c.closePath();
  });
}
