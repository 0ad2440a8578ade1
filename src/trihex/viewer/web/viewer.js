// Viewer: areas, fields and plans on a canvas; the one module behind the server's page, the notebook and the HTML file.
// No framework, no build step, no request but to the host that the page came from.
//
// In this order: bundles, shapes of cells, documents, playback of plans, pane (one canvas), hosts, app (all the rest).
// A *cell* is y * width + x; a *site* is what plans count in (see `Layout` in tessellation.py). Lengths are in edge
// steps from the north-west corner; a pane's view turns them into device pixels: px = x * scale + left.

const NOT_REACHED = 2 ** 31 - 1;
const WAIT = 255, JUMP = 254;
const R3 = Math.sqrt(3);

// ---------------------------------------------------------------------------------------------------------- bundles

const TYPES = { u1: Uint8Array, u2: Uint16Array, i4: Int32Array, f8: Float64Array };
const MAGIC = [...new TextEncoder().encode("trihex1\n")];
const whole = (length) => Math.ceil(length / 8) * 8;

export function decode(bytes) {
  if (bytes.byteOffset % 8) bytes = bytes.slice();
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(8, true);
  const { header, arrays: kinds } = JSON.parse(new TextDecoder().decode(bytes.subarray(16, 16 + length)));
  const arrays = {};
  let at = bytes.byteOffset + 16 + whole(length);
  for (const [name, [type, size]] of Object.entries(kinds)) {
    arrays[name] = new TYPES[type](bytes.buffer, at, size);
    at += whole(size * arrays[name].BYTES_PER_ELEMENT);
  }
  return { header, arrays };
}

export function encode(header, arrays = {}) {
  const kinds = {};
  let total = 0;
  for (const [name, array] of Object.entries(arrays)) {
    const type = Object.keys(TYPES).find((key) => array instanceof TYPES[key]);
    kinds[name] = [type, array.length];
    total += whole(array.byteLength);
  }
  const text = new TextEncoder().encode(JSON.stringify({ header, arrays: kinds }));
  const bytes = new Uint8Array(16 + whole(text.length) + total);
  bytes.set(MAGIC);
  new DataView(bytes.buffer).setUint32(8, text.length, true);
  bytes.set(text, 16);
  let at = 16 + whole(text.length);
  for (const array of Object.values(arrays)) {
    bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
    at += whole(array.byteLength);
  }
  return bytes;
}

// ------------------------------------------------------------------------------------------------- shapes of cells
// The same geometry as tessellation.py: `fill` writes the cell of every pixel, -1 outside of the area.

const SHAPES = {
  square: {
    centre: (x, y) => [x + 0.5, y + 0.5],
    extent: (width, height) => [width, height],
    orientation: () => 0,
    corners: () => [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]],
    fill(area, view, w, h, out) {
      const column = Int32Array.from({ length: w }, (_, i) => inRange(Math.floor(view.x(i + 0.5)), area.width));
      for (let j = 0, p = 0; j < h; j++) {
        const y = inRange(Math.floor(view.y(j + 0.5)), area.height);
        for (let i = 0; i < w; i++, p++) out[p] = y < 0 || column[i] < 0 ? -1 : y * area.width + column[i];
      }
    },
  },
  hexagonal: {
    centre: (x, y) => [(1.5 * x + 1) / R3, y + 0.5 + 0.5 * (x & 1)],
    extent: (width, height) => [(1.5 * width + 0.5) / R3, height + (width > 1 ? 0.5 : 0)],
    orientation: (x) => x & 1,
    corners: () => [[-0.5, -0.5], [0.5, -0.5], [1, 0], [0.5, 0.5], [-0.5, 0.5], [-1, 0]].map(([x, y]) => [x / R3, y]),
    // A pixel belongs to the hexagon of the nearest centre, one of four: two columns, a row in each.
    fill(area, view, w, h, out) {
      const first = new Int32Array(w), before = new Float64Array(w), after = new Float64Array(w);
      for (let i = 0; i < w; i++) {
        const px = view.x(i + 0.5);
        first[i] = Math.floor((px * R3 - 1) / 1.5);
        before[i] = (px - (1.5 * first[i] + 1) / R3) ** 2;
        after[i] = (px - (1.5 * (first[i] + 1) + 1) / R3) ** 2;
      }
      for (let j = 0, p = 0; j < h; j++) {
        const py = view.y(j + 0.5);
        const even = Math.round(py - 0.5), odd = Math.round(py - 1);
        const toEven = (py - 0.5 - even) ** 2, toOdd = (py - 1 - odd) ** 2;
        for (let i = 0; i < w; i++, p++) {
          let x = first[i];
          if (x & 1 ? after[i] + toEven < before[i] + toOdd : after[i] + toOdd < before[i] + toEven) x++;
          const y = x & 1 ? odd : even;
          out[p] = x < 0 || y < 0 || x >= area.width || y >= area.height ? -1 : y * area.width + x;
        }
      }
    },
  },
  triangular: {
    centre: (x, y) => [((x + 1) * R3) / 2, 1.5 * y + 1 - 0.5 * ((x + y) & 1)],
    extent: (width, height) => [((width + 1) * R3) / 2, 1.5 * height],
    orientation: (x, y) => (x + y) & 1,
    corners: (o) => {
      const f = 1 - 2 * o, half = (R3 / 2) * f;
      return [[0, -f], [half, 0.5 * f], [-half, 0.5 * f]];
    },
    // Slanted edges of a row are across - depth = first + 2 i and across + depth = first + 2 i.
    fill(area, view, w, h, out) {
      const across = Float64Array.from({ length: w }, (_, i) => (view.x(i + 0.5) * 2) / R3);
      for (let j = 0, p = 0; j < h; j++) {
        const py = view.y(j + 0.5) / 1.5, y = Math.floor(py), depth = py - y, first = (y + 1) & 1;
        const isRow = y >= 0 && y < area.height;
        for (let i = 0; i < w; i++, p++) {
          const a = across[i] - first;
          const x = Math.floor((a - depth) / 2) + Math.floor((a + depth) / 2) + first;
          out[p] = !isRow || x < 0 || x >= area.width ? -1 : y * area.width + x;
        }
      }
    },
  },
};
const inRange = (i, count) => (i >= 0 && i < count ? i : -1);

// -------------------------------------------------------------------------------------------------------- documents
// A document is never changed: an edit makes another one that shares what is the same.

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

const without = (cells, gone) => cells.filter((cell) => !gone.has(cell));
const plus = (cells, more) => Int32Array.from([...cells, ...more]);
const shapeOf = (doc) => SHAPES[doc.header.tessellation];
const centreOf = (doc, cell) => shapeOf(doc).centre(cell % doc.width, Math.floor(cell / doc.width));

// --------------------------------------------------------------------------------------------------------- playback

const HIDDEN = 0, MOVING = 1, WAITING = 2, FINAL = 3, STRANDED = 4;

// Where the robots of a document stand before there is a plan.
class Still {
  constructor(doc, distance) {
    const n = doc.robots.length;
    this.steps = 0;
    this.count = n;
    this.x0 = new Float32Array(n);
    this.y0 = new Float32Array(n);
    this.state = new Uint8Array(n).fill(MOVING);
    for (let r = 0; r < n; r++) {
      [this.x0[r], this.y0[r]] = centreOf(doc, doc.robots[r]);
      if (distance && distance[doc.robots[r]] === NOT_REACHED) this.state[r] = STRANDED;
    }
    this.x1 = this.x0;
    this.y1 = this.y0;
  }
  seek() {}
}

// Robots of a plan between `step` and the next: from (x0, y0) to (x1, y1), and the set that each belongs to.
export class Playback {
  constructor({ header, arrays }, doc) {
    Object.assign(this, { header, doc, steps: header.steps, count: doc.robots.length });
    this.actions = arrays.actions;
    this.first = arrays.first_action;
    this.hasArrived = arrays.has_arrived;
    this.jumpAt = arrays.jump_at;
    this.jumpTo = arrays.jump_to;
    this.curves = {};
    for (const name of ["moving", "waiting", "arrived", "spent", "least_total"]) this.curves[name] = arrays[`${name}_by_step`];
    this.distance = arrays.distance;
    const { origin, pitch, offsets } = header.layout;
    this.offsets = offsets.map((row) => Int32Array.from(row));
    const start = Int32Array.from(doc.robots, (cell) => origin + Math.floor(cell / doc.width) * pitch + (cell % doc.width));
    // Every so many steps one is kept: as many as fit into some 64 MB.
    this.every = Math.max(32, Math.ceil((this.steps * this.count) / 2 ** 24));
    this.kept = [start];
    this.site = start.slice();
    this.next = new Int32Array(this.count);
    for (const name of ["x0", "y0", "x1", "y1"]) this[name] = new Float32Array(this.count);
    this.state = new Uint8Array(this.count);
    this.step = 0;
    this.#locate(this.site, this.x0, this.y0);
    this.#lookAhead();
  }

  seek(step) {
    step = Math.max(0, Math.min(step, this.steps));
    if (step === this.step) return;
    const isNext = this.step + 1 === step;
    if (step < this.step || step - this.step > this.every) {
      const near = Math.min(Math.floor(step / this.every), this.kept.length - 1);
      if (step < this.step || near * this.every > this.step) {
        this.step = near * this.every;
        this.site.set(this.kept[near]);
        this.#advance(this.site, this.step, this.next);
      }
    }
    while (this.step < step) {
      [this.site, this.next] = [this.next, this.site];
      this.step++;
      if (this.step % this.every === 0 && this.kept.length === this.step / this.every) this.kept.push(this.site.slice());
      if (this.step < step) this.#advance(this.site, this.step, this.next);
    }
    if (isNext) [this.x0, this.y0, this.x1, this.y1] = [this.x1, this.y1, this.x0, this.y0];
    else this.#locate(this.site, this.x0, this.y0);
    this.#lookAhead();
  }

  #lookAhead() {
    this.#advance(this.site, this.step, this.next);
    this.#locate(this.next, this.x1, this.y1);
    const { first, actions, hasArrived, state, step } = this;
    for (let r = 0; r < this.count; r++) {
      const length = first[r + 1] - first[r];
      if (length <= step) state[r] = hasArrived[r] ? HIDDEN : STRANDED;
      else if (hasArrived[r] && length === step + 1) state[r] = FINAL;
      else state[r] = actions[first[r] + step] === WAIT ? WAITING : MOVING;
    }
  }

  #advance(site, step, out) {
    const { first, actions, offsets } = this;
    const [even, odd] = offsets;
    for (let r = 0; r < this.count; r++) {
      const i = first[r] + step, at = site[r];
      if (i >= first[r + 1]) out[r] = at;
      else if (actions[i] < JUMP) out[r] = at + (at & 1 ? odd : even)[actions[i]];
      else out[r] = actions[i] === WAIT ? at : this.jumpTo[this.#jumpOf(i)];
    }
  }

  #jumpOf(i) {
    let low = 0, high = this.jumpAt.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.jumpAt[middle] < i) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  #locate(site, x, y) {
    const { origin, pitch } = this.header.layout;
    const shape = this.doc.header.tessellation;
    for (let r = 0; r < this.count; r++) {
      const cy = ((site[r] - origin) / pitch) | 0, cx = site[r] - origin - cy * pitch;
      if (shape === "hexagonal") {
        x[r] = (1.5 * cx + 1) / R3;
        y[r] = cy + 0.5 + 0.5 * (cx & 1);
      } else if (shape === "triangular") {
        x[r] = ((cx + 1) * R3) / 2;
        y[r] = 1.5 * cy + 1 - 0.5 * ((cx + cy) & 1);
      } else {
        x[r] = cx + 0.5;
        y[r] = cy + 0.5;
      }
    }
  }

  // Cells and times of one robot, from its start to its last action.
  robot(r) {
    const { origin, pitch, costs, names } = this.header.layout;
    const wait = this.header.summary.waiting_cost;
    const cellOf = (site) => {
      const y = Math.floor((site - origin) / pitch);
      return y * this.doc.width + (site - origin - y * pitch);
    };
    let site = this.kept[0][r], d = 0, w = 0;
    const rows = [{ cell: cellOf(site), d, w, action: "start" }];
    for (let i = this.first[r]; i < this.first[r + 1]; i++) {
      const action = this.actions[i], parity = site & 1;
      if (action === WAIT) w += wait;
      else if (action === JUMP) site = this.jumpTo[this.#jumpOf(i)];
      else {
        d += costs[action];
        site += this.offsets[parity][action];
      }
      const name = action === WAIT ? "wait" : action === JUMP ? "jump" : names[parity][action];
      rows.push({ cell: cellOf(site), d, w, action: name });
    }
    return { rows, hasArrived: !!this.hasArrived[r] };
  }
}

