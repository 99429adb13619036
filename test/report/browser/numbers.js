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

export async function checkDiagnosis(page, folder) {
  const file = JSON.parse(readFileSync(folder + "/diagnosis.json", "utf8"));
  assert.deepEqual((await embedded(page)).diagnosis, file, "the page's data are diagnosis.json");
  const [name] = Object.keys(file.final.parameters).filter((n) => n.endsWith("young_modulus"));
  await checkModulus(page, file.final.parameters[name]);
  assert.equal(await page.locator("#arrows").count(), file.missing_force ? 1 : 0, "arrows where a force is missing");
  if (file.missing_force) assert.ok((await page.textContent("#fails")).includes(file.missing_force.words));
  const rows = await page.locator("#staircase tbody tr").all();
  assert.equal(rows.length, file.steps.length);
  for (const [i, step] of file.steps.entries()) {
    const cells = await rows[i].locator("td").allTextContents();
    assertLength(cells[1], step.held_out_rms, "held-out error");
    assertLength(cells[2], step.train_rms, "fitted error");
    assertLength(cells[3], step.noise_floor, "noise");
    const height = await page.locator(".step i").nth(i).evaluate((e) => parseFloat(e.style.height));
    const most = Math.max(...file.steps.map((s) => Math.max(s.held_out_rms, s.noise_floor)));
    assert.ok(Math.abs(height - (100 * step.held_out_rms) / most) < 0.1, "the column is as high as the error");
  }
  const effects = await page.locator("#missing table tr:has(td)").all();
  assert.equal(effects.length, file.candidates.length);
  for (const [i, candidate] of file.candidates.entries()) {
    const cells = await effects[i].locator("td").allTextContents();
    assert.equal(cells[0], candidate.effect.replaceAll("_", " "));
    assertShown(cells[1].replace(" %", ""), 100 * candidate.explained, "explained by " + cells[0]);
  }
  const parts = await page.locator("#fails dd").evaluateAll((all) => all.map((e) => e.firstChild.textContent));
  for (const [i, part] of ["total", "noise", "structured", "numerical"].entries()) {
    assertLength(parts[i], file.how_much.metres[part], part);
  }
  const text = await page.textContent("main");
  assert.ok(text.includes(file.where) && text.includes(file.when), "where and when");
  assert.ok(text.includes(readFileSync(folder + "/model_next.yaml", "utf8").trim().split("\n").pop().trim()));
}
