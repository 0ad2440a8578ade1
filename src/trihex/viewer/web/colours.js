// Colours: as bytes, as text, mixed.

export const DARK = {
  free: [43, 47, 54], barrier: [146, 152, 162], unreached: [84, 82, 90], moving: [86, 180, 233],
  tight: [92, 97, 106], path: [255, 176, 0], stranded: [250, 250, 250], page: [24, 26, 30], fog: [66, 74, 92],
  fog_barrier: [104, 114, 136], door: [196, 160, 255],
};
export const LIGHT = { page: [233, 234, 236], path: [150, 0, 90], door: [112, 48, 208] };

export const packed = ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r;
export const css = ([r, g, b], a = 1) => `rgba(${r},${g},${b},${a})`;
export const isLight = ([r, g, b]) => 0.299 * r + 0.587 * g + 0.114 * b > 140;

// A colour so far on the way from one to another.
export const between = (one, other, share) => one.map((band, k) => Math.round(band + (other[k] - band) * share));

// Mix two packed colours; share 0..255 of the second.
export function mix(one, other, share) {
  const keep = 255 - share;
  const r = ((one & 255) * keep + (other & 255) * share) / 255;
  const g = (((one >> 8) & 255) * keep + ((other >> 8) & 255) * share) / 255;
  const b = (((one >> 16) & 255) * keep + ((other >> 16) & 255) * share) / 255;
  return ((255 << 24) | (Math.round(b) << 16) | (Math.round(g) << 8) | Math.round(r)) >>> 0;
}
