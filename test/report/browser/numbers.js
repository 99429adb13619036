// The numbers that the page shows against those in the JSON file beside it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const prefixes = { G: 1e9, M: 1e6, k: 1e3, m: 1e-3, "µ": 1e-6 };

// "18.83" shown for 18834.2 with scale 1e-3: equal to the last digit shown.
function assertShown(shown, value, what) {
  const number = Number(shown), digits = (shown.split(".")[1] || "").length;
  const trailing = digits === 0 ? shown.length - shown.replace(/0+$/, "").length : 0;
  const step = digits > 0 ? 10 ** -digits : 10 ** trailing;
  assert.ok(Math.abs(number - value) <= 0.5001 * step, `${what}: the page says ${shown}, the file ${value}`);
}

function inUnit(value, shown, unit) {
  return shown === unit ? value : value / prefixes[shown.slice(0, -unit.length)];
}

function assertLength(text, value, what) {
  const [number, unit] = text.trim().split(/\s+/);
  assertShown(number, inUnit(value, unit, "m"), what);
}

// Words outside tables, files and lists of choices, which are looked up and not read.
export async function countWords(page) {
  return page.evaluate(() => {
    const walker = document.createTreeWalker(document.querySelector("main"), NodeFilter.SHOW_TEXT), parts = [];
    while (walker.nextNode()) if (!walker.currentNode.parentElement.closest("table, pre, option, .in-view")) parts.push(walker.currentNode.data);
    return parts.join(" ").split(/\s+/).filter(Boolean).length;
  });
}

// The heights of the staircase's columns as they are drawn [pixel].
async function columnHeights(page) {
  return page.evaluate(() => {
    const { plot } = charts.find((c) => c.host.dataset.chart === "steps"), { width, height } = plot.ctx.canvas;
    const pixels = plot.ctx.getImageData(0, 0, width, height).data, bottom = Math.round(plot.bbox.top + plot.bbox.height);
    return plot.data[0].map((x) => {
      const left = Math.round(plot.valToPos(x, "x", true)) - 8;
      const filled = (y) => pixels[4 * (y * width + left) + 3] > 0 && pixels[4 * (y * width + left)] > pixels[4 * (y * width + left) + 1] + 30;
      let y = bottom - 2;
      while (y > 4 && [0, 1, 2, 3, 4].some((step) => filled(y - step))) --y;  // the line of the noise crosses columns
      return bottom - y;
    });
  });
}

async function embedded(page) {
  return page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
}

// E with its interval in the page's answer.
async function checkModulus(page, { mean, interval95 }) {
  const answer = await page.textContent("#answer");
  const found = answer.match(/([\d.]+) ([GMk]?Pa) ?95 %: ([\d.]+) to ([\d.]+) \2/);
  assert.ok(found, "the answer has E with its interval: " + answer);
  assertShown(found[1], inUnit(mean, found[2], "Pa"), "E");
  assertShown(found[3], inUnit(interval95[0], found[2], "Pa"), "lower end");
  assertShown(found[4], inUnit(interval95[1], found[2], "Pa"), "upper end");
  return answer;
}

export async function checkResults(page, folder) {
  const file = JSON.parse(readFileSync(folder + "/results.json", "utf8"));
  assert.deepEqual((await embedded(page)).results, file, "the page's data are results.json");
  const [name] = Object.keys(file.parameters).filter((n) => n.endsWith("young_modulus"));
  const answer = await checkModulus(page, file.parameters[name]);
  assert.ok(answer.includes(file.state.replace("_", " ")), "the state");
  assert.ok(answer.includes(file.identifiable[name].reason), "what E is relative to");
  const facts = await page.locator("#facts dd").evaluateAll((all) => all.map((e) => e.firstChild.textContent));
  assertLength(facts[0], file.rms_error, "rms error");
  assertShown(facts[1].replace(" %", ""), 100 * file.relative_error, "relative error");
  assertShown(facts[2], file.nis.mean_per_dof, "squared innovation");
  assert.equal(Number(facts[3]), file.frames, "frames");
}

