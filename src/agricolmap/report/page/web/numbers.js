// What others need to go on: the transformation to copy, clouds, times, options, versions.

import { button, choice, el, section, table } from "./dom.js";
import { bytes, count, degrees, exact, fixed, known, length, seconds } from "./format.js";
import { formats } from "./transform.js";

async function copyText(pre, said) {
  const range = document.createRange();
  range.selectNodeContents(pre);
  getSelection().removeAllRanges();
  getSelection().addRange(range);
  try {
    await navigator.clipboard.writeText(pre.textContent);
    said.textContent = "Copied.";
  } catch {
    said.textContent = "Selected; copy it with Ctrl+C.";
  }
}

export function transformSection(report, facts) {
  const state = { format: "matrix", local: false };
  const pre = el("pre", { tabindex: "0", "aria-label": "The transformation" });
  const note = el("p", { class: "hint" });
  const said = el("span", { role: "status" });
  const copy = button("Copy", () => copyText(pre, said));
  const show = (change) => {
    Object.assign(state, change);
    const [, , text, words] = formats(report, facts, state.local)
      .find(([name]) => name === state.format);
    pre.textContent = text ?? "";
    pre.hidden = copy.hidden = text === null;
    note.textContent = words;
    said.textContent = "";
  };
  show({});
  const { local } = report.transform;
  const all = formats(report, facts, false).map(([name, title]) => [name, title]);
  return section("transform", "The transformation, to copy", "Transformation",
    report.status === "accepted" ? null
      : el("p", { class: "warn" }, "This registration was not accepted: do not use this matrix " +
        "without having looked at the map."),
    report.deformation
      ? el("p", { class: "warn" }, "The strip is bent, too: this matrix alone leaves parts of it up " +
        `to ${length(report.deformation.most_m)} off. The aligned cloud and agricolmap apply ` +
        "have the bend taken out.") : null,
    el("div", { class: "tools" },
      choice("format", "For", all, "matrix", (format) => show({ format })),
      choice("frame", "Coordinates", [["file", "as in the files"], ["local", "relative to origins"]],
        "file", (frame) => show({ local: frame === "local" })),
      copy, said),
    pre, note,
    el("p", { class: "hint" }, `Origins: drone ${local.fixed_origin_m.map(exact).join(" ")}; strip ` +
      `${local.moving_origin_m.map(exact).join(" ")}.`));
}

function cloudRows(report) {
  const pair = (label, of) => [label, of(report.fixed), of(report.moving)];
  const box = (c) => c.box_max_m.map((v, i) => fixed(v - c.box_min_m[i], 1)).join(" × ") + " m";
  return [
    pair("File", (c) => c.path),
    pair("Points", (c) => count(c.points)),
    pair("Left out on reading", (c) => count(c.dropped_points)),
    pair("Strays, no part of the map", (c) => count(c.stray_points)),
    pair("Colours", (c) => (c.has_colour ? "yes" : "no")),
    pair("Extent", box),
    pair("Coordinate system", (c) => c.crs?.name ?? "not said"),
    pair("Ground tilted by", (c) => degrees(c.ground.tilt_deg)),
    pair("Ground rough by", (c) => length(c.ground.roughness_m)),
    pair("Map", (c) => `${c.map.cols} × ${c.map.rows} cells of ${length(c.map.cell_m)}`),
  ];
}

const label = (key) => key.replace(/_s$/, "").replaceAll("_", " ");

function timesTable(report) {
  const stages = Object.entries(report.times.stages);
  const most = Math.max(...stages.map(([, value]) => value), 1e-9);
  return table("Stages, in order", ["Stage", "Time", ""], stages.map(([name, value]) => [
    label(name), seconds(value),
    el("span", { class: "length", style: `width:${(100 * value) / most}%`, "aria-hidden": "true" })]));
}

function optionRows(options) {
  return options.map((o) => [o.path, `${o.value}${o.unit ? ` ${o.unit}` : ""}`, o.default, o.help]);
}

function optionsPart(report, facts) {
  const changed = facts.options.filter((o) => o.value !== o.default);
  const heads = ["Option", "In force", "Default", "Meaning"];
  return [
    changed.length
      ? table(`Options that differ from preset ${report.preset}`, heads, optionRows(changed))
      : el("p", {}, `All options are those of preset ${report.preset}.`),
    el("details", {}, el("summary", {}, `All ${facts.options.length} options in force`),
      table("All options in force", heads, optionRows(facts.options))),
  ];
}

export function numbersSection(report, facts) {
  const counts = Object.entries(report.counts).filter(([, value]) => known(value));
  return section("numbers", "Clouds, times, options", "Numbers",
    table("The two clouds", ["", "Drone (fixed)", "Strip (moving)"], cloudRows(report)),
    timesTable(report),
    el("p", {}, `${seconds(report.times.total_s)} in all, on ${report.threads} ` +
      `thread${report.threads === 1 ? "" : "s"}, with at most ${bytes(report.peak_memory_bytes)} of memory.`),
    el("details", {}, el("summary", {}, "What each stage counted"),
      table("Counts", ["What", "How many"], counts.map(([name, value]) =>
        [label(name), Number.isInteger(value) ? count(value) : exact(value)]))),
    el("h3", {}, "Options"), ...optionsPart(report, facts),
    el("h3", {}, "To do it again"),
    el("p", {}, `Guess: ${report.prior.source}. Seed ${report.seed}. AgriColMap ${report.version}.`),
    report.command_line ? el("pre", { tabindex: "0", "aria-label": "Command line" }, report.command_line) : null);
}
