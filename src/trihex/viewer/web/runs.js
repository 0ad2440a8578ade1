// Runs: plans that the page holds.

import { documentOf } from "./documents.js";
import { layerOf } from "./layers.js";
import { undergroundOf } from "./underground.js";
import { Playback } from "./playback.js";

// A plan on a document of the page, or on its own, with what stands beneath it.
export function runOf({ header, arrays }, doc = null, ground = null) {
  const plain = doc ? null : documentOf(header.document, arrays);
  const place = doc ?? { ...plain, ground: ground ?? undergroundOf(header, arrays, plain.barriers) };
  const layers = {}; // maps of it that are here, by name
  for (const [name, told] of Object.entries(header.layers ?? {})) layers[name] = layerOf(told, arrays[`layer_${name}`]);
  return { ...header, playback: new Playback({ header, arrays }, place), doc: place, layers };
}

const FIELD_RULES = ["tessellation", "neighbourhood", "costs", "corners", "clock"];

// Whether the field of two documents is the same.
export const sameField = (one, other) => one === other || (one.barriers === other.barriers &&
  one.destinations === other.destinations && FIELD_RULES.every((name) => one.header[name] === other.header[name]));
