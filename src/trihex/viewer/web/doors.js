// Doors: cells that only so many robots enter in a step; they stay where they are, whatever is painted there.

import { shapeOf } from "./documents.js";
import { css } from "./colours.js";

const MOST_MARKED = 2000; // cells
const OUTLINED_FROM = 7; // device pixels an edge step
const INSET = 0.85; // of a cell, so that each cell of a door has a frame of its own

export const doorsOf = ({ header: { doors } }) => doors ?? [];

// What is said of a cell that belongs to a door, "" of others.
export function wordsOfDoor(doc, cell) {
  const door = doorsOf(doc).find(({ cells }) => cells.includes(cell));
  return door ? `door${door.name ? ` '${door.name}'` : ""}: ${door.words}` : "";
}

// A frame round each cell of a door; where cells are small a square that can still be seen.
export function drawDoors(pane, palette) {
  const { doc, view, paperContext: c } = pane, shape = shapeOf(doc);
  const cells = doorsOf(doc).flatMap((door) => door.cells).filter((cell) => !doc.barriers[cell]);
  if (!cells.length || cells.length > MOST_MARKED) return;
  const square = [[-4, -4], [4, -4], [4, 4], [-4, 4]];
  c.beginPath();
  for (const cell of cells) {
    const [px, py] = pane.pointOf(cell), x = cell % doc.width, y = Math.floor(cell / doc.width);
    const frame = shape.corners(shape.orientation(x, y)).map((corner) => corner.map((at) => at * view.scale * INSET));
    const [[fx, fy], ...others] = view.scale < OUTLINED_FROM ? square : frame;
    c.moveTo(px + fx, py + fy);
    for (const [dx, dy] of others) c.lineTo(px + dx, py + dy);
    c.closePath();
  }
  c.lineJoin = "round";
  const width = Math.max(2, view.scale * 0.08);
  for (const [wide, colour] of [[width + 2, palette.page], [width, palette.door]]) {
    c.lineWidth = wide;
    c.strokeStyle = css(colour);
    c.stroke();
  }
}
