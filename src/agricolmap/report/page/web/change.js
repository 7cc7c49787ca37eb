// The page of a change: before and after side by side, what changed and by how much more than its errors.

import { check, choice, el, section } from "./dom.js";
import { changeChart } from "./charts.js";
import { fixed, known, length, percent } from "./format.js";
import { Picture } from "./layers.js";
import { LinkedMap } from "./linked_map.js";
import { rampLegend } from "./map_section.js";
import { PackedLayer } from "./packed.js";
import { CHANGE_THINGS } from "./things.js";
import { cornersOf, figureList, linkTo } from "./facts.js";

const SEEN = [["colour", "colour"], ["relief", "relief"], ["plant_height", "plant height"], ["cover", "green"]];
const CHANGES = [["change", "surface"], ["plant_height_change", "plants' height"], ["cover_change", "cover"]];
const SIDES = [["before", "Before"], ["after", "After"], ["change", "Change"]];

const cm = (metres, digits = 1) => `${fixed(100 * metres, digits)}\u00a0cm`;
const signedCm = (metres) => (metres > 0 ? `+${cm(metres)}` : cm(metres));
const squares = (area) => `${fixed(area, area < 1 ? 3 : 1)}\u00a0m²`;

function volumeWords({ volume_m3: volume, volume_interval_m3: [low, high] }) {
  const digits = Math.abs(volume) + (high - low) < 0.2 ? 4 : 2;
  return `${fixed(volume, digits)} m³ (${fixed(low, digits)} to ${fixed(high, digits)})`;
}

function changeLead({ surface, cover }) {
  if (!surface) {
    return `The green cover of the field went from ${percent(cover.mean_before)} to ${percent(cover.mean_after)}. ` +
      "These maps have no heights, and of covers no level of detection is known: what of it is error nobody can tell.";
  }
  const { compared, rise, fall } = surface;
  const part = ({ area_m2: area }) => percent(area / compared.area_m2);
  if (rise.cells + fall.cells === 0) return "Nowhere did the surface change by more than the errors of both maps.";
  return `The surface rose on ${part(rise)} of what was compared and fell on ${part(fall)}, by more than the errors ` +
    "of both maps. What else differs may be error.";
}

function surfaceFigures({ rise, fall, compared, bare_ground: bare, median_detection_m: level }) {
  const part = (share) => [squares(share.area_m2), share.cells
    ? `by ${cm(share.median_m)} (median); ${volumeWords(share)}` : "nowhere by more than errors"];
  const figures = [["Rose", ...part(rise)], ["Fell", ...part(fall)],
    ["On average", signedCm(compared.mean_m), `± ${cm(1.96 * compared.mean_deviation_m)} over ${squares(compared.area_m2)}`],
    ["Level of detection", cm(level), "median: what a cell must exceed"]];
  if (bare?.cells) {
    figures.push(["Bare ground", signedCm(bare.mean_m), `± ${cm(1.96 * bare.mean_deviation_m)} expected: a check`]);
  }
  return figures;
}

function changeFigures({ surface, plant_height: plants, cover }) {
  const figures = surface ? surfaceFigures(surface) : [];
  if (plants?.cells) figures.push(["Plants", signedCm(plants.median_change_m), `from ${cm(plants.median_before_m)} to ${cm(plants.median_after_m)}`]);
  if (cover) {
    figures.push(["Cover", `${cover.mean_change > 0 ? "+" : ""}${fixed(100 * cover.mean_change, 1)}\u00a0%`,
      `from ${fixed(100 * cover.mean_before, 1)} to ${fixed(100 * cover.mean_after, 1)} %`]);
  }
  return figures;
}

function changeIntroduction(report, facts) {
  const bare = report.surface?.bare_ground;
  const moved = bare?.cells && Math.abs(bare.mean_m) > 1.96 * bare.mean_deviation_m;
  const ways = [["before", facts.map_before], ["after", facts.map_after]].filter(([, way]) => way);
  return el("section", { id: "verdict", class: `verdict ${moved ? "ambiguous" : "plain"}`, tabindex: "-1",
    "aria-labelledby": "verdict-title", "data-short": "Change" },
  el("p", { class: "subject" }, `${report.before} (before) and ${report.after} (after)`),
  el("h1", { id: "verdict-title" }, "What changed"),
  el("p", { class: "lead" }, changeLead(report)),
  facts.warnings.length ? el("ul", { class: "warn" }, ...facts.warnings.map((line) => el("li", {}, line))) : null,
  figureList(changeFigures(report)),
  ways.length ? el("p", {}, "The maps' own pages: ", ...ways.flatMap(([words, way], k) =>
    [k ? ", " : "", linkTo(way, words)]), ".") : null);
}

