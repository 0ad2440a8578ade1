// Hosts: each answers `ask(header, arrays, {signal, onFrame})` with the last frame of the answer; without one the page
// only plays what it holds.

import { decode, encode } from "./bundles.js";

// A server on this computer.
export class HttpHost {
  get canEdit() { return true; }

  async request(header, arrays, signal) {
    const headers = { "Content-Type": "application/octet-stream" };
    return fetch("ask", { method: "POST", body: encode(header, arrays), signal, headers });
  }

  async ask(header, arrays, { signal, onFrame } = {}) {
    const response = await this.request(header, arrays, signal);
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

// A folder with the answers that were made beforehand, as site.py names them.
export class SiteHost extends HttpHost {
  get canEdit() { return false; }

  async request({ op, plan, planner, layer, tessellation, document }, arrays, signal) {
    const shape = tessellation ?? document?.tessellation;
    const names = { bound: `bound-${plan}`, plan: `plan-${planner}-${shape}`, layer: `layer-${layer}-${plan}` };
    const name = names[op] ?? op;
    const response = await fetch(`answers/${name}.bin`, { signal });
    return response.ok ? response : new Response("This page does not hold that; trihex view does.", { status: 404 });
  }
}

// A notebook.
export class ModelHost {
  get canEdit() { return true; }


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
