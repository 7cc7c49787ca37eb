// node field_test.mjs AGRICOLMAP CHROMIUM FOLDER: facts.html and change.html as a reader meets them, in a headless
// Chromium. Leaves screenshots in FOLDER.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { Chromium } from "./chromium.mjs";
import { contrastsOf, namelessOf } from "./access.mjs";
import { choose, on, picture, runAll, text } from "./harness.mjs";

const [agricolmap, program, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });

function run(...words) {
  const done = spawnSync(agricolmap, [...words, "--overwrite", "--quiet"]);
  assert.equal(done.status, 0, String(done.stderr));
}
const csv = (file) => readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));

/** A field of beets of this size, as a drone and a robot saw it, in one map. */
function mapOf(name, size) {
  const at = (more) => `${folder}/${name}${more}`;
  run("simulate", "--crop", "sugar_beet_10m", "--field.plant-size", size, "--field.width", "12", "--field.height", "12",
    "--seed", "104", "--no-pictures", "-o", at("_clouds"));
  run("register", at("_clouds/uav/point_cloud.ply"), at("_clouds/ugv/point_cloud.ply"), "-o", at("_strip"), "--no-pictures");
  run("fuse", at("_clouds/uav/point_cloud.ply"), at("_strip"), "-o", at(""), "--anew", "--cloud-format", "none");
  return at("");
}

/** Two plots, one of a name that means harm, on the corner of a facts' grid. */
function plotsAt([x, y]) {
  const ring = (west) => [[west, y], [west + 4, y], [west + 4, y + 6], [west, y + 6], [west, y]];
  const plot = (id, west) => ({ type: "Feature", properties: { id }, geometry: { type: "Polygon", coordinates: [ring(west)] } });
  const file = `${folder}/plots.geojson`;
  // Without a coordinate system the plots are in the map's.
  writeFileSync(file, JSON.stringify({ type: "FeatureCollection",
    crs: { type: "name", properties: { name: "urn:ogc:def:crs:EPSG::32633" } },
    features: [plot("<img src=x onerror=alert(1)>", x), plot("B", x + 5)] }));
  return file;
}

const tests = [];
const test = (name, work) => tests.push({ name, run: work });

const card = (page) => text(page, ".card");
const lines = (page) => page.evaluate(`[...document.querySelectorAll(".lines tbody tr")].map((line) => line.innerText)`);
const list = (page, name) => page.evaluate(`(() => {
  const choice = [...document.querySelectorAll("select")].find((one) => [...one.options].some((o) => o.value === "${name}"));
  choice.value = "${name}";
  choice.dispatchEvent(new Event("change"));
})()`);
const chooseLine = (page, k) => page.evaluate(`document.querySelectorAll(".lines tbody button")[${k}].click()`);
const ready = (page) => page.until(`document.querySelector(".swipe").hasAttribute("aria-valuenow")`);
const settled = () => new Promise((resolve) => setTimeout(resolve, 300));
/** Wants each act to change the map. */
async function changing(page) {
  await ready(page);
  await settled();
  let last = await picture(page, ".map canvas");
  return async (what, act) => {
    await act();
    await settled();
    const now = await picture(page, ".map canvas");
    assert.notEqual(now, last, what);
    last = now;
  };
}

test("facts: opens within two seconds, is small enough, and says what stands there", async (chromium, { facts }) => {
  assert.ok(statSync(`${facts}/facts.html`).size < 8e6);
  const json = JSON.parse(readFileSync(`${facts}/facts.json`, "utf8"));
  const times = [];
  for (let i = 0; i < 3; ++i) {
    await on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
      times.push(page.loadTime);
      assert.equal(await text(page, "h1"), "What stands on the field");
      const number = (await text(page, ".lead")).match(/About ([\d\u202f]+) plants/)[1].replaceAll("\u202f", "");
      assert.equal(Number(number), Math.round(json.total.plants.estimate));
    });
  }
  assert.ok(Math.min(...times) < 2000, `${times}`);
});