/** The picture of the change: its red, green and blue are change, level and whether that is exceeded. */
function derivedOf(json) {
  if (!json.layers.change) return {};
  return { change_all: { from: "change", ramp: "change" }, change_sure: { from: "change", ramp: "change", sure: true } };
}

/** What a pixel of a layer stands for; null where nothing is known. */
async function numberAt(pictures, layer, scales, local, channel = 0) {
  for (const picture of pictures) {
    const bytes = await picture.bytesAt(layer, local);
    if (!bytes || bytes[3] === 0) continue;
    const [low, high] = scales[layer];
    return channel === 0 ? low + (bytes[0] / 255) * (high - low) : bytes[channel];
  }
  return null;
}

/** What a place was, is, and by how much it changed: as exact as a 255th of the legend. */
function placeAsker(pictures, scales) {
  return async (local) => {
    const value = (layer) => (scales[layer] ? numberAt(pictures, layer, scales, local) : null);
    const facts = [];
    if (scales.change) {
      const change = await value("change");
      if (change === null) return [["Here", "nothing was compared"]];
      const sure = await numberAt(pictures, "change", scales, local, 2);
      const level = (await numberAt(pictures, "change", scales, local, 1)) / 255 * scales.change[1];
      facts.push(["Surface", signedCm(change)],
        ["Level of detection", level >= scales.change[1] * 0.998 ? `${cm(level)} or more` : cm(level)],
        ["More than errors", sure > 0 ? "yes" : "no"]);
    }
    for (const [name, label, words] of [["plant_height", "Plants", cm], ["cover", "Green", (v) => `${fixed(100 * v, 0)} %`]]) {
      const [before, after] = [await value(`before_${name}`), await value(`after_${name}`)];
      if (before !== null && after !== null) facts.push([label, `${words(before)} before, ${words(after)} after`]);
    }
    return facts.length ? facts : [["Here", "nothing was compared"]];
  };
}

/** What lies on a side of the handle, in the name of its layer. */
function layerOf(side, state) {
  if (side !== "change") return `${side}_${state.seen}`;
  if (state.changed !== "change") return state.changed;
  return state.sure ? "change_sure" : "change_all";
}

function changeLegend(layers, scales, state) {
  const keys = [];
  if (layers.some((layer) => layer.startsWith("change_"))) {
    keys.push(el("div", { class: "tools" }, el("span", {}, "Change of the surface"),
      rampLegend("change", scales.change, scales.change.map(signedCm)),
      state.sure ? el("span", {}, el("i", { class: "swatch unsure" }), "no more than its errors (95 %)") : null));
  }
  for (const [name, title] of CHANGES.slice(1)) {
    if (layers.includes(name)) {
      const ends = scales[name].map((value) => (name === "cover_change" ? `${fixed(100 * value, 0)} %` : signedCm(value)));
      keys.push(el("div", { class: "tools" }, el("span", {}, `Change of the ${title}`), rampLegend(name, scales[name], ends),
        el("span", { class: "hint" }, "no level of detection is known of it")));
    }
  }
  for (const [name, title] of SEEN.slice(2)) {
    if (layers.some((layer) => layer.endsWith(`e_${name}`) || layer.endsWith(`r_${name}`))) {
      const scale = scales[`before_${name}`];
      keys.push(el("div", { class: "tools" }, el("span", {}, title), rampLegend(name, scale,
        name === "cover" ? ["0 %", "100 %"] : scale.map((value) => cm(value, 0)))));
    }
  }
  return keys;
}

