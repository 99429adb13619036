// node report_test.js FOLDER-OF-ESTIMATE FOLDER-OF-DIAGNOSE COMPARISON.html [REPORT.html ...]
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { browser, open } from "./browser.js";
import { checkControls, savePlots } from "./controls.js";
import { checkDiagnosis, checkResults, countWords } from "./numbers.js";

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

const phone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

async function checkWidth(page) {
  const { width, wanted } = await page.evaluate(() => ({ width: document.documentElement.scrollWidth, wanted: innerWidth }));
  assert.ok(width <= wanted, "nothing sticks out: " + width);
}

// A long name wraps: no column of a table is out of view.
async function checkColumns(page, tables) {
  for (const table of await page.locator(tables).all()) {
    const { width, room, text } = await table.evaluate((e) => ({ width: e.offsetWidth, room: e.closest(".scroll").clientWidth, text: e.innerText }));
    assert.ok(width <= room, `a table of ${width} pixels in ${room}: ${text}`);
  }
}

// At the end of each chart over time, the band of a run is as high as the interval in its data.
async function checkIntervals(page) {
  const measured = await page.evaluate(() => charts.filter((c) => c.host.dataset.chart.startsWith("compare:")).flatMap(({ plot }) => {
    const { ctx, data } = plot, last = data[0].length - 1, x = Math.round(plot.valToPos(data[0][last - 1], "x", true));
    const column = ctx.getImageData(x, 0, 1, ctx.canvas.height).data;
    return [...Array((data.length - 1) / 3).keys()].filter((run) => data[3 * run + 1][last - 1] !== null).map((run) => {
      const [low, high] = [2, 3].map((k) => Math.round(plot.valToPos(data[3 * run + k][last - 1], "y", true)));
      let filled = 0;
      for (let y = high + 2; y < low - 2; ++y) if (column[4 * y + 3] > 20) ++filled;
      return { filled, height: low - high - 4 };
    });
  }));
  assert.ok(measured.length >= 4, "each run's parameters: " + measured.length);
  for (const { filled, height } of measured) assert.ok(height > 5 && filled === height, `a band fills ${filled} of ${height} pixels`);
}

const picture = (file, kind) => ({ path: file.replace(/\.html$/, "-" + kind + ".png"), fullPage: true });

await visit("numbers", pages[0], {}, (page) => checkResults(page, estimate));
await visit("numbers", pages[1], {}, (page) => checkDiagnosis(page, diagnose));
// Half of what the page had before its parts were folded and shortened: 857 words, or 997 with those of its charts.
await visit("few words", pages[1], { javaScriptEnabled: false }, async (page) => {
  const words = await countWords(page);
  assert.ok(words > 100 && words <= 428, "words: " + words);
});
await visit("few words with charts", pages[1], {}, async (page) => {
  const words = await countWords(page);
  assert.ok(words > 200 && words <= 498, "words: " + words);
});
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
  for (const colorScheme of ["light", "dark"]) {
    await visit("phone, " + colorScheme, file, { ...phone, colorScheme }, async (page) => {
      await checkWidth(page);
      await page.screenshot(picture(file, "phone-" + colorScheme));
    });
  }
  await visit("paper", file, {}, async (page) => assert.ok((await page.pdf({ format: "A4" })).length > 20000));
  await visit("without scripts", file, { javaScriptEnabled: false }, async (page) => {
    assert.match(await page.textContent("#answer"), /\d [GMk]?Pa/);
  });
}
await visit("comparison", comparison, {}, async (page) => {
  const { runs } = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).compare);
  const names = runs.map((r) => r.name);
  assert.equal(await page.locator("#runs tbody tr").count(), names.length);
  const titles = await page.locator("[data-chart] h3").allTextContents();
  assert.ok(titles.some((t) => t.startsWith("Young's modulus")) && titles.some((t) => t.startsWith("Error of each frame")), titles.join());
  for (const name of names) assert.ok((await page.textContent("[data-chart=compare-misfit] .u-legend")).includes(name));
  assert.deepEqual(await page.locator("#model table tbody tr td:first-child").allTextContents(), ["viscoelasticity"], "paths are no difference");
  await checkIntervals(page);
  await savePlots(page);
});
for (const colorScheme of ["light", "dark"]) {
  await visit("comparison, " + colorScheme, comparison, { colorScheme }, async (page) => {
    await checkWidth(page);
    await checkColumns(page, "table.stacked");
    await page.screenshot(picture(comparison, colorScheme));
  });
  await visit("comparison on a phone, " + colorScheme, comparison, { ...phone, colorScheme }, async (page) => {
    await checkWidth(page);
    await checkColumns(page, "table.stacked");
    await page.screenshot(picture(comparison, "phone-" + colorScheme));
  });
}
await browser.close();
console.log(failed === 0 ? "scripts/test_report: all passed" : `scripts/test_report: ${failed} FAILED`);
process.exit(failed === 0 ? 0 : 1);
