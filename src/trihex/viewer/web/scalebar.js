// Scale bar: how long so many metres are on a canvas, in areas that lie in the world.

import { strokeEach } from "./marks.js";

const SHORTEST = 70; // device pixels
const EDGE = 16; // from the border of the canvas

// The least of 1, 2, 5, 10, ... metres that is at least so many pixels long.
export function lengthOf(pixelsPerMetre) {
  const least = SHORTEST / pixelsPerMetre, power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((one) => one * power).find((metres) => metres >= least * (1 - 1e-9));
}

const namedLength = (metres) => (metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m`
  : `${Number((metres * 100).toPrecision(1))} cm`);

export function drawScaleBar({ context: c, view, doc, canvas, options }) {
  const { frame } = doc.header;
  if (!frame) return;
  const pixels = view.scale / frame.cell_size, metres = lengthOf(pixels), right = canvas.width - EDGE;
  const left = right - metres * pixels, y = canvas.height - EDGE;
  const [ink, below] = options.dark ? ["#fff", "#000"] : ["#000", "#fff"];
  strokeEach(c, [[5, below], [2, ink]], () => {
    c.moveTo(left, y - 6);
    c.lineTo(left, y);
    c.lineTo(right, y);
    c.lineTo(right, y - 6);
  });
  c.font = "13px system-ui, sans-serif";
  c.textAlign = "center";
  c.textBaseline = "alphabetic";
  c.lineWidth = 4;
  c.strokeStyle = below;
  c.strokeText(namedLength(metres), (left + right) / 2, y - 8);
  c.fillStyle = ink;
  c.fillText(namedLength(metres), (left + right) / 2, y - 8);
}
