// The maps' layers: pictures of one byte per cell get their colours here.

// Even to the eye and to those who cannot tell red from green (viridis).
const LOW_TO_HIGH = ["440154", "414487", "2a788e", "22a884", "7ad151", "fde725"];
// Soil to plant: darker is greener, so that it holds without its hue, too.
const SOIL_TO_PLANT = ["f3ead7", "d9d3a5", "a9bd7f", "6b9a5b", "2f7243", "0a4a2e"];
// Brighter is worse.
const GOOD_TO_BAD = ["0d1b3e", "28456c", "4f7396", "8ba3ad", "d0c9a6", "fff3b0"];
// From one extreme by nothing to the other, for the same eyes (ColorBrewer's BrBG).
const FALL_TO_RISE = ["8c510a", "d8b365", "f5f5f5", "5ab4ac", "01665e"];
const DARK_TO_LIGHT = ["000000", "ffffff"];
/** What differs by no more than its errors. */
export const UNSURE = "8d939c";
export const RAMPS = {
  height: LOW_TO_HIGH, plant_height: LOW_TO_HIGH, exg: SOIL_TO_PLANT, green: SOIL_TO_PLANT, cover: SOIL_TO_PLANT,
  plane_error: GOOD_TO_BAD, height_error: GOOD_TO_BAD, relief: DARK_TO_LIGHT,
  change: FALL_TO_RISE, plant_height_change: FALL_TO_RISE, cover_change: FALL_TO_RISE,
};
/** Both times of a layer have its colours. */
const rampOf = (layer) => RAMPS[layer.replace(/^(before|after)_/, "")];
// For the colour-blind (Okabe and Ito); the drone's is grey.
const SOURCES = ["e69f00", "56b4e9", "009e73", "f0e442", "0072b2", "d55e00", "cc79a7"];

/** The colour of the source with this code: 1 is the drone's, strips follow. */
export function sourceColour(code) {
  return code <= 1 ? "9a9a9a" : SOURCES[(code - 2) % SOURCES.length];
}

const parts = (hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** 256 colours, [r, g, b] each. */
export function rampTable(stops) {
  const colours = stops.map(parts);
  return Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (colours.length - 1);
    const low = Math.min(Math.floor(at), colours.length - 2);
    return colours[low].map((from, k) =>
      Math.round(from + (at - low) * (colours[low + 1][k] - from)));
  });
}

function load(base64) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error("a map of this page cannot be read"));
    image.src = `data:image/png;base64,${base64}`;
  });
}

function pixelsOf(image) {
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return { canvas, context, pixels: context.getImageData(0, 0, canvas.width, canvas.height) };
}

/** `sure`: only pixels whose blue says so have colours of the table. */
function coloured(image, table, sure = false) {
  const { canvas, context, pixels } = pixelsOf(image);
  const data = pixels.data;
  const unsure = parts(UNSURE);
  for (let i = 0; i < data.length; i += 4) {
    const colour = sure && data[i + 2] === 0 ? unsure : table[data[i]];
    data[i] = colour[0];
    data[i + 1] = colour[1];
    data[i + 2] = colour[2];
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

/** A picture of the scene whose layers are decoded when they are first asked for. */
export class Picture {
  /** `derived`: layers that are another one, `from`, in colours of a ramp. */
  constructor(json, affine, derived = {}) {
    this.json = json;
    this.affine = affine;  // picture's metres to local coordinates
    this.derived = derived;
    this.ready = {};
    this.bytes = {};
  }
  has(layer) {
    return layer in this.json.layers || layer in this.derived;
  }
  async prepare(layer) {
    if (this.ready[layer] || !this.has(layer)) return;
    const { from = layer, ramp = layer, sure } = this.derived[layer] ?? {};
    const image = await load(this.json.layers[from]);
    const stops = rampOf(ramp);
    const table = layer === "source"
      ? Array.from({ length: 256 }, (_, code) => parts(sourceColour(code)))
      : stops && rampTable(stops);
    this.ready[layer] = table ? coloured(image, table, sure) : image;
  }
  /** Red, green, blue and alpha of a layer's file at a place of local coordinates; null outside. */
  async bytesAt(layer, [x, y]) {
    if (!(layer in this.json.layers)) return null;
    const [a, b, c, d, e, f] = this.affine;
    const det = a * d - b * c;
    const along = (d * (x - e) - c * (y - f)) / det / this.json.pixel_m;
    const up = (a * (y - f) - b * (x - e)) / det / this.json.pixel_m;
    const [col, row] = [Math.floor(along), this.json.rows - 1 - Math.floor(up)];
    if (col < 0 || row < 0 || col >= this.json.cols || row >= this.json.rows) return null;
    this.bytes[layer] ??= pixelsOf(await load(this.json.layers[layer])).pixels;
    return this.bytes[layer].data.slice(4 * (row * this.json.cols + col), 4 * (row * this.json.cols + col) + 4);
  }
  /** Draws it; `view`: local coordinates to pixels, as for setTransform. */
  draw(context, layer, view, affine = this.affine) {
    const image = this.ready[layer];
    if (!image) return;
    const pixel = this.json.pixel_m;
    context.save();
    context.setTransform(...view);
    context.transform(...affine);
    context.transform(pixel, 0, 0, -pixel, 0, pixel * this.json.rows);
    context.drawImage(image, 0, 0);
    context.restore();
  }
  /** Its corners in local coordinates. */
  corners(affine = this.affine) {
    const width = this.json.cols * this.json.pixel_m;
    const height = this.json.rows * this.json.pixel_m;
    return [[0, 0], [width, 0], [width, height], [0, height]].map((p) => apply(affine, p));
  }
}

export function apply([a, b, c, d, e, f], [x, y]) {
  return [a * x + c * y + e, b * x + d * y + f];
}
