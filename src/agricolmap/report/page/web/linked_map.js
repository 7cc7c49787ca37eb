// A map whose things can be asked, and the table of them: what is chosen in one is shown in both.

import { button, el } from "./dom.js";
import { count } from "./format.js";
import { mapHint, rampLegend, zoomButtons } from "./map_section.js";
import { MapView } from "./map_view.js";
import { Marks, symbol } from "./marks.js";
import { LinkedTable } from "./linked_table.js";
import { columnsOf, textOf } from "./things.js";

const REACH = 14;  // px about the pointer
const PARTS = ["plots", "rows", "grid", "squares"];

const MARK_KEYS = "Click a mark, or press Enter for what is under the cross in the middle, for its facts; N and P go " +
  "to the next and the one before, Escape lets go.";

/** Between what hardly any and hardly any other part surpasses; null where there is no number. */
function scaleOf(values) {
  const sorted = values.filter((value) => value !== null).sort((a, b) => a - b);
  if (sorted.length === 0) return null;
  const at = (share) => sorted[Math.round(share * (sorted.length - 1))];
  const [low, high] = [at(0.02), at(0.98)];
  return [low, high > low ? high : low + 1e-9];
}

/** The same as far below nothing as above. */
function evenScale(values) {
  const scale = scaleOf(values.map((value) => (value === null ? null : Math.abs(value))));
  return scale && [-scale[1], scale[1]];
}

function dropdown(label, choices, onchange) {
  const list = el("select", { onchange: () => onchange(list.value) },
    ...choices.map(([value, text]) => el("option", { value }, text)));
  return [el("label", { class: "check" }, el("span", {}, label), list), list];
}

export class LinkedMap {
  /**
   * `scene`: as of MapView; `things` and `layers`: as of Marks; `first`: the kind of thing that the table begins
   * with; `askPlace(local)`: what is said of a place where nothing was hit.
   */
  constructor(scene, state, { things, layers, first, askPlace, hint = MARK_KEYS }) {
    this.marks = new Marks(things, layers);
    this.layers = layers;
    this.askPlace = askPlace;
    this.idle = hint;
    this.place = null;
    this.view = new MapView({ ...scene, role: "application",
      overlay: (context, view, map) => this.overlay(context, view, map),
      onpick: (local) => this.pick(local),
      keys: { Enter: () => this.pick(this.view.centre), n: () => this.step(1), p: () => this.step(-1),
        Escape: () => this.choose(null) } }, state);
    this.view.frame.classList.add("asking");
    this.card = el("div", { class: "card", role: "status" });
    this.table = new LinkedTable(this.marks.things, layers, (chosen) => this.choose(chosen, { look: true }));
    this.legend = el("div", { class: "legend" });
    this.shadeLegend = el("div", { class: "legend" });
    this.first = first;
    this.say(null);
  }
  thing(name) {
    return this.marks.things.find((thing) => thing.name === name);
  }
  overlay(context, view, map) {
    for (const { thing, note } of this.notes ?? []) note.hidden = map.scale >= thing.leastScale;
    this.marks.draw(context, view, { ratio: map.ratio, scale: map.scale, width: map.width, height: map.height,
      localAt: (x, y) => map.localAt(x, y) });
    if (this.place) map.cross(context, view, this.place);
  }

  pick(local) {
    const found = this.marks.find(local, REACH / this.view.scale, this.view.scale) ?? null;
    this.place = null;
    if (!this.askPlace || (found && this.layers[found.name].kind !== "polygon")) return this.choose(found);
    // Within a part of the field the place is asked, too.
    this.place = local;
    this.choose(found, { keep: true });
    return this.askPlace(local).then((facts) => { if (this.place === local) this.sayPlace(facts, found); });
  }
  /** `look`: brings it in sight. */
  choose(chosen, { look = false, keep = false } = {}) {
    if (!keep) this.place = null;
    this.marks.chosen = chosen;
    this.say(chosen);
    // The table follows with the part that the thing is in, where it is not of the table's own kind.
    this.table.choose(chosen && this.related(chosen, this.table.thing.name));
    if (chosen && look) {
      const [west, south, east, north] = this.layers[chosen.name].box(chosen.i);
      this.view.show([[west, south], [east, north]]);
    }
    this.view.draw();
  }
  /** The next of its kind, in the table's order where it has that kind. */
  step(by) {
    const { chosen } = this.marks;
    const name = chosen?.name ?? this.table.thing.name;
    const order = name === this.table.thing.name ? this.table.order : null;
    const size = this.layers[name].size;
    const at = chosen ? (order ? order.indexOf(chosen.i) : chosen.i) : by > 0 ? -1 : size;
    const next = (at + by + size) % size;
    this.choose({ name, i: order ? order[next] : next }, { look: true });
  }
  /** The thing of that kind which `chosen` is, or stands in. */
  related(chosen, name) {
    if (chosen.name === name) return chosen;
    const layer = this.layers[name];
    const own = this.layers[chosen.name];
    if (!layer?.size) return null;
    if (name === "rows") {
      const row = own.value("row", chosen.i);
      return row === null ? null : { name, i: row - 1 };
    }
    if (layer.kind !== "polygon" || own.kind === "polygon" || chosen.name === "rows") return null;
    const i = this.marks.index(name).nearest(own.middle(chosen.i), 0);
    return i === null ? null : { name, i };
  }