// ------------------------------------------------------------------------------------------------------------- pane

const DARK = { free: [43, 47, 54], barrier: [146, 152, 162], unreached: [84, 82, 90], moving: [86, 180, 233], stranded: [250, 250, 250], page: [24, 26, 30] };
const LIGHT = { page: [233, 234, 236] };
const OUTLINES_FROM = 9, ARROWS_FROM = 15, NUMBERS_FROM = 25; // device pixels an edge step
const MOST_OUTLINED = 14000;

const packed = ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r;
const css = ([r, g, b], a = 1) => `rgba(${r},${g},${b},${a})`;
const isLight = ([r, g, b]) => 0.299 * r + 0.587 * g + 0.114 * b > 140;

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
    this.directions = null;
    this.options = {};
    this.follow = -1;
    this.track = null; // cells of the followed robot
    this.cursor = -1;
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
    for (const cell of doc.destinations) colour[cell] = destination;
    return (this.colourOfCell = colour);
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
    if (this.robots) this.#plotRobots(fraction);
    this.context.putImageData(this.frame, 0, 0);
    this.#drawMarks(fraction);
  }

  #plotRobots(fraction) {
    const { robots, view, frame32, canvas } = this;
    const { width, height } = canvas, { x0, y0, x1, y1, state } = robots;
    const palette = this.palette();
    const colours = [null, palette.moving, palette.waiting, palette.final, palette.stranded];
    const radius = Math.max(1, view.scale * (this.doc.header.tessellation === "triangular" ? 0.3 : 0.36));
    if (radius < 2) {
      const side = radius < 1.3 ? 2 : 3, flat = colours.map((colour) => (colour ? packed(colour) : 0));
      const { scale } = view, shiftX = view.left - side / 2 + 0.5, shiftY = view.top - side / 2 + 0.5;
      const right = width - side - 1, bottom = height - side - 1, { count } = robots;
      const place = (r) => {
        const px = (x0[r] + (x1[r] - x0[r]) * fraction) * scale + shiftX, py = (y0[r] + (y1[r] - y0[r]) * fraction) * scale + shiftY;
        return px >= 1 && py >= 1 && px < right && py < bottom ? (py | 0) * width + (px | 0) : -1;
      };
      if (this.values) { // on the blues of a field the dots need a rim
        const rim = packed(this.options.dark ? [12, 12, 14] : [255, 255, 255]);
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
      stamp(frame32, width, height, i, j, this.#sprite(colours[state[r]], radius, (px - i) * 4 | 0, (py - j) * 4 | 0));
    }
  }

  // A disc with a rim, as pixels (dx, dy), colour and opacity, for a quarter of a pixel each way.
  #sprite(colour, radius, qx, qy) {
    const key = `${colour} ${radius.toFixed(2)} ${qx} ${qy} ${this.options.dark}`;
    const known = this.sprites.get(key);
    if (known) return known;
    if (this.sprites.size > 400) this.sprites.clear();
    const rim = packed(this.options.dark ? [12, 12, 14] : [255, 255, 255]), fill = packed(colour);
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
    this.sprites.set(key, sprite);
    return sprite;
  }

  // What must stay above the robots: numbers of robots, the halo of the followed one, the cell of the keyboard.
  #drawMarks(fraction) {
    const { context: c, view, robots, canvas } = this;
    const place = (r) => [
      (robots.x0[r] + (robots.x1[r] - robots.x0[r]) * fraction) * view.scale + view.left,
      (robots.y0[r] + (robots.y1[r] - robots.y0[r]) * fraction) * view.scale + view.top,
    ];
    if (robots && view.scale >= 24 && robots.count <= 3000) {
      const palette = this.palette(), colours = [null, palette.moving, palette.waiting, palette.final, palette.stranded];
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
    if (robots && this.follow >= 0 && this.follow < robots.count && robots.state[this.follow] !== HIDDEN) {
      const [px, py] = place(this.follow), radius = Math.max(8, view.scale * 0.5);
      for (const [width, colour] of [[5, "#000"], [2.5, "#ffe600"]]) {
        c.beginPath();
        c.arc(px, py, radius, 0, 2 * Math.PI);
        c.lineWidth = width;
        c.strokeStyle = colour;
        c.stroke();
      }
    }
    if (this.cursor >= 0 && this.cursor < this.doc.barriers.length) {
      const x = this.cursor % this.doc.width, y = Math.floor(this.cursor / this.doc.width);
      const [px, py] = this.pointOf(this.cursor);
      for (const [width, colour] of [[4, "#000"], [2, "#ffe600"]]) {
        c.beginPath();
        for (const [dx, dy] of shapeOf(this.doc).corners(shapeOf(this.doc).orientation(x, y))) c.lineTo(px + dx * view.scale, py + dy * view.scale);
        c.closePath();
        c.lineWidth = width;
        c.strokeStyle = colour;
        c.stroke();
      }
    }
  }
}

// Mix two packed colours; share 0..255 of the second.
function mix(one, other, share) {
  const keep = 255 - share;
  const r = ((one & 255) * keep + (other & 255) * share) / 255;
  const g = (((one >> 8) & 255) * keep + ((other >> 8) & 255) * share) / 255;
  const b = (((one >> 16) & 255) * keep + ((other >> 16) & 255) * share) / 255;
  return ((255 << 24) | (Math.round(b) << 16) | (Math.round(g) << 8) | Math.round(r)) >>> 0;
}

function stamp(pixels, width, height, i, j, sprite) {
  const { dx, dy, value, opacity, reach } = sprite;
  const isInside = i >= reach && j >= reach && i + reach < width && j + reach < height;
  for (let k = 0; k < dx.length; k++) {
    const x = i + dx[k], y = j + dy[k];
    if (!isInside && (x < 0 || y < 0 || x >= width || y >= height)) continue;
    const p = y * width + x;
    pixels[p] = opacity[k] === 255 ? value[k] : mix(pixels[p], value[k], opacity[k]);
  }
}

// ------------------------------------------------------------------------------------------------------------ hosts
// A host answers `ask(header, arrays, {signal, onFrame})` with the last frame of the answer; without one the page only
// plays what it holds.

class HttpHost {
  async ask(header, arrays, { signal, onFrame } = {}) {
    const response = await fetch("ask", { method: "POST", body: encode(header, arrays), signal, headers: { "Content-Type": "application/octet-stream" } });
    if (!response.ok) throw new Error(await response.text());
    const reader = response.body.getReader();
    let chunks = [], size = 0;
    const take = async (count) => {
      while (size < count) {
        const { done, value } = await reader.read();
        if (done) throw new Error("the server stopped answering; is it still running?");
        chunks.push(value);
        size += value.length;
      }
      const all = new Uint8Array(size);
      let at = 0;
      for (const chunk of chunks) {
        all.set(chunk, at);
        at += chunk.length;
      }
      chunks = [all.subarray(count)];
      size -= count;
      return all.slice(0, count);
    };
    for (;;) {
      const length = new DataView((await take(4)).buffer).getUint32(0, true);
      const frame = finished(decode(await take(length)), onFrame);
      if (frame) return frame;
    }
  }
}

class ModelHost {
  constructor(model) {
    this.model = model;
    this.waiting = new Map();
    this.last = 0;
    model.on("msg:custom", (message, buffers) => {
      const call = this.waiting.get(message.id);
      if (call) call(new Uint8Array(buffers[0].buffer, buffers[0].byteOffset, buffers[0].byteLength));
    });
  }
  ask(header, arrays, { signal, onFrame } = {}) {
    const id = `${Date.now()}-${++this.last}`;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, (bytes) => {
        try {
          const frame = finished(decode(bytes), onFrame);
          if (frame) resolve(frame);
          else return;
        } catch (error) {
          reject(error);
        }
        this.waiting.delete(id);
      });
      signal?.addEventListener("abort", () => this.model.send({ id, cancel: true }));
      this.model.send({ id }, undefined, [encode(header, arrays).buffer]);
    });
  }
}

function finished(frame, onFrame) {
  const { kind } = frame.header;
  if (kind === "result") return frame;
  if (kind === "error") throw new Error(frame.header.message);
  if (kind === "cancelled") throw new DOMException("cancelled", "AbortError");
  onFrame?.(frame);
  return null;
}

// -------------------------------------------------------------------------------------------------------------- app

function h(tag, properties = {}, ...children) {
  const element = tag === "svg" || tag === "polyline" || tag === "line" || tag === "path"
    ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "value") element.value = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(3).filter((child) => child !== null && child !== undefined));
  return element;
}

const TOOLS = [
  ["move", "Move", "V", "Drag a robot or a destination to another cell; drag the ground to move the picture; click a robot to follow it.", "M9 3v12M3 9h12M9 3l-2 2M9 3l2 2M9 15l-2-2M9 15l2-2M3 9l2-2M3 9l2 2M15 9l-2-2M15 9l-2 2"],
  ["wall", "Wall", "W", "Paint barriers.", "M2 4h14v4H2zM2 8h14v4H2zM7 4v4M12 8v4M6 8v4M10 12v3H2v-3M10 12h6v3h-6"],
  ["erase", "Erase", "E", "Remove barriers, robots and destinations.", "M7 15h9M3 11l7-7 5 5-6 6H6z"],
  ["destination", "Destination", "D", "Click a cell to set a destination there, or to take it away.", "M9 16s-5-5-5-9a5 5 0 0 1 10 0c0 4-5 9-5 9zM9 7.5v-.1"],
  ["robot", "Robot", "R", "Click free cells to place robots, or to take them away.", "M4 9a5 5 0 1 0 10 0a5 5 0 1 0-10 0M7 8v1M11 8v1"],
];
const SPEEDS = [0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];
const EXPORT_WORDS = {
  scenario: "Scenario: area, destinations, robots, rules", area: "Area: barriers only", field: "Field: the distance of each cell", starts: "Starts: cells of the robots",
  plan: "Plan: what each robot does at each step", page: "Page: one HTML file that plays anywhere, to share; both plans if there are two",
  movie: "Movie", picture: "Picture", waypoints: "Waypoints in metres", summary: "Summary: the numbers of the plan",
};
const number = (value) => (value === null || value === undefined ? "–" : Math.round(value).toLocaleString("en").replace(/,/g, " "));
const percent = (value) => (value === null || value === undefined ? "–" : `${(100 * value).toFixed(value < 0.1 ? 2 : 1)} %`);
const plural = (count, one) => `${number(count)} ${one}${count === 1 ? "" : "s"}`;
const title = (word) => word[0].toUpperCase() + word.slice(1);

