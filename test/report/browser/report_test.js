// node report_test.js FOLDER-OF-ESTIMATE FOLDER-OF-DIAGNOSE COMPARISON.html [REPORT.html ...]
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { browser, open } from "./browser.js";
import { checkControls, savePlots } from "./controls.js";
import { checkDiagnosis, checkResults } from "./numbers.js";

const [estimate, diagnose, comparison, ...others] = process.argv.slice(2).map((path) => resolve(path));
const pages = [estimate + "/report.html", diagnose + "/report.html", ...others];
let failed = 0;

async function check(name, act) {
  try {
    await act();
    console.log("ok      " + name);
  } catch (error) {
    ++failed;
    console.log("FAILED  " + name + "\n" + error.stack);
  }
}

// Opens the page, acts, and fails for anything that went wrong meanwhile.
function visit(name, file, settings, act) {
  return check(name + ": " + file, async () => {
    const { page, wrong, close } = await open(file, settings);
    try {
      await act(page);
      assert.deepEqual(wrong, []);
    } finally {
      await close();
    }
  });
}

const picture = (file, kind) => ({ path: file.replace(/\.html$/, "-" + kind + ".png"), fullPage: true });

await visit("numbers", pages[0], {}, (page) => checkResults(page, estimate));
await visit("numbers", pages[1], {}, (page) => checkDiagnosis(page, diagnose));
for (const file of pages) {
  await check("below 4 MB: " + file, () => assert.ok(statSync(file).size < 4e6));
  await visit("controls", file, {}, checkControls);
  await visit("light", file, { colorScheme: "light" }, async (page) => {
    await page.screenshot(picture(file, "light"));
    await page.locator("#replay").screenshot({ path: file.replace(/\.html$/, "-replay.png") });
  });
  await visit("dark", file, { colorScheme: "dark" }, async (page) => {
    const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.ok(ground.match(/\d+/g).every((c) => Number(c) < 60), "a dark ground: " + ground);
    await page.screenshot(picture(file, "dark"));
  });
  await visit("phone", file, { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true }, async (page) => {
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, "nothing sticks out: " + width);
    await page.screenshot(picture(file, "phone"));
  });
  await visit("paper", file, {}, async (page) => assert.ok((await page.pdf({ format: "A4" })).length > 20000));
  await visit("without scripts", file, { javaScriptEnabled: false }, async (page) => {
    assert.match(await page.textContent("#answer"), /\d [GMk]?Pa/);
  });
}
await visit("comparison", comparison, {}, async (page) => {
  const names = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).compare.runs.map((r) => r.name));
  assert.equal(await page.locator("#runs tbody tr").count(), names.length);
  const titles = await page.locator("[data-chart] h3").allTextContents();
  assert.ok(titles.some((t) => t.startsWith("Young's modulus")) && titles.some((t) => t.startsWith("Error of each frame")), titles.join());
  for (const name of names) assert.ok((await page.textContent("[data-chart=compare-misfit] .u-legend")).includes(name));
  await savePlots(page);
  await page.screenshot(picture(comparison, "light"));
});
await visit("comparison on a phone", comparison, { viewport: { width: 390, height: 844 }, isMobile: true, colorScheme: "dark" }, async (page) => {
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, "nothing sticks out");
  await page.screenshot(picture(comparison, "phone"));
});
await browser.close();
console.log(failed === 0 ? "scripts/test_report: all passed" : `scripts/test_report: ${failed} FAILED`);
process.exit(failed === 0 ? 0 : 1);
