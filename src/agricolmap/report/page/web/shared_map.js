// The page of a shared map: its layers side by side, and what it was made of.

import { Picture, RAMPS, sourceColour } from "./layers.js";
import { MapView } from "./map_view.js";
import { mapHint, rampLegend, zoomButtons } from "./map_section.js";
import { choice, el, section, table } from "./dom.js";
import { count, fixed, known, length } from "./format.js";

const MAP_LAYERS = [["colour", "Colour"], ["plant_height", "Plant height"], ["exg", "Excess Green"],
  ["source", "Source"], ["plane_error", "Error in the plane"], ["height_error", "Error in height"]];

const area = (value) => (value >= 1e4 ? `${fixed(value / 1e4, 2)} ha` : `${fixed(value, 0)} m²`);
const day = (date) => (date ? String(date).replace(/(\d{4})(\d\d)(\d\d)/, "$1-$2-$3") : "not said");

function introduction(map) {
  const strips = map.sources.slice(1);
  const wrong = map.overlaps.filter((pair) => !pair.plausible);
  const { rows, cols, cell_m: cell } = map.frame;
  const owned = strips.reduce((sum, strip) => sum + strip.owned_m2, 0);
  return el("section", { id: "verdict", class: `verdict ${wrong.length ? "ambiguous" : "accepted"}`,
    tabindex: "-1", "aria-labelledby": "verdict-title", "data-short": "Map" },
    el("p", { class: "subject" }, map.sources[0].file),
    el("h1", { id: "verdict-title" }, `One map of a drone and ${strips.length} strip${strips.length === 1 ? "" : "s"}`),
    el("p", { class: "lead" }, wrong.length
      ? `Look twice: ${wrong.map((pair) => pair.strips.join(" and ")).join(", ")} contradict each ` +
        "other where they overlap, so that one of them must lie wrong."
      : map.overlaps.length ? "Where strips overlap they do not contradict each other."
        : "No two strips overlap, so that none can contradict another."),
    el("dl", { class: "figures" }, ...[
      ["Extent", `${fixed(cols * cell, 0)} × ${fixed(rows * cell, 0)} m`, `in cells of ${length(cell)}`],
      ["Seen by robots", area(owned), "the rest is the drone's"],
      ...(map.cloud ? [["Points", count(map.sources.reduce((sum, source) =>
        sum + source.points_in_cloud, 0)), map.cloud]] : []),
    ].map(([label, value, meaning]) => el("div", {}, el("dt", {}, label),
      el("dd", {}, el("strong", {}, value), el("span", {}, meaning))))),
    map.flat ? el("p", {}, "These clouds have no heights, so the map has none.") : null,
    map.warnings.length ? el("ul", {}, ...map.warnings.map((line) => el("li", {}, line))) : null);
}

function legendOf(layer, map, scales) {
  if (layer === "source") {
    return el("p", { class: "key clouds" }, ...map.sources.map((source) => el("span", {},
      el("i", { class: "swatch", style: `background:#${sourceColour(source.code)}` }), source.id)));
  }
  return RAMPS[layer] ? rampLegend(layer, scales[layer]) : null;
}

function layersSection(map, maps) {
  const picture = new Picture(maps.fixed[0], maps.fixed[0].local_from_image);
  const layers = MAP_LAYERS.filter(([name]) => picture.has(name));
  const titles = new Map(layers);
  const state = { left: "colour", right: picture.has("plant_height") ? "plant_height" : "exg" };
  const corners = picture.corners();
  const view = new MapView({
    base: [picture], focus: corners, origin: map.frame.origin_m,
    middle: [0, 1].map((k) => (corners[0][k] + corners[2][k]) / 2),
    label: "The field from above",
    sides: () => [state.left, state.right].map((layer) =>
      ({ label: titles.get(layer), layer, strips: [], other: [] })),
  }, state);
  const legend = el("div", { class: "legend" });
  const redraw = async (change) => {
    Object.assign(state, change);
    await Promise.all([state.left, state.right].map((layer) => picture.prepare(layer)));
    legend.replaceChildren(...[...new Set([state.left, state.right])].flatMap((layer) => {
      const key = legendOf(layer, map, maps.scales);
      return key ? [el("div", { class: "tools" }, el("span", {}, titles.get(layer)), key)] : [];
    }));
    view.draw();
  };
  redraw({});
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.draw());
  return section("map", "The field", "Layers",
    el("div", { class: "tools" },
      choice("left", "Left", layers, state.left, (left) => redraw({ left })),
      choice("right", "Right", layers, state.right, (right) => redraw({ right })),
      zoomButtons(view, [["Whole map", corners]])),
    view.root, legend,
    mapHint(`Pixels are ${length(maps.fixed[0].pixel_m)}; layers/*.tif have all cells. Grey: nothing is known.`));
}

function sourcesSection(map) {
  const rows = map.sources.map((source) => [
    source.id, day(source.date), count(source.points), count(source.points_in_cloud),
    known(source.plane_error_m) ? `± ${length(source.plane_error_m)}` : "",
    source.heights_limited ? "limited" : known(source.height_error_m) ? `± ${length(source.height_error_m)}` : "",
    known(source.owned_m2) ? area(source.owned_m2) : "",
    source.moved_m ? length(Math.hypot(source.moved_m[0], source.moved_m[1])) : ""]);
  const overlaps = map.overlaps.map((pair) => [pair.strips.join(" and "), area(pair.area_m2),
    length(Math.hypot(pair.offset_m[0], pair.offset_m[1])), `${fixed(pair.sigmas, 1)} deviations`,
    pair.plausible ? "yes" : "no: one must lie wrong"]);
  return section("sources", "What it was made of", "Sources",
    table("Sources", ["Source", "Date", "Points", "In the map", "In the plane", "In height", "Has in the map",
      "Moved to fit"], rows),
    overlaps.length ? table("Strips that overlap", ["Strips", "Area", "Apart", "That is", "Plausible"], overlaps)
      : null,
    el("h3", {}, "To do it again"),
    el("p", {}, `AgriColMap ${map.version}.`),
    el("pre", { tabindex: "0", "aria-label": "Command line" }, map.command_line.join(" ")));
}

export function sharedMapParts(map, facts, scene) {
  const parts = [introduction(map)];
  if (scene?.maps) parts.push(layersSection(map, scene.maps));
  parts.push(sourcesSection(map));
  return parts;
}
