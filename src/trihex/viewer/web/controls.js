// Controls: buttons, choices and fields, each with its label.

import { h, title } from "./words.js";

export const button = (text, onclick, more = {}) => h("button", { type: "button", onclick, ...more }, text);

// A control with a word above it.
export const labelled = (text, control, kind = "field") => h("label", { class: kind }, h("span", {}, text), control);

export const select = (label, names, onchange, more = {}) => labelled(label,
  h("select", { onchange, "aria-label": label, ...more },
    names.map((name) => h("option", { value: name }, title(name)))));

export const numberField = (label, value, more = {}) => labelled(label,
  h("input", { type: "number", value, "aria-label": label, ...more }));

export const check = (input, text) => h("label", { class: "check" }, input, text);

export const row = (...children) => h("div", { class: "row" }, children);
export const endRow = (...children) => h("div", { class: "row end" }, children);
export const grid = (...children) => h("div", { class: "grid" }, children);
export const note = (...children) => h("p", { class: "note" }, children);

export const inner = (name, ...children) => h("details", { class: "inner" }, h("summary", {}, name), children);

export const section = (name, ...children) => h("details", { open: true, "data-section": name },
  h("summary", {}, name), h("div", { class: "content" }, children));

// What a choice or a field says; an empty field says null.
export const chosenIn = (field) => field.lastChild.value;
export const numberIn = (field) => (field.lastChild.value === "" ? null : Number(field.lastChild.value));