function changeSection(scene, report) {
  const layers = Object.fromEntries(Object.entries(scene.layers).map(([name, json]) => [name, new PackedLayer(name, json)]));
  const first = ["plots", "grid", "squares"].find((name) => layers[name]?.size > 0);
  const parts = first === "plots" ? "plot" : "square";
  const pictures = (scene.maps?.fixed ?? []).map((json) => new Picture(json, json.local_from_image, derivedOf(json)));
  const has = (name) => pictures.some((picture) => picture.has(name));
  const seen = SEEN.filter(([name]) => has(`before_${name}`) && has(`after_${name}`));
  const changes = CHANGES.filter(([name]) => has(name));
  const state = { left: "before", right: "change", seen: seen[0]?.[0], changed: changes[0]?.[0] ?? "change", sure: true };
  const corners = cornersOf(pictures, layers);
  const scales = scene.maps?.scales ?? {};
  const drawn = () => [state.left, state.right].map((side) => layerOf(side, state));
  const words = new Map(SIDES);
  const map = new LinkedMap({
    base: pictures, focus: corners, origin: scene.origin_m, label: "The field from above, before, after, and what changed",
    middle: [0, 1].map((k) => (Math.min(...corners.map((c) => c[k])) + Math.max(...corners.map((c) => c[k]))) / 2),
    sides: () => [state.left, state.right].map((side) =>
      ({ label: words.get(side), layer: layerOf(side, state), strips: [], other: [] })),
  }, state, { things: CHANGE_THINGS, layers, first,
    hint: "Click a place, or press Enter for what is under the cross in the middle, for what it was, is and by how much " +
      `it changed; N and P go to the next ${parts} and the one before, Escape lets go.`,
    askPlace: pictures.length ? placeAsker(pictures, scales) : undefined });
  const redraw = async (made) => {
    Object.assign(state, made);
    await Promise.all(pictures.flatMap((picture) => drawn().map((layer) => picture.prepare(layer))));
    map.legend.replaceChildren(...changeLegend(drawn(), scales, state));
    map.view.draw();
  };
  redraw({});
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => map.view.draw());
  const tools = pictures.length ? [
    choice("left", "Left", SIDES, state.left, (left) => redraw({ left })),
    choice("right", "Right", SIDES, state.right, (right) => redraw({ right })),
    seen.length > 1 ? choice("seen", "Seen by", seen, state.seen, (name) => redraw({ seen: name })) : null,
    changes.length > 1 ? choice("changed", "Change of", changes, state.changed, (changed) => redraw({ changed })) : null,
    report.surface ? check("Grey where it may be error", true, (sure) => redraw({ sure })) : null] : [];
  const cell = report.grid.cell_m;
  return section("map", "Before, after and between", "Map",
    pictures.length ? null : el("p", { class: "warn" }, `Without pictures (--no-pictures): ${parts}s stand on empty ground.`),
    el("div", { class: "tools" }, ...tools),
    el("div", { class: "tools keys" }, map.switches(), map.shading(), map.zooms(corners)),
    map.view.root, map.shadeLegend, map.legend, map.card,
    el("h3", {}, parts === "plot" ? "Plot by plot" : "Square by square"),
    report.surface ? el("p", { class: "hint" }, layers.squares && parts === "square"
      ? "The mean of a square is more than errors where it exceeds the mean level of its cells: neighbours err as one."
      : `The mean of a ${parts} is more than errors where it exceeds what all of it has in common: of its sources, and of the maps' frames.`) : null,
    map.lists(),
    map.hint(`Cells are ${length(cell)}${pictures.length ? `, pixels ${length(pictures[0].json.pixel_m)}` : ""}; the GeoTIFFs have all cells. ` +
      "Where the map is empty nothing was compared."));
}

function numbersPart(report, facts, scene) {
  return section("numbers", "All of it in numbers", "Numbers",
    scene.cells ? changeChart(scene.cells) : null,
    el("h3", {}, "In words"),
    el("dl", { class: "words" }, ...facts.facts.map(([label, text]) => el("div", {}, el("dt", {}, label), el("dd", {}, text.replaceAll("+-", "±").replace(/\bm([23])\b/g, (_, k) => (k === "2" ? "m²" : "m³")))))),
    el("p", {}, `Between the frames of both maps ${known(report.frame_error.height_m) && report.frame_error.height_m + report.frame_error.plane_m > 0
      ? `${cm(report.frame_error.height_m)} in height and ${cm(report.frame_error.plane_m)} in the plane are expected`
      : "no error is expected"}. AgriColMap ${facts.version}.`),
    el("pre", { tabindex: "0", "aria-label": "Command line" }, facts.command_line.join(" ")));
}

export function changeParts(report, facts, scene) {
  return [changeIntroduction(report, facts), changeSection(scene, report), numbersPart(report, facts, scene)];
}
