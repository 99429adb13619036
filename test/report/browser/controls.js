// Every control of the page, used. What is not used here fails the test.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { surfaceColours, surfaceHash } from "./browser.js";

const clock = async (page) => parseFloat(await page.textContent("#clock"));

async function changesSurface(page, what, act) {
  const before = await surfaceHash(page);
  await act();
  assert.notEqual(await surfaceHash(page), before, what + " changes the surface");
}

async function choose(page, name, value) {
  await page.locator(`input[name=${name}][value="${value}"] + span`).click();
}

async function scrubTo(page, share) {
  await page.locator("#scrub").evaluate((input, s) => {
    input.value = Number(input.min) + s * (Number(input.max) - Number(input.min));
    input.dispatchEvent(new Event("input"));
  }, share);
}

async function usePlayer(page) {
  await scrubTo(page, 0);
  const first = await clock(page);
  await changesSurface(page, "the scrubber", () => scrubTo(page, 0.63));
  assert.ok((await clock(page)) > first, "the scrubber moves the clock");
  const line = () => page.locator(".clock-line").first().evaluate((e) => e.style.transform);
  const before = await line();
  await scrubTo(page, 0.1);
  assert.notEqual(await line(), before, "the line in the charts follows");
  const start = await clock(page);
  await page.click("#play");
  await page.waitForFunction((t) => parseFloat(document.getElementById("clock").textContent) > t, start);
  await page.click("#play");
  const stopped = await clock(page);
  await page.waitForTimeout(250);
  assert.equal(await clock(page), stopped, "pause stops the clock");
  const speeds = await page.locator("#speed option").evaluateAll((all) => all.map((o) => o.value));
  await page.selectOption("#speed", speeds[0]);
  await scrubTo(page, 0.2);
  await page.click("#play");
  await page.waitForFunction(() => document.getElementById("play").getAttribute("aria-label") === "Play", null, { timeout: 600000 });
  assert.equal(await page.locator("#scrub").evaluate((i) => i.value === i.max), true, "playing ends at the end");
}

async function useSurface(page) {
  await scrubTo(page, 0.7);
  assert.ok((await surfaceColours(page)) > 50, "the surface is there");
  const scale = await page.textContent("#colour-bar");
  await choose(page, "colour", "sigmas");
  assert.notEqual(await page.textContent("#colour-bar"), scale);
  const other = (await page.isChecked("input[name=span][value=all]")) ? "frame" : "all";
  await changesSurface(page, "all frames", () => choose(page, "span", other));
  await choose(page, "colour", "error");
  assert.equal(await page.textContent("#colour-bar"), scale);
  if (await page.locator("#measured").count()) await changesSurface(page, "hiding points", () => page.click("#measured"));
  await changesSurface(page, "magnifying", () => page.locator("#magnify").fill("3"));
  assert.equal(await page.textContent("#magnify-value"), "10");
  await page.locator("#magnify").fill("0");
  if (await page.locator("#arrows").count()) await changesSurface(page, "hiding the missing force", () => page.click("#arrows"));
  await changesSurface(page, "hiding loads and supports", () => page.click("#surroundings"));
  assert.equal(await page.locator(".in-view:visible").count(), 0, "their words go as well");
  await page.click("#surroundings");
  assert.ok((await page.locator(".in-view:visible").count()) >= 3, "the axes have names");
  const glass = await page.isChecked("#glass");
  await page.click("#glass");
  assert.equal(await page.isChecked("#glass"), !glass);
  const still = await surfaceHash(page);
  await page.click("#turn");
  await page.waitForTimeout(600);
  await page.click("#turn");
  assert.notEqual(await surfaceHash(page), still, "turning turns");
  await page.click("#view");
  const home = await surfaceHash(page);
  const box = await page.locator("#surface").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  assert.notEqual(await surfaceHash(page), home, "dragging turns the surface");
  await changesSurface(page, "the reset", () => page.click("#view"));
  for (const radio of await page.locator("input[name=model]").all()) {
    const value = await radio.getAttribute("value");
    if (value === "0") continue;
    await changesSurface(page, "another model", () => choose(page, "model", value));
    await changesSurface(page, "the given model", () => choose(page, "model", "0"));
  }
}

async function useMotion(page) {
  const title = () => page.textContent("[data-chart=motion] h3");
  for (const list of ["#track", "#component"]) {
    const values = await page.locator(list + " option").evaluateAll((all) => all.map((o) => o.value));
    const before = await title(), now = await page.locator(list).inputValue();
    const other = values.find((v) => v !== now);
    if (other === undefined) continue;
    await page.selectOption(list, other);
    assert.notEqual(await title(), before, list + " changes the chart");
  }
}

// A click on the surface chooses the point that is plotted.
async function pickPoint(page) {
  const tracks = await page.evaluate(() => surfaceView.tracked.length);
  if (tracks < 2) return;
  await page.click("#view");
  const title = () => page.textContent("[data-chart=motion] h3");
  const goal = await page.evaluate(() => {
    const seen = surfaceView.trackVertex.map((v, i) => ({ i, ...surfaceView.project(surfaceView.geometry.attributes.position.array.subarray(3 * v, 3 * v + 3)) }));
    const other = seen.filter((p) => surfaceView.tracked[p.i] !== Number(document.getElementById("track").value));
    return other.sort((a, b) => a.depth - b.depth)[0];
  });
  const before = await title(), box = await page.locator("#surface").boundingBox();
  await page.mouse.click(box.x + goal.x, box.y + goal.y);
  assert.notEqual(await title(), before, "a click on the surface changes the chart");
  assert.ok((await title()).startsWith(await page.evaluate((i) => player.replay.tracks[surfaceView.tracked[i]].name + ",", goal.i)));
  assert.ok((await page.textContent("#picked")).includes(await page.evaluate((i) => player.replay.tracks[surfaceView.tracked[i]].name, goal.i)));
}

