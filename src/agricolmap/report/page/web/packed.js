// Things on a map as packed_layer.cpp packs them: columns of whole numbers in steps.

function unpacked(base64) {
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
  return out;
}

/** The numbers of a column as a function of their index; null where there is none. */
function numbersOf({ low, step, bytes: width, data }) {
  const raw = unpacked(data);
  const codes = width === 1 ? raw : width === 2 ? new Uint16Array(raw.buffer) : new Uint32Array(raw.buffer);
  const none = 2 ** (8 * width) - 1;
  const at = (i) => (codes[i] === none ? null : low + step * codes[i]);
  at.size = codes.length;
  return at;
}

/** Points, lines or polygons in local coordinates [m], with what is known of each. */
export class PackedLayer {
  constructor(name, json) {
    Object.assign(this, { name, kind: json.kind, size: json.count, of: json.of });
    this.columns = Object.fromEntries(Object.entries(json.columns).map(([field, column]) =>
      [field, Array.isArray(column) ? (i) => column[i] : numbersOf(column)]));
    const [x, y] = [json.shapes.x, json.shapes.y].map(numbersOf);
    this.x = Float64Array.from({ length: x.size }, (_, i) => x(i));
    this.y = Float64Array.from({ length: y.size }, (_, i) => y(i));
    // Where the points of each thing begin; one more, the end of the last.
    const counts = json.shapes.points && numbersOf(json.shapes.points);
    this.starts = new Uint32Array(this.size + 1);
    for (let i = 0; i < this.size; ++i) this.starts[i + 1] = this.starts[i] + (counts ? counts(i) : 1);
  }
  has(field) {
    return field in this.columns;
  }
  value(field, i) {
    return this.columns[field]?.(i) ?? null;
  }
  points(i) {
    const out = [];
    for (let k = this.starts[i]; k < this.starts[i + 1]; ++k) out.push([this.x[k], this.y[k]]);
    return out;
  }
  /** West, south, east, north of one thing, or of points `from`…`to`. */
  box(i) {
    return this.boxOf(this.starts[i], this.starts[i + 1]);
  }
  boxOf(from, to) {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let k = from; k < to; ++k) {
      box[0] = Math.min(box[0], this.x[k]);
      box[1] = Math.min(box[1], this.y[k]);
      box[2] = Math.max(box[2], this.x[k]);
      box[3] = Math.max(box[3], this.y[k]);
    }
    return box;
  }
  middle(i) {
    const [west, south, east, north] = this.box(i);
    return [(west + east) / 2, (south + north) / 2];
  }
}

function distanceToLine(layer, i, [px, py]) {
  let least = Infinity;
  for (let k = layer.starts[i]; k + 1 < layer.starts[i + 1]; ++k) {
    const [ax, ay] = [layer.x[k], layer.y[k]];
    const [dx, dy] = [layer.x[k + 1] - ax, layer.y[k + 1] - ay];
    const square = dx * dx + dy * dy;
    const share = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
    least = Math.min(least, Math.hypot(px - ax - share * dx, py - ay - share * dy));
  }
  return least;
}

function isInside(layer, i, [px, py]) {
  let inside = false;
  const [from, to] = [layer.starts[i], layer.starts[i + 1]];
  for (let k = from, before = to - 1; k < to; before = k++) {
    const [ay, by] = [layer.y[before], layer.y[k]];
    if ((ay > py) === (by > py)) continue;
    const [ax, bx] = [layer.x[before], layer.x[k]];
    if (px < ax + ((py - ay) / (by - ay)) * (bx - ax)) inside = !inside;
  }
  return inside;
}

const MOST_CELLS = 512;  // along an axis

/** What lies where, in squares, so that neither drawing nor pointing looks at all of it. */
export class PlaceIndex {
  constructor(layer) {
    this.layer = layer;
    const [west, south, east, north] = layer.boxOf(0, layer.x.length);
    this.corner = [west, south];
    const [width, height] = [Math.max(east - west, 1e-3), Math.max(north - south, 1e-3)];
    this.cell = Math.max(Math.sqrt((2 * width * height) / Math.max(layer.size, 1)),
      Math.max(width, height) / MOST_CELLS, 0.05);
    this.cols = Math.floor(width / this.cell) + 1;
    this.rows = Math.floor(height / this.cell) + 1;
    // How many things each square has, then where its list begins.
    this.from = new Uint32Array(this.cols * this.rows + 1);
    this.everyCell((at) => { ++this.from[at + 1]; });
    for (let at = 0; at < this.from.length - 1; ++at) this.from[at + 1] += this.from[at];
    this.items = new Uint32Array(this.from.at(-1));
    const next = this.from.slice();
    this.everyCell((at, i) => { this.items[next[at]++] = i; });
    this.seen = new Uint32Array(layer.size);
    this.search = 0;
  }
  at(x, y) {
    const col = Math.min(this.cols - 1, Math.max(0, Math.floor((x - this.corner[0]) / this.cell)));
    const row = Math.min(this.rows - 1, Math.max(0, Math.floor((y - this.corner[1]) / this.cell)));
    return row * this.cols + col;
  }
  everyCell(visit) {
    const { layer } = this;
    for (let i = 0; i < layer.size; ++i) {
      if (layer.kind === "polygon") this.cellsWithin(layer.box(i), (at) => visit(at, i));
      else this.cellsAlong(i, (at) => visit(at, i));
    }
  }
  /** Squares that a line passes, at steps of half their side. */
  cellsAlong(i, visit) {
    const { x, y, starts } = this.layer;
    let last = this.at(x[starts[i]], y[starts[i]]);
    visit(last);
    for (let k = starts[i]; k + 1 < starts[i + 1]; ++k) {
      const steps = Math.ceil(Math.hypot(x[k + 1] - x[k], y[k + 1] - y[k]) / (0.5 * this.cell));
      for (let s = 1; s <= steps; ++s) {
        const share = s / steps;
        const at = this.at(x[k] + share * (x[k + 1] - x[k]), y[k] + share * (y[k + 1] - y[k]));
        if (at !== last) visit(at);
        last = at;
      }
    }
  }
  cellsWithin([west, south, east, north], visit) {
    const low = this.at(west, south);
    const high = this.at(east, north);
    for (let row = low - (low % this.cols); row <= high; row += this.cols) {
      for (let col = low % this.cols; col <= high % this.cols; ++col) visit(row + col);
    }
  }
  /** Each thing in or near a box once. */
  within(box, visit) {
    ++this.search;
    const wide = [box[0] - this.cell, box[1] - this.cell, box[2] + this.cell, box[3] + this.cell];
    this.cellsWithin(wide, (at) => {
      for (let k = this.from[at]; k < this.from[at + 1]; ++k) {
        const i = this.items[k];
        if (this.seen[i] === this.search) continue;
        this.seen[i] = this.search;
        visit(i);
      }
    });
  }
  /** The nearest within `reach` [m], or the polygon about the point; null where there is none. */
  nearest([x, y], reach) {
    const { layer } = this;
    let found = null;
    let least = reach;
    this.within([x - reach, y - reach, x + reach, y + reach], (i) => {
      if (layer.kind === "polygon") {
        if (isInside(layer, i, [x, y])) found = i;
        return;
      }
      const away = layer.kind === "point" ? Math.hypot(layer.x[i] - x, layer.y[i] - y)
        : distanceToLine(layer, i, [x, y]);
      if (away > least) return;
      least = away;
      found = i;
    });
    return found;
  }
}
