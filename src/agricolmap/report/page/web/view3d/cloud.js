// Points as the page holds them (page_points.cpp): steps from a corner, as differences, in planes of
// bytes, gzip, base64.

async function unpacked(base64) {
  const text = atob(base64);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Positions about `origin` (three numbers a point) and colours, bytes, or null. */
export async function readCloud(json, origin) {
  const bytes = await unpacked(json.gzip_base64);
  const { count, step_m: step, min_m: min } = json;
  const positions = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    const low = bytes.subarray(2 * axis * count, (2 * axis + 1) * count);
    const high = bytes.subarray((2 * axis + 1) * count, (2 * axis + 2) * count);
    const from = min[axis] - origin[axis];
    for (let i = 0, steps = 0; i < count; ++i) {
      steps = (steps + low[i] + 256 * high[i]) & 65535;
      positions[3 * i + axis] = from + step * steps;
    }
  }
  if (!json.coloured) return { positions, colours: null };
  const colours = new Uint8Array(3 * count);
  for (let k = 0; k < 3; ++k) {
    const plane = bytes.subarray((6 + k) * count, (7 + k) * count);
    for (let i = 0; i < count; ++i) colours[3 * i + k] = plane[i];
  }
  return { positions, colours };
}

/** Where the middle of the points lies in the plane, and their lowest height. */
export function middleOf(json) {
  const extent = json.extent_m;
  return [0, 1].map((k) => json.min_m[k] + extent[k] / 2).concat(json.min_m[2]);
}

/** Heights that all but a few points lie between. */
export function heightRange(clouds) {
  const heights = [];
  for (const { positions } of clouds) {
    const step = 3 * Math.max(1, Math.floor(positions.length / 3 / 5000));
    for (let i = 2; i < positions.length; i += step) heights.push(positions[i]);
  }
  heights.sort((a, b) => a - b);
  const at = (share) => heights[Math.floor(share * (heights.length - 1))] ?? 0;
  return [at(0.02), Math.max(at(0.98), at(0.02) + 0.01)];
}