const betweenSaves = 150;  // [ms]; Chromium drops the eleventh file that a page saves within a second (kBurstDownloadLimit)

// Every canvas is that of a plot with two buttons, which save its numbers and its picture.
export async function savePlots(page) {
  await page.evaluate(() => document.querySelectorAll("main details:not([open])").forEach((e) => { e.open = true; e.dataset.opened = "yes"; }));
  const plots = page.locator("[data-plot]");
  assert.equal(await page.locator("main canvas").count(), await page.locator("[data-plot] canvas").count(), "each canvas has its plot");
  assert.ok(await plots.count());
  for (const plot of await plots.all()) {
    const name = await plot.evaluate((e) => e.dataset.chart || e.dataset.plot);
    assert.equal(await plot.locator("canvas").count(), 1, name);
    for (const kind of ["csv", "png"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), plot.locator(`button[name=save-${kind}]`).click()]);
      assert.ok(download.suggestedFilename().endsWith("." + kind));
      checkFile(readFileSync(await download.path()), kind, name);
      await page.waitForTimeout(betweenSaves);
    }
  }
  await page.evaluate(() => document.querySelectorAll("[data-opened]").forEach((e) => { e.open = false; }));
}

function checkFile(file, kind, name) {
  if (kind === "png") {
    assert.equal(file.toString("latin1", 1, 4), "PNG");
    assert.ok(file.length > (name === "surface" ? 5000 : 1000), name + ": a picture with something in it");
    return;
  }
  const rows = file.toString().trim().split("\r\n"), width = rows[0].match(/"[^"]*"/g).length;
  assert.ok(rows.length > 2 && width > 1, name + ": numbers with headings: " + rows[0]);
  for (const row of rows.slice(1)) assert.equal(row.split(",").length, width, row);
  assert.match(rows.slice(1).join(), /\d/, name + ": numbers");
}

// The scrubber stands below the surface and covers neither it nor a chart.
async function checkScrubber(page) {
  const bar = await page.locator(".player").boundingBox();
  for (const selector of ["#surface", "[data-chart=motion]", "#picture"]) {
    if (!(await page.locator(selector).count())) continue;
    const box = await page.locator(selector).boundingBox();
    assert.ok(bar.y >= box.y + box.height || bar.y + bar.height <= box.y, "the scrubber lies over " + selector);
  }
}

async function useRest(page) {
  for (const box of await page.locator("[data-chart] input[type=checkbox]").all()) {
    if (!(await box.isVisible())) continue;
    const plot = await box.evaluate((e) => { e.closest("[data-chart]").dataset.tried = "yes"; return e.id; });
    await page.evaluate((id) => document.getElementById(id).click(), plot);
    assert.ok(await page.locator("[data-chart][data-tried] canvas").count(), "the chart is drawn again");
  }
  for (const details of await page.locator("details").all()) {
    const was = await details.evaluate((e) => e.open);
    await details.locator("> summary").click();
    assert.equal(await details.evaluate((e) => e.open), !was, "details fold");
    if (was) await details.locator("> summary").click();
  }
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.click("#theme");
  await page.click("#theme");
  assert.notEqual(await ground(), light, "the theme's button makes it dark");
  await page.click("#theme");
  assert.equal(await ground(), light);
}

const used = new Set(["play", "scrub", "speed", "colour", "span", "model", "measured", "magnify", "glass", "arrows", "turn", "view",
  "track", "component", "theme", "camera", "surroundings", "save-csv", "save-png"]);

// Both outlines are on the picture, and it plays.
async function checkPicture(page) {
  if (!(await page.locator("#picture").count())) return;
  const look = () => page.evaluate(() => {
    const canvas = document.getElementById("picture"), style = getComputedStyle(document.documentElement);
    const context = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height }).getContext("2d");
    context.drawImage(canvas, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const wanted = ["measured-on-image", "predicted-on-image"].map((name) =>
      style.getPropertyValue("--" + name).trim().match(/[0-9a-f]{2}/g).map((h) => parseInt(h, 16)));
    const seen = [0, 0];
    let sum = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      wanted.forEach((c, k) => { if (c.every((x, j) => Math.abs(x - pixels[i + j]) < 8)) ++seen[k]; });
      sum = (31 * sum + pixels[i]) % 1000003;
    }
    return { seen, sum };
  });
  await scrubTo(page, 0);
  await page.waitForFunction(() => document.getElementById("picture").width > 300);
  const first = await look();
  assert.ok(first.seen[0] > 100 && first.seen[1] > 100, "both outlines are drawn: " + first.seen);
  await scrubTo(page, 0.5);
  const later = await look();
  assert.notEqual(later.sum, first.sum, "the picture plays");
  const cameras = await page.locator("#camera option").all();
  if (!cameras.length) return;
  assert.equal(cameras.length, 2);
  await page.selectOption("#camera", { index: 1 });
  const other = await look();
  assert.notEqual(other.sum, later.sum, "the other camera is shown");
  assert.ok(other.seen[0] > 100 && other.seen[1] > 100, "with both outlines: " + other.seen);
}

export async function checkControls(page) {
  const names = await page.locator("button, input, select").evaluateAll((all) => all.map((e) => e.name || e.id));
  for (const name of names) assert.ok(used.has(name) || name.startsWith("close-"), "a control that no test uses: " + name);
  await usePlayer(page);
  await useSurface(page);
  await useMotion(page);
  await pickPoint(page);
  await checkScrubber(page);
  await savePlots(page);
  await checkPicture(page);
  await useRest(page);
}
