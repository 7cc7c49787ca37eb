// Both clouds in space. Draws when something changed and rests otherwise.

import {
  BufferAttribute, BufferGeometry, Color, ColorManagement, Line, LineBasicMaterial,
  LinearSRGBColorSpace, PerspectiveCamera, Plane, Points, PointsMaterial, Scene, Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { RAMPS, rampTable } from "../layers.js";
import { heightRange, middleOf, readCloud } from "./cloud.js";

// Colours go through as they are in the files.
ColorManagement.enabled = false;

const BY_CLOUD = { fixed: [86, 180, 233], moving: [240, 150, 20] };
const NO_COLOUR = [150, 150, 150];
const NEAR = 7;    // how far from the pointer a point may be to be picked [px]
const FAR = 18;    // and where there is none as near
const TURN = 0.1;  // of a key [rad]
const OPENING = 40;  // of the camera, upright [°]
const HALF = Math.tan((OPENING * Math.PI) / 360);

/** What points must be large to close the ground: by how far apart they are [m]. */
function closingSize(json) {
  const [x, y] = json.extent_m;
  const apart = Math.sqrt((x * y) / Math.max(1, json.count));
  return Math.min(0.08, Math.max(0.005, 0.005 * Math.round((1.2 * apart) / 0.005)));
}

export class SpaceView {
  /** `points`: of the page's scene; `along`: direction of the strip in the plane. */
  static async make(host, points, along) {
    const origin = middleOf(points.moving);
    const clouds = {};
    for (const name of ["fixed", "moving"]) clouds[name] = await readCloud(points[name], origin);
    return new SpaceView(host, clouds, origin, along, closingSize(points.fixed));
  }

  constructor(host, clouds, origin, along, size) {
    this.host = host;
    this.size = size;  // of points [m]
    this.clouds = clouds;
    this.origin = origin;
    this.along = new Vector3(along[0], along[1], 0).normalize();
    this.across = new Vector3(-this.along.y, this.along.x, 0);
    this.heights = heightRange(Object.values(clouds));
    this.reach = {
      across: this.extentAlong(this.along), along: this.extentAlong(this.across),
    };
    this.cut = { kind: "none", at: 0, width: 0.3 };
    this.picked = [];
    this.onmeasure = () => {};
    this.build();
    this.listen();
    this.colour("own");
    this.pointSize(size);
    new ResizeObserver(() => this.resize()).observe(host);
  }

  build() {
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.localClippingEnabled = true;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.host.append(this.canvas);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(OPENING, 1, 0.05, 2000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    this.controls.enableZoom = false;  // by hand: a page that is scrolled past must not zoom
    this.controls.addEventListener("change", () => this.redraw());
    this.planes = [new Plane(), new Plane()];
    this.objects = {};
    for (const [name, cloud] of Object.entries(this.clouds)) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(cloud.positions, 3));
      geometry.setAttribute("color",
        new BufferAttribute(new Uint8Array(cloud.positions.length), 3, true));
      const material = new PointsMaterial({ vertexColors: true });
      this.objects[name] = new Points(geometry, material);
      this.scene.add(this.objects[name]);
    }
    this.line = new Line(new BufferGeometry(),
      new LineBasicMaterial({ color: 0xff4fa3, depthTest: false }));
    this.line.visible = false;
    this.scene.add(this.line);
    this.dots = new Points(new BufferGeometry(), new PointsMaterial({ size: 11,
      sizeAttenuation: false, color: 0xff4fa3, depthTest: false }));
    this.dots.visible = false;
    this.scene.add(this.dots);
  }

  /** How far the strip reaches to either side along a direction. */
  extentAlong(direction) {
    const { positions } = this.clouds.moving;
    let most = 0.5;
    for (let i = 0; i < positions.length; i += 3) {
      most = Math.max(most,
        Math.abs(positions[i] * direction.x + positions[i + 1] * direction.y));
    }
    return most;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.looked) this.look("default");
    this.looked = true;
    this.redraw();
  }
  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }
  draw() {
    this.waiting = false;
    this.scene.background = new Color(getComputedStyle(this.host).backgroundColor);
    this.renderer.render(this.scene, this.camera);
  }

  show(name, visible) {
    this.objects[name].visible = visible;
    this.redraw();
  }
  pointSize(metres) {
    // three takes it for a camera of another opening.
    for (const object of Object.values(this.objects)) object.material.size = metres / HALF;
    this.redraw();
  }
  colour(mode) {
    const table = rampTable(RAMPS.height);
    const [low, high] = this.heights;
    for (const [name, { positions, colours }] of Object.entries(this.clouds)) {
      const attribute = this.objects[name].geometry.getAttribute("color");
      const out = attribute.array;
      for (let i = 0; i < out.length; i += 3) {
        let colour = mode === "cloud" ? BY_CLOUD[name] : NO_COLOUR;
        if (mode === "own" && colours) colour = colours.subarray(i, i + 3);
        if (mode === "height") {
          const share = (positions[i + 2] - low) / (high - low);
          colour = table[Math.round(255 * Math.min(1, Math.max(0, share)))];
        }
        out.set(colour, i);
      }
      attribute.needsUpdate = true;
    }
    this.redraw();
  }

  /** `change` of `kind` (none, across, along), `at` and `width` [m]; returns how many are in it. */
  cutBy(change) {
    Object.assign(this.cut, change);
    const { kind, at, width } = this.cut;
    const normal = kind === "along" ? this.across : this.along;
    this.planes[0].set(normal, -(at - width / 2));
    this.planes[1].set(normal.clone().negate(), at + width / 2);
    const planes = kind === "none" ? [] : this.planes;
    for (const object of Object.values(this.objects)) {
      object.material.clippingPlanes = planes;
      object.material.needsUpdate = true;
    }
    this.redraw();
    return this.countInCut();
  }
  inCut(x, y) {
    if (this.cut.kind === "none") return true;
    const normal = this.cut.kind === "along" ? this.across : this.along;
    return Math.abs(x * normal.x + y * normal.y - this.cut.at) <= this.cut.width / 2;
  }
  countInCut() {
    let count = 0;
    for (const [name, { positions }] of Object.entries(this.clouds)) {
      if (!this.objects[name].visible) continue;
      for (let i = 0; i < positions.length; i += 3) {
        if (this.inCut(positions[i], positions[i + 1])) ++count;
      }
    }
    return count;
  }

  /** How far away what reaches `wide` to either side and `high` up and down just fits. */
  distanceFor(wide, high) {
    return 1.08 * Math.max(wide / (HALF * this.camera.aspect), high / HALF);
  }
  look(from) {
    const target = new Vector3(0, 0, (this.heights[0] + this.heights[1]) / 2);
    const offset = new Vector3();
    const { across: length, along: width } = this.reach;
    // The strip lies from left to right, seen from its right-hand side.
    const right = this.along.x < 0 ? -1 : 1;
    if (from === "above") {
      const away = this.distanceFor(length, 1.3 * width);
      offset.copy(this.across).multiplyScalar(-0.001 * right * away).setZ(away);
    }
    if (from === "default") {
      offset.copy(this.across).multiplyScalar(-right).setZ(0.75).normalize();
      offset.multiplyScalar(this.distanceFor(length, width) + width);
    }
    if (from === "cut") {
      const lengthwise = this.cut.kind === "along";
      const normal = lengthwise ? this.across : this.along;
      target.addScaledVector(normal, this.cut.at);
      const sense = lengthwise ? -right : -1;
      offset.copy(normal).multiplyScalar(sense * this.distanceFor(lengthwise ? length : width, 0.5));
    }
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(offset);
    this.controls.update();
    this.redraw();
  }

  /** The point nearest to a place of the canvas [px]: the foremost of those that are near. */
  pick(x, y) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.camera.updateMatrixWorld();
    const toClip = this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse);
    const place = new Vector3();
    let best = null;
    for (const [name, { positions }] of Object.entries(this.clouds)) {
      if (!this.objects[name].visible) continue;
      for (let i = 0; i < positions.length; i += 3) {
        if (!this.inCut(positions[i], positions[i + 1])) continue;
        place.fromArray(positions, i).applyMatrix4(toClip);
        if (place.z < -1 || place.z > 1) continue;
        const off = Math.hypot((0.5 + place.x / 2) * width - x, (0.5 - place.y / 2) * height - y);
        if (off > FAR) continue;
        const rank = off <= NEAR ? place.z : 2 + off;
        if (!best || rank < best.rank) best = { rank, name, at: positions.slice(i, i + 3) };
      }
    }
    return best;
  }
  measureAt(x, y) {
    const found = this.pick(x, y);
    if (!found) return;
    if (this.picked.length === 2) this.picked = [];
    this.picked.push(found);
    this.showPicked();
  }
  clearMeasure() {
    this.picked = [];
    this.showPicked();
  }
  showPicked() {
    const corners = Float32Array.from(this.picked.flatMap(({ at }) => [...at]));
    for (const object of [this.line, this.dots]) {
      object.geometry.dispose();
      object.geometry = new BufferGeometry();
      object.geometry.setAttribute("position", new BufferAttribute(corners, 3));
    }
    this.dots.visible = this.picked.length > 0;
    this.line.visible = this.picked.length === 2;
    this.redraw();
    this.onmeasure(this.picked.map(({ name, at }) =>
      ({ cloud: name, local: [...at].map((v, k) => v + this.origin[k]) })));
  }

  zoom(factor) {
    const away = this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(away, factor);
    this.controls.update();
    this.redraw();
  }
  turn(aside, up) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const distance = away.length();
    const heading = Math.atan2(away.y, away.x) + aside;
    const height = Math.min(1.55, Math.max(-1.5, Math.asin(away.z / distance) + up));
    away.set(Math.cos(height) * Math.cos(heading), Math.cos(height) * Math.sin(heading),
      Math.sin(height)).multiplyScalar(distance);
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.redraw();
  }
  pan(right, up) {
    const step = 0.05 * this.camera.position.distanceTo(this.controls.target);
    const side = new Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const ahead = new Vector3().crossVectors(this.camera.up, side);
    const move = side.multiplyScalar(step * right).addScaledVector(ahead, step * up);
    this.camera.position.add(move);
    this.controls.target.add(move);
    this.controls.update();
    this.redraw();
  }

  listen() {
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      down = [event.clientX, event.clientY];
    });
    this.canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4;
      if (!still || !this.measuring) return;
      const box = this.canvas.getBoundingClientRect();
      this.measureAt(event.clientX - box.left, event.clientY - box.top);
    });
    this.canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? 1.15 : 1 / 1.15);
    }, { passive: false });
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }
  key(event) {
    const far = event.shiftKey;
    const actions = {
      ArrowLeft: () => (far ? this.pan(-1, 0) : this.turn(-TURN, 0)),
      ArrowRight: () => (far ? this.pan(1, 0) : this.turn(TURN, 0)),
      ArrowUp: () => (far ? this.pan(0, 1) : this.turn(0, TURN)),
      ArrowDown: () => (far ? this.pan(0, -1) : this.turn(0, -TURN)),
      "+": () => this.zoom(1 / 1.15), "=": () => this.zoom(1 / 1.15), "-": () => this.zoom(1.15),
      0: () => this.look("default"),
      Enter: () => this.measuring &&
        this.measureAt(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }
}
