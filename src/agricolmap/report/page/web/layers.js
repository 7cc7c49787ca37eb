// The maps' layers: pictures of one byte per cell get their colours here.

// Even to the eye and to those who cannot tell red from green (viridis).
const LOW_TO_HIGH = ["440154", "414487", "2a788e", "22a884", "7ad151", "fde725"];
// Soil to plant: darker is greener, so that it holds without its hue, too.
const SOIL_TO_PLANT = ["f3ead7", "d9d3a5", "a9bd7f", "6b9a5b", "2f7243", "0a4a2e"];
// Brighter is worse.
const GOOD_TO_BAD = ["0d1b3e", "28456c", "4f7396", "8ba3ad", "d0c9a6", "fff3b0"];
export const RAMPS = {
  height: LOW_TO_HIGH, plant_height: LOW_TO_HIGH, exg: SOIL_TO_PLANT,
  plane_error: GOOD_TO_BAD, height_error: GOOD_TO_BAD,
};
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

function coloured(image, table) {
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  const data = pixels.data;
  for (let i = 0; i < data.length; i += 4) {
    const colour = table[data[i]];
    data[i] = colour[0];
    data[i + 1] = colour[1];
    data[i + 2] = colour[2];
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

/** A picture of the scene whose layers are decoded when they are first asked for. */
export class Picture {
  constructor(json, affine) {
    this.json = json;
    this.affine = affine;  // picture's metres to local coordinates
    this.ready = {};
  }
  has(layer) {
    return layer in this.json.layers;
  }
  async prepare(layer) {
    if (this.ready[layer] || !this.has(layer)) return;
    const image = await load(this.json.layers[layer]);
    const table = layer === "source"
      ? Array.from({ length: 256 }, (_, code) => parts(sourceColour(code)))
      : RAMPS[layer] && rampTable(RAMPS[layer]);
    this.ready[layer] = table ? coloured(image, table) : image;
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