export class App {
  constructor(root, settings, host, first) {
    Object.assign(this, { root, settings, host });
    this.doc = null;
    this.runs = [null, null];
    this.past = [];
    this.future = [];
    this.tool = host ? "wall" : "move";
    this.clock = 0;
    this.isPlaying = false;
    this.follow = -1;
    this.fields = null; // { doc, distance, directions }
    this.growth = null; // { doc, values, counts, cells, changes, ends, generation, isComplete, isPlaying }
    this.job = null;
    this.pointers = new Map();
    this.stroke = null;
    this.theme = stored("trihex-theme") ?? "auto";
    this.listeners = new AbortController();
    this.build();
    this.panes = [new Pane(this.canvases[0], settings.colours), new Pane(this.canvases[1], settings.colours)];
    new ResizeObserver(() => this.resize()).observe(this.stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.applyTheme(), { signal: this.listeners.signal });
    this.applyTheme();
    this.choose(this.tool);
    if (first) this.take(first);
    else this.generate({ generator: "rooms", tessellation: "hexagonal", height: 32, width: 48, seed: 1 }, true);
  }

  close() {
    this.listeners.abort();
    this.isClosed = true;
  }

  // ---- what the page is made of

  build() {
    const { settings } = this, can = !!this.host;
    const button = (text, onclick, more = {}) => h("button", { type: "button", onclick, ...more }, text);
    const icon = (path) => {
      const svg = h("svg", { viewBox: "0 0 18 18", "aria-hidden": "true", class: "icon" });
      svg.append(h("path", { d: path }));
      return svg;
    };
    const select = (label, names, onchange, more = {}) =>
      h("label", { class: "field" }, h("span", {}, label), h("select", { onchange, "aria-label": label, ...more }, names.map((name) => h("option", { value: name }, title(name)))));
    const numberField = (label, value, more = {}) =>
      h("label", { class: "field" }, h("span", {}, label), h("input", { type: "number", value, "aria-label": label, ...more }));
    this.parts = { button, select, numberField };

    this.undoButton = button("Undo", () => this.undo(), { title: "Ctrl+Z" });
    this.redoButton = button("Redo", () => this.redo(), { title: "Ctrl+Shift+Z" });
    this.themeButton = button("Theme", () => this.nextTheme());
    const files = [
      button("New…", () => this.newDialog(), { title: "Make an area" }), button("Open…", () => this.openDialog(), { title: "Ctrl+O" }),
      button("Save…", () => this.saveDialog(), { title: "Ctrl+S" }), this.undoButton, this.redoButton,
    ];
    const bar = h("header", { class: "bar" }, h("strong", { class: "brand" }, "trihex"), can ? files : null,
      (this.nameOfArea = h("span", { class: "name" })), this.themeButton, button("Help", () => this.helpDialog(), { title: "?" }));

    this.toolButtons = Object.fromEntries(TOOLS.map(([name, label, key, hint, path]) => {
      const element = button(icon(path), () => this.choose(name), { title: `${label} (${key}): ${hint}`, "aria-label": label, "aria-pressed": "false", "data-tool": name });
      element.append(h("span", {}, label));
      return [name, element];
    }));
    this.brush = h("input", { type: "range", min: 1, max: 9, step: 2, value: 1, "aria-label": "Width of the brush in cells", title: "Width of the brush" });
    const tools = h("div", { class: "tools", role: "toolbar", "aria-label": "Tools" }, Object.values(this.toolButtons), h("label", { class: "brush" }, h("span", {}, "Brush"), this.brush));

    this.canvases = [0, 1].map((i) => h("canvas", { tabindex: "0", role: "application", "aria-describedby": "trihex-readout", "aria-label": "Picture", "data-pane": i }));
    this.captions = [0, 1].map(() => h("div", { class: "caption" }));
    this.paneElements = [0, 1].map((i) => h("div", { class: "pane" }, this.canvases[i], this.captions[i]));
    this.paneElements[1].hidden = true;
    this.legend = h("div", { class: "legend", "aria-label": "Legend" });
    const zoom = h("div", { class: "zoom" }, button("+", () => this.zoom(1.4), { "aria-label": "Zoom in" }),
      button("−", () => this.zoom(1 / 1.4), { "aria-label": "Zoom out" }), button("Fit", () => this.fit(), { "aria-label": "Show all" }));
    this.stage = h("div", { class: "panes" }, this.paneElements);
    this.status = h("div", { class: "status", role: "status" });
    this.readout = h("div", { class: "readout", id: "trihex-readout", "aria-live": "polite" });
    const stage = h("section", { class: "stage", "aria-label": "Picture" }, this.status, h("div", { class: "view" }, this.stage), h("div", { class: "under" }, this.readout, this.legend, zoom), this.buildTransport());
    this.panel = h("aside", { class: "panel", "aria-label": "Controls" }, this.buildPanel(can));
    const main = h("main", { class: can ? "main" : "main alone" }, can ? tools : null, stage, this.panel);
    this.dialog = h("dialog", { class: "dialog" });
    this.root.replaceChildren(h("div", { class: "trihex" }, bar, main, this.dialog));
    this.shell = this.root.firstChild;
    this.listen();
    this.setSpeed(6);
  }

  buildTransport() {
    const { button } = this.parts;
    this.playButton = button("Play", () => this.togglePlay(), { class: "primary play", title: "Space" });
    this.scrubber = h("input", { type: "range", min: 0, max: 0, value: 0, step: "any", class: "scrub", "aria-label": "Step", oninput: () => this.seek(Number(this.scrubber.value)) });
    this.clockText = h("output", { class: "clock" });
    this.speed = h("input", { type: "range", min: 0, max: SPEEDS.length - 1, value: 5, "aria-label": "Steps per second", oninput: () => this.setSpeed(SPEEDS[this.speed.value]) });
    this.speedText = h("span", { class: "unit" });
    return h("div", { class: "transport", role: "group", "aria-label": "Playback" },
      button("|‹", () => this.seek(0), { "aria-label": "To the start", title: "Home" }), button("‹", () => this.seek(Math.ceil(this.clock) - 1), { "aria-label": "Step back", title: "," }),
      this.playButton, button("›", () => this.seek(Math.floor(this.clock) + 1), { "aria-label": "Step forward", title: "." }),
      button("›|", () => this.seek(this.steps), { "aria-label": "To the end", title: "End" }),
      this.scrubber, this.clockText, h("label", { class: "speed" }, h("span", {}, "Speed"), this.speed, this.speedText));
  }

  buildPanel(can) {
    const { settings } = this, { button, select, numberField } = this.parts;
    const section = (name, open, ...children) => h("details", { open, "data-section": name }, h("summary", {}, name), h("div", { class: "content" }, children));
    const parts = [];
    if (can) {
      this.tessellation = h("div", { class: "choice", role: "radiogroup", "aria-label": "Tessellation" }, settings.tessellations.map((name) =>
        h("label", {}, h("input", { type: "radio", name: "trihex-tessellation", value: name, onchange: () => this.retile({ tessellation: name }) }), title(name))));
      this.rules = {
        neighbourhood: select("Neighbours", settings.neighbourhoods, (e) => this.retile({ neighbourhood: e.target.value })),
        costs: select("Costs", settings.costs, (e) => this.retile({ costs: e.target.value })),
        corners: select("Corners", settings.corners, (e) => this.rule("corners", e.target.value)),
        crossing: select("Crossing", settings.crossings, (e) => this.rule("crossing", e.target.value)),
        waiting_cost: numberField("Waiting cost w_t", "", { min: 0, placeholder: "one edge", onchange: (e) => this.rule("waiting_cost", wholeOf(e.target)) }),
        destination_capacity: numberField("Arrivals per step and destination", "", { min: 1, placeholder: "any", onchange: (e) => this.rule("destination_capacity", wholeOf(e.target)) }),
      };
      parts.push(section("Cells and rules", true, this.tessellation, h("details", { class: "inner" }, h("summary", {}, "Rules"), h("div", { class: "grid" }, Object.values(this.rules)))));
      this.count = numberField("Robots", 60, { min: 0, max: 2097152 });
      this.seed = numberField("Seed", 1, { min: 0 });
      parts.push(section("Robots", true, h("div", { class: "row" }, this.count, this.seed, button("Scatter", () => this.scatter())),
        (this.countText = h("p", { class: "note" }))));
    }
    const toggle = (name, text, value) => h("label", { class: "check" }, (this[name] = h("input", { type: "checkbox", checked: value, onchange: () => this.fieldChanged() })), text);
    this.generationText = h("output", { class: "note" });
    this.generation = h("input", { type: "range", min: 0, max: 0, value: 0, "aria-label": "Generation", oninput: () => this.setGeneration(Number(this.generation.value)) });
    this.growButton = button("Grow the field", () => this.grow());
    parts.push(section("Distance field", true, h("div", { class: "row" }, toggle("showField", "Colours", false), can ? toggle("showArrows", "Arrows", false) : null, toggle("showNumbers", "Numbers", false)),
      can ? [h("div", { class: "row" }, this.growButton, button("‹", () => this.setGeneration(this.growth ? this.growth.generation - 1 : 0), { "aria-label": "Previous generation" }),
        button("›", () => this.nextGeneration(), { "aria-label": "Next generation" }), this.generation), this.generationText,
      h("p", { class: "note" }, "Arrows and numbers appear when cells are large: zoom in.")] : null));
    if (can) {
      const planners = Object.keys(settings.planners);
      this.planner = select("Planner", planners, () => this.showOptions());
      this.planner.lastChild.value = planners.includes("fcost") ? "fcost" : planners[0];
      this.planButton = button("Plan", () => this.plan(0), { class: "primary", title: "P" });
      this.plannerOptions = h("details", { class: "inner" }, h("summary", {}, "Options of the planner"), h("div", { class: "grid" }));
      this.otherPlanner = select("Beside it", planners, () => {}, { "aria-label": "Planner beside it" });
      this.otherPlanner.lastChild.value = planners.includes("optimal") ? "optimal" : "greedy";
      this.otherCells = select("on", ["the same cells", ...settings.tessellations], () => {}, { "aria-label": "Cells beside it" });
      this.compareButton = button("Compare", () => this.plan(1));
      this.endCompareButton = button("One picture", () => this.endCompare(), { hidden: true });
      this.progress = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
      this.progressText = h("span", { class: "note" });
      this.progressRow = h("div", { class: "row working", hidden: true }, this.progress, this.progressText, button("Cancel", () => this.cancel(), { title: "Escape" }));
      this.showOptions();
      parts.push(section("Plan", true, h("div", { class: "row" }, this.planner, this.planButton), this.plannerOptions,
        h("div", { class: "grid" }, this.otherPlanner, this.otherCells), h("div", { class: "row" }, this.compareButton, this.endCompareButton), this.progressRow));
    }
    this.results = h("div", { class: "results" });
    this.sofar = h("p", { class: "note sofar" });
    this.chart = h("div", { class: "chart" });
    this.sets = h("div", { class: "sets", "aria-label": "Robots by set" });
    parts.push(section("Result", true, this.results, this.sets, this.sofar, this.chart));
    this.robotNumber = h("input", { type: "number", min: 0, "aria-label": "Number of the robot to follow", placeholder: "number", onchange: (e) => this.followRobot(e.target.value === "" ? -1 : Number(e.target.value)) });
    this.robotText = h("div", { class: "robot" });
    this.centred = h("input", { type: "checkbox" });
    parts.push(section("One robot", true, h("div", { class: "row" }, h("label", { class: "field" }, h("span", {}, "Follow robot"), this.robotNumber), button("None", () => this.followRobot(-1)),
      h("label", { class: "check" }, this.centred, "keep it in view")), this.robotText));
    return parts;
  }

