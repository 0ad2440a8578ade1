// Hosts: each answers `ask(header, arrays, {signal, onFrame})` with the last frame of the answer; without one the page
// only plays what it holds.

import { decode, encode } from "./bundles.js";

export class HttpHost {
  async ask(header, arrays, { signal, onFrame } = {}) {
    const headers = { "Content-Type": "application/octet-stream" };
    const response = await fetch("ask", { method: "POST", body: encode(header, arrays), signal, headers });
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

export class ModelHost {
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

// What to say of a question that failed.
export const complaintOf = (error) =>
  (error instanceof TypeError ? "The server does not answer; is it still running?" : error.message);
