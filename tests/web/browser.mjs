// Chromium with WebGPU on a software device, and monitored pages.
import assert from "node:assert/strict";
import fs from "node:fs";
import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox",
  "--enable-unsafe-webgpu",
  "--ignore-gpu-blocklist",
  "--use-webgpu-adapter=swiftshader",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--enable-features=Vulkan",
  "--use-vulkan=swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--no-first-run",
  "--disable-quic",
];

/** The browser, or `null` with the reason printed if it does not start. */
export function startChromium() {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  return chromium.launch({ executablePath, headless: true, args: FLAGS }).catch((error) => {
    // An installed Chromium must start, otherwise the tests would pass without running.
    if (fs.existsSync(executablePath)) throw error;
    console.error(`skipped: Chromium does not start here, so no page is opened: ${error.message.split("\n")[0]}`);
    return null;
  });
}

/**
 * A page at an address of the server. Requests to other hosts, script errors and console messages are recorded.
 *
 * @param {import("playwright-core").Browser} browser
 */
export async function openPage(browser, server, address, { width = 800, height = 600, before, ...context } = {}) {
  const made = await browser.newContext({ viewport: { width, height }, ...context });
  const page = await made.newPage();
  // The CPU renders, and other programs may need it.
  page.setDefaultTimeout(90_000);
  const faults = { foreign: [], errors: [], console: [] };
  page.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(server.origin)) faults.foreign.push(request.url());
  });
  page.on("pageerror", (error) => faults.errors.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") faults.console.push(message.text());
  });
  if (before) await page.addInitScript(before);
  await page.goto(`${server.origin}${address}`);
  return Object.assign(page, { faults, end: () => made.close() });
}

/** Checks that there were no requests to other hosts and no script errors. */
export function checkFaults(page) {
  assert.deepEqual(page.faults.foreign, [], "requests to other hosts");
  assert.deepEqual(page.faults.errors, [], "errors of scripts");
}

/** Waits until the page's workers have ended, which takes a while on a busy machine. */
export async function checkWorkersEnd(page) {
  for (let wait = 0; wait < 200 && page.workers().length > 0; wait += 1) await page.waitForTimeout(50);
  assert.equal(page.workers().length, 0, "workers that are left");
}

/** Puts a map into the page and waits until it is open or has failed. Returns { ready } or { error }. */
export function addMap(page, attributes, { width = "100%", height = "600px" } = {}) {
  return page.evaluate(
    ([attributes, width, height]) => {
      const map = document.createElement("corniche-map");
      for (const [name, value] of Object.entries(attributes)) map.setAttribute(name, value);
      Object.assign(map.style, { width, height });
      document.querySelector("main").append(map);
      return new Promise((resolve) => {
        map.addEventListener("ready", (event) => resolve({ ready: event.detail }), { once: true });
        map.addEventListener("error", (event) => resolve({ error: event.detail }), { once: true });
      });
    },
    [attributes, width, height],
  );
}

/** A page with one map, with all tiles of its view loaded. */
export async function openMap(browser, server, attributes, options = {}) {
  const page = await openPage(browser, server, "/blank.html", options);
  const opened = await addMap(
    page,
    { src: "/packages/pass.pmtiles", samples: "1", ...attributes },
    options.size ?? { height: `${options.height ?? 600}px` },
  );
  assert.ok(opened.ready, `the map did not open: ${JSON.stringify(opened.error)}`);
  await settled(page);
  return page;
}

export const settled = (page) => page.evaluate(() => document.querySelector("corniche-map").settled());

/** Calls the map of the page. */
export const ask = (page, of, argument) =>
  page.evaluate(
    ([of, argument]) => new Function("map", "argument", `return (${of})(map, argument)`)(document.querySelector("corniche-map"), argument),
    [of.toString(), argument],
  );

/** The displayed pixels, as { width, height, data }. */
export async function pixelsOf(page) {
  const { width, height, text } = await ask(page, async (map) => {
    const { width, height, data } = await map.readPixels();
    let text = "";
    for (let at = 0; at < data.length; at += 32768) text += String.fromCharCode(...data.subarray(at, at + 32768));
    return { width, height, text: btoa(text) };
  });
  return { width, height, data: Buffer.from(text, "base64") };
}

/** Touch events with the browser's protocol: points are [x, y] in CSS pixels of the page. */
export async function touches(page) {
  const client = await page.context().newCDPSession(page);
  const send = (type, points) => client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  return {
    down: (...points) => send("touchStart", points),
    move: (...points) => send("touchMove", points),
    up: () => send("touchEnd", []),
    left: (...points) => send("touchEnd", points),
  };
}
