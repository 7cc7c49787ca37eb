// The 3-D view's place on the page; the view itself is bundled apart (view3d/) and may be absent.

import { button, check, choice, el, section } from "./dom.js";
import { count, fixed, known, length, percent } from "./format.js";
import { rampLegend } from "./map_section.js";

/** A slider with its value beside it. */
function slider(label, [low, high, step, value], words, oninput) {
  const said = el("output", {}, words(value));
  const input = el("input", { type: "range", min: low, max: high, step, value, oninput: () => {
    said.textContent = words(Number(input.value));
    oninput(Number(input.value));
  } });
  return el("label", { class: "slider" }, el("span", {}, label), input, said);
}

const NAMES = { fixed: "Drone", moving: "Strip" };

function shareWords(points) {
  return Object.entries(NAMES).map(([key, name]) => {
    const { count: shown, of } = points[key];
    return `${name}: ${count(shown)} of ${count(of)} points (${shown === of ? "all" : percent(shown / of)})`;
  }).join("; ");
}

function measureWords(picked, origin) {
  if (picked.length === 0) return "Click two points, or press Enter on what is in the middle.";
  const place = ({ cloud, local }) =>
    `${local.map((v, k) => fixed(v + origin[k], 2)).join(" ")} (${NAMES[cloud].toLowerCase()})`;
  if (picked.length === 1) return `From ${place(picked[0])}. Now the other end.`;
  const [a, b] = picked.map((p) => p.local);
  const d = b.map((v, k) => v - a[k]);
  return `${length(Math.hypot(...d))} apart: ${length(Math.hypot(d[0], d[1]))} in the plane, ` +
    `${length(d[2])} in height. From ${place(picked[0])} to ${place(picked[1])}.`;
}

/** The controls of a view that is ready. */
function controls(view, report, points) {
  const said = el("p", { class: "said", role: "status" }, " ");
  const legend = el("div");
  const cutSaid = el("span", { class: "hint", role: "status" });
  const cutTools = el("div", { class: "tools", hidden: true });
  const cut = (change) => {
    const inside = view.cutBy(change);
    cutTools.hidden = view.cut.kind === "none";
    cutSaid.textContent = `${count(inside)} points in the cut`;
  };
  const cutSliders = (kind) => {
    const reach = view.reach[kind];
    cutTools.replaceChildren(
      slider("Position", [-reach, reach, 0.01, 0], (v) => `${fixed(v, 2)} m`, (at) => cut({ at })),
      slider("Width", [0.02, 2, 0.01, view.cut.width], (v) => `${fixed(v, 2)} m`,
        (width) => cut({ width })),
      button("Look at the cut", () => view.look("cut")), cutSaid);
  };
  const colours = [["own", "their own"], ["cloud", "by cloud"], ["height", "by height"]];
  view.onmeasure = (picked) => { said.textContent = measureWords(picked, report.fixed.origin_m); };
  const measure = check("Measure", false, (on) => {
    view.measuring = on;
    view.host.classList.toggle("measuring", on);
    view.clearMeasure();
    if (!on) said.textContent = " ";
  });
  const colour = (mode) => {
    view.colour(mode);
    const heights = view.heights.map((h) => h - view.heights[0]);
    legend.replaceChildren(...(mode === "height" ? [rampLegend("height", heights)]
      : mode === "cloud" ? [el("p", { class: "key clouds" }, el("span", { class: "drone" }, "drone"),
        el("span", { class: "strip" }, "strip"))] : []));
  };
  return [
    el("div", { class: "tools" },
      ...Object.entries(NAMES).map(([key, name]) =>
        check(name, true, (on) => { view.show(key, on); cut({}); })),
      choice("space-colour", "Colours", colours, "own", colour),
      choice("space-cut", "Cut", [["none", "none"], ["across", "across the strip"],
        ["along", "along it"]], "none", (kind) => {
        if (kind !== "none") cutSliders(kind);
        cut({ kind, at: 0 });
        if (kind !== "none") view.look("cut");
        else view.look("default");
      }),
      measure,
      slider("Points", [0.005, 0.08, 0.005, view.size], (v) => `${fixed(100 * v, 1)} cm`,
        (size) => view.pointSize(size)),
      el("span", { class: "zoom", role: "group", "aria-label": "View" },
        button("−", () => view.zoom(1.25), { "aria-label": "Zoom out" }),
        button("+", () => view.zoom(0.8), { "aria-label": "Zoom in" }),
        button("From above", () => view.look("above")),
        button("Aslant", () => view.look("default")))),
    cutTools, view.host, said, legend,
    el("p", { class: "hint" }, `${shareWords(points)}, drawn by lot. Drag to turn, with the right ` +
      "button to pan. Keys: arrows turn, with Shift they pan; plus, minus, 0; Enter measures what " +
      "is in the middle."),
  ];
}

/** Longer side of the strip's box, where nothing says how it lies. */
function directionOf(facts, points) {
  if (facts.strip && known(facts.strip.direction[0])) return facts.strip.direction;
  const [x, y] = points.moving.extent_m;
  return x > y ? [1, 0] : [0, 1];
}

async function showSpace(body, report, facts, points) {
  const host = el("div", { class: "space" });
  body.replaceChildren(el("p", { role: "status" }, "Unpacking the points …"));
  try {
    const view = await AgriColMap3d.SpaceView.make(host, points, directionOf(facts, points));
    view.canvas.setAttribute("role", "img");
    view.canvas.setAttribute("aria-label", "Points of the drone's cloud and of the strip in space");
    body.replaceChildren(...controls(view, report, points));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.redraw());
  } catch (error) {
    body.replaceChildren(el("p", { class: "warn" },
      `The 3-D view cannot be shown here: ${error.message}. It needs WebGL and a browser of 2023 or later.`));
  }
}

export function view3dSection(report, facts, points) {
  const body = el("div", { class: "space-body" });
  if (!facts.with_3d) {
    body.append(el("p", {}, "This page has no 3-D view: AgriColMap was built without it " +
      "(AGRICOLMAP_WITH_PAGE_3D, which needs npm). The aligned cloud can be looked at in CloudCompare."));
  } else {
    // Only once it is looked for: unpacking takes a moment.
    body.append(el("div", { class: "space" }));
    const observer = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      showSpace(body, report, facts, points);
    }, { rootMargin: "300px" });
    observer.observe(body);
  }
  const laid = report.transform
    ? `The strip lies where the ${report.status === "accepted" ? "registration" : "best answer"} ` +
      `puts it${report.deformation ? ", its bend taken out" : ""}; ` +
      "plants of both clouds should stand in one another."
    : "There is no registered place; the strip lies where the guess put it.";
  return section("space", "Both clouds in 3-D", "3-D", el("p", {}, laid), body);
}
