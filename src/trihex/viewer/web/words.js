// Words: elements, numbers and names as people read them.

export function h(tag, properties = {}, ...children) {
  const element = tag === "svg" || tag === "polyline" || tag === "line" || tag === "path"
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

export const EXPORT_WORDS = {
  scenario: "Scenario: area, destinations, robots, rules", area: "Area: barriers only", field: "Field: the distance of each cell", starts: "Starts: cells of the robots",
  plan: "Plan: what each robot does at each step", page: "Page: one HTML file that plays anywhere, to share; both plans if there are two",
  movie: "Movie", picture: "Picture", waypoints: "Waypoints in metres", summary: "Summary: the numbers of the plan",
  run: "Live run: all that happened, for trihex run --resume", run_movie: "Movie of the live run", run_picture: "Picture of the live run: what was seen when",
};
export const number = (value) => (value === null || value === undefined ? "–" : Math.round(value).toLocaleString("en").replace(/,/g, " "));
export const percent = (value) => (value === null || value === undefined ? "–" : `${(100 * value).toFixed(value < 0.1 ? 2 : 1)} %`);
export const plural = (count, one) => `${number(count)} ${one}${count === 1 ? "" : "s"}`;
export const title = (word) => word[0].toUpperCase() + word.slice(1);

export const gapWords = (summary) => (summary.optimal || summary.gap === 0 ? "proven optimal" : summary.gap === null ? "gap unknown" : `${summary.lower_bound_name === "optimum" ? "" : "at most "}${percent(summary.gap)} above the optimum`);
export const wholeOf = (input) => (input.value === "" ? null : Math.max(Number(input.min), Math.round(Number(input.value))));
