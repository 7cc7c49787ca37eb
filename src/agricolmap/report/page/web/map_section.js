// Before and after: the map with its switches.

import { apply, Picture, RAMPS } from "./layers.js";
import { MapView } from "./map_view.js";
import { button, check, choice, el, section } from "./dom.js";
import { fixed } from "./format.js";
import { unguessed } from "./words.js";

const LAYERS = [["colour", "Colour"], ["exg", "Excess Green"], ["height", "Height"]];

/** `words`: of both ends, where they are no metres. */
export function rampLegend(layer, [low, high], words = undefined) {
  const ends = words ?? (["exg", "green"].includes(layer) ? ["soil", "plants"] : [`${fixed(low, 2)} m`, `${fixed(high, 2)} m`]);
  return el("p", { class: "ramp" }, el("span", {}, ends[0]),
    el("span", { class: "bar", "aria-hidden": "true",
      style: `background:linear-gradient(to right,${RAMPS[layer].map((c) => `#${c}`)})` }),
    el("span", {}, ends[1]));
}

const middleOf = (corners) => [0, 1].map((k) =>
  corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);

/** Everything that can lie on the map. */
function sceneOf(report, facts, maps) {
  const best = report.status === "accepted" ? "Registered" : "Best answer";
  const came = unguessed(report, facts) ? "As it came" : "As guessed";
  const base = maps.fixed.map((json) => new Picture(json, json.local_from_image));
  const strip = new Picture(maps.moving.picture, maps.moving.before);
  const bent = maps.moving.straight ? new Picture(maps.moving.straight, maps.moving.after) : strip;
  const laid = (picture, affine) => ({ picture, affine,
    outline: (picture.json.rectangle_m ?? []).map((corner) => apply(affine, corner)) });
  const before = laid(strip, maps.moving.before);
  const after = maps.moving.after ? laid(bent, maps.moving.after) : null;
  const others = (maps.moving.others ?? []).map((affine) => laid(strip, affine));
  const places = after ? [after, ...others] : [];
  const focus = report.status === "ambiguous" ? places.flatMap((place) => strip.corners(place.affine))
    : [...strip.corners(maps.moving.before), ...(after ? bent.corners(after.affine) : [])];
  return {
    base, focus, middle: middleOf(after ? bent.corners(after.affine) : strip.corners()), origin: report.fixed.origin_m,
    pictures: [...base, strip, bent],
    whole: base[0].corners(),
    placesOf: (place) => [...strip.corners(maps.moving.before), ...strip.corners(places[place].affine)],
    label: "The drone's map from above with the robot's strip on it",
    sides(state) {
      const rest = places.map((place, i) => ({ outline: place.outline, label: `Place ${i + 1}` }))
        .filter((_, i) => i !== state.place);
      const found = { other: before.outline, rest, label: others.length ? `Place ${state.place + 1}` : best,
        strips: places.length ? [places[state.place]] : [],
        blocks: state.place === 0 ? facts.blocks : null };
      const guess = { label: came, strips: [before],
        other: places.length ? places[state.place].outline : [] };
      const bare = { label: "Drone alone", strips: [], other: [], rest };
      if (!places.length) return [bare, guess];
      return state.compare === "guess" ? [guess, found] : [bare, found];
    },
  };
}

function candidates(report, redraw) {
  if (!report.alternatives.length) return null;
  const all = ["", ...report.alternatives].map((_, i) => [String(i), `Place ${i + 1}`]);
  return choice("place", "Candidate", all, "0", (value) => redraw({ place: Number(value) }));
}

export function mapHint(words) {
  return el("p", { class: "hint", id: "map-keys" },
    `${words} Drag to pan. Zoom with the buttons, by pinching, or with the wheel after a click (or ` +
    "with Ctrl). Keys on the map: arrows, plus, minus, 0; on the handle: arrows, Home, End.");
}

/** Buttons that show what there is to see: [label, its corners]. */
export function zoomButtons(view, sights) {
  return el("span", { class: "zoom", role: "group", "aria-label": "Zoom" },
    button("\u2212", () => view.zoom(0.8), { "aria-label": "Zoom out" }),
    button("+", () => view.zoom(1.25), { "aria-label": "Zoom in" }),
    ...sights.map(([label, corners]) => button(label, () => view.fitTo(corners))));
}

export function mapSection(report, facts, maps) {
  const scene = sceneOf(report, facts, maps);
  const layers = LAYERS.filter(([name]) => scene.pictures.every((picture) => picture.has(name)));
  const start = unguessed(report, facts) && report.transform ? "drone" : "guess";
  const state = { layer: layers[0][0], compare: start, outline: true, blocks: false, place: 0 };
  const view = new MapView(scene, state);
  const legend = el("div", { class: "legend" });
  const redraw = async (change) => {
    Object.assign(state, change);
    await Promise.all(scene.pictures.map((picture) => picture.prepare(state.layer)));
    legend.replaceChildren(...(RAMPS[state.layer] ? [rampLegend(state.layer, maps.height_m)] : []));
    view.draw();
  };
  const tools = el("div", { class: "tools" },
    layers.length > 1 ? choice("layer", "Layer", layers, state.layer,
      (layer) => redraw({ layer })) : null,
    report.transform ? choice("compare", "Left of the handle",
      [["guess", start === "guess" ? "as guessed" : "as it came"], ["drone", "drone alone"]], start,
      (compare) => redraw({ compare })) : null,
    candidates(report, (change) => {
      view.fitTo(scene.placesOf(change.place));
      redraw(change);
    }),
    check("Outline", true, (outline) => redraw({ outline })),
    facts.blocks.length ? check("Blocks", false, (blocks) => redraw({ blocks })) : null,
    zoomButtons(view, [["Strip", scene.focus], ["Whole map", scene.whole]]));
  redraw({});
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.draw());
  const bend = report.deformation
    ? " On the registered side the bend is taken out of the strip." : "";
  return section("map", "Before and after", "Map",
    el("p", {}, report.transform
      ? `Drag the handle. Left of it ${start === "guess" ? "the strip lies where the guess put it" : "is the drone's map alone"}, ` +
        `right of it the strip lies where the ${report.status === "accepted" ? "registration" : "best answer"} puts it: ` +
        `its rows and plants and the map's should run into each other across the outline.${bend}`
      : "There is no registered place; the strip is shown where the guess put it."),
    tools, view.root, legend,
    mapHint("Dashed: the strip's place on the other side" +
      `${report.alternatives.length ? ", and the other places where it fits, with their numbers" : ""}. Grey: not seen ` +
      "by the drone, or too far from the guess to be looked at. Blocks: discs agree with the whole, " +
      "crosses do not."));
}
