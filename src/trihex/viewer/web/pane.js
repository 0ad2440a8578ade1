// Pane: one canvas, cells below, robots above.

import { NOT_REACHED, shapeOf, centreOf } from "./documents.js";
import { DARK, LIGHT, packed, css, isLight, mix } from "./colours.js";
import { plotRobots, drawMarks } from "./robots.js";

export const OUTLINES_FROM = 9, ARROWS_FROM = 15, NUMBERS_FROM = 25; // device pixels an edge step
export const MOST_OUTLINED = 14000;

export class View {
  constructor() {
    Object.assign(this, { scale: 1, left: 0, top: 0 });
  }
  x(px) { return (px - this.left) / this.scale; }
  y(py) { return (py - this.top) / this.scale; }
}

// One canvas: cells below, robots above, both as pixels that we write ourselves; that keeps 60 frames a second with
// ten thousand robots where nothing but software draws. What rests (cells, outlines, numbers, arrows, paths) is drawn
// once into `base`; a frame is a copy of it with the robots on top.
export class Pane {
  constructor(canvas, colours) {
    this.canvas = canvas;
    this.colours = colours;
    this.context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
    this.paper = document.createElement("canvas");
    this.paperContext = this.paper.getContext("2d", { alpha: false, willReadFrequently: true });
    this.view = new View();
    this.isFitted = true;
    this.doc = null;
    this.robots = null;
    this.values = null; // distance of each cell, or null for no field
    this.directions = null;
    this.options = {};
    this.follow = -1;
    this.track = null; // cells of the followed robot
    this.cursor = -1;
    this.known = null; // of each cell, whether a robot has seen it; null if all are known
    this.crosses = []; // cells where something was refused
    this.isStale = { map: true, base: true, colours: true };
    this.isRough = false; // while a hand moves the picture
    this.sprites = new Map();
  }

  resize(width, height) {
    const { canvas, view } = this;
    if (canvas.width === width && canvas.height === height) return;
    view.left += (width - canvas.width) / 2;
    view.top += (height - canvas.height) / 2;
    for (const canvas of [this.canvas, this.paper]) Object.assign(canvas, { width, height });
    this.base = new ImageData(width, height);
    this.frame = new ImageData(width, height);
    this.base32 = new Uint32Array(this.base.data.buffer);
    this.frame32 = new Uint32Array(this.frame.data.buffer);
    this.cellOfPixel = new Int32Array(width * height);
    this.changed("map");
    if (this.isFitted) this.fit();
  }

  changed(what) {
    this.isStale.base = true;
    this.isStale[what === "map" ? "map" : "colours"] = true;
  }

  show(doc, robots) {
    const isNew = !this.doc || doc.width !== this.doc.width || doc.height !== this.doc.height ||
      doc.header.tessellation !== this.doc.header.tessellation;
    this.doc = doc;
    this.robots = robots;
    this.changed(isNew ? "map" : "base");
    if (isNew) this.fit();
  }

  fit() {
    if (!this.doc || !this.canvas.width) return;
    const [across, down] = shapeOf(this.doc).extent(this.doc.width, this.doc.height);
    const { width, height } = this.canvas, margin = 12;
    this.view.scale = Math.min((width - 2 * margin) / across, (height - 2 * margin) / down, 64);
    this.view.left = (width - across * this.view.scale) / 2;
    this.view.top = (height - down * this.view.scale) / 2;
    this.isFitted = true;
    this.changed("map");
  }

  zoom(factor, px, py) {
    const { view } = this;
    const [across, down] = shapeOf(this.doc).extent(this.doc.width, this.doc.height);
    const least = 0.5 * Math.min(this.canvas.width / across, this.canvas.height / down, 16);
    const scale = Math.max(least, Math.min(view.scale * factor, 200));
    view.left = px - (px - view.left) * (scale / view.scale);
    view.top = py - (py - view.top) * (scale / view.scale);
    view.scale = scale;
    this.isFitted = false;
    this.isRough = true;
    this.changed("map");
  }

