// The 3-D view's place on the page; the view itself is bundled apart (view3d.js) and may be absent.

import { el, section } from "./dom.js";

export function view3dSection(report, facts) {
  return section("space", "Both clouds in 3-D", "3-D",
    el("p", {}, facts.with_3d ? "" :
      "This build of AgriColMap has no 3-D view: npm was missing when it was built."));
}