  showOptions() {
    const options = this.settings.planners[this.planner.lastChild.value], grid = this.plannerOptions.lastChild;
    this.plannerOptions.hidden = !Object.keys(options).length;
    grid.replaceChildren(...Object.entries(options).map(([name, value]) => h("label", { class: "field" }, h("span", {}, name.replace(/_/g, " ")),
      typeof value === "boolean" ? h("input", { type: "checkbox", checked: value, "data-option": name }) :
        h("input", { type: typeof value === "number" ? "number" : "text", step: "any", value: value ?? "", placeholder: "default", "data-option": name }))));
  }

  chosenOptions(planner) {
    if (planner !== this.planner.lastChild.value) return {};
    const options = {}, defaults = this.settings.planners[planner];
    for (const input of this.plannerOptions.querySelectorAll("[data-option]")) {
      const name = input.dataset.option, text = input.value.trim();
      const value = input.type === "checkbox" ? input.checked : text === "" ? defaults[name] : isNaN(Number(text)) ? text : Number(text);
      if (value !== defaults[name]) options[name] = value;
    }
    return options;
  }

  listen() {
    for (const canvas of this.canvases) {
      const pane = Number(canvas.dataset.pane);
      const on = (name, does) => canvas.addEventListener(name, (event) => does.call(this, event, pane), { passive: false });
      on("pointerdown", this.pointerDown);
      on("pointermove", this.pointerMove);
      on("pointerup", this.pointerUp);
      on("pointercancel", this.pointerUp);
      on("pointerleave", (event) => { if (!this.pointers.size) this.readCell(pane, -1); });
      on("wheel", this.wheel);
      on("contextmenu", (event) => event.preventDefault());
      on("keydown", this.canvasKey);
      on("blur", () => { this.setCursor(-1); });
    }
    this.shell.addEventListener("keydown", (event) => this.key(event));
    if (this.settings.host !== "notebook") document.addEventListener("keydown", (event) => { if (!this.shell.contains(event.target)) this.key(event); }, { signal: this.listeners.signal });
    this.shell.addEventListener("dragover", (event) => event.preventDefault());
    this.shell.addEventListener("drop", (event) => {
      event.preventDefault();
      if (this.host && event.dataTransfer.files[0]) this.openFile(event.dataTransfer.files[0]);
    });
  }

  // ---- the document and its history

  get steps() { return Math.max(0, ...this.runs.map((run) => (run ? run.playback.steps : 0))); }

  // Take an answer of the host: a document, and the plan for it if there is one.
  take({ header, arrays }, { isEdit = true } = {}) {
    const doc = documentOf(header.document, arrays);
    const run = header.summary ? { ...header, playback: new Playback({ header, arrays }, doc), doc } : null;
    // A file may hold the plan beside it as well.
    const beside = arrays.beside ? runOf(decode(arrays.beside.slice())) : null;
    if (header.planner && this.planner && this.settings.planners[header.planner]) this.planner.lastChild.value = header.planner;
    if (isEdit) this.edit(doc, [run, beside]);
    else this.set(doc, [run, beside]);
    if (run) {
      this.choose("move");
      this.say("Press Play.");
      this.bound();
    }
  }

  edit(doc, runs = [null, null]) {
    if (this.doc) {
      this.past.push({ doc: this.doc, runs: this.runs });
      let bytes = 0, count = 0; // what the past may hold
      for (let i = this.past.length - 1; i >= 0 && bytes < 2 ** 28 && count < 300; i--, count++) bytes += this.past[i].doc.barriers.length;
      this.past = this.past.slice(this.past.length - count);
    }
    this.future = [];
    this.set(doc, runs);
  }

  set(doc, runs) {
    const isSame = this.doc && doc.barriers === this.doc.barriers;
    this.doc = doc;
    this.runs = runs;
    if (runs[0]) this.fields = { doc, distance: runs[0].playback.distance, directions: null };
    else if (!this.fields || !sameField(this.fields.doc, doc)) this.fields = null;
    if (this.growth && !sameField(this.growth.doc, doc)) this.endGrowth();
    this.clock = Math.min(this.clock, this.steps);
    if (!runs[0]) this.isPlaying = false;
    if (!isSame || this.follow >= doc.robots.length) this.follow = Math.min(this.follow, doc.robots.length - 1);
    this.refresh();
    this.fieldChanged();
  }

  undo() { this.travel(this.past, this.future); }
  redo() { this.travel(this.future, this.past); }
  travel(from, to) {
    const state = from.pop();
    if (!state) return;
    to.push({ doc: this.doc, runs: this.runs });
    this.set(state.doc, state.runs);
  }

  change(changes) { this.edit({ ...this.doc, ...changes }); }
  rule(name, value) { this.change({ header: { ...this.doc.header, [name]: value } }); }
  retile(changes) {
    const header = { ...this.doc.header, ...changes };
    if (header.frame && (changes.tessellation || changes.neighbourhood)) {
      this.refresh();
      return this.say("This area lies in the world in metres: open its file again with other cells.", true);
    }
    // A cost of waiting in the old unit would mean something else.
    if (changes.costs) header.waiting_cost = null;
    this.change({ header });
  }

  // ---- asking the host

  async ask(header, arrays, words) {
    this.cancel();
    const job = new AbortController();
    this.job = job;
    if (words) this.working(words, 0, 0);
    try {
      return await this.host.ask(header, arrays, { signal: job.signal, onFrame: (frame) => {
        if (job.signal.aborted) return;
        if (frame.header.kind === "progress") this.working(`${title(frame.header.stage)}…`, frame.header.done, frame.header.total);
        else this.onPart?.(frame);
      } });
    } catch (error) {
      if (error.name === "AbortError") this.say("Cancelled.");
      else this.say(error instanceof TypeError ? "The server does not answer; is it still running?" : error.message, true);
      return null;
    } finally {
      if (this.job === job) {
        this.job = null;
        this.progressRow.hidden = true;
      }
    }
  }

  // Better lower bounds take longer than plans: they are asked for while the plan is on the page already. Where the
  // optimum has been found meanwhile, it is the bound.
  async bound() {
    if (!this.host) return;
    for (const run of this.runs) {
      if (!run || run.summary.optimal || run.isBounding) continue;
      run.isBounding = true;
      try {
        const { header } = await this.host.ask({ op: "bound", plan: run.plan });
        Object.assign(run, { summary: header.summary });
        if (this.runs.includes(run)) this.refresh();
      } catch { /* the weaker bound holds as well */ } finally {
        run.isBounding = false;
      }
    }
  }

  working(words, done, total) {
    this.progressRow.hidden = false;
    this.progressText.textContent = total > 0 ? `${words} ${number(done)} of ${number(total)}` : words;
    if (total > 0) Object.assign(this.progress, { max: total, value: done });
    else this.progress.removeAttribute("value");
  }

  cancel() { this.job?.abort(); }

  get request() { return { document: this.doc.header }; }

  async generate(wish, isFirst = false) {
    const answer = await this.ask({ op: "generate", ...wish }, {}, "Making…");
    if (!answer) return;
    this.clock = 0;
    const size = wish.height * wish.width;
    this.count.lastChild.value = Math.max(1, Math.min(200, Math.round(size / 25)));
    if (!isFirst) return this.take(answer);
    this.count.lastChild.value = 60;
    // Something to look at for those who open the viewer without a file.
    this.take(answer, { isEdit: false });
    const free = [...this.doc.barriers.keys()].filter((cell) => !this.doc.barriers[cell]);
    const middle = free.reduce((best, cell) => (this.fromMiddle(cell) < this.fromMiddle(best) ? cell : best));
    this.set({ ...this.doc, destinations: Int32Array.of(middle) }, [null, null]);
    const drawn = await this.ask({ op: "scatter", count: 60, seed: 1, ...this.request }, arraysOf(this.doc));
    if (drawn) this.set({ ...this.doc, robots: drawn.arrays.robots.slice(), header: { ...this.doc.header, seed: 1 } }, [null, null]);
  }

  fromMiddle(cell) {
    return Math.abs((cell % this.doc.width) - this.doc.width / 2) + Math.abs(Math.floor(cell / this.doc.width) - this.doc.height / 2);
  }

  async scatter() {
    const count = Number(this.count.lastChild.value), seed = Number(this.seed.lastChild.value);
    const doc = this.doc, answer = await this.ask({ op: "scatter", count, seed, ...this.request }, arraysOf(doc));
    if (answer && this.doc === doc) this.change({ robots: answer.arrays.robots.slice(), header: { ...doc.header, seed } });
  }

  async plan(which) {
    const missing = this.missing();
    if (missing) return this.say(missing, true);
    if (which && !this.runs[0]) {
      await this.plan(0);
      if (!this.runs[0]) return;
    }
    const { doc } = this;
    const planner = (which ? this.otherPlanner : this.planner).lastChild.value;
    const tessellation = which && this.otherCells.lastChild.value;
    const request = { op: "plan", planner, options: this.chosenOptions(planner), ...this.request };
    if (tessellation && tessellation !== "the same cells") request.tessellation = tessellation;
    this.isPlaying = false;
    const answer = await this.ask(request, arraysOf(doc), "Planning…");
    if (!answer || this.doc !== doc) return;
    // The plan plays on the very document of the page, so that an edit is noticed.
    const run = runOf(answer, which ? null : doc);
    this.past.push({ doc, runs: this.runs });
    this.future = [];
    this.endGrowth();
    if (!which) this.clock = 0;
    this.set(doc, which ? [this.runs[0], run] : [run, this.runs[1]]);
    this.seek(0);
    // From here on a click should follow a robot rather than paint a wall, which would undo the plan.
    this.choose("move");
    this.results.closest("details").scrollIntoView({ block: "nearest" });
    this.bound();
    const { summary } = run;
    const stranded = summary.unreachable ? ` ${plural(summary.unreachable, "robot")} cannot arrive.` : "";
    const conflicts = summary.conflicts ? ` ${plural(summary.conflicts, "conflict")}!` : "";
    if (run === this.runs[which]) this.say(`${title(summary.planner || "plan")}: total time ${number(summary.total_time)}${summary.optimal ? ", proven optimal" : ""}.${stranded}${conflicts} Press Play.`, conflicts !== "");
  }

  endCompare() { this.set(this.doc, [this.runs[0], null]); }

  missing() {
    if (!this.doc.destinations.length) return "There is no destination yet: choose the tool Destination and click a cell.";
    if (!this.doc.robots.length) return "There are no robots yet: scatter some, or place them with the tool Robot.";
    return "";
  }

  // ---- the field and its generations

  fieldChanged() {
    const wanted = this.showField.checked || this.showArrows?.checked || this.showNumbers.checked;
    if (wanted && !this.showField.checked) this.showField.checked = true;
    const hasAll = this.fields && (this.fields.directions || !this.showArrows?.checked);
    clearTimeout(this.fieldTimer);
    if (wanted && !hasAll && this.host && this.doc.destinations.length) this.fieldTimer = setTimeout(() => this.fetchFields(), this.stroke ? 60 : 0);
    this.refreshPanes();
  }

