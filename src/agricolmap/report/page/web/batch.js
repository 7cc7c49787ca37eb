// The page of a batch: which strips to trust, where they lie, and the way to the report of each.

import { choice, el, section, svg } from "./dom.js";
import { fixed, length, percent, seconds } from "./format.js";

const ORDER = ["accepted", "ambiguous", "rejected", "failed"];
const VERDICTS = { accepted: "Accepted", ambiguous: "Ambiguous", rejected: "Rejected", failed: "Failed" };

const reportOf = (strip) => `${encodeURIComponent(strip.id)}/report.html`;

function duration(value) {
  return value < 90 ? seconds(value) : value < 5400 ? `${fixed(value / 60, 0)} min` : `${fixed(value / 3600, 1)} h`;
}

function verdictPart(summary) {
  const { counts, strips } = summary;
  const doubtful = strips.length - counts.accepted;
  const lead = strips.length === 0 ? "There is no strip in this batch."
    : doubtful === 0 ? "Every strip was found, and all results can be used."
    : `${counts.accepted} of ${strips.length} strips were found. Do not use the other ` +
      `${doubtful === 1 ? "one" : doubtful} without having looked into why.`;
  return el("section", { id: "verdict", class: `verdict ${doubtful === 0 ? "accepted" : "ambiguous"}`,
    tabindex: "-1", "aria-labelledby": "verdict-title", "data-short": "Verdict" },
    el("p", { class: "subject" }, summary.manifest),
    el("h1", { id: "verdict-title" }, `${counts.accepted} of ${strips.length} accepted`),
    el("p", { class: "lead" }, lead),
    el("dl", { class: "figures" }, ...ORDER.filter((status) => counts[status] > 0).map((status) =>
      el("div", {}, el("dt", {}, VERDICTS[status]),
        el("dd", {}, el("strong", {}, String(counts[status])), el("span", {}, "strips"))))),
    el("p", { class: "hint" }, `It took ${duration(summary.seconds)}.`));
}

/** The strips of one map from above, each a way to its report. */
function plan(map, strips) {
  const corners = strips.flatMap((strip) => strip.outline_m);
  const low = [0, 1].map((k) => Math.min(...corners.map((c) => c[k])));
  const high = [0, 1].map((k) => Math.max(...corners.map((c) => c[k])));
  const margin = 0.04 * Math.max(high[0] - low[0], high[1] - low[1], 1);
  const [width, height] = [0, 1].map((k) => high[k] - low[k] + 2 * margin);
  const shape = (strip) => svg("polygon", { class: `strip ${strip.status}`,
    points: strip.outline_m.map(([x, y]) =>
      `${(x - low[0] + margin).toFixed(3)},${(high[1] - y + margin).toFixed(3)}`).join(" ") },
    svg("title", {}, `${strip.id}: ${VERDICTS[strip.status]}`));
  return el("figure", {}, el("figcaption", {}, `Map ${map}, ${fixed(width, 0)} × ${fixed(height, 0)} m, north up`),
    svg("svg", { class: "plan", viewBox: `0 0 ${width} ${height}`, role: "group", "aria-label": `Strips of map ${map}` },
      ...strips.map((strip) => svg("a", { href: reportOf(strip),
        "aria-label": `${strip.id}: ${VERDICTS[strip.status]}` }, shape(strip)))));
}

function planSection(strips) {
  const maps = [...new Set(strips.map((strip) => strip.map))];
  const laid = (map) => strips.filter((strip) => strip.map === map && strip.outline_m.length > 2);
  return section("plan", "Where the strips lie", "Map",
    el("p", {}, "Accepted strips are filled; the others are drawn in dashes, where their best answer " +
      "or their guess lays them. Click a strip for its report."),
    ...maps.filter((map) => laid(map).length > 0).map((map) => plan(map, laid(map))));
}

const ROWS = [
  ["Strip", (s) => (s.status === "failed" ? s.id : el("a", { href: reportOf(s) }, s.id))],
  ["Verdict", (s) => el("span", { class: `tag ${s.status}` }, VERDICTS[s.status])],
  ["Right place", (s) => (s.status === "failed" ? "" : percent(s.probability))],
  ["In the plane", (s) => (s.status === "accepted" ? `± ${length(s.expected_error_m)}` : "")],
  ["In height", (s) => (s.status !== "accepted" ? "" : s.heights === "limited" ? "limited"
    : `± ${length(s.height_error_m)}`)],
  ["Time", (s) => (s.status === "failed" ? "" : seconds(s.seconds))],
  ["Why", (s) => s.message],
];

const SORTS = {
  listed: () => 0,
  doubtful: (a, b) => ORDER.indexOf(b.status) - ORDER.indexOf(a.status) || a.probability - b.probability,
  name: (a, b) => a.id.localeCompare(b.id, "en", { numeric: true }),
};

function tableSection(summary) {
  const { strips, counts } = summary;
  const state = { status: "all", sort: "listed", text: "" };
  const body = el("tbody");
  const said = el("span", { role: "status", class: "hint" });
  const rows = new Map(strips.map((strip) => [strip, el("tr", {}, ...ROWS.map(([, cell], i) =>
    el(i === 0 ? "th" : "td", i === 0 ? { scope: "row" } : {}, cell(strip))))]));
  const show = (change) => {
    Object.assign(state, change);
    const chosen = strips.filter((strip) => (state.status === "all" || strip.status === state.status) &&
      strip.id.toLowerCase().includes(state.text.toLowerCase())).sort(SORTS[state.sort]);
    body.replaceChildren(...chosen.map((strip) => rows.get(strip)));
    said.textContent = `${chosen.length} shown`;
  };
  show({});
  const search = el("input", { type: "search", oninput: () => show({ text: search.value }) });
  return section("strips", "Strip by strip", "Strips",
    el("div", { class: "tools" },
      choice("status", "Show", [["all", "all"], ...ORDER.filter((status) => counts[status] > 0)
        .map((status) => [status, VERDICTS[status].toLowerCase()])], "all", (status) => show({ status })),
      choice("sort", "Order", [["listed", "as listed"], ["doubtful", "doubtful first"], ["name", "by name"]],
        "listed", (sort) => show({ sort })),
      el("label", { class: "check" }, el("span", {}, "Name has"), search), said),
    el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Strips" },
      el("table", { class: "strips" }, el("thead", {}, el("tr", {}, ...ROWS.map(([head]) => el("th", { scope: "col" }, head)))), body)));
}

export function batchParts(summary) {
  const parts = [verdictPart(summary)];
  if (summary.strips.some((strip) => strip.outline_m.length > 2)) parts.push(planSection(summary.strips));
  parts.push(tableSection(summary));
  return parts;
}