  pan(dx, dy) {
    const { view, canvas } = this;
    const [across, down] = shapeOf(this.doc).extent(this.doc.width, this.doc.height).map((side) => side * view.scale);
    const keep = (at, move, size, length) => Math.max(Math.min(at + move, length - 40), 40 - size);
    view.left = keep(view.left, dx, across, canvas.width);
    view.top = keep(view.top, dy, down, canvas.height);
    this.isFitted = false;
    this.isRough = true;
    this.changed("map");
  }

  cellAt(px, py) {
    if (this.isStale.map) this.#map();
    const { width, height } = this.canvas;
    if (!(px >= 0 && py >= 0 && px < width && py < height)) return -1;
    return this.cellOfPixel[Math.floor(py) * width + Math.floor(px)];
  }

  pointOf(cell) {
    const [x, y] = centreOf(this.doc, cell);
    return [x * this.view.scale + this.view.left, y * this.view.scale + this.view.top];
  }

  reveal(cell) {
    const [px, py] = this.pointOf(cell), { width, height } = this.canvas;
    const margin = Math.min(60, width / 5, height / 5);
    const dx = px < margin ? margin - px : px > width - margin ? width - margin - px : 0;
    const dy = py < margin ? margin - py : py > height - margin ? height - margin - py : 0;
    if (dx || dy) this.pan(dx, dy);
  }

  palette() {
    return { ...this.colours, ...(this.options.dark ? DARK : LIGHT) };
  }

