// The transformation as other programs want it.

import { exact, fixed, length } from "./format.js";

/** What a rigid transform may be off by at the strip's corners and still be handed out [m]. */
const RIGID_ENOUGH = 0.05;

const rows = (matrix) => matrix.map((row) => row.map(exact).join(" ")).join("\n");

function pdal(matrix) {
  const stage = { type: "filters.transformation", matrix: matrix.flat().map(exact).join(" ") };
  return JSON.stringify({ pipeline: ["robot.las", stage, "aligned.las"] }, null, 2);
}

function ros(rigid, local) {
  const [x, y, z] = local ? rigid.local_shift_m : rigid.file_shift_m;
  const [qx, qy, qz, qw] = rigid.quaternion_xyzw;
  const values = { x, y, z, qx, qy, qz, qw };
  return "ros2 run tf2_ros static_transform_publisher " +
    Object.entries(values).map(([name, value]) => `--${name} ${exact(value)}`).join(" ") +
    " --frame-id drone_map --child-frame-id robot_map";
}

function scaleWords(parts) {
  const list = [["x", parts.scale_x], ["y", parts.scale_y]];
  const scales = list.map(([axis, scale]) => `${fixed(scale, 4)} along ${axis}`).join(" and ");
  return `the strip is scaled by ${scales}` +
    (Math.abs(parts.shear) > 1e-4 ? `, with a shear of ${fixed(parts.shear, 4)}` : "");
}

/** [name, title, text or null, note] for each program. `local`: between the two origins. */
export function formats(report, facts, local) {
  const transform = report.transform;
  const matrix = local ? transform.local.matrix : transform.matrix;
  const frame = local
    ? "Between coordinates relative to the two origins below: file = origin + local."
    : "From the strip's file coordinates to the drone's.";
  const off = facts.rigid.most_off_m;
  const scaled = scaleWords(transform.parts);
  const rigid = off <= RIGID_ENOUGH;
  return [
    ["matrix", "4 × 4", rows(matrix), `${frame} Row-major: p_drone = M · p_robot, metres.`],
    ["cloudcompare", "CloudCompare", rows(matrix), `${frame} Edit, Apply transformation, paste. ` +
      "Where CloudCompare shifted a cloud on loading it (large coordinates), take the one " +
      "relative to the origins and shift the clouds by these."],
    ["pdal", "PDAL", pdal(matrix), `${frame} A pipeline for pdal pipeline.`],
    ["ros", "ROS 2", rigid ? ros(facts.rigid, local) : null, rigid
      ? `${frame} A static transform cannot scale: ${scaled}. The nearest rigid one, given here, ` +
        `is off by up to ${length(off)} at the strip's corners.`
      : `A static transform is rigid, and this one is not: ${scaled}. The nearest rigid one would ` +
        `be off by ${length(off)} at the strip's corners. Publish the aligned cloud in the drone's ` +
        "frame instead."],
  ];
}