  async fetchFields() {
    const doc = this.doc;
    if (this.job) return (this.fieldTimer = setTimeout(() => this.fetchFields(), 100));
    const answer = await this.ask({ op: "fields", ...this.request }, arraysOf(doc));
    if (!answer || !sameField(doc, this.doc)) return;
    this.fields = { doc, ...answer.arrays };
    this.refresh();
  }

  async grow() {
    const { growth } = this;
    if (growth && sameField(growth.doc, this.doc)) {
      if (growth.isComplete && growth.generation === growth.ends.length - 1) this.setGeneration(0);
      growth.isPlaying = !growth.isPlaying;
      return this.refresh();
    }
    if (!this.doc.destinations.length) return this.say(this.missing(), true);
    this.showField.checked = true;
    if (!this.fields) await this.fetchFields();
    if (!this.fields) return;
    const doc = this.doc, values = new Int32Array(doc.barriers.length).fill(NOT_REACHED);
    for (const cell of doc.destinations) values[cell] = 0;
    this.growth = { doc, values, cells: [], changes: [], ends: [0], generation: 0, isComplete: false, isPlaying: true, at: 0 };
    this.refresh();
    this.onPart = ({ arrays }) => this.addGenerations(arrays);
    const answer = await this.ask({ op: "generations", ...this.request }, arraysOf(doc), "Growing…");
    this.onPart = null;
    if (!answer) return this.endGrowth();
    if (this.growth?.doc !== doc) return;
    this.addGenerations(answer.arrays);
    this.growth.isComplete = true;
    this.refresh();
  }

  addGenerations({ counts, cells, values }) {
    const { growth } = this;
    if (!growth) return;
    let at = 0;
    for (const count of counts) {
      growth.cells.push(cells.slice(at, at + count));
      growth.changes.push(values.slice(at, at + count));
      growth.ends.push(growth.ends.length);
      at += count;
    }
    this.generation.max = growth.ends.length - 1;
    this.invalidate();
  }

  setGeneration(generation) {
    const { growth } = this;
    if (!growth) return;
    generation = Math.max(0, Math.min(generation, growth.ends.length - 1));
    if (generation < growth.generation) {
      growth.values.fill(NOT_REACHED);
      for (const cell of growth.doc.destinations) growth.values[cell] = 0;
      growth.generation = 0;
    }
    while (growth.generation < generation) {
      const cells = growth.cells[growth.generation], values = growth.changes[growth.generation];
      for (let i = 0; i < cells.length; i++) growth.values[cells[i]] = values[i];
      growth.generation++;
    }
    growth.at = generation;
    this.generation.value = generation;
    const isLast = growth.isComplete && generation === growth.ends.length - 1;
    this.generationText.textContent = `Generation ${number(generation)}${growth.isComplete ? ` of ${number(growth.ends.length - 1)}` : ""}` +
      (isLast ? ": nothing changes any more, this is the N-scheme." : "");
    this.refreshPanes();
  }

  async nextGeneration() {
    if (!this.growth) {
      await this.grow();
      if (!this.growth) return;
    }
    this.growth.isPlaying = false;
    this.setGeneration(this.growth.generation + 1);
    this.refresh();
  }

  endGrowth() {
    this.growth = null;
    this.generationText.textContent = "";
    this.generation.value = this.generation.max = 0;
  }

  // ---- what the page shows

  say(words, isWarning = false) {
    this.status.textContent = words;
    this.status.classList.toggle("warning", isWarning);
  }

  refresh() {
    const { doc } = this, { header } = doc;
    this.nameOfArea.textContent = `${header.name || "area"} · ${doc.width} × ${doc.height} ${header.tessellation}`;
    this.undoButton.disabled = !this.past.length;
    this.redoButton.disabled = !this.future.length;
    if (this.host) {
      for (const input of this.tessellation.querySelectorAll("input")) input.checked = input.value === header.tessellation;
      for (const [name, field] of Object.entries(this.rules)) field.lastChild.value = header[name] ?? "";
      this.countText.textContent = `${plural(doc.robots.length, "robot")}, ${plural(doc.destinations.length, "destination")} in the area.`;
      this.growButton.textContent = this.growth?.isPlaying ? "Pause" : this.growth && !this.growth.isComplete ? "Growing…" : "Grow the field";
      this.endCompareButton.hidden = !this.runs[1];
      this.compareButton.disabled = this.planButton.disabled = false;
      if (!this.runs[0] && !this.status.classList.contains("warning")) this.say(this.missing() || "Press Plan to find paths for all robots.");
      else if (!this.runs[0] && !this.missing()) this.say("Press Plan to find paths for all robots.");
    }
    if (this.runs[0] && !this.status.textContent) this.say("Press Play.");
    this.refreshPanes();
    this.showResults();
    this.followRobot(this.follow);
    this.showClock();
  }

  refreshPanes() {
    if (!this.doc || !this.panes) return;
    const isSplit = !!this.runs[1];
    if (this.paneElements[1].hidden === isSplit) {
      this.paneElements[1].hidden = !isSplit;
      this.stage.classList.toggle("split", isSplit);
      this.resize();
    }
    const wanted = this.showField.checked;
    const values = !wanted ? null : this.growth ? this.growth.values : this.fields?.distance ?? null;
    const dark = this.isDark();
    this.panes.forEach((pane, i) => {
      const run = this.runs[i];
      if (i && !run) return;
      const doc = run ? run.doc : this.doc;
      const own = i ? (wanted ? run.playback.distance : null) : values;
      const directions = i ? null : this.fields?.directions ?? null;
      pane.values = own;
      pane.directions = this.growth ? null : directions;
      pane.options = { dark, growing: !i && !!this.growth, most: this.farthest(i ? run.playback.distance : this.fields?.distance ?? own), arrows: this.showArrows?.checked, numbers: this.showNumbers.checked, steps: this.settings.steps?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`] };
      pane.follow = this.follow;
      pane.track = this.follow >= 0 && run && this.follow < run.playback.count ? run.playback.robot(this.follow).rows.map((row) => row.cell) : null;
      if (!run && (this.still?.doc !== doc || this.still.distance !== this.fields?.distance)) this.still = { doc, distance: this.fields?.distance, robots: new Still(doc, this.fields?.distance) };
      pane.show(doc, run ? run.playback : this.still.robots);
      pane.changed("base");
      const kind = `${title(doc.header.tessellation)} area of ${doc.width} by ${doc.height} cells, ${plural(doc.robots.length, "robot")}, ${plural(doc.destinations.length, "destination")}.`;
      this.canvases[i].setAttribute("aria-label", `${kind} ${this.host && !i ? "Arrow keys move the cursor, Enter uses the tool." : "Arrow keys move the cursor."}`);
      this.captions[i].textContent = run && isSplit ? `${run.summary.planner} · ${doc.header.tessellation} · total time ${number(run.summary.total_time)} · ${gapWords(run.summary)}` : "";
    });
    this.showLegend(!!values);
    this.invalidate();
  }

  farthest(distance) {
    if (!distance) return 1;
    if (this.most?.distance !== distance) {
      let most = 1, unreached = -this.doc.barriers.reduce((count, barrier) => count + barrier, 0);
      for (const value of distance) {
        if (value === NOT_REACHED) unreached++;
        else if (value > most) most = value;
      }
      this.most = { distance, most, unreached };
    }
    return this.most.most;
  }

  showLegend(hasField) {
    const palette = this.panes[0].palette();
    const entry = (name, words, kind = "disc") => {
      const mark = h("i", { class: kind });
      mark.style.background = css(palette[name]);
      return h("span", {}, mark, words);
    };
    const entries = [entry("barrier", "barrier", "cell"), entry("destination", "destination")];
    if (this.runs[0]) entries.push(entry("moving", "moving"), entry("waiting", "waiting"), entry("final", "arriving"));
    else if (this.doc.robots.length) entries.push(entry("moving", "robot"));
    if (this.runs[0]?.summary.unreachable || this.still?.robots.state.includes(STRANDED)) entries.push(entry("stranded", "cannot arrive"));
    if (hasField) {
      const ramp = h("i", { class: "ramp" });
      ramp.style.background = `linear-gradient(to right, ${[0, 64, 128, 192, 255].map((i) => css(palette.distance[i])).join(",")})`;
      if (this.most?.distance === this.panes[0].values && this.most.unreached > 0) entries.push(entry("unreached", "not reached", "cell"));
      entries.push(h("span", {}, "0 ", ramp, ` ${number(this.panes[0].options.most)} to go`));
    }
    this.legend.replaceChildren(...entries);
  }

  showResults() {
    const runs = this.runs.filter(Boolean);
    if (!runs.length) {
      this.results.replaceChildren(h("p", { class: "note" }, "No plan yet."));
      this.sets.replaceChildren();
      this.sofar.textContent = "";
      this.chart.replaceChildren();
      return;
    }
    const rows = [
      ["Total time", (s) => number(s.total_time)], ["Lower bound", (s) => `${number(s.lower_bound)} (${s.lower_bound_name})`],
      ["Gap to the optimum", (s) => (s.gap === null ? "–" : s.gap === 0 ? "0, proven" : s.lower_bound_name === "optimum" ? percent(s.gap) : `at most ${percent(s.gap)}`)], ["Steps", (s) => number(s.steps)],
      ["Moves d", (s) => number(s.total_distance)], ["Waiting w", (s) => number(s.total_waiting)], ["Longest t", (s) => number(s.longest_time)],
      ["Arrived", (s) => `${number(s.arrived)} of ${number(s.robots)}`], ["Conflicts", (s) => (s.conflicts ? number(s.conflicts) : "none")],
      ["Planned in", (s) => (s.seconds.plan === null ? "–" : `${s.seconds.plan.toPrecision(2)} s`)],
    ];
    const name = (run) => `${run.summary.planner || "plan"}${runs.length > 1 && run.summary.tessellation !== this.doc.header.tessellation ? ` (${run.summary.tessellation})` : ""}`;
    const table = h("table", {}, h("thead", {}, h("tr", {}, h("td"), runs.map((run, i) => h("th", { scope: "col", class: `run${i}` }, name(run))))),
      h("tbody", {}, rows.map(([label, of]) => h("tr", {}, h("th", { scope: "row" }, label), runs.map((run) => h("td", {}, of(run.summary)))))));
    const conflicts = runs.flatMap((run) => run.conflicts).slice(0, 5).map(({ step, text }) => h("li", {}, h("button", { type: "button", class: "link", onclick: () => this.seek(step - 1) }, text)));
    this.results.replaceChildren(...[table, this.verdict(runs), conflicts.length ? h("ul", { class: "conflicts" }, conflicts) : null].filter(Boolean));
    this.drawChart(runs);
  }

  // One sentence on what two plans differ in.
  verdict(runs) {
    if (runs.length < 2) return null;
    const [one, two] = runs.map((run) => run.summary), share = two.total_time ? one.total_time / two.total_time - 1 : 0;
    const isSame = one.tessellation === two.tessellation;
    const names = [one, two].map((summary) => `${summary.planner}${isSame ? "" : ` on ${summary.tessellation} cells`}`);
    const text = Math.abs(share) < 5e-5 ? `${title(names[0])} and ${names[1]} take the same total time.` :
      `${title(names[0])} takes ${percent(Math.abs(share))} ${share > 0 ? "more" : "less"} time than ${names[1]}.`;
    return h("p", { class: "verdict" }, text);
  }

  drawChart(runs) {
    const width = 300, height = 120, steps = Math.max(1, this.steps);
    const draw = (label, of, last) => {
      const most = Math.max(1, ...runs.map((run) => { let m = 0; for (const v of of(run)) if (v > m) m = v; return m; }));
      const svg = h("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${label} by step, at most ${number(most)}`, preserveAspectRatio: "none" });
      svg.append(h("line", { x1: 0, y1: height - 1, x2: width, y2: height - 1, class: "axis" }));
      runs.forEach((run, i) => {
        const curve = of(run), every = Math.max(1, Math.floor(curve.length / 600)), points = [];
        for (let s = 0; s < curve.length; s += every) points.push(`${((s / steps) * width).toFixed(1)},${(height - 2 - (curve[s] / most) * (height - 6)).toFixed(1)}`);
        if (last) points.push(`${((curve.length - 1) / steps) * width},${height - 2 - (curve[curve.length - 1] / most) * (height - 6)}`, `${width},${height - 2 - (curve[curve.length - 1] / most) * (height - 6)}`);
        svg.append(h("polyline", { points: points.join(" "), class: `run${i}` }));
      });
      const cursor = h("line", { x1: 0, x2: 0, y1: 0, y2: height, class: "cursor" });
      svg.append(cursor);
      svg.addEventListener("pointerdown", (event) => {
        const box = svg.getBoundingClientRect();
        this.seek(((event.clientX - box.left) / box.width) * steps);
      });
      this.cursors.push(cursor);
      return h("figure", {}, h("figcaption", {}, h("span", {}, label), h("span", {}, `max ${number(most)}`)), svg);
    };
    this.cursors = [];
    this.chartWidth = width;
    this.chart.replaceChildren(draw("Robots arrived", (run) => run.playback.curves.arrived, true), draw("Robots waiting (queue)", (run) => run.playback.curves.waiting, false));
  }