test("facts: marks are switched, layers chosen, parts shaded", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    const changes = await changing(page);
    for (const mark of ["grid", "plots", "rows", "gaps", "weeds", "plants"]) {
      await changes(mark, () => page.evaluate(`document.querySelector('[data-mark="${mark}"]').click()`));
    }
    for (const layer of ["plant_height", "green"]) await changes(layer, () => choose(page, "left", layer));
    await changes("shade", () => page.evaluate(`(() => {
      const shade = document.querySelectorAll("select")[0];
      shade.value = [...shade.options].find((o) => o.text === "plots by green").value;
      shade.dispatchEvent(new Event("change"));
    })()`));
    assert.match(await text(page, "#map"), /Plots: green\s+\d+\.\d\s%/);
  }));

test("facts: a plot chosen in the table is shown on the map, and its name stays a name", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    const changes = await changing(page);
    assert.equal((await lines(page)).length, 2);
    await changes("line", () => chooseLine(page, 1));
    const rows = csv(`${facts}/plots.csv`);
    const cover = Number(rows.find((row) => row[0] === "B")[rows[0].indexOf("cover")]);
    assert.match(await card(page), /^Plot B\n/);
    assert.ok((await card(page)).includes(`${(100 * cover).toFixed(1)}\u00a0%`), await card(page));
    assert.equal(await page.evaluate(`document.querySelector(".lines tr.chosen button").ariaPressed`), "true");
    await chooseLine(page, 0);
    assert.match(await card(page), /^Plot <img src=x/);
    assert.equal(await page.evaluate("document.images.length"), 0);
  }));

test("facts: tables sort both ways, by number, and turn their pages", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    await ready(page);
    await list(page, "plants");
    const all = csv(`${facts}/plants.csv`).slice(1).length;
    assert.match(await text(page, ".pager"), new RegExp(`1 to 50 of ${String(all).replace(/\B(?=(\d{3})+$)/g, "\u202f")}`));
    const head = (title) => `[...document.querySelectorAll(".sort")].find((b) => b.innerText.startsWith("${title}"))`;
    const numbers = async () => (await lines(page)).map((line) => parseFloat(line.split("\t")[3]));
    await page.evaluate(`${head("Height")}.focus()`);
    await page.evaluate(`${head("Height")}.click()`);
    const down = await numbers();
    assert.deepEqual(down, [...down].sort((a, b) => b - a));
    assert.equal(await page.evaluate(`${head("Height")}.parentElement.ariaSort`), "descending");
    assert.ok(await page.evaluate(`document.activeElement === ${head("Height")}`));
    await page.evaluate(`${head("Height")}.click()`);
    assert.ok((await numbers())[0] < down[0]);
    await page.evaluate(`[...document.querySelectorAll(".pager button")][1].click()`);
    assert.match(await text(page, ".pager"), /^51 to 100/);
  }));

