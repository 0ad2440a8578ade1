// Words: elements, numbers and names as people read them.

const IN_SVG = ["svg", "polyline", "line", "path"];

export function h(tag, properties = {}, ...children) {
  const element = IN_SVG.includes(tag)
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

export const number = (value) =>
  (value === null || value === undefined ? "–" : Math.round(value).toLocaleString("en").replace(/,/g, " "));
export const percent = (value) =>
  (value === null || value === undefined ? "–" : `${(100 * value).toFixed(value < 0.1 ? 2 : 1)} %`);
export const secondsOf = (value) => (value < 100 ? `${value.toFixed(1)} s` : `${number(value)} s`);
export const durationOf = (value) => (value < 60 ? `${Number(value.toPrecision(3))} s`
  : `${Math.floor(Math.round(value) / 60)} min ${Math.round(value) % 60} s`);
export const plural = (count, one) => `${number(count)} ${one}${count === 1 ? "" : "s"}`;
export const title = (word) => word[0].toUpperCase() + word.slice(1);

export function gapWords({ optimal, gap, lower_bound_name: bound, steps }) {
  if (gap === undefined) return plural(steps, "step"); // of a run
  if (optimal || gap === 0) return "proven optimal";
  if (gap === null) return "gap unknown";
  return `${bound === "optimum" ? "" : "at most "}${percent(gap)} above the optimum`;
}

export const wholeOf = (input) =>
  (input.value === "" ? null : Math.max(Number(input.min), Math.round(Number(input.value))));
