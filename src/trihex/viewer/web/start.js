// Start: the page of a server, a file, or a notebook.

import { decode } from "./bundles.js";
import { HttpHost, ModelHost, SiteHost } from "./hosts.js";
import { App } from "./app.js";

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return decode(new Uint8Array(await new Response(stream).arrayBuffer()));
}

async function start(root) {
  const settings = JSON.parse(document.getElementById("trihex-settings").textContent);
  const content = document.getElementById("trihex-content").textContent.trim();
  const host = { server: () => new HttpHost(), site: () => new SiteHost() }[settings.host]?.() ?? null;
  root.app = new App(root, settings, host, content ? await unpacked(content) : null);
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
