// Shapes of cells: the same geometry as tessellation.py; `fill` writes the cell of every pixel, -1 outside of the area.

export const R3 = Math.sqrt(3);

export const SHAPES = {
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
    // From the middle of a move by (dx, dy) to the corner that it passes; most moves go straight.
    bend(o, dx, dy) {
      const squared = dx * dx + dy * dy;
      if (squared < 2.9 || squared > 3.1) return STRAIGHT;
      const corner = CORNERS[o].find(([x, y]) => (x - dx / 2) ** 2 + (y - dy / 2) ** 2 < 0.3);
      return corner ? [corner[0] - dx / 2, corner[1] - dy / 2] : STRAIGHT;
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
const STRAIGHT = [0, 0], CORNERS = [0, 1].map((o) => SHAPES.triangular.corners(o));
for (const name of ["square", "hexagonal"]) SHAPES[name].bend = () => STRAIGHT;
const inRange = (i, count) => (i >= 0 && i < count ? i : -1);
