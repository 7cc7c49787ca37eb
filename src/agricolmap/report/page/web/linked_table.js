// A table of things that a map shows: sorted by any column, a page at a time, each line a way to its thing.

import { button, el } from "./dom.js";
import { count } from "./format.js";
import { columnsOf, textOf } from "./things.js";

const PAGE = 50;  // lines

const nameOf = (layer, i) => layer.value("id", i);

/** Numbers by size, names as people count them; what is not known last, whichever way. */
function compared(a, b, sense) {
  if (a === null || b === null) return (a === null) - (b === null);
  return sense * (typeof a === "string" ? a.localeCompare(b, "en", { numeric: true }) : a - b);
}

export class LinkedTable {
  /** `onchoose({ name, i })`: a line was chosen. */
  constructor(things, layers, onchoose) {
    Object.assign(this, { things, layers, onchoose, chosen: null });
    this.said = el("span", { class: "hint", role: "status" });
    this.back = button("Previous", () => this.turn(-1));
    this.on = button("Next", () => this.turn(1));
    this.head = el("thead");
    this.body = el("tbody");
    this.region = el("div", { class: "scroll lines", tabindex: "0", role: "region" },
      el("table", {}, this.head, this.body));
    this.root = el("div", {}, this.region,
      el("div", { class: "tools pager" }, this.said, this.back, this.on));
  }
  show(name) {
    if (this.thing?.name === name) return;
    this.thing = this.things.find((thing) => thing.name === name);
    this.layer = this.layers[name];
    const { head, one, columns, sorts, many } = this.thing;
    this.name = { title: head ?? one, of: nameOf };
    this.columns = [this.name, ...columnsOf(this.thing, this.layer)];
    this.region.setAttribute("aria-label", many);
    const wanted = sorts === undefined ? null : columns[sorts];
    // A layer need not have the column that tables of its kind begin with.
    const first = wanted === null || this.columns.includes(wanted) ? wanted : this.columns[1] ?? null;
    this.sort(first ?? this.name, first ? -1 : 1);
  }
  sort(column, sense) {
    const values = Array.from({ length: this.layer.size }, (_, i) => column.of(this.layer, i));
    this.order = [...values.keys()].sort((a, b) => compared(values[a], values[b], sense) || a - b);
    this.sorted = { column, sense };
    this.page = 0;
    this.drawHead();
    this.drawLines();
  }
  drawHead() {
    const focused = [...this.head.querySelectorAll("button")].indexOf(document.activeElement);
    this.head.replaceChildren(el("tr", {}, ...this.columns.map((column) => {
      const here = column === this.sorted.column;
      // A column of numbers is asked for its largest first, names for their beginning.
      const sense = here ? -this.sorted.sense : column === this.name ? 1 : -1;
      return el("th", { scope: "col",
        "aria-sort": here ? (this.sorted.sense > 0 ? "ascending" : "descending") : undefined },
      el("button", { type: "button", class: "sort", onclick: () => this.sort(column, sense) }, column.title,
        el("span", { class: "arrow", "aria-hidden": "true" },
          here ? (this.sorted.sense > 0 ? " \u25b2" : " \u25bc") : "")));
    })));
    if (focused >= 0) this.head.querySelectorAll("button")[focused].focus();
  }
  line(i) {
    const thing = { name: this.thing.name, i };
    const isChosen = this.isChosen(i);
    const name = button(String(nameOf(this.layer, i)), () => this.onchoose(thing),
      { class: "link", "aria-pressed": String(isChosen),
        "aria-label": `${this.thing.one} ${nameOf(this.layer, i)}` });
    return el("tr", { class: isChosen ? "chosen" : undefined, "data-i": i, onclick: (event) => {
      if (event.target !== name) this.onchoose(thing);
    } },
    el("th", { scope: "row" }, name),
    ...this.columns.slice(1).map((column) => el("td", {}, textOf(column, this.layer, i))));
  }
  isChosen(i) {
    return this.chosen?.name === this.thing.name && this.chosen.i === i;
  }
  drawLines() {
    const from = this.page * PAGE;
    const shown = this.order.slice(from, from + PAGE);
    this.body.replaceChildren(...shown.map((i) => this.line(i)));
    this.region.scrollTop = 0;
    this.said.textContent = `${count(from + 1)} to ${count(from + shown.length)} of ${count(this.order.length)}`;
    this.back.disabled = from === 0;
    this.on.disabled = from + PAGE >= this.order.length;
    this.back.hidden = this.on.hidden = this.order.length <= PAGE;
  }
  turn(pages) {
    this.page += pages;
    this.drawLines();
  }
  /** Marks a thing's line, turns to it and brings it in sight; null: none. */
  choose(chosen) {
    this.chosen = chosen;
    if (chosen?.name === this.thing.name) {
      const page = Math.floor(this.order.indexOf(chosen.i) / PAGE);
      if (page !== this.page) {
        this.page = page;
        this.drawLines();
      }
    }
    for (const line of this.body.children) {
      const here = this.isChosen(Number(line.dataset.i));
      line.classList.toggle("chosen", here);
      line.querySelector("button").setAttribute("aria-pressed", String(here));
      if (here) this.reveal(line);
    }
  }
  /** Within the table's own window: the page must not jump. */
  reveal(line) {
    const head = this.head.offsetHeight;
    const { scrollTop, clientHeight } = this.region;
    if (line.offsetTop - head < scrollTop) this.region.scrollTop = line.offsetTop - head;
    const bottom = line.offsetTop + line.offsetHeight;
    if (bottom > scrollTop + clientHeight) this.region.scrollTop = bottom - clientHeight;
  }
}
