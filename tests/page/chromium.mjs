// A headless Chromium, driven over its debugging pipe (Chrome DevTools Protocol): no package needed.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const PATIENCE = 60_000;  // ms

export class Chromium {
  constructor(program) {
    this.home = mkdtempSync(join(tmpdir(), "agricolmap-page-"));
    this.process = spawn(program, [
      "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-extensions",
      // WebGL without a graphics card.
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
      "--hide-scrollbars", `--user-data-dir=${this.home}`, "about:blank",
    ], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.waiting = new Map();
    this.listeners = [];
    this.next = 1;
    let rest = Buffer.alloc(0);
    this.process.stdio[4].on("data", (data) => {
      rest = Buffer.concat([rest, data]);
      for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        this.hear(JSON.parse(rest.subarray(0, end).toString()));
        rest = rest.subarray(end + 1);
      }
    });
  }

  hear(message) {
    if (message.id === undefined) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    const { resolve, reject } = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) reject(new Error(JSON.stringify(message.error)));
    else resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = this.next++;
    this.process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${method}: no answer`)), PATIENCE);
      this.waiting.set(id, {
        resolve: (result) => { clearTimeout(timer); resolve(result); },
        reject: (error) => { clearTimeout(timer); reject(error); },
      });
    });
  }

  /** Opens a tab: `size` [px], `dark`, `phone`, `print`, `still` (prefers reduced motion). */
  async open(url, { width = 1280, height = 900, dark = false, phone = false, print = false,
    still = true, scripts = true } = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    this.listeners.push((message) => { if (message.sessionId === sessionId) page.hear(message); });
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride",
      { width, height, deviceScaleFactor: phone ? 2 : 1, mobile: phone });
    if (!scripts) await page.send("Emulation.setScriptExecutionDisabled", { value: true });
    await page.send("Emulation.setEmulatedMedia", { media: print ? "print" : "screen", features: [
      { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
      { name: "prefers-reduced-motion", value: still ? "reduce" : "no-preference" }] });
    const begin = performance.now();
    const loaded = page.once("Page.loadEventFired");
    await page.send("Page.navigate", { url });
    await loaded;
    page.loadTime = performance.now() - begin;
    return page;
  }

  async close() {
    const gone = new Promise((resolve) => this.process.once("exit", resolve));
    await this.send("Browser.close").catch(() => this.process.kill());
    await gone;
    rmSync(this.home, { recursive: true, force: true, maxRetries: 5 });
  }
}

export class Page {
  constructor(chromium, sessionId, targetId) {
    Object.assign(this, { chromium, sessionId, targetId, problems: [], requests: [], events: [] });
  }
  send(method, params) {
    return this.chromium.send(method, params, this.sessionId);
  }
  once(method) {
    return new Promise((resolve) => this.events.push({ method, resolve }));
  }
  hear({ method, params }) {
    if (method === "Runtime.exceptionThrown") {
      const { exceptionDetails: details } = params;
      this.problems.push(details.exception?.description ?? details.text);
    }
    if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) {
      this.problems.push(params.args.map((arg) => arg.value ?? arg.description).join(" "));
    }
    if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level)) {
      this.problems.push(params.entry.text);
    }
    if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
    this.events = this.events.filter((event) => {
      if (event.method !== method) return true;
      event.resolve(params);
      return false;
    });
  }

  /** The value of an expression, promises awaited. */
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate",
      { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) {
      throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    }
    return result.value;
  }
  async until(expression, what = expression) {
    const end = performance.now() + PATIENCE / 2;
    while (performance.now() < end) {
      if (await this.evaluate(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`waited in vain for ${what}`);
  }
  async screenshot(file, whole = true) {
    const { data } = await this.send("Page.captureScreenshot",
      { format: "png", captureBeyondViewport: whole });
    writeFileSync(file, Buffer.from(data, "base64"));
  }
  async pdf(file) {
    const { data } = await this.send("Page.printToPDF", { printBackground: true });
    writeFileSync(file, Buffer.from(data, "base64"));
  }
  /** Where the middle of an element is on the screen, scrolled to. */
  middle(selector) {
    return this.evaluate(`(() => {
      const element = document.querySelector(${JSON.stringify(selector)});
      element.scrollIntoView({ block: "center", behavior: "instant" });
      const box = element.getBoundingClientRect();
      return [box.left + box.width / 2, box.top + box.height / 2];
    })()`);
  }
  mouse(type, [x, y], more = {}) {
    return this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1,
      buttons: type === "mouseReleased" ? 0 : 1, ...more });
  }
  async click(selector) {
    const at = await this.middle(selector);
    await this.clickAt(at);
  }
  async clickAt(at) {
    await this.mouse("mousePressed", at);
    await this.mouse("mouseReleased", at);
  }
  async drag(from, to) {
    await this.mouse("mousePressed", from);
    for (let i = 1; i <= 5; ++i) {
      await this.mouse("mouseMoved", [0, 1].map((k) => from[k] + ((to[k] - from[k]) * i) / 5));
    }
    await this.mouse("mouseReleased", to);
  }
  async press(key, times = 1) {
    const text = key.length === 1 ? key : undefined;
    for (let i = 0; i < times; ++i) {
      await this.send("Input.dispatchKeyEvent", { type: "keyDown", key, text });
      await this.send("Input.dispatchKeyEvent", { type: "keyUp", key });
    }
  }
  close() {
    return this.chromium.send("Target.closeTarget", { targetId: this.targetId });
  }
}
