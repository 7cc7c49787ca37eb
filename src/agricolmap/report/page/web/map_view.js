// The drone's map from above with the strip on it: what can be panned, zoomed and swiped.

import { apply } from "./layers.js";
import { el, styleColour } from "./dom.js";
import { fixed } from "./format.js";

const MOST_ZOOM = 2000;  // px per metre
const STEP = 1.25;

function bounds(points) {
  const xs = points.map((p) => p[0]);
  const ys = points.map((p) => p[1]);
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

function roundStep(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((k) => k * power).find((step) => step <= most) ?? power;
}

export class MapView {
  /**
   * `scene`: `base`, pictures, coarsest first; `sides(swipe)`: what lies left and right. Where it has them:
   * `overlay(context, view, this)` draws over both sides, `onpick(local)` hears of clicks, `keys` of keys.
   */
  constructor(scene, state) {
    this.scene = scene;
    this.state = state;
    this.canvas = el("canvas", { tabindex: "0", role: scene.role ?? "img", "aria-describedby": "map-keys",
      "aria-label": scene.label });
    this.handle = el("div", { class: "swipe", role: "slider", tabindex: "0",
      "aria-label": "Swipe between the two sides", "aria-valuemin": "0", "aria-valuemax": "100" },
      el("span", { class: "grip", "aria-hidden": "true" }));
    this.left = el("span", { class: "side left" });
    this.right = el("span", { class: "side right" });
    this.place = el("p", { class: "place" }, "\u00a0");
    this.frame = el("div", { class: "map" }, this.canvas, this.left, this.right, this.handle);
    this.root = el("div", {}, this.frame, this.place);
    this.swipe = 0.5;
    this.pointers = new Map();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.frame);
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const { width, height } = this.frame.getBoundingClientRect();
    if (!width || !height) return;
    this.width = width;
    this.height = height;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.ratio = this.canvas.width / width;
    if (this.scale) this.draw();
    else this.begin();
  }

  /** All of the strip's places, and the handle on the one that was found. */
  begin() {
    this.fitTo(this.scene.focus);
    const right = (this.scene.middle[0] - this.centre[0]) * this.scale;
    this.swipeTo(Math.min(0.9, Math.max(0.1, 0.5 + right / this.width)));
  }
  fitTo(points) {
    const [x0, y0, x1, y1] = bounds(points);
    const least = Math.min(this.width / (x1 - x0), this.height / (y1 - y0));
    this.scale = Math.min(MOST_ZOOM, 0.9 * least);
    this.centre = [(x0 + x1) / 2, (y0 + y1) / 2];
    this.draw();
  }

  /** Brings a thing in sight where it is not, lies under the handle or is too small to be made out. */
  show(points) {
    const [x0, y0, x1, y1] = bounds(points);
    const [left, top] = this.localAt(24, 24);
    const [right, bottom] = this.localAt(this.width - 24, this.height - 24);
    const size = Math.max(x1 - x0, y1 - y0);
    const inside = x0 >= left && x1 <= right && y0 >= bottom && y1 <= top;
    const handle = this.localAt(this.swipe * this.width, 0)[0];
    const covered = Math.max(Math.abs(x0 - handle), Math.abs(x1 - handle)) * this.scale < 30;
    if (inside && !covered && Math.max(size, 0.1) * this.scale >= 24) return;
    const fitting = (0.7 * Math.min(this.width, this.height)) / Math.max(size, 0.01);
    this.scale = Math.min(fitting, Math.max(this.scale, 120));
    // What is small comes to lie beside the handle.
    const half = 0.5 * size * this.scale;
    const isSmall = half < 0.15 * this.width && Math.abs(this.swipe - 0.5) < 0.1;
    const aside = isSmall ? Math.max(0.12 * this.width, half + 40) / this.scale : 0;
    this.centre = [(x0 + x1) / 2 + aside, (y0 + y1) / 2];
    this.draw();
  }

  /** Local coordinates to canvas pixels, as for setTransform. */
  view() {
    const s = this.scale * this.ratio;
    return [s, 0, 0, -s, this.canvas.width / 2 - s * this.centre[0],
      this.canvas.height / 2 + s * this.centre[1]];
  }
  localAt(x, y) {
    return [this.centre[0] + (x - this.width / 2) / this.scale,
      this.centre[1] - (y - this.height / 2) / this.scale];
  }

  draw() {
    if (!this.width) return;
    const context = this.canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = styleColour("--map-empty");
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const view = this.view();
    context.imageSmoothingEnabled = this.scale < 120;
    const at = this.swipe * this.canvas.width;
    const [left, right] = this.scene.sides(this.state);
    this.side(context, left, 0, at, view);
    this.side(context, right, at, this.canvas.width, view);
    this.scene.overlay?.(context, view, this);
    this.scaleBar(context);
    this.handle.style.left = `${100 * this.swipe}%`;
    this.handle.setAttribute("aria-valuenow", String(Math.round(100 * this.swipe)));
    this.handle.setAttribute("aria-valuetext",
      `${left.label} on the left ${Math.round(100 * this.swipe)} %, ${right.label} on the right`);
    this.left.textContent = left.label;
    this.right.textContent = right.label;
    this.left.style.maxWidth = `calc(${100 * this.swipe}% - 1.4rem)`;
    this.right.style.maxWidth = `calc(${100 * (1 - this.swipe)}% - 1.4rem)`;
  }

  side(context, side, from, to, view) {
    context.save();
    context.beginPath();
    context.rect(from, 0, to - from, this.canvas.height);
    context.clip();
    const layer = side.layer ?? this.state.layer;
    for (const picture of this.scene.base) picture.draw(context, layer, view);
    for (const strip of side.strips) {
      strip.picture.draw(context, layer, view, strip.affine);
      if (this.state.outline) this.outline(context, strip.outline, view, []);
    }
    if (this.state.outline) {
      this.outline(context, side.other, view, [6, 6]);
      for (const { outline, label } of side.rest ?? []) {
        this.outline(context, outline, view, [6, 6]);
        this.label(context, outline, label, view);
      }
    }
    if (this.state.blocks && side.blocks) this.blocks(context, side.blocks, view);
    context.restore();
  }

  /** Dashed: where the strip lies on the other side of the handle. */
  outline(context, corners, view, dashes) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.setLineDash(dashes.map((dash) => dash * this.ratio));
    context.beginPath();
    for (const corner of corners) context.lineTo(...apply(view, corner));
    context.closePath();
    for (const [width, colour] of [[5, "#000000c0"], [2.5, "#00e5ff"]]) {
      context.lineWidth = width * this.ratio;
      context.strokeStyle = colour;
      context.stroke();
    }
    context.setLineDash([]);
  }
  label(context, corners, text, view) {
    const pixels = corners.map((corner) => apply(view, corner));
    const [x, y] = [0, 1].map((k) => pixels.reduce((sum, p) => sum + p[k], 0) / pixels.length);
    context.font = `600 ${13 * this.ratio}px system-ui, sans-serif`;
    context.textAlign = "center";
    const half = context.measureText(text).width / 2 + 6 * this.ratio;
    context.fillStyle = "#000000b3";
    context.fillRect(x - half, y - 14 * this.ratio, 2 * half, 21 * this.ratio);
    context.fillStyle = "#ffffff";
    context.fillText(text, x, y + 2 * this.ratio);
    context.textAlign = "start";
  }

  /** Blocks as discs that agree and crosses that do not, with a line to where each fits best. */
  blocks(context, blocks, view) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    const size = 5 * this.ratio;
    for (const block of blocks) {
      const [x, y] = apply(view, block.place_m);
      const best = apply(view, block.best_m);
      const mark = new Path2D();
      mark.moveTo(x, y);
      mark.lineTo(...best);
      if (block.agrees) {
        mark.moveTo(x + size, y);
        mark.arc(x, y, size, 0, 2 * Math.PI);
      } else {
        mark.moveTo(x - size, y - size);
        mark.lineTo(x + size, y + size);
        mark.moveTo(x - size, y + size);
        mark.lineTo(x + size, y - size);
      }
      for (const [width, colour] of [[5, "#000000c0"], [2, block.agrees ? "#56b4e9" : "#ffb000"]]) {
        context.lineWidth = width * this.ratio;
        context.strokeStyle = colour;
        context.stroke(mark);
      }
    }
  }

  /** Marks a place. */
  cross(context, view, place) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    const [x, y] = apply(view, place);
    const [near, far] = [4 * this.ratio, 13 * this.ratio];
    const path = new Path2D();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      path.moveTo(x + near * dx, y + near * dy);
      path.lineTo(x + far * dx, y + far * dy);
    }
    for (const [width, colour] of [[5, "#000000d0"], [2.5, "#00e5ff"]]) {
      context.lineWidth = width * this.ratio;
      context.strokeStyle = colour;
      context.stroke(path);
    }
  }

  scaleBar(context) {
    const step = roundStep(140 / this.scale);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const y = this.height - 14;
    const width = step * this.scale;
    context.font = "600 13px system-ui, sans-serif";
    const text = step < 1 ? `${Math.round(100 * step)} cm` : `${step} m`;
    context.fillStyle = "#000000b3";
    context.fillRect(6, y - 15, width + context.measureText(text).width + 24, 23);
    context.strokeStyle = context.fillStyle = "#ffffff";
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(14, y - 5);
    context.lineTo(14, y);
    context.lineTo(14 + width, y);
    context.lineTo(14 + width, y - 5);
    context.stroke();
    context.fillText(text, 22 + width, y + 1);
  }

  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const before = this.localAt(x, y);
    this.scale = Math.min(MOST_ZOOM, Math.max(this.scene.leastScale ?? 1, this.scale * factor));
    const after = this.localAt(x, y);
    this.pan(before[0] - after[0], before[1] - after[1]);
  }
  pan(x, y) {
    this.centre = [this.centre[0] + x, this.centre[1] + y];
    this.draw();
  }
  swipeTo(share) {
    this.swipe = Math.min(1, Math.max(0, share));
    this.draw();
  }

  listen() {
    const canvas = this.canvas;
    const at = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, at(event));
      this.pressed = this.pointers.size === 1 ? at(event) : null;
    });
    canvas.addEventListener("pointermove", (event) => {
      this.say(...at(event));
      if (this.pointers.has(event.pointerId)) this.drag(event.pointerId, at(event));
    });
    canvas.addEventListener("pointerup", (event) => this.released(at(event)));
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    // A page that is scrolled past must not zoom.
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(STEP ** (-Math.sign(event.deltaY)), ...at(event));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    const move = (event) => {
      const box = this.frame.getBoundingClientRect();
      this.swipeTo((event.clientX - box.left) / box.width);
    };
    this.handle.addEventListener("pointerdown", (event) => {
      this.handle.setPointerCapture(event.pointerId);
      this.handle.onpointermove = move;
    });
    for (const name of ["pointerup", "pointercancel"]) {
      this.handle.addEventListener(name, () => { this.handle.onpointermove = null; });
    }
    this.handle.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: this.swipe - 0.02, ArrowDown: this.swipe - 0.02,
        ArrowRight: this.swipe + 0.02, ArrowUp: this.swipe + 0.02,
        PageDown: this.swipe - 0.2, PageUp: this.swipe + 0.2, Home: 0, End: 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      this.swipeTo(to);
    });
  }

  /** What was pressed and hardly moved is a click. */
  released(to) {
    const moved = this.pressed ? Math.hypot(to[0] - this.pressed[0], to[1] - this.pressed[1]) : Infinity;
    this.pressed = null;
    if (moved < 6) this.scene.onpick?.(this.localAt(...to));
  }

  /** One finger pans, two zoom, too. */
  drag(id, to) {
    const from = this.pointers.get(id);
    const other = [...this.pointers].find(([key]) => key !== id)?.[1];
    this.pointers.set(id, to);
    if (other) {
      const distance = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      this.zoom(distance(to) / Math.max(1, distance(from)), ...other);
    } else {
      this.pan((from[0] - to[0]) / this.scale, (to[1] - from[1]) / this.scale);
    }
  }

  key(event) {
    const step = 60 / this.scale;
    const actions = {
      ArrowLeft: () => this.pan(-step, 0), ArrowRight: () => this.pan(step, 0),
      ArrowUp: () => this.pan(0, step), ArrowDown: () => this.pan(0, -step),
      "+": () => this.zoom(STEP), "=": () => this.zoom(STEP), "-": () => this.zoom(1 / STEP),
      0: () => this.fitTo(this.scene.focus),
      ...this.scene.keys,
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }

  say(x, y) {
    const [east, north] = this.localAt(x, y);
    const [ox, oy] = this.scene.origin;
    this.place.textContent = `x ${fixed(ox + east, 2)}   y ${fixed(oy + north, 2)}`;
  }
}
