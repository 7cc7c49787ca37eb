// What was found, in sentences.

import { degrees, fixed, known, length, percent } from "./format.js";

const direction = (value, positive, negative) =>
  `${length(Math.abs(value))} ${value < 0 ? negative : positive}`;

export function title(report) {
  if (report.status === "accepted" && report.heights.status === "limited") {
    return "Accepted in the plane";
  }
  return { accepted: "Accepted", rejected: "Rejected", ambiguous: "Ambiguous" }[report.status];
}

export function lead(report) {
  if (report.status === "accepted") {
    return report.heights?.status === "limited"
      ? "The strip was found. Trust its place in the plane; do not rely on its height."
      : "The strip was found, and the result can be used.";
  }
  if (report.status === "ambiguous") {
    return `The strip fits in ${report.alternatives.length + 1} places about equally well. ` +
      "One of them may be right; which one, the data cannot tell. Do not use this result as it is.";
  }
  return report.transform
    ? "Do not use this result. What is shown below is the best that was found; the software does " +
      "not stand for it."
    : "No place was found for this strip.";
}

/** null where it is as long and as wide as it was. */
function stretch(parts) {
  const percents = [parts.scale_x, parts.scale_y].map((scale) => 100 * (scale - 1));
  if (percents.every((value) => Math.abs(value) < 0.05)) return null;
  const [x, y] = percents.map((value) =>
    `${fixed(Math.abs(value), 1)}\u00a0% ${value < 0 ? "shorter" : "longer"}`);
  return x === y ? `${x}` : `${x} along its file's x axis and ${y} along y`;
}

/** Whether there was no guess to measure from. */
export const unguessed = (report, facts) => report.prior.source === "coordinates as they stand" &&
  Number(facts.options.find((o) => o.path === "prior.translation").value) >= 1e6;

/** Where the strip lies against its guess. */
export function placeWords(report, facts) {
  if (!report.transform) return null;
  const parts = report.transform.parts;
  const [x, y, z] = parts.shift_m;
  const sense = parts.yaw_deg < 0 ? "clockwise" : "anticlockwise";
  const from = unguessed(report, facts) ? "where its own coordinates put it (no guess was given)" : "where the guess put it";
  const far = length(Math.hypot(x, y));
  const stretched = stretch(parts);
  // Of a place that may be wrong no more than what tells whether it can be right.
  if (report.status === "rejected") {
    return `The best answer lies ${far} from ${from}, turned by ` +
      `${degrees(Math.abs(parts.yaw_deg))} ${sense}${stretched ? `; ${stretched}` : ""}.`;
  }
  return `${report.status === "accepted" ? "It lies" : "The best answer lies"} ` +
    `${far} from ${from}: ${direction(x, "east", "west")}, ${direction(y, "north", "south")}` +
    `${known(z) ? `, ${direction(z, "up", "down")}` : ""}; turned by ` +
    `${degrees(Math.abs(parts.yaw_deg))} ${sense}. ` + (stretched
    ? `Its size is corrected: ${stretched}, as odometry errs along each axis by a share of its own.`
    : "Its size was right.");
}

/** Of an ambiguous one: how far from the best the others lie. */
export function otherPlaces(report) {
  const at = (matrix) => [0, 1].map((row) => matrix[row][3] +
    [0, 1, 2].reduce((sum, k) => sum + matrix[row][k] * report.moving.origin_m[k], 0));
  if (report.status !== "ambiguous") return [];
  const best = at(report.transform.matrix);
  return report.alternatives.map((other, i) => {
    const [east, north] = at(other.matrix).map((value, k) => value - best[k]);
    const ways = [[east, "east", "west"], [north, "north", "south"]]
      .filter(([value]) => Math.abs(value) >= 0.02 * Math.hypot(east, north))
      .map(([value, ...names]) => direction(value, ...names));
    return `Place ${i + 2} lies ${ways.join(" and ")} of the first.`;
  });
}

export function sureWords(report) {
  if (!report.transform) return null;
  const [place, plane] = [percent(report.place_probability), percent(report.plane_probability)];
  const which = report.status === "ambiguous" ? "the first" : "it";
  const within = `The probability that ${which} lies within 5 cm of its right place is ${plane}`;
  return place === plane ? `${within}.`
    : `${within}; that row and plant are the right ones, ${place}.`;
}

