// The page of crop facts: what stands on a field, on its map, in a table, in words.

import { choice, el, section } from "./dom.js";
import { count, fixed, known, length } from "./format.js";
import { Picture } from "./layers.js";
import { LinkedMap } from "./linked_map.js";
import { rampLegend } from "./map_section.js";
import { PackedLayer } from "./packed.js";
import { FIELD_THINGS } from "./things.js";

const FACTS_LAYERS = [["colour", "Colour"], ["green", "Green"], ["plant_height", "Plant height"]];

const share = (value, digits = 1) => `${fixed(100 * value, digits)}\u00a0%`;

/** The way to a page beside this one; each part of it is a name, whatever it looks like. */
export function linkTo(way, words) {
  return el("a", { href: way.split("/").map((part) => (part === ".." ? part : encodeURIComponent(part))).join("/") },
    words);
}

function leadOf({ rows, total, plant_spacing_m: spacing }) {
  const found = `${count(rows.count)} rows ${length(rows.spacing_m)} apart`;
  if (rows.count === 0) return "No rows were found, so there is nothing to count along: green and heights are known, plants are not.";
  if (!total.plants) {
    return `There are ${found}. Plants are not counted here: they touch, or stand too close for what the map shows.`;
  }
  return `About ${count(total.plants.estimate)} plants stand in ${found}, one every ${length(spacing)}.`;
}

function figuresOf({ total }) {
  const { plants, gaps, height_m: height } = total;
  const figures = [];
  if (plants) {
    figures.push(["Plants", count(plants.estimate), `${count(plants.low)} to ${count(plants.high)}, nine times in ten`],
      ["Per m²", fixed(plants.estimate / total.seen_m2, 1), `of ${count(total.seen_m2)} m² seen`],
      ["Missing", total.row_m > 0 ? share(gaps.length_m / total.row_m) : "unknown",
        `of the rows: ${count(gaps.count)} gaps, ${fixed(gaps.length_m, 0)} m`]);
    if (plants.uncounted_row_m >= 0.5) {
      figures.push(["Not countable", `${fixed(plants.uncounted_row_m, 0)}\u00a0m`, "of row, estimated by the spacing"]);
    }
  }
  figures.push(["Green", share(total.cover), `of ${count(total.seen_m2)} m² seen`]);
  if (known(height.p50)) {
    figures.push(["Height", `${fixed(100 * height.p50, 0)}\u00a0cm`,
      `a tenth below ${fixed(100 * height.p10, 0)}, a tenth above ${fixed(100 * height.p90, 0)} cm`]);
  }
  if (total.row_m > 0) {
    figures.push(["Weeds", share(total.weed_share, 2), `of the ground between rows, ${count(total.weed_patches)} patches`]);
  }
  return figures;
}

export function figureList(figures) {
  return el("dl", { class: "figures" }, ...figures.map(([label, value, meaning]) =>
    el("div", {}, el("dt", {}, label), el("dd", {}, el("strong", {}, value), el("span", {}, meaning)))));
}

function introductionOf(report, facts) {
  return el("section", { id: "verdict", class: "verdict plain", tabindex: "-1", "aria-labelledby": "verdict-title",
    "data-short": "Facts" },
  el("p", { class: "subject" }, report.source),
  el("h1", { id: "verdict-title" }, "What stands on the field"),
  el("p", { class: "lead" }, leadOf(report)),
  figureList(figuresOf(report)),
  facts.map_page ? el("p", {}, "What it was read from, and what that was made of: ", linkTo(facts.map_page, "the map's own page"), ".")
    : null);
}

/** What of the field is not on this page, in words. */
function thinnedWords(layers) {
  return FIELD_THINGS.filter(({ name }) => layers[name] && layers[name].size < layers[name].of).map((thing) => {
    const { size, of } = layers[thing.name];
    const which = thing.name === "plants" ? "evenly chosen" : "the largest";
    return size === 0 ? `The ${count(of)} ${thing.many.toLowerCase()} are too many for this page.`
      : `${count(size)} of ${count(of)} ${thing.many.toLowerCase()} are on this page, ${which}.`;
  }).concat(["facts.gpkg and the tables beside this page have all."]).join(" ");
}