  showClock() {
    const { steps } = this, step = Math.floor(this.clock);
    this.scrubber.max = steps;
    this.scrubber.value = this.clock;
    this.scrubber.disabled = this.playButton.disabled = !this.runs[0];
    this.scrubber.setAttribute("aria-valuetext", `step ${step} of ${steps}`);
    this.playButton.textContent = this.isPlaying ? "Pause" : "Play";
    this.clockText.textContent = this.runs[0] ? `step ${number(step)} / ${number(steps)}` : "no plan";
    const runs = this.runs.filter(Boolean);
    if (!runs.length) return;
    for (const cursor of this.cursors ?? []) for (const end of ["x1", "x2"]) cursor.setAttribute(end, (this.clock / Math.max(1, steps)) * this.chartWidth);
    const key = `${step} ${runs.map((run) => run.plan + run.summary.planner)}`;
    if (this.clockKey === key && this.clockDoc === this.doc) return;
    this.clockKey = key;
    this.clockDoc = this.doc;
    const now = (run, name) => run.playback.curves[name][Math.min(step, run.playback.steps)];
    const ahead = (run, name) => (step < run.playback.steps ? run.playback.curves[name][step + 1] : 0);
    this.sets.replaceChildren(...runs.map((run, i) => h("p", { class: `note run${i}` }, runs.length > 1 ? `${run.summary.planner}: ` : "",
      `${number(ahead(run, "moving"))} moving · ${number(ahead(run, "waiting"))} waiting · ${number(now(run, "arrived"))} arrived`)));
    this.sofar.textContent = runs.map((run) => {
      const least = now(run, "least_total"), { lower_bound: bound, gap } = run.summary;
      const over = gap === null || !bound ? "" : least <= bound ? ", not above the lower bound so far" : `, ${percent(least / bound - 1)} above the lower bound`;
      return `${runs.length > 1 ? `${title(run.summary.planner)}: ` : ""}${number(now(run, "spent"))} spent, ${number(least)} at least in the end${over}.`;
    }).join(" ");
    if (this.follow >= 0) this.showRobot();
  }

  followRobot(robot) {
    const count = this.doc.robots.length;
    robot = Number.isInteger(robot) && robot >= 0 && robot < count ? robot : -1;
    const isNew = robot !== this.follow;
    this.follow = robot;
    this.robotNumber.value = robot < 0 ? "" : robot;
    this.robotNumber.max = count - 1;
    this.tracks = robot < 0 ? [] : this.runs.map((run) => (run && robot < run.playback.count ? run.playback.robot(robot) : null));
    if (isNew) this.refreshPanes();
    this.showRobot();
  }

  showRobot() {
    if (this.follow < 0) return this.robotText.replaceChildren(h("p", { class: "note" }, "Click a robot to see its path, its moves d, its waits w and its time t."));
    const runs = this.runs.map((run, i) => [run, this.tracks[i]]).filter(([run, track]) => run && track);
    const place = (doc, cell) => `(${cell % doc.width}, ${Math.floor(cell / doc.width)})`;
    if (!runs.length) return this.robotText.replaceChildren(h("p", { class: "note" }, `Robot ${this.follow} starts at ${place(this.doc, this.doc.robots[this.follow])}.`));
    const step = Math.floor(this.clock);
    this.robotText.replaceChildren(...runs.map(([run, track], i) => {
      const { rows, hasArrived } = track, now = rows[Math.min(step, rows.length - 1)], last = rows[rows.length - 1];
      const next = rows[step + 1], doing = next ? `next ${next.action}` : hasArrived ? `arrived at step ${rows.length - 1}` : "cannot arrive";
      const line = (label, of) => h("tr", {}, h("th", { scope: "row" }, label), h("td", {}, number(of(now))), h("td", {}, number(of(last))));
      return h("div", {}, h("p", { class: `note run${i}` }, `${runs.length > 1 ? `${run.summary.planner}: ` : ""}robot ${this.follow} at ${place(run.doc, now.cell)}, ${doing}`),
        h("table", {}, h("thead", {}, h("tr", {}, h("td"), h("th", { scope: "col" }, "so far"), h("th", { scope: "col" }, "in the end"))),
          h("tbody", {}, line("moves d", (row) => row.d), line("waits w", (row) => row.w), line("time t = d + w", (row) => row.d + row.w))));
    }));
    if (this.centred.checked) runs.forEach(([run, track]) => this.panes[this.runs.indexOf(run)].reveal(track.rows[Math.min(step, track.rows.length - 1)].cell));
  }

  // ---- time

  setSpeed(speed) {
    this.stepsPerSecond = speed;
    this.speed.value = SPEEDS.indexOf(speed);
    this.speedText.textContent = `${speed}/s`;
    this.speed.setAttribute("aria-valuetext", `${speed} steps per second`);
  }

  togglePlay() {
    if (!this.runs[0]) return this.host ? this.say(this.missing() || "Press Plan first.", true) : undefined;
    if (!this.isPlaying && this.clock >= this.steps) this.clock = 0;
    this.isPlaying = !this.isPlaying;
    if (this.isPlaying) this.say("Playing. Click a robot to follow it.");
    this.showClock();
    this.invalidate();
  }

  seek(clock) {
    this.clock = Math.max(0, Math.min(clock, this.steps));
    this.showClock();
    this.invalidate();
  }

  invalidate() {
    if (this.isWaiting || this.isClosed) return;
    this.isWaiting = true;
    requestAnimationFrame((time) => this.tick(time));
  }