test("facts: rows, plants and gaps tell their facts when they are clicked", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    await ready(page);
    // What is chosen in the table lies where the page says that it drew it; a click there finds it again.
    for (const [name, one] of [["plants", "Plant"], ["gaps", "Gap"], ["rows", "Row"]]) {
      await list(page, name);
      await chooseLine(page, 3);
      const said = await card(page);
      assert.match(said, new RegExp(`^${one} \\d+\\n`));
      const at = await page.evaluate(`(async () => {
        document.querySelector(".map").scrollIntoView({ block: "center", behavior: "instant" });
        await new Promise((resolve) => requestAnimationFrame(resolve));
        const canvas = document.querySelector(".map canvas");
        // Read from a copy: the page's own canvas is not made for it, and the browser would say so.
        const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
        copy.drawImage(canvas, 0, 0);
        const { data, width } = copy.getImageData(0, 0, canvas.width, canvas.height);
        const found = [];
        for (let i = 0; i < data.length; i += 4) {
          if (data[i] < 40 && Math.abs(data[i + 1] - 229) < 20 && data[i + 2] > 235) found.push([(i / 4) % width, Math.floor(i / 4 / width)]);
        }
        const box = canvas.getBoundingClientRect();
        // Of a ring its middle, of a line one of its own places, off the handle.
        const middle = [0, 1].map((k) => found.reduce((sum, p) => sum + p[k], 0) / found.length);
        const handle = document.querySelector(".swipe").getBoundingClientRect();
        const free = found.filter(([x]) => Math.abs(box.left + x - (handle.left + handle.right) / 2) > 40);
        const [x, y] = "${name}" === "plants" ? middle : free[Math.floor(free.length / 2)];
        return [box.left + x, box.top + y];
      })()`);
      await page.evaluate(`[...document.querySelectorAll(".card button")].find((b) => b.innerText === "Let go").click()`);
      assert.match(await card(page), /^Click a mark/);
      // A row is found beside its plants and gaps.
      if (name === "rows") {
        await page.evaluate(`for (const m of ["plants", "gaps", "weeds"]) document.querySelector('[data-mark="' + m + '"]').click()`);
      }
      await page.clickAt(at);
      assert.equal(await card(page), said, name);
    }
    await page.screenshot(`${folder}/facts_chosen.png`, false);
  }));

test("facts: all of it by keyboard", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    await ready(page);
    await page.evaluate(`document.querySelector(".map canvas").focus()`);
    await page.press("n", 2);
    assert.match(await card(page), /^Plot B\n/);
    await page.press("n");
    assert.match(await card(page), /^Plot <img/);
    await page.press("p");
    assert.match(await card(page), /^Plot B\n/);
    await page.press("Escape");
    assert.match(await card(page), /^Click a mark/);
    await page.press("+", 6);
    await page.press("Enter");
    assert.match(await card(page), /^(Plot|Plant|Row|Gap|Weed patch) /);
    // From what was found on to the row that it stands in.
    await list(page, "plants");
    await chooseLine(page, 0);
    await page.evaluate(`[...document.querySelectorAll(".card button")].find((b) => b.innerText.startsWith("Row")).click()`);
    assert.match(await card(page), /^Row 1\n/);
    assert.equal(await page.evaluate(`document.querySelector(".card").getAttribute("role")`), "status");
  }));

test("facts: without pictures the marks stand alone", (chromium, { bare }) =>
  on(chromium, `file://${bare}/facts.html`, {}, async (page) => {
    assert.match(await text(page, "#map"), /--no-pictures/);
    const changes = await changing(page);
    await changes("line", () => chooseLine(page, 2));
    assert.match(await card(page), /^Row 3\n/);
    assert.ok(statSync(`${bare}/facts.html`).size < 1e6);
  }));

test("facts: the way to the map's page is there", (chromium, { facts }) =>
  on(chromium, `file://${facts}/facts.html`, {}, async (page) => {
    await page.evaluate(`[...document.querySelectorAll("#verdict a")].at(-1).click()`);
    await page.until(`document.querySelector("h1")?.innerText.startsWith("One map of a drone")`);
  }));

test("change: before, after and what is more than errors", (chromium, { change }) =>
  on(chromium, `file://${change}/change.html`, {}, async (page) => {
    assert.ok(statSync(`${change}/change.html`).size < 8e6);
    assert.ok(page.loadTime < 4000, page.loadTime);
    const json = JSON.parse(readFileSync(`${change}/change.json`, "utf8"));
    const share = (100 * json.surface.rise.area_m2) / json.surface.compared.area_m2;
    assert.ok((await text(page, ".lead")).includes(`rose on ${share.toFixed(1)}\u00a0%`), await text(page, ".lead"));
    const changes = await changing(page);
    await changes("all of it", () => page.evaluate(`document.querySelector("#map .tools .check input").click()`));
    await changes("after", () => choose(page, "left", "after"));
    for (const layer of ["plant_height", "cover", "colour"]) await changes(layer, () => choose(page, "seen", layer));
    for (const layer of ["plant_height_change", "cover_change", "change"]) {
      await changes(layer, () => choose(page, "changed", layer));
    }
    await changes("squares", () => page.evaluate(`document.querySelector('[data-mark="squares"]').click()`));
  }));

