// node browser_test.mjs AGRICOLMAP PAIRS CHROMIUM FOLDER: report.html as a reader meets it, in a
// headless Chromium. Leaves screenshots in FOLDER.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { Chromium } from "./chromium.mjs";
import { contrastsOf, namelessOf } from "./access.mjs";
import { choose, labelled, on, picture, runAll, text } from "./harness.mjs";

const [agricolmap, pairs, program, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });

/** Registers a pair, unless it cannot be; returns the address of its page and its report. */
function register(name, kind, { moving, more = [], status = 0 } = {}) {
  const out = `${folder}/${name}`;
  const done = spawnSync(agricolmap, ["register", `${pairs}/${kind}/uav/point_cloud.ply`,
    moving ?? `${pairs}/${kind}/ugv/point_cloud.ply`, "-o", out, "--overwrite", "--quiet", ...more]);
  assert.equal(done.status, status, String(done.stderr));
  return { file: `${out}/report.html`, url: `file://${encodeURI(out)}/report.html`,
    report: JSON.parse(readFileSync(`${out}/registration.json`, "utf8")) };
}

const tests = [];
const test = (name, run) => tests.push({ name, run });
async function inSpace(page) {
  await page.middle("#space");
  await page.until(`document.querySelector("#space canvas")`, "the 3-D view");
}
const with3d = (page) =>
  page.evaluate(`JSON.parse(document.getElementById("data-facts").textContent).with_3d`);

test("opens within two seconds, is small enough, and says the verdict", async (chromium, { good }) => {
  assert.ok(statSync(good.file).size < 8e6);
  const times = [];
  for (let i = 0; i < 3; ++i) {
    await on(chromium, good.url, {}, async (page) => {
      times.push(page.loadTime);
      assert.equal(await text(page, "h1"), "Accepted");
      for (const reason of good.report.reasons) {
        assert.ok((await text(page, "#verdict")).includes(reason), reason);
      }
    });
  }
  assert.ok(Math.min(...times) < 2000, `${times}`);
});

test("the handle swipes by mouse and by key", (chromium, { good }) =>
  on(chromium, good.url, {}, async (page) => {
    await page.until(`document.querySelector(".swipe").hasAttribute("aria-valuenow")`);
    const value = () => page.evaluate(`Number(document.querySelector(".swipe").ariaValueNow)`);
    const at = await page.middle(".swipe");
    const begun = await value();
    assert.ok(begun > 30 && begun < 70, begun);  // on the strip
    const before = await picture(page, ".map canvas");
    await page.drag(at, [at[0] + 200, at[1]]);
    assert.ok((await value()) > begun + 10);
    assert.notEqual(await picture(page, ".map canvas"), before);
    await page.evaluate(`document.querySelector(".swipe").focus()`);
    await page.press("Home");
    assert.equal(await value(), 0);
    await page.press("ArrowRight", 5);
    assert.equal(await value(), 10);
    await page.press("End");
    assert.equal(await value(), 100);
  }));

test("layers, blocks, pan and zoom change the map", (chromium, { good }) =>
  on(chromium, good.url, {}, async (page) => {
    let last = await picture(page, ".map canvas");
    const changes = async (what, act) => {
      await act();
      await new Promise((resolve) => setTimeout(resolve, 300));
      const now = await picture(page, ".map canvas");
      assert.notEqual(now, last, what);
      last = now;
    };
    for (const layer of ["exg", "height", "colour"]) {
      await changes(layer, () => choose(page, "layer", layer));
    }
    await changes("blocks", () => page.evaluate(`${labelled("Blocks")}.click()`));
    await changes("outline", () => page.evaluate(`${labelled("Outline")}.click()`));
    await changes("drone alone", () => choose(page, "compare", "drone"));
    await page.evaluate(`document.querySelector(".map canvas").focus()`);
    for (const key of ["+", "ArrowLeft", "ArrowUp", "-", "0"]) await changes(key, () => page.press(key));
    const at = await page.middle(".map canvas");
    await changes("drag", () => page.drag([at[0] + 150, at[1]], [at[0] + 210, at[1] + 30]));
    assert.match(await text(page, ".place"), /x 3524\d\d\.\d\d {3}y 48153\d\d\.\d\d/);
  }));

test("blocks tell their numbers to the keyboard", (chromium, { good }) =>
  on(chromium, good.url, {}, async (page) => {
    await page.evaluate(`document.querySelector("#sure .mark").focus()`);
    assert.match(await text(page, "#sure .said"), /^Block at \d+\.\d m, agrees: /);
    const marks = await page.evaluate(`document.querySelectorAll("#sure .mark").length`);
    assert.equal(marks, good.report.evidence.blocks.length);
  }));

