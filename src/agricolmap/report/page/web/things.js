// What is known of each kind of thing on a field, in the words and units of people.

import { count, fixed, known, length } from "./format.js";

const percentOf = (value) => (known(value) ? `${fixed(100 * value, 1)}\u00a0%` : "unknown");
const centimetres = (value) => (known(value) ? `${fixed(100 * value, 1)}\u00a0cm` : "unknown");
const change = (value) => (known(value) && value > 0 ? `+${centimetres(value)}` : centimetres(value));
const metres = (value) => (known(value) ? `${fixed(value, 2)}\u00a0m` : "unknown");
const squareMetres = (value) => `${fixed(value, value < 10 ? 2 : 0)}\u00a0m²`;
const squareCentimetres = (value) => `${fixed(1e4 * value, 0)}\u00a0cm²`;

const field = (name, title, text) => ({ title, text, needs: [name], of: (layer, i) => layer.value(name, i) });
/** A share of two fields; nothing where the second is. */
const ratio = (over, under, title, text) => ({ title, text, needs: [over, under], of: (layer, i) => {
  const below = layer.value(under, i);
  const above = layer.value(over, i);
  return below > 0 && above !== null ? above / below : null;
} });

const PLANTS = { title: "Plants", needs: ["plants"], of: (layer, i) => layer.value("plants", i),
  text: (value, layer, i) => `${count(value)} (${count(layer.value("plants_low", i))} to ` +
    `${count(layer.value("plants_high", i))})` };
const DENSITY = ratio("plants", "seen_m2", "Plants per m²", (value) => fixed(value, 1));
const MISSING = ratio("gap_m", "row_m", "Missing", percentOf);
const GREEN = field("cover", "Green", percentOf);
const WEEDS = field("weed_share", "Weeds between rows", percentOf);
const HEIGHT = field("height_p50_m", "Height", centimetres);

const UNCOUNTED = { ...field("uncounted_row_m", "Not countable", metres), rare: true };

/** Of a part of the field. `rare`: of no interest where it is 0 everywhere. */
const PART = [PLANTS, DENSITY, field("gaps", "Gaps", count), MISSING, GREEN, HEIGHT, WEEDS,
  field("row_m", "Row", metres), UNCOUNTED,
  field("seen_m2", "Seen", squareMetres)];
const ROW = [field("length_m", "Length", metres), PLANTS,
  field("plants_per_row_m", "Plants per m", (value) => fixed(value, 2)), field("gaps", "Gaps", count), MISSING,
  GREEN, HEIGHT, UNCOUNTED];
const STRETCH = [field("row", "In row", count), field("length_m", "Length", length),
  field("spacings", "In spacings", (value) => fixed(value, 1)), field("from_m", "From", metres),
  field("to_m", "To", metres)];

/**
 * In the order in which they are drawn. `one`, `many`: what they are called; `shape`, `colour`: how they look;
 * `leastScale`: pixels per metre from which they are drawn; `measures`: what parts can be shaded by; `sorts`: the
 * column that their table begins with, largest first, else their names.
 */
export const FIELD_THINGS = [
  { name: "grid", one: "Square", many: "Squares", shape: "outline", colour: "#ffffff90", shown: false,
    columns: PART, measures: [GREEN, DENSITY, MISSING, HEIGHT, WEEDS] },
  { name: "plots", one: "Plot", many: "Plots", shape: "outline", colour: "#ffffff", labels: true,
    columns: PART, measures: [GREEN, DENSITY, MISSING, HEIGHT, WEEDS] },
  { name: "rows", one: "Row", many: "Rows", shape: "line", colour: "#ffffffb0",
    columns: ROW, measures: [GREEN, MISSING, HEIGHT] },
  { name: "uncountable", one: "Stretch that cannot be counted", many: "Not countable", shape: "dash",
    colour: "#ffe14d", columns: STRETCH, head: "Stretch", sorts: 1 },
  { name: "gaps", one: "Gap", many: "Gaps", shape: "bar", colour: "#ff7a45", columns: STRETCH, sorts: 1 },
  { name: "weeds", one: "Weed patch", many: "Weeds", shape: "diamond", colour: "#ff6cf6",
    columns: [field("area_m2", "Area", squareCentimetres)], sorts: 0, leastScale: 12 },
  { name: "plants", one: "Plant", many: "Plants", shape: "ring", colour: "#ffffff", leastScale: 45,
    columns: [field("row", "In row", count), field("along_m", "Along it", metres),
      field("height_m", "Height", centimetres), field("area_m2", "Green", squareCentimetres),
      field("certainty", "Certain by", percentOf)] },
];