// The list holds the probable effects, the table all of them.
async function checkEffects(page, file) {
  const listed = await page.locator("#missing li h3").allTextContents();
  const words = ({ effect }) => effect.replaceAll("_", " ");
  const probable = file.candidates.filter((c) => c.probability >= 0.01 || file.set.includes(c.effect)).map(words);
  assert.deepEqual(listed.map((name) => name.toLowerCase()), file.none_of_these >= 0.01 ? [...probable, "none of these"] : probable);
  const rows = await page.locator("#missing table tr:has(td)").all();
  assert.equal(rows.length, file.candidates.length);
  for (const [i, candidate] of file.candidates.entries()) {
    const cells = await rows[i].locator("td").allTextContents();
    assert.equal(await rows[i].locator("td b").textContent(), words(candidate));
    if (candidate.held_out_rms_after === null) assert.equal(cells[1], "not refitted");
    else if (candidate.probability < 1e-3) assert.equal(cells[1], "< 0.1 %");
    else assertShown(cells[1].replace(" %", ""), 100 * candidate.probability, "probability of " + words(candidate));
    if (candidate.z > 100) assert.equal(cells[2], "> 100");
    if (candidate.explained < 5e-4) assert.equal(cells[3], "nothing");
    else if (candidate.explained < 1e-3) assert.equal(cells[3], "< 0.1 %");
    else assertShown(cells[3].replace(" %", ""), 100 * candidate.explained, "explained by " + words(candidate));
    assert.ok(!/\de[-+]?\d/.test(cells.slice(1, 7).join()), "no exponents: " + cells);
  }
}

// Every best fit of E on the page is one of the table's, and the answer says so.
async function checkModuli(page) {
  const fits = await page.locator("#staircase .scroll tbody tr td:nth-child(5)").allTextContents();
  const answer = await page.textContent("#answer"), force = await page.textContent("#fails");
  for (const fit of [fits[0], fits[fits.length - 1]]) assert.ok(answer.includes(fit), "the answer tells of the best fit " + fit);
  if (/best fit of E/.test(force)) assert.equal(force.match(/best fit of E, ([^,]*),/)[1], fits[fits.length - 1]);
  assert.ok((await page.textContent("#missing table")).includes(fits[fits.length - 1]), "so does the table of effects");
}

export async function checkDiagnosis(page, folder) {
  const file = JSON.parse(readFileSync(folder + "/diagnosis.json", "utf8"));
  assert.deepEqual((await embedded(page)).diagnosis, file, "the page's data are diagnosis.json");
  const [name] = Object.keys(file.final.parameters).filter((n) => n.endsWith("young_modulus"));
  await checkModulus(page, file.final.parameters[name]);
  assert.equal(await page.locator("#arrows").count(), file.missing_force ? 1 : 0, "arrows where a force is missing");
  if (file.missing_force) assert.ok((await page.textContent("#fails")).includes(file.missing_force.words));
  const rows = await page.locator("#staircase .scroll tbody tr").all();
  assert.equal(rows.length, file.steps.length);
  for (const [i, step] of file.steps.entries()) {
    const cells = await rows[i].locator("td").allTextContents();
    assertLength(cells[1], step.held_out_rms, "held-out error");
    assertLength(cells[2], step.train_rms, "fitted error");
    assertLength(cells[3], step.noise_floor, "noise");
  }
  const heights = await columnHeights(page), highest = Math.max(...heights), most = Math.max(...file.steps.map((s) => s.held_out_rms));
  assert.ok(highest > 100, "columns are drawn: " + heights);
  file.steps.forEach((step, i) => {
    assert.ok(Math.abs(heights[i] / highest - step.held_out_rms / most) < 0.015, "the column is as high as the error: " + heights);
  });
  await checkEffects(page, file);
  const parts = await page.locator("#fails dd").evaluateAll((all) => all.map((e) => e.firstChild.textContent));
  for (const [i, part] of ["total", "noise", "structured", "numerical"].entries()) {
    assertLength(parts[i], file.how_much.metres[part], part);
  }
  await checkModuli(page);
  assert.deepEqual(await page.locator("#model table tbody tr td:first-child").allTextContents(), file.final.effects, "what the proposed model adds");
  const text = await page.textContent("main");
  assert.ok(text.includes(file.where) && text.includes(file.when), "where and when");
  assert.ok(text.includes(readFileSync(folder + "/model_next.yaml", "utf8").trim().split("\n").pop().trim()));
}
