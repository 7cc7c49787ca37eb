// Puts the page together from the three pieces of data in it.

import { el } from "./dom.js";
import { batchParts } from "./batch.js";
import { changeParts } from "./change.js";
import { factsParts } from "./facts.js";
import { registrationParts } from "./registration.js";
import { sharedMapParts } from "./shared_map.js";

const read = (id) => JSON.parse(document.getElementById(id).textContent);

// By the format of what it is a page of.
const KINDS = {
  "agricolmap-registration": ["registration report", registrationParts],
  "agricolmap-batch-summary": ["batch report", batchParts],
  "agricolmap-map": ["map of a field", sharedMapParts],
  "agricolmap-facts": ["crop facts", factsParts],
  "agricolmap-change": ["change of a field", changeParts],
};

function build() {
  const report = read("data-report");
  const [kind, partsOf] = KINDS[report.format];
  const parts = partsOf(report, read("data-facts"), read("data-scene"));
  document.getElementById("kind").textContent = kind;
  document.getElementById("report").replaceChildren(...parts);
  document.getElementById("contents").replaceChildren(...parts.map((part) =>
    el("a", { href: `#${part.id}` }, part.dataset.short)));
}

build();