test("the transformation is that of registration.json", (chromium, { good }) =>
  on(chromium, good.url, {}, async (page) => {
    const numbers = (string) => string.trim().split(/\s+/).map(Number);
    const shown = () => text(page, "#transform pre");
    assert.deepEqual(numbers(await shown()), good.report.transform.matrix.flat());
    await choose(page, "frame", "local");
    assert.deepEqual(numbers(await shown()), good.report.transform.local.matrix.flat());
    await choose(page, "format", "pdal");
    const [, stage] = JSON.parse(await shown()).pipeline;
    assert.equal(stage.type, "filters.transformation");
    assert.deepEqual(numbers(stage.matrix), good.report.transform.local.matrix.flat());
    // The strip is stretched by a twentieth, which no rigid transform can say.
    await choose(page, "format", "ros");
    assert.ok(await page.evaluate(`document.querySelector("#transform pre").hidden`));
    assert.match(await text(page, "#transform .hint"), /is rigid, and this one is not: .*off by/);
  }));

test("the 3-D view toggles, cuts and measures", (chromium, { good }) =>
  on(chromium, good.url, {}, async (page) => {
    if (!(await with3d(page))) {
      assert.match(await text(page, "#space"), /built without it/);
      return;
    }
    await inSpace(page);
    let last = await picture(page, "#space canvas");
    const changes = async (what, act) => {
      await act();
      const now = await picture(page, "#space canvas");
      assert.notEqual(now, last, what);
      last = now;
    };
    await changes("drone off", () => page.evaluate(`${labelled("Drone")}.click()`));
    await changes("drone on", () => page.evaluate(`${labelled("Drone")}.click()`));
    for (const mode of ["cloud", "height", "own"]) {
      await changes(mode, () => choose(page, "space-colour", mode));
    }
    const inside = async () => Number((await text(page, "#space .tools .hint")).match(/^[\d\u202f]+/)[0]
      .replaceAll("\u202f", ""));
    await changes("cut", () => choose(page, "space-cut", "across"));
    const narrow = await inside();
    assert.ok(narrow > 100);
    await changes("wider", () => page.evaluate(`(() => {
      const width = document.querySelectorAll("#space .tools + .tools input")[1];
      width.value = 1;
      width.dispatchEvent(new Event("input"));
    })()`));
    assert.ok((await inside()) > 2 * narrow);
    await page.evaluate(`${labelled("Measure")}.click()`);
    const at = await page.middle("#space canvas");
    await changes("first end", () => page.clickAt([at[0] - 120, at[1]]));
    await changes("other end", () => page.clickAt([at[0] + 120, at[1]]));
    assert.match(await text(page, "#space .said"), /apart: .* in the plane, .* in height\. From 3524/);
    await page.screenshot(`${folder}/space.png`, false);
    await page.evaluate(`document.querySelector("#space canvas").focus()`);
    await changes("turned by key", () => page.press("ArrowLeft"));
    await changes("measured by key", () => page.press("Enter"));
  }));

test("a rejection names cause and remedy, and offers no error to rely on", (chromium, { bad }) =>
  on(chromium, bad.url, {}, async (page) => {
    assert.equal(await text(page, "h1"), "Rejected");
    const words = await text(page, "#verdict");
    for (const line of [...bad.report.reasons, ...bad.report.remedies]) assert.ok(words.includes(line), line);
    assert.doesNotMatch(words, /±/);
    assert.match(await text(page, "#transform"), /was not accepted/);
    await page.screenshot(`${folder}/rejected.png`);
  }));

test("without pictures it says so, and a name that means harm stays a name", async (chromium, { hostile }) =>
  on(chromium, hostile.url, {}, async (page) => {
    assert.match(await text(page, "#map"), /run without pictures/);
    assert.ok((await text(page, ".subject")).includes("<img src=x onerror="));
    assert.equal(await page.evaluate("document.images.length"), 0);
    assert.ok(statSync(hostile.file).size < 2e5);
  }));

for (const [name, options] of Object.entries({
  light: {}, dark: { dark: true }, phone: { phone: true, width: 390, height: 844 },
  print: { print: true, width: 800 },
})) {
  test(`${name}: readable, labelled, within the screen`, (chromium, { good }) =>
    on(chromium, good.url, options, async (page) => {
      await page.until(`document.querySelector(".swipe").hasAttribute("aria-valuenow")`);
      if (await with3d(page)) await inSpace(page);
      assert.deepEqual(await page.evaluate(`(${contrastsOf})(4.5)`), []);
      assert.deepEqual(await namelessOf(page), []);
      const [width, inner] = await page.evaluate(`[document.documentElement.scrollWidth, innerWidth]`);
      assert.ok(width <= inner, `${width} > ${inner}`);
      await page.evaluate("scrollTo(0, 0)");
      await page.screenshot(`${folder}/${name}.png`);
      if (name === "print") await page.pdf(`${folder}/print.pdf`);
    }));
}