  #map() {
    shapeOf(this.doc).fill(this.doc, this.view, this.canvas.width, this.canvas.height, this.cellOfPixel);
    this.isStale.map = false;
  }

  #colourOfCells(palette) {
    const { doc, values } = this;
    if (!this.isStale.colours) return this.colourOfCell;
    this.isStale.colours = false;
    const colour = new Uint32Array(doc.barriers.length).fill(packed(palette.free));
    if (values) {
      const ramp = Uint32Array.from(palette.distance, packed), factor = 255 / Math.max(this.options.most, 1);
      const unreached = packed(this.options.growing ? palette.free : palette.unreached);
      for (let cell = 0; cell < colour.length; cell++) {
        const value = values[cell];
        colour[cell] = value === NOT_REACHED ? unreached : ramp[Math.min(255, (value * factor) | 0)];
      }
    }
    const barrier = packed(palette.barrier), destination = packed(palette.destination);
    for (let cell = 0; cell < colour.length; cell++) if (doc.barriers[cell]) colour[cell] = barrier;
    if (this.known) this.#fog(colour, palette);
    for (const cell of doc.destinations) colour[cell] = destination;
    return (this.colourOfCell = colour);
  }

  // What no robot has seen lies under fog; a field shines through it.
  #fog(colour, palette) {
    const { doc, known, values } = this, fog = packed(palette.fog), barrier = packed(palette.fog_barrier);
    for (let cell = 0; cell < colour.length; cell++) {
      if (!known[cell]) colour[cell] = doc.barriers[cell] ? barrier : values ? mix(colour[cell], fog, 150) : fog;
    }
  }

  #drawBase() {
    if (this.isStale.map) this.#map();
    const palette = this.palette(), colour = this.#colourOfCells(palette), page = packed(palette.page);
    const { base32, cellOfPixel, view, paperContext } = this;
    for (let p = 0; p < base32.length; p++) base32[p] = cellOfPixel[p] < 0 ? page : colour[cellOfPixel[p]];
    if (view.scale < 1 && !this.isRough) this.#darkenBarriers(palette);
    paperContext.putImageData(this.base, 0, 0);
    const cells = this.#visibleCells();
    if (cells && view.scale >= OUTLINES_FROM) this.#drawOutlines(cells);
    if (cells && this.values && view.scale >= ARROWS_FROM) this.#drawField(cells, palette);
    this.#drawDestinations(palette);
    if (this.track) this.#drawTrack();
    this.base.data.set(paperContext.getImageData(0, 0, this.canvas.width, this.canvas.height).data);
    this.isStale.base = false;
  }

  // Where several cells share a pixel, thin walls would come and go: tint by the share of barriers instead.
  #darkenBarriers(palette) {
    const { doc, view, canvas, base32 } = this;
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
  #visibleCells() {
    const { doc, view, canvas } = this;
    const [unitX] = shapeOf(doc).centre(1, 0), [firstX] = shapeOf(doc).centre(0, 0);
    const step = unitX - firstX, [, down] = shapeOf(doc).extent(1, 2), row = down - shapeOf(doc).extent(1, 1)[1];
    const x0 = Math.max(0, Math.floor(view.x(0) / step) - 2), x1 = Math.min(doc.width, Math.ceil(view.x(canvas.width) / step) + 2);
    const y0 = Math.max(0, Math.floor(view.y(0) / row) - 2), y1 = Math.min(doc.height, Math.ceil(view.y(canvas.height) / row) + 2);
    if ((x1 - x0) * (y1 - y0) > MOST_OUTLINED) return null;
    const cells = [];
    for (let y = y0; y < y1; y++) for (let x = x0; x < x1; x++) cells.push([x, y]);
    return cells;
  }

  #drawOutlines(cells) {
    const { doc, view, paperContext: c } = this;
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
    c.strokeStyle = this.options.dark ? "rgba(0,0,0,0.45)" : "rgba(60,64,72,0.28)";
    c.lineWidth = 1;
    c.stroke();
  }

  #drawField(cells, palette) {
    const { doc, view, values, directions, paperContext: c, options } = this;
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
      const [cx, cy] = this.pointOf(cell);
      if (hasArrows) this.#drawArrows(cell, x, y, cx, cy);
      if (hasNumbers && values[cell] > 0) c.fillText(String(values[cell]), cx, cy + (hasArrows ? view.scale * 0.25 : 0));
    }
  }

  #drawArrows(cell, x, y, cx, cy) {
    const { doc, view, directions, paperContext: c, options } = this;
    const orientation = shapeOf(doc).orientation(x, y), steps = options.steps[orientation];
    const up = options.numbers && view.scale >= NUMBERS_FROM ? -view.scale * 0.2 : 0;
    const length = view.scale * (up ? 0.2 : 0.34), head = Math.max(2.5, length * 0.34);
    c.lineWidth = Math.max(1, view.scale / 22);
    for (let k = 0; k < steps.length; k++) {
      if (!((directions[cell] >> k) & 1)) continue;
      const [tx, ty] = shapeOf(doc).centre(x + steps[k][0], y + steps[k][1]), [sx, sy] = shapeOf(doc).centre(x, y);
      const angle = Math.atan2(ty - sy, tx - sx), ex = cx + length * Math.cos(angle), ey = cy + up + length * Math.sin(angle);
      c.beginPath();
      c.moveTo(cx, cy + up);
      c.lineTo(ex, ey);
      c.moveTo(ex - head * Math.cos(angle - 0.5), ey - head * Math.sin(angle - 0.5));
      c.lineTo(ex, ey);
      c.lineTo(ex - head * Math.cos(angle + 0.5), ey - head * Math.sin(angle + 0.5));
      c.stroke();
    }
  }

  // A ring makes destinations visible at any zoom, unless they are many.
  #drawDestinations(palette) {
    const { doc, view, paperContext: c } = this;
    if (doc.destinations.length > 500) return;
    const radius = Math.max(5, view.scale * 0.36);
    for (const cell of doc.destinations) {
      const [px, py] = this.pointOf(cell);
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

  #drawTrack() {
    const { view, paperContext: c, track } = this;
    c.lineJoin = c.lineCap = "round";
    for (const [width, colour] of [[5, this.options.dark ? "#000" : "#fff"], [2.5, this.options.dark ? "#ffb000" : "#b3005e"]]) {
      c.beginPath();
      track.forEach((cell, k) => {
        const [px, py] = this.pointOf(cell);
        if (k) c.lineTo(px, py);
        else c.moveTo(px, py);
      });
      c.lineWidth = Math.max(width, view.scale * 0.04 * width);
      c.strokeStyle = colour;
      c.stroke();
    }
  }

  draw(fraction = 0) {
    if (!this.doc || !this.frame) return;
    if (this.isStale.base || this.isStale.map) this.#drawBase();
    this.frame32.set(this.base32);
    if (this.robots) plotRobots(this, fraction);
    this.context.putImageData(this.frame, 0, 0);
    drawMarks(this, fraction);
  }
}
