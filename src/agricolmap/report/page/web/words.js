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

function stretch(parts) {
  const percents = [parts.scale_x, parts.scale_y].map((scale) => 100 * (scale - 1));
  if (percents.every((value) => Math.abs(value) < 0.05)) return "its size as it was";
  const [x, y] = percents.map((value) =>
    `${fixed(Math.abs(value), 1)}\u00a0% ${value < 0 ? "shorter" : "longer"}`);
  return x === y ? `${x}` : `${x} along its file's x axis and ${y} along y`;
}

/** Where the strip lies against its guess. */
export function placeWords(report) {
  if (!report.transform) return null;
  const parts = report.transform.parts;
  const [x, y, z] = parts.shift_m;
  const turn = parts.yaw_deg;
  const sense = turn < 0 ? "clockwise" : "anticlockwise";
  return `${report.status === "accepted" ? "It lies" : "The best answer lies"} ` +
    `${length(Math.hypot(x, y))} from where the guess put it ` +
    `(${direction(x, "east", "west")}, ${direction(y, "north", "south")}` +
    `${known(z) ? `, ${direction(z, "up", "down")}` : ""}), turned by ` +
    `${degrees(Math.abs(turn))} ${sense}, ${stretch(parts)}.`;
}

export function sureWords(report) {
  if (!report.transform) return null;
  const place = `The probability that this is the right place, row and plant, is ` +
    `${percent(report.place_probability)}; that all of it lies within 5 cm, ` +
    `${percent(report.plane_probability)}.`;
  return place;
}

/** Of an accepted one: errors and bends of a place that may be wrong mean nothing. */
export function errorWords(report) {
  if (report.status !== "accepted") return null;
  const { uncertainty, heights } = report;
  if (!uncertainty) return "Too few parts of the strip can be compared to state an error.";
  const plane = `The expected error is ${length(uncertainty.expected_rms_m)} in the plane`;
  if (heights.status === "limited") return `${plane}. Heights are limited: ${heights.words}.`;
  return `${plane} and ${length(heights.deviation_m)} in height.`;
}

export function bendWords(report) {
  if (report.status !== "accepted") return null;
  const bend = report.deformation;
  if (!bend) {
    const local = report.uncertainty?.local_rms_m;
    return known(local)
      ? `No bend of the strip had to be followed; ${length(local)} of deformation remain, which no ` +
        "single transformation undoes."
      : "No bend of the strip was followed.";
  }
  const slips = bend.slips.length;
  const slipped = slips === 0 ? "" :
    ` At ${slips === 1 ? "one place" : `${slips} places`} the odometry slipped.`;
  return `The strip is bent by up to ${length(bend.most_m)} (${length(bend.rms_m)} on average) ` +
    `along ${length(bend.length_m)} of path.${slipped} The aligned cloud has this taken out; ` +
    "transform.txt alone does not.";
}

/** The few figures to remember: [label, value, what it means]. */
export function figures(report) {
  if (!report.transform) return [];
  const { uncertainty, heights, deformation, evidence, residuals } = report;
  const parts = report.transform.parts;
  const right = ["Right place", percent(report.plane_probability), "within 5 cm in the plane"];
  const moved = ["Moved", length(Math.hypot(parts.shift_m[0], parts.shift_m[1])),
    `from the guess, turned ${degrees(parts.yaw_deg)}`];
  if (report.status !== "accepted") {
    return [right,
      ["Parts that agree", `${evidence.agreeing_blocks} of ${evidence.blocks.length}`,
        "placed alone"],
      ["On the map", percent(residuals.overlap), "of the strip"],
      moved];
  }
  const limited = heights.status === "limited";
  return [right,
    ["In the plane", uncertainty ? `±\u00a0${length(uncertainty.expected_rms_m)}` : "unknown",
      "expected error, RMS"],
    ["In height", limited ? "limited" : `±\u00a0${length(heights.deviation_m)}`,
      !limited ? "expected error" :
        known(heights.deviation_m) ? `good to ${length(heights.deviation_m)}` : "not measured"],
    moved,
    ["Bent", deformation ? length(deformation.most_m) : "hardly",
      deformation ? "at most, along its path" : "nothing had to be followed"]];
}