  title({ name, i }) {
    return `${this.thing(name)?.one ?? name} ${this.layers[name].value("id", i)}`;
  }
  say(chosen) {
    if (!chosen) {
      this.card.replaceChildren(el("p", { class: "hint" }, this.idle));
      return;
    }
    const layer = this.layers[chosen.name];
    const others = PARTS.filter((name) => this.thing(name) && name !== chosen.name)
      .map((name) => this.related(chosen, name)).filter((other) => other !== null);
    this.card.replaceChildren(
      el("h3", {}, this.title(chosen)),
      this.list(columnsOf(this.thing(chosen.name), layer).map((column) => [column.title, textOf(column, layer, chosen.i)])),
      el("p", { class: "also" }, ...others.map((other) =>
        button(this.title(other), () => this.choose(other, { look: true }))),
      button("Let go", () => this.choose(null))));
  }
  /** `part`: what the card tells of already. */
  sayPlace(facts, part) {
    const [x, y] = this.place.map((value, k) => value + this.view.scene.origin[k]);
    const said = [el("h3", {}, `At x ${x.toFixed(2)}, y ${y.toFixed(2)}`), this.list(facts)];
    if (part) this.card.append(...said);
    else this.card.replaceChildren(...said);
  }
  list(facts) {
    return el("dl", {}, ...facts.map(([label, text]) => el("div", {}, el("dt", {}, label), el("dd", {}, text))));
  }

  /** Switches of the marks, which are their legend, too. */
  switches() {
    this.notes = [];
    this.boxes = {};
    const items = this.marks.things.map((thing) => {
      const input = el("input", { type: "checkbox", checked: this.marks.on[thing.name], "data-mark": thing.name,
        onchange: () => {
          this.marks.on[thing.name] = input.checked;
          this.view.draw();
        } });
      const note = thing.leastScale ? el("span", { class: "note" }, " (zoom in)") : null;
      if (note) this.notes.push({ thing, note });
      this.boxes[thing.name] = input;
      return el("label", { class: "check" }, input, symbol(thing), el("span", {}, thing.many, note));
    });
    return el("fieldset", { class: "marks" }, el("legend", {}, "Marks"), ...items);
  }
  /** What parts of the field are shaded by, of the parts that the table has. */
  shading() {
    const parts = PARTS.map((name) => this.thing(name)).filter((thing) => thing?.measures);
    const choices = parts.flatMap((thing) => columnsOf(thing, this.layers[thing.name], thing.measures)
      .map((measure) => ({ thing, measure })));
    if (choices.length === 0) return null;
    const [label] = dropdown("Shade", [["", "nothing"], ...choices.map(({ thing, measure }, k) =>
      [String(k), `${thing.many.toLowerCase()} by ${measure.title.toLowerCase()}`])],
    (value) => this.shadeBy(value === "" ? null : choices[Number(value)]));
    return label;
  }
  shadeBy(choice) {
    this.marks.shade = null;
    this.shadeLegend.replaceChildren();
    if (choice) {
      const { thing, measure } = choice;
      const layer = this.layers[thing.name];
      const values = Array.from({ length: layer.size }, (_, i) => measure.of(layer, i));
      const scale = measure.ramp ? evenScale(values) : scaleOf(values);
      if (scale) {
        const [low, high] = scale;
        const sure = (i) => measure.sure?.(layer, i) ?? true;
        // What is shaded can be clicked, too.
        this.marks.on[thing.name] = this.boxes[thing.name].checked = true;
        this.marks.shade = { name: thing.name, ramp: measure.ramp,
          share: (i) => (values[i] === null ? null : (values[i] - low) / (high - low)),
          unsure: (i) => !sure(i),
          text: (i) => measure.text(values[i]) };
        this.shadeLegend.replaceChildren(el("div", { class: "tools" },
          el("span", {}, `${thing.many}: ${measure.title.toLowerCase()}`),
          rampLegend(measure.ramp ?? "height", scale, scale.map((value) => (measure.ramp ? measure.text(value) : measure.text(value, layer, 0)))),
          measure.sure ? el("span", {}, el("i", { class: "swatch unsure" }), "no more than its errors") : null));
      }
      this.tabs?.(thing.name);
    }
    this.view.draw();
  }
  /** The table with the choice of what it lists. */
  lists() {
    const rank = ({ name }) => (PARTS.includes(name) ? PARTS.indexOf(name) : PARTS.length);
    const things = this.marks.things.slice().reverse().sort((a, b) => rank(a) - rank(b));
    const [label, list] = dropdown("List", things.map((thing) =>
      [thing.name, `${thing.many} (${count(this.layers[thing.name].size)})`]), (name) => this.tabs(name));
    this.tabs = (name) => {
      list.value = name;
      this.table.show(name);
      this.table.choose(this.marks.chosen && this.related(this.marks.chosen, name));
    };
    this.tabs(this.first ?? things[0].name);
    const hint = "A heading sorts by its column; a line shows its thing on the map.";
    return el("div", { class: "listing" },
      el("div", { class: "tools" }, things.length > 1 ? label : null, el("span", { class: "hint" }, hint)),
      this.table.root);
  }
  zooms(whole) {
    return zoomButtons(this.view, [["Whole map", whole]]);
  }
  hint(words) {
    return mapHint(words);
  }
}