test("change: a place says what it was and is, a square is found in both", (chromium, { change }) =>
  on(chromium, `file://${change}/change.html`, {}, async (page) => {
    const changes = await changing(page);
    const at = await page.middle(".map canvas");
    await changes("click", () => page.clickAt([at[0] - 60, at[1] + 40]));
    await page.until(`document.querySelector(".card h3")`);
    assert.match(await card(page), /^At x [\d.]+, y [\d.]+\nSurface\n.*\nLevel of detection\n.*\nMore than errors\n(yes|no)/);
    await changes("line", () => chooseLine(page, 0));
    assert.match(await card(page), /^Square \d+\n/);
    // The largest change comes first.
    const values = (await lines(page)).map((line) => parseFloat(line.split("\t")[1].replace("\u2212", "-")));
    assert.deepEqual(values, [...values].sort((a, b) => b - a));
    await page.evaluate(`document.querySelectorAll("#numbers .mark")[24].focus()`);
    assert.match(await text(page, "#numbers .said"), /cm: .*% of the cells/);
  }));

test("change: plots are listed, drawn, shaded by what changed, and found in both", (chromium, { plots }) =>
  on(chromium, `file://${plots}/change.html`, {}, async (page) => {
    const changes = await changing(page);
    assert.match(await text(page, "#map"), /Plot by plot/);
    const table = await lines(page);
    assert.equal(table.length, 2);
    const [, ...rows] = csv(`${plots}/plots.csv`);
    const [name, , mean] = rows.find(([id]) => id === "B");
    const shown = table.map((line) => line.split(/\s*\t/)).find(([first]) => first === name);
    assert.ok(shown[1].startsWith(`${mean > 0 ? "+" : ""}${(100 * mean).toFixed(1)}`), `${shown[1]} ${mean}`);
    await changes("line", () => chooseLine(page, 0));
    assert.match(await card(page), /^Plot .*\nSurface\n[+\u2212]/);
    assert.match(await card(page), /Plants' height\n\+[\d.]+\u00a0cm \([\d.]+ to [\d.]+\)\n/);
    await changes("shade", () => list(page, "0"));
    assert.match(await text(page, "#map"), /Plots: surface[^]*no more than its errors/);
    await changes("let go", () => page.evaluate(`[...document.querySelectorAll(".card button")].at(-1).click()`));
    const at = await page.middle(".map canvas");
    await changes("click", () => page.clickAt([at[0] + 80, at[1] + 60]));
    await page.until(`document.querySelectorAll(".card h3").length === 2`);
    assert.match(await card(page), /^Plot [^]*\nAt x [\d.]+, y /);
    assert.equal(await page.evaluate(`document.querySelectorAll(".lines tr.chosen").length`), 1);
    await list(page, "grid");
    assert.match(await text(page, ".listing"), /Squares \(\d+\)/);
  }));

for (const [kind, sort] of [["facts", "facts"], ["change", "change"], ["plots", "change"]]) {
  for (const [name, options] of Object.entries({
    light: {}, dark: { dark: true }, phone: { phone: true, width: 390, height: 844 }, print: { print: true, width: 800 },
  })) {
    test(`${kind}, ${name}: readable, labelled, within the screen`, (chromium, pages) =>
      on(chromium, `file://${pages[kind]}/${sort}.html`, options, async (page) => {
        await ready(page);
        await settled();
        if (name !== "print") await chooseLine(page, 1);
        if (kind === "plots") await list(page, "0");
        assert.deepEqual(await page.evaluate(`(${contrastsOf})(4.5)`), []);
        assert.deepEqual(await namelessOf(page), []);
        const [width, inner] = await page.evaluate(`[document.documentElement.scrollWidth, innerWidth]`);
        assert.ok(width <= inner, `${width} > ${inner}`);
        await page.evaluate("scrollTo(0, 0)");
        await page.screenshot(`${folder}/${kind}_${name}.png`);
      }));
  }
}

test("facts: a hundred thousand plants open, are drawn, found and listed without a wait", (chromium, { large }) =>
  on(chromium, `file://${large}/facts.html`, {}, async (page) => {
    assert.ok(page.loadTime < 4000, page.loadTime);
    await ready(page);
    await settled();
    assert.match(await text(page, "#map"), /120\u202f000 of 300\u202f000 plants are on this page, evenly chosen/);
    const timed = (act) => page.evaluate(`(() => { const begin = performance.now(); ${act}; return performance.now() - begin; })()`);
    const canvas = `document.querySelector(".map canvas")`;
    await page.evaluate(`${canvas}.focus()`);
    const key = (name) => `${canvas}.dispatchEvent(new KeyboardEvent("keydown", { key: "${name}" }))`;
    for (const name of ["+", "+", "+", "+", "ArrowLeft", "Enter"]) {
      const time = await timed(key(name));
      assert.ok(time < 1000, `${name}: ${time} ms`);
    }
    assert.match(await card(page), /^Plant \d+\n/);
    await list(page, "plants");
    assert.match(await text(page, ".pager"), / of 120\u202f000/);
    const sorting = await timed(`document.querySelectorAll(".sort")[2].click()`);
    assert.ok(sorting < 2000, `${sorting} ms`);
    assert.match(await text(page, ".pager"), /^1 to 50 of /);
  }));

/** A page of so many plants, 0.1 m and 0.2 m apart, instead of its own. */
function largePage(from, to) {
  const page = readFileSync(`${from}/facts.html`, "utf8");
  const [, begin, data, end] = page.match(/^([^]*id="data-scene">)(.*?)(<\/script>[^]*)$/s);
  const scene = JSON.parse(data);
  const count = 120_000;
  const column = (value, step, kind) => ({ low: 0, step, bytes: kind.BYTES_PER_ELEMENT,
    data: Buffer.from(kind.from({ length: count }, (_, i) => value(i)).buffer).toString("base64") });
  const along = 1000;  // in a row
  scene.layers.plants = { kind: "point", count, of: 300_000,
    shapes: { x: column((i) => 100 * (i % along), 0.001, Uint32Array),
      y: column((i) => 200 * Math.floor(i / along), 0.001, Uint16Array) },
    columns: { id: column((i) => i + 1, 1, Uint32Array), row: column((i) => Math.floor(i / along) % 20 + 1, 1, Uint8Array),
      along_m: column((i) => i % along, 0.1, Uint16Array),
      height_m: column((i) => (i * 7919) % 300, 0.001, Uint16Array) } };
  mkdirSync(to, { recursive: true });
  writeFileSync(`${to}/facts.html`, begin + JSON.stringify(scene) + end);
  return to;
}

const map = mapOf("june", "0.5");
const later = mapOf("august", "0.9");
const pages = { facts: `${folder}/facts`, bare: `${folder}/bare`, change: `${folder}/change`,
  plots: `${folder}/plots`, large: `${folder}/large` };
run("facts", map, "-o", pages.bare, "--no-pictures");
const [, first] = csv(`${pages.bare}/grid.csv`);
const plots = plotsAt([Number(first[1]) + 2, Number(first[2]) + 2]);
run("facts", map, "-o", pages.facts, "--plots", plots);
run("diff", map, later, "-o", pages.change, "--frame-error", "0.01", "0.01");
run("diff", map, later, "-o", pages.plots, "--frame-error", "0.01", "0.01", "--plots", plots, "--grid", "2");
largePage(pages.facts, pages.large);
await runAll(tests, new Chromium(program), pages);