/** Corners of all that lies on the map. */
export function cornersOf(pictures, layers) {
  const corners = pictures.flatMap((picture) => picture.corners());
  for (const layer of corners.length ? [] : Object.values(layers)) {
    if (layer.size === 0) continue;
    const [west, south, east, north] = layer.boxOf(0, layer.x.length);
    corners.push([west, south], [east, north]);
  }
  return corners.length ? corners : [[0, 0], [1, 1]];
}

/** Legends of what lies left and right, each once. */
export function sideLegends(layers, titles, scales, ends = {}) {
  return [...new Set(layers)].flatMap((layer) => {
    const scale = scales?.[layer];
    return scale ? [el("div", { class: "tools" }, el("span", {}, titles.get(layer)),
      rampLegend(layer, scale, ends[layer]?.(scale)))] : [];
  });
}

function fieldSection(report, scene) {
  // Where nothing can be counted that is said once and not drawn everywhere.
  const things = FIELD_THINGS.map((thing) => ({ ...thing,
    shown: thing.shown ?? (thing.name !== "uncountable" || report.total.plants !== null) }));
  const layers = Object.fromEntries(Object.entries(scene.layers).map(([name, json]) => [name, new PackedLayer(name, json)]));
  const pictures = (scene.maps?.fixed ?? []).map((json) => new Picture(json, json.local_from_image));
  const shown = FACTS_LAYERS.filter(([name]) => pictures.some((picture) => picture.has(name)));
  const titles = new Map(shown);
  const state = { left: shown[0]?.[0], right: titles.has("green") ? "green" : shown[0]?.[0] };
  const corners = cornersOf(pictures, layers);
  const map = new LinkedMap({
    base: pictures, focus: corners, origin: scene.origin_m, label: "The field from above with its rows, plants and gaps",
    middle: [0, 1].map((k) => (Math.min(...corners.map((c) => c[k])) + Math.max(...corners.map((c) => c[k]))) / 2),
    sides: () => [state.left, state.right].map((layer) => ({ label: titles.get(layer) ?? "", layer, strips: [], other: [] })),
  }, state, { things, layers, first: layers.plots ? "plots" : layers.rows?.size ? "rows" : undefined });
  const redraw = async (change) => {
    Object.assign(state, change);
    await Promise.all(pictures.flatMap((picture) => [state.left, state.right].map((layer) => picture.prepare(layer))));
    map.legend.replaceChildren(...sideLegends([state.left, state.right], titles, scene.maps?.scales));
    map.view.draw();
  };
  redraw({});
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => map.view.draw());
  const sides = shown.length > 1 ? [
    choice("left", "Left", shown, state.left, (left) => redraw({ left })),
    choice("right", "Right", shown, state.right, (right) => redraw({ right }))] : [];
  const sizes = pictures.length ? `Pixels are ${length(pictures.at(-1).json.pixel_m)}. ` : "";
  return section("map", "Rows, plants and gaps", "Map",
    pictures.length ? null : el("p", { class: "warn" }, "Without pictures (--no-pictures): the marks stand on empty ground."),
    el("div", { class: "tools" }, ...sides, map.zooms(corners)),
    el("div", { class: "tools keys" }, map.switches(), map.shading()),
    map.view.root, map.shadeLegend, map.legend, map.card, map.lists(),
    el("p", { class: "hint" }, thinnedWords(layers)),
    map.hint(`${sizes}Plants are drawn once there is room for them: zoom in.`));
}

function waysSection(report, facts) {
  const { vegetation } = report;
  return section("how", "How it was counted", "How",
    el("p", {}, `Green is what exceeds ${fixed(vegetation.excess_green_threshold, 3)} of Excess Green, which the map's own ` +
      "colours give. The number of plants is the mean over all ways to make plants of what is green in a row; its interval " +
      "holds the truth nine times in ten on simulated fields. Weeds in the rows may count as plants. A gap is 1.5 spacings and more from plant to plant."),
    el("p", {}, `Coordinates: ${report.crs ?? "of a system that nobody named"}. AgriColMap ${facts.version}.`),
    el("pre", { tabindex: "0", "aria-label": "Command line" }, facts.command_line.join(" ")));
}

export function factsParts(report, facts, scene) {
  return [introductionOf(report, facts), fieldSection(report, scene), waysSection(report, facts)];
}