test("a batch leads to the report of each strip", (chromium, { batch }) =>
  on(chromium, batch, {}, async (page) => {
    assert.equal(await text(page, "h1"), "1 of 2 accepted");
    const shown = () => page.evaluate(`document.querySelectorAll("#strips tbody tr").length`);
    assert.equal(await shown(), 2);
    await choose(page, "status", "rejected");
    assert.equal(await shown(), 1);
    await choose(page, "status", "all");
    await choose(page, "sort", "doubtful");
    assert.match(await text(page, "#strips tbody tr"), /^b\s+Rejected/);
    assert.equal(await page.evaluate(`document.querySelectorAll("#plan a").length`), 2);
    assert.deepEqual(await page.evaluate(`(${contrastsOf})(4.5)`), []);
    assert.deepEqual(await namelessOf(page), []);
    await page.screenshot(`${folder}/batch.png`);
    await page.evaluate(`document.querySelector("#strips a[href='a/report.html']").click()`);
    await page.until(`document.querySelector("h1")?.innerText === "Accepted"`);
  }));

test("a shared map shows its layers side by side", (chromium, { map }) =>
  on(chromium, map, {}, async (page) => {
    assert.equal(await text(page, "h1"), "One map of a drone and 3 strips");
    let last = await picture(page, ".map canvas");
    for (const layer of ["source", "height_error", "exg", "colour"]) {
      await choose(page, "right", layer);
      await new Promise((resolve) => setTimeout(resolve, 300));
      const now = await picture(page, ".map canvas");
      assert.notEqual(now, last, layer);
      last = now;
      if (layer === "source") await page.screenshot(`${folder}/map.png`);
    }
    assert.deepEqual(await page.evaluate(`(${contrastsOf})(4.5)`), []);
    assert.deepEqual(await namelessOf(page), []);
  }));

test("without scripts the verdict and its reasons are read", async (chromium, { bad }) => {
  const page = await chromium.open(bad.url, { scripts: false });
  const { root } = await page.send("DOM.getDocument", { depth: -1 });
  const { nodeId } = await page.send("DOM.querySelector", { nodeId: root.nodeId, selector: "main" });
  const { outerHTML } = await page.send("DOM.getOuterHTML", { nodeId });
  for (const line of bad.report.reasons) assert.ok(outerHTML.includes(line), line);
  await page.close();
});

/** A batch of a strip that is found and one that is not; returns the address of its page. */
function batch() {
  const entry = (id, kind) => `  - {id: ${id}, map: ${kind}, file: ${pairs}/${kind}/ugv/point_cloud.ply}\n`;
  const map = (kind) => `  - {id: ${kind}, file: ${pairs}/${kind}/uav/point_cloud.ply}\n`;
  writeFileSync(`${folder}/batch.yaml`, `maps:\n${map("same_field")}${map("other_field")}strips:\n` +
    entry("a", "same_field") + entry("b", "other_field") + "pictures: false\n");
  const done = spawnSync(agricolmap, ["batch", `${folder}/batch.yaml`, "-o", `${folder}/batch`, "--overwrite", "--quiet"]);
  assert.equal(done.status, 10, String(done.stderr));
  return `file://${encodeURI(folder)}/batch/summary.html`;
}

/** The shared map of strips that were registered before; returns the address of its page. */
function fused() {
  const done = spawnSync(agricolmap, ["fuse", `${pairs}/strips/uav/point_cloud.ply`,
    ...[1, 2, 3].map((number) => `${pairs}/runs/strip_${number}`), "-o", `${folder}/map`, "--anew",
    "--overwrite", "--quiet", "--cloud-format", "none"]);
  assert.equal(done.status, 0, String(done.stderr));
  return `file://${encodeURI(folder)}/map/map.html`;
}

const evil = `${folder}/<img src=x onerror=alert(1)>.ply`;
copyFileSync(`${pairs}/same_field/ugv/point_cloud.ply`, evil);
const pages = {
  good: register("good", "same_field"),
  bad: register("bad", "other_field", { status: 10 }),
  hostile: register("hostile", "same_field", { moving: evil,
    more: ["--prior", `${pairs}/same_field/prior.txt`, "--no-pictures"] }),
  batch: batch(),
  map: fused(),
};
await runAll(tests, new Chromium(program), pages);