const signedPercent = (value) => (known(value) && value > 0 ? `+${percentOf(value)}` : percentOf(value));
const cubicMetres = (value) => `${fixed(value, 3)}\u00a0m³`;

/** What a number grew by, and from what to what. */
const growth = (before, after, title, text, end) => ({ title, needs: [before, after], of: (layer, i) => {
  const [first, second] = [layer.value(before, i), layer.value(after, i)];
  return first === null || second === null ? null : second - first;
},
text: (value, layer, i) => (layer ? `${text(value)} (${[before, after].map((name) => end(layer.value(name, i))).join(" to ")})`
  : text(value)) });

/** Shades of a change go both ways from nothing; `sure(layer, i)`: whether it is more than errors. */
const shaded = (column, sure) => ({ ...column, ramp: "change", sure });

const SQUARE_SURE = (layer, i) => Math.abs(layer.value("change_m", i)) > layer.value("level_m", i);
const SQUARE_SURFACE = shaded(field("change_m", "Surface", change), SQUARE_SURE);
const SQUARE_PLANTS = shaded(field("plant_height_change_m", "Plants' height", change));
const SQUARE_COVER = shaded(field("cover_change", "Cover", signedPercent));

const yes = (sure) => (sure ? "yes" : "no");
const SURFACE = shaded(field("height_change_m", "Surface", change), (layer, i) => layer.value("more_than_errors", i) === 1);
const GROWN = shaded(growth("plant_height_before_m", "plant_height_after_m", "Plants' height", change,
  (value) => fixed(100 * value, 1)));
const GREENER = shaded(growth("cover_before", "cover_after", "Cover", signedPercent, (value) => fixed(100 * value, 1)));

/** Of a plot, or of a square that was asked for: columns of plots.csv and grid.csv. */
const CHANGED = { sorts: 0, measures: [SURFACE, GROWN, GREENER],
  columns: [SURFACE, field("height_change_level_m", "Level", centimetres), field("more_than_errors", "More than errors", yes),
    field("rose_share", "Rose", percentOf), field("fell_share", "Fell", percentOf), GROWN, GREENER,
    { ...field("volume_m3", "Volume", cubicMetres), text: (value, layer, i) => `${cubicMetres(value)} ` +
      `(${fixed(layer.value("volume_low_m3", i), 3)} to ${fixed(layer.value("volume_high_m3", i), 3)})` },
    field("compared_m2", "Compared", squareMetres)] };

export const CHANGE_THINGS = [
  { name: "squares", one: "Square", many: "Squares", shape: "outline", colour: "#000000a0", shown: false, sorts: 0,
    measures: [SQUARE_SURFACE, SQUARE_PLANTS, SQUARE_COVER],
    columns: [SQUARE_SURFACE, field("level_m", "Level", centimetres),
      { title: "More than errors", needs: ["change_m", "level_m"], text: (value) => yes(value > 0),
        of: (layer, i) => Math.abs(layer.value("change_m", i)) - layer.value("level_m", i) },
      field("rose", "Rose", percentOf), field("fell", "Fell", percentOf), SQUARE_PLANTS, SQUARE_COVER,
      field("volume_m3", "Volume", cubicMetres), field("compared_m2", "Compared", squareMetres)] },
  { name: "grid", one: "Square", many: "Squares", shape: "outline", colour: "#000000a0", shown: false, ...CHANGED },
  { name: "plots", one: "Plot", many: "Plots", shape: "outline", colour: "#ffffff", labels: true, ...CHANGED },
];

/** Those of the columns that a layer has something to say in. */
export function columnsOf(thing, layer, list = thing.columns) {
  layer.told ??= new Map();  // looking at all of them takes a moment
  if (!layer.told.has(list)) {
    const says = (column) => {
      for (let i = 0; i < layer.size; ++i) {
        const value = column.of(layer, i);
        if (value !== null && !(column.rare && value === 0)) return true;
      }
      return false;
    };
    layer.told.set(list, list.filter((column) => column.needs.every((name) => layer.has(name)) && says(column)));
  }
  return layer.told.get(list);
}

export function textOf(column, layer, i) {
  const value = column.of(layer, i);
  return value === null ? "unknown" : column.text(value, layer, i);
}
