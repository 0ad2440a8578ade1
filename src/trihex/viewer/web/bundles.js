// Bundles: a JSON header with arrays in one string of bytes, as in bundle.py.

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