  tick(time) {
    this.isWaiting = false;
    if (!this.panes || !this.doc || !this.shell.isConnected) return;
    const passed = Math.min(0.25, (time - (this.lastTick ?? time)) / 1000);
    this.lastTick = time;
    if (this.isPlaying) {
      this.clock = Math.min(this.steps, this.clock + passed * this.stepsPerSecond);
      if (this.clock >= this.steps) {
        this.isPlaying = false;
        this.say("The last robot has arrived.");
      }
      this.showClock();
    }
    if (this.growth?.isPlaying) this.growTick(passed);
    const step = Math.floor(this.clock);
    this.panes.forEach((pane, i) => {
      if (i && !this.runs[1]) return;
      this.runs[i]?.playback.seek(step);
      pane.draw(step >= (this.runs[i]?.playback.steps ?? 0) ? 0 : this.clock - step);
    });
    if (this.panes.some((pane) => pane.isRough)) {
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.settle(), 150);
    }
    if (this.isPlaying || this.growth?.isPlaying) this.invalidate();
    else this.lastTick = undefined;
  }

  settle() {
    for (const pane of this.panes) {
      if (!pane.isRough) continue;
      pane.isRough = false;
      if (pane.view.scale < 1) pane.changed("map");
    }
    this.invalidate();
  }

  growTick(passed) {
    const { growth } = this, last = growth.ends.length - 1;
    // The whole field in some four seconds.
    const edge = growth.doc.header.costs === "euclidean" ? 1000 : 10;
    const rate = Math.max(8, this.panes[0].options.most / edge / 4);
    growth.at = Math.min(last, growth.at + passed * rate);
    const isEnd = growth.isComplete && growth.at >= last;
    if (Math.floor(growth.at) !== growth.generation || isEnd) {
      const { at } = growth;
      this.setGeneration(Math.floor(growth.at));
      growth.at = at;
    }
    if (isEnd) {
      growth.isPlaying = false;
      this.refresh();
    }
  }

  // ---- hand and eye

  resize() {
    if (!this.panes) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.panes.forEach((pane, i) => {
      if (this.paneElements[i].hidden) return;
      const box = this.canvases[i].getBoundingClientRect();
      pane.resize(Math.max(16, Math.round(box.width * ratio)), Math.max(16, Math.round(box.height * ratio)));
    });
    this.invalidate();
  }

  place(event, i) {
    const canvas = this.canvases[i], box = canvas.getBoundingClientRect();
    return [((event.clientX - box.left) * canvas.width) / box.width, ((event.clientY - box.top) * canvas.height) / box.height];
  }

  pointerDown(event, i) {
    event.preventDefault();
    this.canvases[i].focus({ preventScroll: true });
    try { this.canvases[i].setPointerCapture(event.pointerId); } catch { /* a pointer of a test */ }
    const [px, py] = this.place(event, i);
    this.pointers.set(event.pointerId, { px, py, i });
    this.setCursor(-1);
    if (this.pointers.size === 2) return this.beginPinch(i);
    const isPan = event.button === 1 || event.button === 2 || event.shiftKey || i === 1 || this.tool === "move";
    const cell = this.panes[i].cellAt(px, py);
    if (!isPan) return this.beginStroke(cell, px, py);
    const held = i === 0 && event.button === 0 && this.host && this.tool === "move" && cell >= 0 ? this.thingAt(cell) : null;
    this.stroke = { kind: held && this.clock === 0 ? "carry" : "pan", i, px, py, cell, held, moved: 0 };
  }

  pointerMove(event, i) {
    const [px, py] = this.place(event, i), known = this.pointers.get(event.pointerId);
    if (!known) return this.readCell(i, this.panes[i].cellAt(px, py));
    const [dx, dy] = [px - known.px, py - known.py];
    Object.assign(known, { px, py });
    if (this.pinch) return this.movePinch(i);
    const { stroke } = this;
    if (!stroke) return;
    const cell = this.panes[i].cellAt(px, py);
    if (stroke.kind === "pan") {
      stroke.moved += Math.abs(dx) + Math.abs(dy);
      if (stroke.moved > 6) {
        this.panes[i].pan(dx, dy);
        this.invalidate();
      }
    } else if (stroke.kind === "carry") stroke.target = cell;
    else {
      // Every cell between two reports of a fast hand.
      const [lx, ly] = stroke.last, pieces = Math.max(1, Math.ceil(Math.hypot(px - lx, py - ly) / Math.max(2, this.panes[0].view.scale / 3)));
      for (let k = 1; k <= pieces; k++) this.apply(this.panes[0].cellAt(lx + ((px - lx) * k) / pieces, ly + ((py - ly) * k) / pieces));
      stroke.last = [px, py];
      this.showStroke();
    }
    this.readCell(i, cell);
  }

  pointerUp(event, i) {
    this.pointers.delete(event.pointerId);
    if (this.pinch) {
      if (!this.pointers.size) this.pinch = null;
      return;
    }
    const { stroke } = this;
    this.stroke = null;
    if (!stroke) return;
    if (stroke.kind === "carry") {
      if (stroke.target !== undefined && stroke.target >= 0 && stroke.target !== stroke.cell) this.carry(stroke);
      else if (stroke.held.robot !== undefined) this.followRobot(stroke.held.robot);
    } else if (stroke.kind === "pan") {
      if (stroke.moved <= 6) this.pick(i, stroke);
    } else this.endStroke(stroke);
  }

  beginPinch(i) {
    if (this.stroke && this.stroke.kind !== "pan") this.refreshPanes();
    this.stroke = null;
    const [a, b] = [...this.pointers.values()];
    this.pinch = { length: Math.hypot(a.px - b.px, a.py - b.py), x: (a.px + b.px) / 2, y: (a.py + b.py) / 2 };
  }

  movePinch(i) {
    if (this.pointers.size < 2) return;
    const [a, b] = [...this.pointers.values()], { pinch } = this;
    const length = Math.hypot(a.px - b.px, a.py - b.py), x = (a.px + b.px) / 2, y = (a.py + b.py) / 2;
    this.panes[i].pan(x - pinch.x, y - pinch.y);
    this.panes[i].zoom(length / Math.max(1, pinch.length), x, y);
    Object.assign(pinch, { length, x, y });
    this.invalidate();
  }

  wheel(event, i) {
    event.preventDefault();
    const [px, py] = this.place(event, i);
    this.panes[i].zoom(Math.exp(-Math.max(-120, Math.min(120, event.deltaY)) * 0.0025), px, py);
    this.invalidate();
  }

  zoom(factor) {
    for (const pane of this.panes) if (pane.doc) pane.zoom(factor, pane.canvas.width / 2, pane.canvas.height / 2);
    this.invalidate();
  }

  fit() {
    for (const pane of this.panes) pane.fit();
    this.invalidate();
  }

  // Click: the robot nearest to the pointer, if it is near.
  pick(i, { px, py }) {
    const pane = this.panes[i], { robots, view } = pane;
    if (!robots) return;
    const fraction = this.clock - Math.floor(this.clock), reach = Math.max(10, view.scale * 0.6);
    let best = -1, least = reach * reach;
    for (let r = 0; r < robots.count; r++) {
      if (robots.state[r] === HIDDEN) continue;
      const dx = (robots.x0[r] + (robots.x1[r] - robots.x0[r]) * fraction) * view.scale + view.left - px;
      const dy = (robots.y0[r] + (robots.y1[r] - robots.y0[r]) * fraction) * view.scale + view.top - py;
      if (dx * dx + dy * dy < least) [best, least] = [r, dx * dx + dy * dy];
    }
    this.followRobot(best);
  }

  thingAt(cell) {
    const robot = this.doc.robots.indexOf(cell);
    if (robot >= 0) return { robot };
    return this.doc.destinations.includes(cell) ? { destination: cell } : null;
  }

  carry({ held, target, cell }) {
    const { doc } = this;
    if (doc.barriers[target] || doc.robots.includes(target) || doc.destinations.includes(target)) return this.say("That cell is taken.", true);
    if (held.robot !== undefined) this.change({ robots: doc.robots.map((other, r) => (r === held.robot ? target : other)), header: { ...doc.header, seed: null } });
    else this.change({ destinations: doc.destinations.map((other) => (other === cell ? target : other)) });
  }

  beginStroke(cell, px, py) {
    this.stroke = { kind: this.tool, last: [px, py], touched: new Set(), isRemoving: false };
    if (cell >= 0) {
      if (this.tool === "robot") this.stroke.isRemoving = this.doc.robots.includes(cell);
      if (this.tool === "destination") this.stroke.isRemoving = this.doc.destinations.includes(cell);
    }
    this.apply(cell);
    this.showStroke();
  }

  // The cells of the brush around a cell: those whose centres lie within its half width.
  brushed(cell) {
    const width = this.tool === "wall" || this.tool === "erase" ? Number(this.brush.value) : 1;
    if (width === 1) return [cell];
    const { doc } = this, [cx, cy] = centreOf(doc, cell), x = cell % doc.width, y = Math.floor(cell / doc.width), reach = 2 * width, cells = [];
    for (let j = Math.max(0, y - width); j <= Math.min(doc.height - 1, y + width); j++) {
      for (let i = Math.max(0, x - reach); i <= Math.min(doc.width - 1, x + reach); i++) {
        const [px, py] = shapeOf(doc).centre(i, j);
        if (Math.hypot(px - cx, py - cy) < width / 2) cells.push(j * doc.width + i);
      }
    }
    return cells;
  }

  apply(cell) {
    if (cell < 0) return;
    for (const one of this.brushed(cell)) this.stroke.touched.add(one);
  }

  // What the document is after a stroke.
  stroked({ kind, touched, isRemoving }) {
    const { doc } = this, changed = { ...doc };
    if (kind === "wall" || kind === "erase") {
      changed.barriers = doc.barriers.slice();
      for (const cell of touched) changed.barriers[cell] = kind === "wall" ? 1 : 0;
    }
    const isKept = (cells) => !cells.some((cell) => touched.has(cell));
    if (kind === "wall" || kind === "erase" || isRemoving) {
      if (kind !== "destination" && !isKept(doc.robots)) changed.robots = without(doc.robots, touched);
      if (kind !== "robot" && !isKept(doc.destinations)) changed.destinations = without(doc.destinations, touched);
    } else {
      const name = kind === "robot" ? "robots" : "destinations", there = new Set(doc[name]), other = new Set(kind === "robot" ? doc.destinations : doc.robots);
      changed[name] = plus(doc[name], [...touched].filter((cell) => !doc.barriers[cell] && !there.has(cell) && !other.has(cell)));
    }
    if (changed.robots !== doc.robots) changed.header = { ...doc.header, seed: null };
    return changed;
  }

  showStroke() {
    const doc = this.stroked(this.stroke);
    this.panes[0].show(doc, doc.robots === this.doc.robots ? this.panes[0].robots : new Still(doc, null));
    this.invalidate();
  }

  endStroke(stroke) {
    const doc = this.stroked(stroke);
    const isSame = ["barriers", "robots", "destinations"].every((name) => doc[name] === this.doc[name] || (doc[name].length === this.doc[name].length && doc[name].every((value, k) => value === this.doc[name][k])));
    if (isSame) {
      this.refresh();
      const [cell] = stroke.touched;
      if (cell !== undefined && this.doc.barriers[cell] && stroke.kind !== "wall") this.say(`Cell (${cell % this.doc.width}, ${Math.floor(cell / this.doc.width)}) is a barrier: erase it first.`, true);
      return;
    }
    this.say("");
    this.clock = 0;
    this.edit(doc);
  }

  readCell(i, cell) {
    const pane = this.panes[i], { doc } = pane;
    if (!doc || cell < 0) {
      this.readout.textContent = "";
      this.readout.removeAttribute("data-cell");
      return;
    }
    const words = [`cell (${cell % doc.width}, ${Math.floor(cell / doc.width)})`];
    if (doc.barriers[cell]) words.push("barrier");
    else if (doc.destinations.includes(cell)) words.push("destination");
    else words.push("free");
    const robot = this.clock === 0 ? doc.robots.indexOf(cell) : -1;
    if (robot >= 0) words.push(`robot ${robot}`);
    const distance = i ? this.runs[1]?.playback.distance : this.fields?.distance;
    if (distance && !doc.barriers[cell]) words.push(distance[cell] === NOT_REACHED ? "not reached" : `${number(distance[cell])} to go`);
    const names = this.settings.names?.[`${doc.header.tessellation} ${doc.header.neighbourhood}`];
    if (!i && this.fields?.directions && names) {
      const bits = this.fields.directions[cell], row = names[shapeOf(doc).orientation(cell % doc.width, Math.floor(cell / doc.width))];
      const best = row.filter((_, k) => (bits >> k) & 1);
      if (best.length) words.push(`best ${best.join(", ")}`);
    }
    this.readout.textContent = words.join(" · ");
    this.readout.dataset.cell = cell;
  }

  choose(tool) {
    this.tool = tool;
    for (const [name, button] of Object.entries(this.toolButtons)) button.setAttribute("aria-pressed", name === tool);
    for (const canvas of this.canvases) canvas.dataset.tool = tool;
    this.brush.parentElement.hidden = tool !== "wall" && tool !== "erase";
    if (this.doc) this.say(TOOLS.find(([name]) => name === tool)[3]);
  }

  // ---- keys

  key(event) {
    if (event.defaultPrevented || this.dialog.open) return;
    const isText = event.target.matches?.("input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea");
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, isCommand = event.ctrlKey || event.metaKey;
    if (isCommand && this.host && !isText) {
      const does = { z: () => (event.shiftKey ? this.redo() : this.undo()), y: () => this.redo(), s: () => this.saveDialog(), o: () => this.openDialog() }[key];
      if (does) {
        event.preventDefault();
        does();
      }
      return;
    }
    if (isText || isCommand || event.altKey) return;
    if (key === " " && event.target.matches?.("button, summary, input, canvas")) return;
    const tool = this.host && TOOLS.find(([, , letter]) => letter.toLowerCase() === key);
    const does = tool ? () => this.choose(tool[0]) : {
      " ": () => this.togglePlay(), ",": () => this.seek(Math.ceil(this.clock) - 1), ".": () => this.seek(Math.floor(this.clock) + 1),
      "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => this.fit(), p: () => this.host && this.plan(0),
      "[": () => this.faster(-1), "]": () => this.faster(1), "?": () => this.helpDialog(), Escape: () => this.cancel(),
    }[key];
    if (!does) return;
    event.preventDefault();
    does();
  }

  faster(by) { this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.stepsPerSecond) + by))]); }

  canvasKey(event, i) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const pane = this.panes[i], { doc } = pane;
    if (step) {
      event.preventDefault();
      const by = event.shiftKey ? 10 : 1;
      const at = pane.cursor >= 0 ? pane.cursor : doc.width * Math.floor(doc.height / 2) + Math.floor(doc.width / 2);
      const clamp = (value, count) => Math.max(0, Math.min(count - 1, value));
      const x = clamp((at % doc.width) + by * step[0], doc.width), y = clamp(Math.floor(at / doc.width) + by * step[1], doc.height);
      return this.setCursor(y * doc.width + x, i);
    }
    if (event.key === "Enter" || event.key === " ") {
      if (pane.cursor < 0) return event.key === " " ? (event.preventDefault(), this.togglePlay()) : undefined;
      event.preventDefault();
      const [px, py] = pane.pointOf(pane.cursor), { cursor } = pane;
      if (i || this.tool === "move") return this.pick(i, { px, py });
      this.beginStroke(cursor, px, py);
      const { stroke } = this;
      this.stroke = null;
      this.endStroke(stroke);
      this.setCursor(cursor, i);
    }
  }

  setCursor(cell, i = 0) {
    if (!this.panes || this.panes.every((pane, k) => pane.cursor === (k === i ? cell : -1))) return;
    this.panes.forEach((pane, k) => { pane.cursor = k === i ? cell : -1; });
    if (cell >= 0) {
      this.panes[i].reveal(cell);
      this.readCell(i, cell);
    }
    this.invalidate();
  }

  // ---- light and dark

  isDark() { return this.theme === "dark" || (this.theme === "auto" && matchMedia("(prefers-color-scheme: dark)").matches); }

  nextTheme() {
    this.theme = this.isDark() ? "light" : "dark";
    try { localStorage.setItem("trihex-theme", this.theme); } catch { /* a page without storage */ }
    this.applyTheme();
  }

  applyTheme() {
    this.shell.dataset.theme = this.isDark() ? "dark" : "light";
    this.themeButton.textContent = this.isDark() ? "Light" : "Dark";
    this.refreshPanes();
  }

  // ---- dialogs

  open(heading, ...children) {
    const { button } = this.parts;
    this.dialog.replaceChildren(h("form", { method: "dialog" }, h("div", { class: "heading" }, h("h2", {}, heading), button("×", () => this.dialog.close(), { "aria-label": "Close" })), children));
    if (!this.dialog.open) this.dialog.showModal();
  }

  newDialog() {
    const { button, select, numberField } = this.parts, { header } = this.doc;
    const kind = select("Kind", this.settings.generators, () => {}), cells = select("Cells", this.settings.tessellations, () => {});
    const width = numberField("Width", 48, { min: 1, max: 4096 }), height = numberField("Height", 32, { min: 1, max: 4096 }), seed = numberField("Seed", 1, { min: 0 });
    cells.lastChild.value = header.tessellation;
    this.open("New area", h("div", { class: "grid" }, kind, cells, width, height, seed), h("div", { class: "row end" }, button("Make", () => {
      this.dialog.close();
      this.generate({ generator: kind.lastChild.value, tessellation: cells.lastChild.value, width: Number(width.lastChild.value), height: Number(height.lastChild.value), seed: Number(seed.lastChild.value) });
    }, { class: "primary" })));
  }

  async openDialog() {
    const { button, select, numberField } = this.parts;
    const answer = await this.ask({ op: "files" }, {});
    if (!answer) return;
    const { files, folder } = answer.header;
    const cells = select("Cells", ["as the file says", ...this.settings.tessellations], () => {});
    const size = numberField("Cell size in metres", "", { min: 0, step: "any", placeholder: "maps in metres" }), radius = numberField("Robot radius in metres", "", { min: 0, step: "any", placeholder: "0" });
    const pixel = numberField("Width of a pixel in metres", "", { min: 0, step: "any", placeholder: "images in metres" }), bright = numberField("Free from brightness", "", { min: 0, max: 1, step: "any", placeholder: "0.5" });
    const check = (text) => h("label", { class: "check" }, h("input", { type: "checkbox" }), text);
    const invert = check("dark is free"), unknown = check("unknown is free");
    const numberOf = (field) => (field.lastChild.value === "" ? null : Number(field.lastChild.value));
    const wish = () => ({
      tessellation: cells.lastChild.value === "as the file says" ? null : cells.lastChild.value,
      cell_size: numberOf(size), robot_radius: numberOf(radius), resolution: numberOf(pixel), threshold: numberOf(bright),
      invert: invert.firstChild.checked || null, unknown: unknown.firstChild.checked ? "free" : null,
    });
    const list = h("ul", { class: "files" });
    const fill = (text) => list.replaceChildren(...files.filter((name) => name.toLowerCase().includes(text.toLowerCase())).map((name) =>
      h("li", {}, h("button", { type: "button", onclick: () => { this.dialog.close(); this.openName(name, wish()); } }, name))));
    fill("");
    const filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter files", oninput: (event) => fill(event.target.value) });
    const upload = h("input", { type: "file", "aria-label": "A file of this computer", accept: this.settings.suffixes.join(","), onchange: (event) => {
      const [file] = event.target.files, options = wish();
      this.dialog.close();
      if (file) this.openFile(file, options);
    } });
    this.open("Open", h("div", { class: "grid" }, cells, size, radius),
      h("details", { class: "inner" }, h("summary", {}, "Images and maps of ROS"), h("div", { class: "grid" }, pixel, bright), h("div", { class: "row" }, invert, unknown)),
      folder ? [h("p", { class: "note" }, files.length ? `In ${folder}` : `There is nothing to open in ${folder}.`), files.length > 8 ? filter : null, list] : null,
      h("label", { class: "field" }, h("span", {}, "Or a file of this computer"), upload));
  }

  openName(name, wish = {}) { return this.opened({ op: "open", name, in_folder: true, ...wish, ...this.request }, arraysOf(this.doc), name); }
  async openFile(file, wish = {}) {
    if (file.size > 6e7) return this.say(`${file.name} is too large to be sent; start the viewer in its folder.`, true);
    const content = new Uint8Array(await file.arrayBuffer());
    return this.opened({ op: "open", name: file.name, in_folder: false, ...wish, ...this.request }, { ...arraysOf(this.doc), content }, file.name);
  }
  async opened(request, arrays, name) {
    const answer = await this.ask(request, arrays, `Opening ${name}…`);
    if (!answer) return;
    this.clock = 0;
    this.follow = -1;
    this.say("");
    this.take(answer);
    const missing = this.missing();
    this.say(`Opened ${name}: ${number(this.doc.width)} × ${number(this.doc.height)} cells. ${this.runs[0] ? "Press Play." : missing || "Press Plan."}`);
  }

  saveDialog() {
    const { button } = this.parts, { exports } = this.settings, run = this.runs[0];
    const what = h("select", { "aria-label": "What to save", onchange: () => update() }, Object.keys(exports).map((name) => h("option", { value: name, disabled: exports[name].plan && !run }, EXPORT_WORDS[name])));
    const suffix = h("select", { "aria-label": "Format", onchange: () => rename() }), name = h("input", { type: "text", "aria-label": "Name", value: "" });
    const base = (this.doc.header.name || "area").replace(/[^\w-]+/g, "-").replace(/^-|-$/g, "") || "area";
    const rename = () => { name.value = `${base}${exports[what.value].plan ? `-${run.summary.planner || "plan"}` : ""}${suffix.value}`; };
    const update = () => {
      suffix.replaceChildren(...exports[what.value].suffixes.map((one) => h("option", { value: one }, one)));
      rename();
    };
    what.value = run ? "plan" : "scenario";
    if (run && exports.plan.suffixes.includes(".npz")) exports.plan.suffixes.sort((a, b) => (b === ".npz") - (a === ".npz"));
    update();
    const message = h("p", { class: "note", role: "status" });
    const save = async (inFolder, overwrite = false) => {
      const plan = run && (exports[what.value].plan || what.value === "picture") ? run.plan : null;
      const beside = what.value === "page" ? this.runs[1]?.plan ?? null : null;
      const request = { op: "save", what: what.value, name: name.value, in_folder: inFolder, overwrite, plan, beside, planner: this.planner.lastChild.value, ...this.request };
      message.textContent = "Saving…";
      const answer = await this.ask(request, arraysOf(this.doc));
      if (!answer) return void (message.textContent = this.status.textContent);
      if (answer.header.exists) {
        message.replaceChildren(`${name.value} is there already. `, button("Replace it", () => save(true, true)));
        return;
      }
      if (answer.arrays.content) download(answer.header.name, answer.arrays.content);
      this.say(`Saved ${answer.header.saved ?? answer.header.name}.`);
      this.dialog.close();
    };
    this.open("Save", h("div", { class: "grid" }, h("label", { class: "field wide" }, h("span", {}, "What"), what), h("label", { class: "field" }, h("span", {}, "Format"), suffix), h("label", { class: "field wide" }, h("span", {}, "Name"), name)), message,
      h("div", { class: "row end" }, this.settings.folder ? button("Save in folder", () => save(true)) : null, button("Download", () => save(false), { class: "primary" })));
  }

  helpDialog() {
    const keys = [["Space", "play, pause"], [", .", "step back, forward"], ["[ ]", "slower, faster"], ["+ − 0", "zoom in, out, show all"], ["P", "plan"], ["V W E D R", "tools"],
      ["Arrows, Enter", "move the cursor, use the tool (Shift: ten cells)"], ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"], ["Ctrl+O, Ctrl+S", "open, save"], ["Escape", "cancel"]];
    this.open("How it works", h("ol", {}, ["Paint walls, or open an area.", "Set a destination and place robots; all robots go to the nearest destination.", "Grow the field: an automaton computes how far each cell is from the destinations.",
      "Plan: every robot gets a path; no two ever collide.", "Play, and compare with the optimum or with other cells."].map((line) => h("li", {}, line))),
    h("p", {}, "Time t of a robot is the cost of its moves d and of its waits w. A planner keeps the sum over all robots small; the lower bound tells how small it could be at all."),
    h("table", { class: "keys" }, keys.map(([key, words]) => h("tr", {}, h("th", { scope: "row" }, key), h("td", {}, words)))),
    h("p", { class: "note" }, "Wheel or pinch to zoom; drag with the right button, Shift or two fingers to move the picture."));
  }
}