/** What to do with it: which file is for what. */
export function useWords(report) {
  if (report.status !== "accepted") return null;
  const bend = report.deformation;
  // Who calls the library has no such files beside this page.
  const [aligned, apply, matrix] = report.command_line
    ? ["the aligned cloud (aligned.ply or .las)", "agricolmap apply", "transform.txt"]
    : ["the result's aligned cloud", "place() of the result", "its transformation"];
  const files = bend
    ? `Use ${aligned}, or ${apply} for other clouds: ${matrix} alone leaves up to ${length(bend.most_m)} of the ` +
      "strip's bend in it."
    : `Use ${aligned}, or ${matrix} for other clouds of this strip.`;
  return report.heights?.status === "limited"
    ? `${files} Take no heights of plants or ground from it: where soil shows (wheel tracks, gaps, the field's ` +
      "edge), or with another surface model, they can be measured."
    : files;
}

/** Of an accepted one: errors and bends of a place that may be wrong mean nothing. */
export function errorWords(report) {
  if (report.status !== "accepted") return null;
  const { uncertainty, heights } = report;
  if (!uncertainty) return "Too few parts of the strip can be compared to state an error.";
  const plane = `The expected error (RMS) is ${length(uncertainty.expected_rms_m)} in the plane`;
  if (heights.status === "limited") return `${plane}. Heights are limited: ${heights.words}.`;
  return `${plane} and ${length(heights.deviation_m)} in height.`;
}

export function bendWords(report) {
  if (report.status !== "accepted") return null;
  const bend = report.deformation;
  if (!bend) {
    const local = report.uncertainty?.local_rms_m;
    return known(local)
      ? `No bend of the strip had to be followed; its parts are bent by another ${length(local)} (RMS), ` +
        "which no single transformation takes out."
      : "No bend of the strip was followed.";
  }
  const slips = bend.slips.map((slip) => length(Math.hypot(...slip.offset_m.slice(0, 2))));
  const slipped = slips.length === 0 ? "" :
    `, with ${slips.length === 1 ? "a slip" : `${slips.length} slips`} of the odometry by ${slips.join(", ")}`;
  return `The strip's ${length(bend.length_m)} of path were bent by up to ${length(bend.most_m)} ` +
    `(${length(bend.rms_m)} on average)${slipped}; the aligned cloud has this taken out.`;
}

/** The few figures to remember: [label, value, what it means, and "weak" where it is a warning or "plain" where
 * it is neither good nor bad]. */
export function figures(report, facts) {
  if (!report.transform) return [];
  const { uncertainty, heights, deformation, evidence, residuals } = report;
  const parts = report.transform.parts;
  const right = ["Right to 5 cm", percent(report.plane_probability), "probability, in the plane"];
  const moved = ["Moved", length(Math.hypot(parts.shift_m[0], parts.shift_m[1])),
    `${unguessed(report, facts) ? "without a guess" : "from the guess"}, turned ${degrees(Math.abs(parts.yaw_deg))} ` +
    `${parts.yaw_deg < 0 ? "clockwise" : "anticlockwise"}`, "plain"];
  if (report.status !== "accepted") {
    return [right,
      ["Parts that agree", `${evidence.agreeing_blocks} of ${evidence.blocks.length}`,
        "of the strip, placed alone", report.status === "ambiguous" ? "plain" : undefined],
      ["On the map", percent(residuals.overlap), "of the strip", residuals.overlap > 0.9 ? "plain" : undefined],
      moved];
  }
  const limited = heights.status === "limited";
  return [right,
    ["In the plane", uncertainty ? `\u00b1\u00a0${length(uncertainty.expected_rms_m)}` : "unknown",
      "expected error, RMS"],
    ["In height", limited ? "limited" : `\u00b1\u00a0${length(heights.deviation_m)}`,
      !limited ? "expected error, RMS" :
        known(heights.deviation_m) ? `may be off by ${length(heights.deviation_m)}` : "not measured",
      limited ? "weak" : undefined],
    moved,
    ["Bent", deformation ? length(deformation.most_m) : "hardly",
      deformation ? "at most; taken out of the aligned cloud" : "nothing had to be followed", "plain"]];
}
