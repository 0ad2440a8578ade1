// Rules: the cells of the document and how robots move on them, as the panel lets them be chosen.

import { h, title, wholeOf } from "./words.js";
import { button, grid, inner, labelled, note, numberField, section, select } from "./controls.js";
import { mayLeak } from "./leaks.js";
import { OF_RULES } from "./sentences.js";

const ENTRY = "Arrivals per step and destination";
const DOORS_STAY = "Its doors let in so many robots a step or tick: change the clock in its file, and open it again.";

// A whole number, or a fraction as text, such as 1/2 or 0.5, which the host reads.
function flowOf({ value }) {
  const text = value.trim(), flow = Number(text);
  return !text ? null : Number.isInteger(flow) && flow > 0 ? flow : text;
}

export class Rules {
  constructor(app) {
    this.app = app;
    const { tessellations, neighbourhoods, costs, corners, crossings, clocks, followings } = app.settings;
    const retile = (name) => (event) => this.#retile({ [name]: event.target.value });
    const rule = (name) => (event) => this.#rule(name, event.target.value);
    const whole = (name) => (event) => this.#rule(name, wholeOf(event.target));
    this.tessellation = h("div", { class: "choice", role: "radiogroup", "aria-label": "Tessellation" },
      tessellations.map((name) => h("label", {}, h("input", { type: "radio", name: "trihex-tessellation", value: name,
        onchange: retile("tessellation") }), title(name))));
    this.fields = { // by their names in the header of a document
      neighbourhood: select("Neighbours", neighbourhoods, retile("neighbourhood")),
      costs: select("Costs", costs, retile("costs")),
      corners: select("Corners", corners, rule("corners")),
      crossing: select("Crossing", crossings, rule("crossing")),
      clock: select("Clock", clocks, retile("clock")),
      following: select("Following", followings, rule("following")),
      waiting_cost: numberField("Waiting cost w_t", "",
        { min: 0, placeholder: "one edge", onchange: whole("waiting_cost") }),
      destination_capacity: labelled(ENTRY, h("input", { placeholder: "any", "aria-label": ENTRY,
        onchange: ({ target }) => this.#rule("destination_capacity", flowOf(target)) })),
    };
    for (const [name, field] of Object.entries(this.fields)) field.setAttribute("title", OF_RULES[name]);
    this.squeeze = note("Robots may squeeze between walls that touch at a corner: ",
      button("close the gaps", () => this.#rule("corners", "no-squeeze"), { class: "link" }));
    this.element = section("Cells and rules", this.tessellation, this.squeeze,
      inner("Rules", grid(Object.values(this.fields))));
  }

  #rule(name, value) { this.app.change({ header: { ...this.app.doc.header, [name]: value } }); }

  #retile(changes) {
    const { app } = this, header = { ...app.doc.header, ...changes };
    if (header.frame && (changes.tessellation || changes.neighbourhood)) {
      app.refresh();
      return app.say("This area lies in the world in metres: open its file again with other cells.", true);
    }
    if (header.doors && (changes.clock || header.clock === "costs")) {
      app.refresh();
      return app.say(DOORS_STAY, true);
    }
    // A cost of waiting in the old unit would mean something else.
    if (changes.costs || changes.clock) header.waiting_cost = null;
    app.change({ header });
  }

  show() {
    const { doc } = this.app, { header } = doc;
    this.squeeze.hidden = !mayLeak(doc);
    const radios = this.tessellation.querySelectorAll("input");
    for (const radio of radios) radio.checked = radio.value === header.tessellation;
    for (const [name, field] of Object.entries(this.fields)) field.lastChild.value = header[name] ?? "";
  }
}