function runOf({ header, arrays }, doc = null) {
  const place = doc ?? documentOf(header.document, arrays);
  return { ...header, playback: new Playback({ header, arrays }, place), doc: place };
}

const sameField = (one, other) => one === other || (one.barriers === other.barriers && one.destinations === other.destinations &&
  ["tessellation", "neighbourhood", "costs", "corners"].every((name) => one.header[name] === other.header[name]));
const gapWords = (summary) => (summary.optimal || summary.gap === 0 ? "proven optimal" : summary.gap === null ? "gap unknown" : `${summary.lower_bound_name === "optimum" ? "" : "at most "}${percent(summary.gap)} above the optimum`);
const wholeOf = (input) => (input.value === "" ? null : Math.max(Number(input.min), Math.round(Number(input.value))));

function stored(key) {
  try { return localStorage.getItem(key); } catch { return null; }
}

function download(name, content) {
  const url = URL.createObjectURL(new Blob([content]));
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

// -------------------------------------------------------------------------------------------------- where it starts

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return decode(new Uint8Array(await new Response(stream).arrayBuffer()));
}

async function start(root) {
  const settings = JSON.parse(document.getElementById("trihex-settings").textContent);
  const content = document.getElementById("trihex-content").textContent.trim();
  root.app = new App(root, settings, settings.host === "server" ? new HttpHost() : null, content ? await unpacked(content) : null);
}

const root = typeof document === "undefined" ? null : document.getElementById("trihex");
if (root && document.getElementById("trihex-settings")) start(root);

// For anywidget: the settings and the first bundle are traits of the model.
export default {
  render({ model, el }) {
    const settings = model.get("_settings"), first = model.get("_first");
    const bytes = first && first.byteLength ? new Uint8Array(first.buffer, first.byteOffset, first.byteLength) : null;
    el.style.height = `${model.get("height")}px`;
    el.classList.add("trihex-host");
    const app = new App(el, settings, new ModelHost(model), bytes ? decode(bytes) : null);
    el.app = app;
    return () => app.close();
  },
};
