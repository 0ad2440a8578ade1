// Pane: one canvas, cells below, robots above.

import { NOT_REACHED, shapeOf, centreOf } from "./documents.js";
import { DARK, LIGHT, between, packed, mix } from "./colours.js";
import { darkenBarriers, drawGround } from "./ground.js";
import { drawMarks } from "./marks.js";
import { plotOwned } from "./owners.js";
import { plotRobots } from "./robots.js";
import { drawScaleBar } from "./scalebar.js";
import { drawUnderground } from "./underground.js";

// Where the cells are on a canvas: device pixels an edge step, and the north-west corner.
class View {
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
    this.layer = null; // a map over the cells: values, most; or null
    this.owns = false; // whether the cells that robots own are drawn
    this.directions = null;
    this.options = {}; // dark, growing, most (distance), arrows, numbers, steps (of directions)
    this.follow = -1;
    this.track = null; // cells of the followed robot
    this.paths = null; // cells of all robots, or null where they are not shown
    this.cursor = -1;
    this.known = null; // of each cell, whether a robot has seen it; null if all are known
    this.world = null; // of a run, in the step that is shown
    this.crosses = []; // cells where something was refused
    this.isStale = { map: true, base: true, colours: true };
    this.isRough = false; // while a hand moves the picture
    this.sprites = new Map();
    this.colouring = null; // the palette, and what it depends on
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

  // Take over what is drawn beside document and robots: fields of the constructor by their names.
  take(look) { Object.assign(this, look); }

  // The hand rests: draw as well as can be.
  settle() {
    if (!this.isRough) return;
    this.isRough = false;
    if (this.view.scale < 1) this.changed("map");
  }

  show(doc, robots) {
    const isNew = !this.doc || doc.width !== this.doc.width || doc.height !== this.doc.height ||
      doc.header.tessellation !== this.doc.header.tessellation;
    this.doc = doc;
    this.robots = robots;
    this.changed("base");
    if (!isNew) return;
    this.changed("map");
    this.fit();
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

  // The colours of now; a field is paler where there are robots to be seen on it.
  palette() {
    const { options: { dark }, robots } = this, isPale = robots?.count > 0, key = `${dark} ${isPale}`;
    if (this.colouring?.key === key) return this.colouring.palette;
    const plain = { ...this.colours, ...(dark ? DARK : LIGHT) }, { free } = plain;
    if (dark) plain.visits = [...plain.visits].reverse(); // what is most is always farthest from the ground
    const pale = (shade) => between(shade, free, dark ? 0.6 : 0.5);
    const palette = isPale ? { ...plain, distance: plain.distance.map(pale) } : plain;
    this.colouring = { key, palette };
    return palette;
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
    if (this.layer) this.#overlay(colour, palette);
    if (this.known) this.#fog(colour, palette);
    for (const cell of doc.destinations) colour[cell] = destination;
    return (this.colourOfCell = colour);
  }

  // A map tells nothing of cells where it is 0.
  #overlay(colour, palette) {
    const { values, most } = this.layer, ramp = Uint32Array.from(palette.visits, packed), factor = 255 / (most || 1);
    for (let cell = 0; cell < colour.length; cell++) {
      if (values[cell] > 0) colour[cell] = ramp[Math.min(255, Math.round(values[cell] * factor))];
    }
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
    if (this.doc.ground) drawUnderground(this, palette);
    else if (view.scale < 1 && !this.isRough) darkenBarriers(this, palette);
    paperContext.putImageData(this.base, 0, 0);
    drawGround(this, palette);
    this.base.data.set(paperContext.getImageData(0, 0, this.canvas.width, this.canvas.height).data);
    this.isStale.base = false;
  }

  draw(fraction = 0) {
    if (!this.doc || !this.frame) return;
    if (this.isStale.base || this.isStale.map) this.#drawBase();
    this.frame32.set(this.base32);
    if (this.owns && this.robots) plotOwned(this, fraction);
    if (this.robots) plotRobots(this, fraction);
    this.context.putImageData(this.frame, 0, 0);
    drawMarks(this, fraction);
    drawScaleBar(this);
  }
}
