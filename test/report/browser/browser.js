// A page in headless Chromium that remembers everything that went wrong.
import { chromium } from "playwright-core";

const options = {
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
};

export const browser = await chromium.launch(options);

export async function open(file, settings = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...settings });
  context.setDefaultTimeout(600000);  // a busy machine is slow
  const page = await context.newPage();
  const wrong = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text())) {
      wrong.push("console: " + message.text());
    }
  });
  page.on("pageerror", (error) => wrong.push("exception: " + error.message));
  page.on("request", (request) => {
    const url = request.url();
    if (url !== "file://" + file && !url.startsWith("data:") && !url.startsWith("blob:")) wrong.push("request: " + url);
  });
  await page.goto("file://" + file);
  if (settings.javaScriptEnabled !== false) await page.waitForSelector("html[data-ready=yes]", { state: "attached" });
  return { page, wrong, close: () => context.close() };
}

// What the surface shows, as one number.
export async function surfaceHash(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.evaluate(() => {
    const canvas = document.querySelector("#surface canvas"), copy = document.createElement("canvas");
    copy.width = copy.height = 200;
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, 200, 200);
    return context.getImageData(0, 0, 200, 200).data.reduce((hash, byte) => (31 * hash + byte) % 1000003, 7);
  });
}

// How many different colours the surface shows: one when it is empty.
export async function surfaceColours(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector("#surface canvas"), copy = document.createElement("canvas");
    copy.width = copy.height = 200;
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, 200, 200);
    const pixels = new Uint32Array(context.getImageData(0, 0, 200, 200).data.buffer);
    return new Set(pixels).size;
  });
}
