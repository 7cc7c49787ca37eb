// What the tests of pages have in common.
import assert from "node:assert/strict";

/** Nothing was complained of, and nothing asked for but the pages themselves. */
export const quiet = (page) => {
  assert.deepEqual(page.problems, []);
  const foreign = page.requests.filter((url) => !url.startsWith("data:") && !url.endsWith(".html"));
  assert.deepEqual(foreign, []);
};
export const text = (page, selector) =>
  page.evaluate(`document.querySelector(${JSON.stringify(selector)}).innerText`);
export const picture = (page, selector) =>
  page.evaluate(`new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() =>
    resolve(document.querySelector(${JSON.stringify(selector)}).toDataURL()))))`);
export const choose = (page, name, value) =>
  page.evaluate(`document.querySelector('input[name="${name}"][value="${value}"]').click()`);
export const labelled = (label) =>
  `[...document.querySelectorAll("label")].find((l) => l.innerText.trim() === ${JSON.stringify(label)})`;

/** Opens a page, works on it, and wants it to have been quiet throughout. */
export async function on(chromium, url, options, work) {
  const page = await chromium.open(url, options);
  try {
    await work(page);
    quiet(page);
  } finally {
    await page.close();
  }
}

/** Runs `tests`, each { name, run(chromium, pages) }, and says how they went; ends the browser. */
export async function runAll(tests, chromium, pages) {
  let failures = 0;
  for (const { name, run } of tests) {
    try {
      await run(chromium, pages);
      console.log(`ok      ${name}`);
    } catch (error) {
      ++failures;
      console.log(`FAILED  ${name}\n${error.stack}`);
    }
  }
  await chromium.close();
  process.exitCode = failures > 0 ? 1 : 0;
}
