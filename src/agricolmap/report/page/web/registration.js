// The page of one registration.

import { el, section, svg } from "./dom.js";
import { shortNames } from "./format.js";
import { bendWords, errorWords, figures, lead, otherPlaces, placeWords, sureWords, title, useWords } from "./words.js";
import { mapSection } from "./map_section.js";
import { bendSection, sureSection } from "./charts.js";
import { numbersSection, transformSection } from "./numbers.js";
import { view3dSection } from "./view3d_section.js";

// A shape of its own for each verdict: colours alone would not do.
const SHAPES = {
  accepted: "M5 12.5l4.5 4.5L19 7.5",
  rejected: "M6 6l12 12M18 6L6 18",
  ambiguous: "M8 9a4 4 0 1 1 5.5 3.7c-1 .4-1.5 1-1.5 2.3M12 18.5v.01",
};

function verdictSection(report, facts) {
  const status = report.status;
  const [fixedName, movingName] = shortNames(report.fixed.path, report.moving.path);
  const icon = svg("svg", { viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" },
    svg("path", { d: SHAPES[status] }));
  const sentences = [placeWords(report, facts), ...otherPlaces(report), sureWords(report),
    errorWords(report), bendWords(report)].filter(Boolean);
  const tiles = figures(report, facts);
  const use = useWords(report);
  return el("section", { id: "verdict", class: `verdict ${status}`, tabindex: "-1", "aria-labelledby": "verdict-title",
    "data-short": "Verdict" },
    el("p", { class: "subject" }, `${movingName}, laid into ${fixedName}`),
    el("h1", { id: "verdict-title" }, icon, title(report)),
    el("p", { class: "lead" }, lead(report)),
    use ? el("p", { class: `use${report.deformation || report.heights?.status === "limited" ? " careful" : ""}` }, use) : null,
    status === "accepted" ? null : reasonsPart(report),
    tiles.length ? el("dl", { class: "figures" }, ...tiles.map(([label, value, meaning, tone]) =>
      el("div", { class: tone }, el("dt", {}, label), el("dd", {}, el("strong", {}, value), el("span", {}, meaning))))) : null,
    el("p", {}, sentences.join(" ")),
    status === "accepted" ? reasonsPart(report) : null,
    report.warnings.length ? el("div", {}, el("h2", {}, "Worth knowing"),
      el("ul", {}, ...report.warnings.map((line) => el("li", {}, line)))) : null);
}

function reasonsPart(report) {
  const list = (lines) => el("ul", {}, ...lines.map((line) => el("li", {}, line)));
  return el("div", { class: "reasons" },
    el("div", {}, el("h2", {}, report.status === "accepted" ? "Why it was accepted" : "Why"),
      list(report.reasons)),
    report.remedies.length ? el("div", {}, el("h2", {}, "What may help"), list(report.remedies),
      el("p", { class: "hint" },
        "The guess is --prior FILE or offset.xyz; how good it is, --prior-sigma METRES,DEGREES,PERCENT, as in " +
        "--prior-sigma 2,5,10, or none; --scale-unknown where the strip's unit is not known.")) : null);
}

/** Why there is no map here. */
const missingSection = (facts) => section("map", "Before and after", "Map",
  el("p", {}, `There are no maps and no 3-D view on this page: ${facts.scene_missing}.`));

export function registrationParts(report, facts, scene) {
  const parts = [verdictSection(report, facts)];
  parts.push(scene?.maps ? mapSection(report, facts, scene.maps) : missingSection(facts));
  if (report.transform) parts.push(sureSection(report, facts));
  if (report.deformation) parts.push(bendSection(report));
  if (scene && (scene.points || !facts.with_3d)) parts.push(view3dSection(report, facts, scene.points));
  if (report.transform) parts.push(transformSection(report, facts));
  parts.push(numbersSection(report, facts));
  return parts;
}
