// Storage: what stays on this computer.

import { h } from "./words.js";

export function stored(key) {
  try { return localStorage.getItem(key); } catch { return null; }
}

export function keep(key, text) {
  try { localStorage.setItem(key, text); } catch { /* a page without storage */ }
}

export function download(name, content) {
  const url = URL.createObjectURL(new Blob([content]));
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
