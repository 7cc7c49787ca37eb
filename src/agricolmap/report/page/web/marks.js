// Rows, plants, gaps and parts of the field, drawn over its map.

import { PlaceIndex } from "./packed.js";
import { svg } from "./dom.js";
import { apply, rampTable, RAMPS, UNSURE } from "./layers.js";

const HALO = "#000000b0";
const FAINT_HALO = "#00000060";
const CHOSEN = "#00e5ff";
const PATH_MARKS = 200;  // in one path: long ones take long to stroke
const SHADES = { height: rampTable(RAMPS.height), change: rampTable(RAMPS.change) };
const MAY_BE_ERROR = rampTable([UNSURE, UNSURE])[0];

/** How each kind of mark is drawn: a colour and a shape that tell it apart without the colour. */
const MARK_SHAPES = {
  ring: { width: 1.6, radius: 4 },
  diamond: { width: 1.6, radius: 4 },
  line: { width: 1.2 },
  bar: { width: 3 },
  dash: { width: 2.5, dashes: [5, 4] },
  outline: { width: 1 },
};

/** A mark as it looks on the map, for its switch. */
export function symbol({ shape, colour }) {
  const [width, height] = [30, 18];
  const y = height / 2;
  const path = {
    ring: "M20 9a5 5 0 1 0-10 0a5 5 0 1 0 10 0z", diamond: "M15 3.5L20.5 9L15 14.5L9.5 9z",
    line: `M3 ${y}H27`, dash: `M3 ${y}H27`, bar: `M5 ${y}H25M5 4V14M25 4V14`, outline: "M5 3.5H25V14.5H5z",
  }[shape];
  return svg("svg", { class: "symbol", width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" },
    svg("rect", { width, height, rx: 4, fill: "#4d5b3f" }),
    svg("path", { d: path, fill: "none", stroke: colour, "stroke-width": shape === "bar" ? 2.5 : 2,
      "stroke-dasharray": shape === "dash" ? "5 4" : undefined }));
}

/** Layers of marks on a map: drawn, switched on and off, found by place. */
export class Marks {
  /** `things`: how each layer is drawn, in the order of drawing; `layers` by name. */
  constructor(things, layers) {
    this.things = things.filter((thing) => layers[thing.name]?.size > 0);
    this.layers = layers;
    this.places = {};
    this.on = Object.fromEntries(this.things.map((thing) => [thing.name, thing.shown !== false]));
    this.chosen = null;  // { name, i }
    this.shade = null;   // { name, ramp, share(i): 0…1 or null, unsure(i), text(i) }
  }
  index(name) {
    this.places[name] ??= new PlaceIndex(this.layers[name]);
    return this.places[name];
  }
  isDrawn(thing, scale) {
    return this.on[thing.name] && scale >= (thing.leastScale ?? 0);
  }
  /** What lies at a place, the smallest kinds first; `reach` in metres. */
  find(point, reach, scale) {
    for (const thing of [...this.things].reverse()) {
      if (!this.isDrawn(thing, scale)) continue;
      const i = this.index(thing.name).nearest(point, reach);
      if (i !== null) return { name: thing.name, i };
    }
    return null;
  }

  /** `view`: local coordinates to pixels of a canvas that has `ratio` of them for each of the page's. */
  draw(context, view, { ratio, scale, width, height, localAt }) {
    const [west, north] = localAt(0, 0);
    const [east, south] = localAt(width, height);
    const box = [west, south, east, north];
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.lineJoin = "round";
    // Of a whole field marks are small, so that they do not run into each other.
    const sizes = { point: ratio * Math.min(1.5, Math.max(0.5, scale / 90)),
      line: ratio * Math.min(1.3, Math.max(0.55, scale / 28)), polygon: ratio };
    if (this.shade) this.drawShade(context, view, box, ratio);
    for (const thing of this.things) {
      if (this.isDrawn(thing, scale)) this.drawThing(context, view, box, thing, sizes[this.layers[thing.name].kind]);
    }
    for (const thing of this.things) {
      if (thing.labels && this.on[thing.name]) this.drawLabels(context, view, box, thing, ratio);
    }
    if (this.chosen) this.drawChosen(context, view, Math.max(sizes.line, ratio));
    context.restore();
  }
  tracePoint(path, x, y, thing, ratio) {
    const r = MARK_SHAPES[thing.shape].radius * ratio;
    if (thing.shape === "diamond") {
      path.moveTo(x, y - r);
      path.lineTo(x + r, y);
      path.lineTo(x, y + r);
      path.lineTo(x - r, y);
      path.closePath();
    } else {
      path.moveTo(x + r, y);
      path.arc(x, y, r, 0, 2 * Math.PI);
    }
  }
  /** Adds a thing's outline to a path, in pixels. */
  trace(path, view, layer, i, thing, ratio) {
    if (layer.kind === "point") {
      const [x, y] = apply(view, [layer.x[i], layer.y[i]]);
      this.tracePoint(path, x, y, thing, ratio);
      return;
    }
    const points = layer.points(i).map((point) => apply(view, point));
    points.forEach((point, k) => path[k === 0 ? "moveTo" : "lineTo"](...point));
    if (layer.kind === "polygon") path.closePath();
    if (thing.shape === "bar") this.traceEnds(path, points, 4 * ratio);
  }
  /** Strokes across both ends of a line. */
  traceEnds(path, points, half) {
    for (const [end, next] of [[points[0], points[1]], [points.at(-1), points.at(-2)]]) {
      const [dx, dy] = [next[0] - end[0], next[1] - end[1]];
      const long = Math.hypot(dx, dy) || 1;
      const [nx, ny] = [(-dy / long) * half, (dx / long) * half];
      path.moveTo(end[0] - nx, end[1] - ny);
      path.lineTo(end[0] + nx, end[1] + ny);
    }
  }
  drawThing(context, view, box, thing, ratio) {
    const layer = this.layers[thing.name];
    const visible = [];
    this.index(thing.name).within(box, (i) => visible.push(i));
    if (layer.kind === "point") this.drawPoints(context, view, layer, visible, thing, ratio);
    else this.drawLines(context, view, layer, visible, thing, ratio);
  }
  /** Of points one is drawn, and its picture laid down for all: paths of many arcs take minutes. */
  drawPoints(context, view, layer, visible, thing, ratio) {
    const { width, radius } = MARK_SHAPES[thing.shape];
    const half = Math.ceil((radius + width + 2) * ratio);
    const stamp = document.createElement("canvas");
    stamp.width = stamp.height = 2 * half;
    const path = new Path2D();
    this.tracePoint(path, half, half, thing, ratio);
    this.stroke(stamp.getContext("2d"), [path], thing, ratio);
    for (const i of visible) {
      const [x, y] = apply(view, [layer.x[i], layer.y[i]]);
      context.drawImage(stamp, Math.round(x) - half, Math.round(y) - half);
    }
  }
  drawLines(context, view, layer, visible, thing, ratio) {
    const paths = [];
    for (const [k, i] of visible.entries()) {
      if (k % PATH_MARKS === 0) paths.push(new Path2D());
      this.trace(paths.at(-1), view, layer, i, thing, ratio);
    }
    this.stroke(context, paths, thing, ratio);
  }
  /** First what sets them off from the ground, of all of them, then they themselves. */
  stroke(context, paths, thing, ratio) {
    const { width, dashes = [] } = MARK_SHAPES[thing.shape];
    context.lineWidth = (width + 2) * ratio;
    context.strokeStyle = thing.shape === "line" ? FAINT_HALO : HALO;
    for (const path of paths) context.stroke(path);
    context.setLineDash(dashes.map((dash) => dash * ratio));
    context.lineWidth = width * ratio;
    context.strokeStyle = thing.colour;
    for (const path of paths) context.stroke(path);
    context.setLineDash([]);
  }
  drawShade(context, view, box, ratio) {
    const { name, share, ramp = "height", unsure } = this.shade;
    const layer = this.layers[name];
    this.index(name).within(box, (i) => {
      const value = share(i);
      if (value === null) return;
      const colour = unsure(i) ? MAY_BE_ERROR : SHADES[ramp][Math.round(255 * Math.min(1, Math.max(0, value)))];
      const path = new Path2D();
      this.trace(path, view, layer, i, { shape: "outline" }, ratio);
      if (layer.kind === "polygon") {
        context.fillStyle = `rgb(${colour.join(" ")} / 0.72)`;
        context.fill(path);
      } else {
        context.lineWidth = 7 * ratio;
        context.strokeStyle = `rgb(${colour.join(" ")} / 0.85)`;
        context.stroke(path);
      }
    });
  }
  /** Names in the middle of parts that have the room; below them what they are shaded by, which need not be read off colours. */
  drawLabels(context, view, box, thing, ratio) {
    const layer = this.layers[thing.name];
    const told = this.shade?.name === thing.name ? this.shade : null;
    context.font = `600 ${12 * ratio}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    this.index(thing.name).within(box, (i) => {
      const [west, south, east, north] = layer.box(i);
      const [x0, y0] = apply(view, [west, north]);
      const [x1, y1] = apply(view, [east, south]);
      const name = String(layer.value("id", i));
      const lines = told && told.share(i) !== null && y1 - y0 > 34 * ratio ? [name, told.text(i)] : [name];
      const fits = (text) => context.measureText(text).width + 8 * ratio <= x1 - x0;
      if (!fits(name) || y1 - y0 < 16 * ratio) return;
      const shown = lines.filter(fits);
      shown.forEach((text, k) => {
        const y = (y0 + y1) / 2 + (k - (shown.length - 1) / 2) * 15 * ratio;
        context.lineWidth = 3 * ratio;
        context.strokeStyle = HALO;
        context.strokeText(text, (x0 + x1) / 2, y);
        context.fillStyle = "#ffffff";
        context.fillText(text, (x0 + x1) / 2, y);
      });
    });
  }
  drawChosen(context, view, ratio) {
    const { name, i } = this.chosen;
    const thing = this.things.find((one) => one.name === name);
    if (!thing) return;
    const layer = this.layers[name];
    const path = new Path2D();
    this.trace(path, view, layer, i, thing, (layer.kind === "point" ? 2 : 1) * ratio);
    for (const [width, colour] of [[7, "#000000d0"], [3.5, CHOSEN]]) {
      context.lineWidth = width * ratio;
      context.strokeStyle = colour;
      context.stroke(path);
    }
  }
}
