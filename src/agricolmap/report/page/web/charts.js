// Charts whose every mark can be pointed at, or reached with the Tab key, for its numbers.

import { el, section, svg } from "./dom.js";
import { fixed, known, length, percent } from "./format.js";

const WIDTH = 720;
const LEFT = 54, RIGHT = 66, TOP = 14, BOTTOM = 40;

function niceTicks(low, high, most) {
  const span = high - low || 1;
  const rough = span / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough);
  const ticks = [];
  for (let t = Math.ceil(low / step) * step; t <= high + 1e-9 * span; t += step) ticks.push(t);
  return { ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** Axes with `x` and `y` to pixels. */
function axes(height, [x0, x1], [y0, y1], xLabel, yLabel) {
  const x = (v) => LEFT + ((v - x0) / (x1 - x0 || 1)) * (WIDTH - LEFT - RIGHT);
  const y = (v) => height - BOTTOM - ((v - y0) / (y1 - y0 || 1)) * (height - TOP - BOTTOM);
  const parts = [];
  const ys = niceTicks(y0, y1, 5);
  for (const t of ys.ticks) {
    parts.push(svg("line", { class: t === 0 ? "zero" : "grid", x1: LEFT, x2: WIDTH - RIGHT, y1: y(t), y2: y(t) }),
      svg("text", { x: LEFT - 8, y: y(t) + 4, "text-anchor": "end" }, fixed(t, ys.digits)));
  }
  const xs = niceTicks(x0, x1, 8);
  for (const t of xs.ticks) {
    parts.push(svg("text", { x: x(t), y: height - BOTTOM + 18, "text-anchor": "middle" },
      fixed(t, xs.digits)));
  }
  parts.push(svg("text", { class: "axis", x: (LEFT + WIDTH - RIGHT) / 2, y: height - 4, "text-anchor": "middle" }, xLabel),
    svg("text", { class: "axis", x: 14, y: (TOP + height - BOTTOM) / 2, "text-anchor": "middle",
      transform: `rotate(-90 14 ${(TOP + height - BOTTOM) / 2})` }, yLabel));
  return { x, y, parts };
}

/** A figure whose marks tell `words` when pointed at or focused. */
function figure(label, height, parts, hint) {
  const said = el("p", { class: "said", "aria-live": "polite" }, hint);
  const chart = svg("svg", { viewBox: `0 0 ${WIDTH} ${height}`, role: "group", "aria-label": label }, ...parts);
  for (const mark of chart.querySelectorAll("[data-words]")) {
    const tell = () => { said.textContent = mark.dataset.words; };
    mark.addEventListener("pointerenter", tell);
    mark.addEventListener("focus", tell);
  }
  return el("figure", {}, el("div", { class: "scroll chart" }, chart), said);
}

function mark(x, y, agrees, words) {
  const size = 6;
  const shape = agrees
    ? svg("circle", { cx: x, cy: y, r: size })
    : svg("path", { d: `M${x - size} ${y - size}l${2 * size} ${2 * size}m0 ${-2 * size}l${-2 * size} ${2 * size}` });
  return svg("g", { class: `mark ${agrees ? "yes" : "no"}`, tabindex: "0", role: "img",
    "aria-label": words, "data-words": words },
    svg("rect", { x: x - 11, y: y - 11, width: 22, height: 22, fill: "transparent" }), shape);
}

export function blocksChart(facts, agreement) {
  const blocks = facts.blocks;
  const height = 240;
  const off = (b) => 100 * Math.hypot(b.offset_along_m, b.offset_across_m);
  const most = Math.max(1.25 * 100 * agreement, 1.08 * Math.max(...blocks.map(off)));
  const { x, y, parts } = axes(height, [0, facts.strip.length_m], [0, most],
    "along the strip [m]", "off by [cm]");
  const limit = y(100 * agreement);
  parts.unshift(svg("rect", { class: "band", x: LEFT, width: WIDTH - LEFT - RIGHT, y: limit,
    height: y(0) - limit }));
  parts.push(svg("text", { x: WIDTH - RIGHT + 8, y: limit + 14 }, "agrees"));
  blocks.forEach((b) => {
    const words = `Block at ${fixed(b.along_m, 1)} m, ${b.agrees ? "agrees" : "disagrees"}: placed ` +
      `alone it fits best ${length(off(b) / 100)} away (${fixed(100 * b.offset_along_m, 1)} cm along, ` +
      `${fixed(100 * b.offset_across_m, 1)} cm across the strip).`;
    // Those side by side across the strip beside each other, too.
    parts.push(mark(x(b.along_m) + 6 * Math.sign(b.across_m), y(off(b)), b.agrees, words));
  });
  return figure("Blocks along the strip, and how far off each is", height, parts,
    "Point at a block, or tab to it, for its numbers.");
}

/** Scores side by side: the strip's own, the next best place, mirrored copies. */
export function scoresChart(report) {
  const { significance, uniqueness, decoys } = report.evidence;
  const rows = [{ label: report.alternatives.length ? "Place 1" : "This place", value: significance, own: true }];
  report.alternatives.forEach((other, i) =>
    rows.push({ label: `Place ${i + 2}`, value: other.significance }));
  // What is highest beside it may be one of the places above.
  const next = known(uniqueness) && uniqueness > 0 ? significance / uniqueness : 0;
  if (next > 0 && !report.alternatives.some((other) => Math.abs(other.significance / next - 1) < 0.01)) {
    rows.push({ label: "Next best place", value: next });
  }
  decoys.forEach((value, i) => rows.push({ label: `Mirrored copy ${i + 1}`, value }));
  const most = Math.max(...rows.map((row) => row.value), 1e-9);
  return el("figure", { class: "bars" },
    el("dl", {}, ...rows.flatMap((row) => [
      el("dt", {}, row.label),
      el("dd", { class: row.own ? "own" : "" },
        el("span", { class: "length", style: `width:${(70 * Math.max(0, row.value)) / most}%`, "aria-hidden": "true" }),
        el("span", {}, fixed(row.value, 1)))])),
    el("figcaption", {}, decoys.length
      ? "How far each place stands out from chance, in standard deviations. Mirrored copies of the " +
        "strip fit nowhere: their scores are what a wrong place reaches on this pair."
      : "How far each place stands out from chance, in standard deviations. A score this high is not " +
        "reached by chance: mirrored copies of the strip were not needed to compare with."));
}

export function sureSection(report, facts) {
  const agreement = Number(facts.options.find((o) => o.path === "evidence.agreement").value);
  const { agreeing_blocks: agreeing } = report.evidence;
  const total = facts.blocks.length;
  const title = report.status === "accepted" ? "What speaks for it" : "What speaks for and against it";
  return section("sure", title, "Evidence",
    el("h3", {}, "The strip's score beside wrong places"),
    scoresChart(report),
    el("h3", {}, "Parts of the strip, each placed alone"),
    el("p", {}, total
      ? `The strip is cut into ${total} blocks, and each is looked for by itself. ${agreeing} of them ` +
        `find the place that the whole gives them, to ${length(agreement)}. A block alone is placed less ` +
        "exactly than the whole: leaves and shadows move it by centimetres, and one that shows little is placed " +
        "anywhere. Where several side by side are off by the same, that part of the strip lies elsewhere."
      : "Too little of the strip can be compared to place parts of it alone."),
    total ? blocksChart(facts, agreement) : null,
    el("p", {}, `${percent(report.residuals?.overlap)} of the strip lie on the drone's map.`));
}

/** How many cells changed by how much, those beyond their errors apart. */
export function changeChart({ reach_m: reach, sure, unsure }) {
  const height = 240;
  const most = Math.max(1, ...sure.map((value, i) => value + unsure[i]));
  const plot = axes(height, [-100 * reach, 100 * reach], [0, 100], "change of the surface [cm]", "cells [% of the fullest]");
  const { x, y, parts } = plot;
  const wide = (2 * reach * 100) / sure.length;
  const all = sure.reduce((sum, value, i) => sum + value + unsure[i], 0);
  for (const [i, value] of sure.entries()) {
    const [from, to] = [-100 * reach + i * wide, -100 * reach + (i + 1) * wide];
    const [low, high] = [(100 * value) / most, (100 * (value + unsure[i])) / most];
    const edge = i === 0 ? "and less" : i === sure.length - 1 ? "and more" : `to ${fixed(to, 1)} cm`;
    const words = `${fixed(i === 0 ? to : from, 1)} cm ${edge}: ${percent((value + unsure[i]) / all)} of the cells, ` +
      `${percent(value / Math.max(1, value + unsure[i]))} of them by more than their errors.`;
    parts.push(svg("g", { class: "mark cells", tabindex: "0", role: "img", "aria-label": words, "data-words": words },
      svg("rect", { x: x(from), y: TOP, width: x(to) - x(from), height: height - TOP - BOTTOM, fill: "transparent" }),
      svg("rect", { class: "unsure", x: x(from) + 0.5, y: y(high), width: x(to) - x(from) - 1, height: y(low) - y(high) }),
      svg("rect", { class: from + to < 0 ? "fell" : "rose", x: x(from) + 0.5, y: y(low), width: x(to) - x(from) - 1, height: y(0) - y(low) })));
  }
  return figure("Cells by their change", height, parts, "Cells by their change; grey: by no more than their errors. Point at a bar, or tab to it.");
}

const AXES = [["east", "x", 0], ["north", "y", 1], ["up", "z", 2]];

function bendLine(nodes, axis, { x, y }) {
  const at = (node, sign) => {
    const value = 100 * node.displacement_m[axis] + sign * 100 * (node.deviation_m[axis] ?? 0);
    return `${x(node.along_m).toFixed(1)} ${y(value).toFixed(1)}`;
  };
  const band = [...nodes.map((n) => at(n, 1)), ...[...nodes].reverse().map((n) => at(n, -1))];
  return [svg("path", { class: `bend-band a${axis}`, d: `M${band.join("L")}Z` }),
    svg("path", { class: `bend a${axis}`, d: `M${nodes.map((n) => at(n, 0)).join("L")}` })];
}

export function bendSection(report) {
  const bend = report.deformation;
  const nodes = bend.nodes;
  const height = 300;
  const shown = AXES.filter(([, , k]) => nodes.every((n) => known(n.displacement_m[k])));
  const values = nodes.flatMap((n) => shown.flatMap(([, , k]) =>
    [-1, 1].map((sign) => 100 * (n.displacement_m[k] + sign * (n.deviation_m[k] ?? 0)))));
  const plot = axes(height, [0, bend.length_m], [Math.min(0, ...values), Math.max(0, ...values)],
    "along the path [m]", "displaced by [cm]");
  const parts = plot.parts;
  for (const [, , k] of shown) parts.push(...bendLine(nodes, k, plot));
  const { x, y } = plot;
  for (const slip of bend.slips) {
    parts.push(svg("line", { class: "slip", x1: x(slip.along_m), x2: x(slip.along_m), y1: TOP, y2: height - BOTTOM }),
      svg("text", { x: x(slip.along_m) + 5, y: TOP + 12 }, "slip"));
  }
  for (const n of nodes) {
    const words = `At ${fixed(n.along_m, 1)} m: ` + shown.map(([name, , k]) =>
      `${fixed(100 * n.displacement_m[k], 1)} ± ${fixed(100 * (n.deviation_m[k] ?? 0), 1)} cm ${name}`).join(", ") + ".";
    parts.push(svg("g", { class: "mark node", tabindex: "0", role: "img", "aria-label": words, "data-words": words },
      svg("rect", { x: x(n.along_m) - 9, y: TOP, width: 18, height: height - TOP - BOTTOM, fill: "transparent" }),
      ...shown.map(([, , k]) => svg("circle", { class: `a${k}`, cx: x(n.along_m), cy: y(100 * n.displacement_m[k]), r: 3 }))));
  }
  return section("bend", "How the strip bends", "Bend",
    el("p", {}, `Beside the transformation every point is displaced by this much; bands show one ` +
      `standard deviation. Parts that took no part in finding it confirm it by ` +
      `${fixed(bend.gain, 1)} standard errors.`),
    figure("Displacement along the path", height, parts, "Point at the curve, or tab along it, for its numbers."),
    el("p", { class: "key" }, ...shown.map(([name, letter, k]) =>
      el("span", { class: `a${k}` }, `${name} (${letter})`))),
    bend.slips.length ? el("ul", {}, ...bend.slips.map((slip) =>
      el("li", {}, `Slip at ${fixed(slip.along_m, 1)} m: all behind it lies ` +
        `${length(Math.hypot(...slip.offset_m.slice(0, 2)))} off what is before it.`))) : null);
}
