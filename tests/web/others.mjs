// Measures the first picture of <corniche-map> beside those of MapLibre GL JS, CesiumJS and rerun: the same ground and roads, browser, network and measure.
//
//   scripts/web-others [MAP…]             installs what is missing, makes the data, and measures; see there
//   node others.mjs FOLDER BUILT CORNICHE PYTHON HEIGHTS EXTRACT RUNS [MAP…]
//
// BUILT is the page that scripts/web makes, PYTHON an interpreter with rerun's SDK; pages, data and pictures are put into FOLDER. 20 Mbit/s, 50 ms for each answer, a new browser with nothing kept for each run, HTTP/1.1 (six requests at a time), 1280 × 800. Each map looks from where
// <corniche-map> looks when it opens the package. Each run is made twice: with pictures, which are judged by their pixels (others/frames.mjs), and with all draw calls left out
// (others/watch.mjs), since the renderer is a program on the processor here, which takes most of the time. With RUNS 0 it shows instead what maps do where something fails.
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { startChromium } from "./browser.mjs";
import { compressAll, heightAt, makeData, makeRecording } from "./others/data.mjs";
import { showFaults } from "./others/faults.mjs";
import { follow, judge, toPng } from "./others/frames.mjs";
import { makeSite } from "./others/site.mjs";
import { watch } from "./others/watch.mjs";
import { startServer } from "./server.mjs";

const [folder, built, corniche, python, heights, extract, runs, ...named] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));
const SLOW = { delay_ms: 50, bytes_per_ms: 2500, compresses: true };
const VIEWPORT = { width: 1280, height: 800 };
const LONGEST_MS = 240_000;
const QUIET_MS = 3000;

const ofPage = (page, roads) => (view, data) => `/${page}?view=${view}&height=${height_m}&roads=${roads}&data=${data}`;
const MAPS = {
  corniche: { address: (view, data) => `/corniche/index.html?src=/${data}/li.pmtiles#${view}`, leastVertices: 3000 },
  "maplibre, vector tiles": { address: ofPage("maplibre/maplibre.html", "tiles") },
  "maplibre, vector tiles, one source of heights": { address: ofPage("maplibre/maplibre.html", "tiles, one source") },
  "maplibre, GeoJSON": { address: ofPage("maplibre/maplibre.html", "geojson") },
  "cesium, terrain and GeoJSON": { address: ofPage("cesium/cesium.html", "geojson") },
  "cesium, terrain and GeoJSON, bundled": { address: ofPage("cesium/bundled.html", "geojson") },
  "cesium, 3D Tiles with roads": { address: ofPage("cesium/cesium.html", "cut") },
  // It tells nothing; the mesh is the only thing of so many vertices.
  rerun: { address: ofPage("rerun/rerun.html", "lines"), leastVertices: 100_000, isSilent: true },
};

const site = path.join(folder, "site");
const pictures = path.join(folder, "pictures");
fs.mkdirSync(pictures, { recursive: true });

/** A page in a new browser that has come to rest. */
async function openBrowser(prepare) {
  const browser = await startChromium();
  if (!browser) process.exit(77);
  const context = await browser.newContext({ viewport: VIEWPORT });
  const page = await context.newPage();
  page.setDefaultTimeout(LONGEST_MS);
  await prepare?.(page);
  await new Promise((done) => setTimeout(done, 1500));
  return { browser, page };
}

/** <corniche-map> tells when it is whole by a promise. */
function tellWhole() {
  addEventListener("ready", (event) => event.target.settled?.().then(() => (window.others.told.whole ??= performance.now())), true);
}

/** One run, in a browser of its own. */
async function measure(server, map, view, mute) {
  const { browser, page } = await openBrowser(async (page) => {
    await page.addInitScript(watch, { mute, leastVertices: map.leastVertices ?? 0 });
    await page.addInitScript(tellWhole);
  });
  return measureIn(page, server, map, view, mute).finally(() => browser.close());
}

async function measureIn(page, server, { address, isSilent = false }, view, mute) {
  const faults = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("request", (request) => {
    if (!/^(data|blob|chrome):/.test(request.url()) && !request.url().startsWith(server.origin)) faults.push(`asks ${request.url()}`);
  });
  server.behave();
  Object.assign(server.state, SLOW);
  const frames = mute ? [] : await follow(page);
  await page.goto(`${server.origin}${address(view, "data")}`, { waitUntil: "commit" });
  await page.waitForFunction((name) => window.others.told[name] !== undefined, isSilent ? "handed" : "whole");
  // Nothing changes any more when no frame, no request and no word came for a while, and the renderer is done with all: a screenshot waits for it.
  const begun = Date.now();
  const latest = () => Math.max(begun, frames.at(-1)?.at_ms ?? 0, server.state.requests.at(-1)?.sent_ms ?? 0);
  const calm = async () => {
    while (Date.now() - latest() < QUIET_MS && Date.now() - begun < LONGEST_MS) await new Promise((done) => setTimeout(done, 200));
  };
  await calm();
  if (!mute) {
    await page.screenshot({ timeout: LONGEST_MS });
    await calm();
  }
  const { told, origin, drawn } = await page.evaluate(() => ({ told: window.others.told, origin: performance.timeOrigin, drawn: window.others.frames }));
  const shown = mute ? null : judge(frames.filter(({ at_ms }) => at_ms >= origin));
  const requests = [...server.state.requests];

  /** Requests and bytes, of the program and of data, that had come by a time. */
  function until(ms) {
    const came = requests.filter(({ sent_ms }) => sent_ms !== undefined && sent_ms <= origin + ms);
    const isData = ({ path: asked }) => asked.startsWith("/data/");
    const sum = (list) => ({ requests: list.length, bytes: list.reduce((bytes, one) => bytes + one.bytes, 0) });
    return { program: sum(came.filter((one) => !isData(one))), data: sum(came.filter(isData)) };
  }
  const point = (ms) => (ms === undefined || ms === null ? null : { ms, ...until(ms) });
  return {
    first: point(shown && shown.first.at_ms - origin),
    whole: point(shown && shown.whole.at_ms - origin),
    handed: point(told.handed),
    told: point(told.whole),
    last_data_ms: Math.max(...requests.map(({ sent_ms }) => sent_ms ?? 0)) - origin,
    missing: requests.filter(({ bytes }) => bytes === undefined).map(({ path: asked }) => asked),
    drawn,
    shown,
    faults,
  };
}

const median = (values) => [...values].sort((one, other) => one - other)[Math.floor(values.length / 2)];
const seconds = (ms) => (ms / 1000).toFixed(2);
const kB = (bytes) => Math.round(bytes / 1000);

/** The run whose time is the median, with all times. */
function told(results, name) {
  const points = results.map((result) => result[name]).filter(Boolean);
  if (points.length === 0) return "–";
  const middle = median(points.map(({ ms }) => ms));
  const { program, data } = points.find(({ ms }) => ms === middle);
  const all = points.map(({ ms }) => seconds(ms)).join(", ");
  return `${seconds(middle)} s (${all}); program ${program.requests} requests, ${kB(program.bytes)} kB; data ${data.requests} requests, ${kB(data.bytes)} kB`;
}

fs.mkdirSync(path.join(folder, "work"), { recursive: true });
makeSite({ folder, modules: path.join(here, "node_modules"), pages: path.join(here, "others", "pages"), built });
makeData({ folder, corniche, heights, extract });
compressAll(site);
const server = await startServer({ site, packages: path.join(site, "data") });

/** Where <corniche-map> looks from when it opens the package. */
async function firstView() {
  const { browser, page } = await openBrowser();
  await page.goto(`${server.origin}${MAPS.corniche.address("", "data")}`);
  await page.waitForFunction(() => document.querySelector("corniche-map")?.camera?.distance);
  const { lon, lat, distance, heading, pitch } = await page.evaluate(() => document.querySelector("corniche-map").camera);
  await browser.close();
  return [lon.toFixed(6), lat.toFixed(6), Math.round(distance), heading.toFixed(1), pitch.toFixed(1)].join(",");
}

const view = await firstView();
const height_m = heightAt(heights, view);
console.log(`all look at ${view} (longitude, latitude, metres from there to the eye, heading, pitch), ${height_m} m high`);
makeRecording({ folder, corniche, python, view, height_m });

async function compare(name, map) {
  const file = name.replace(/[^a-zA-Z0-9]+/g, "-");
  const [seen, mute] = [[], []];
  for (let run = 0; run < Number(runs); run += 1) {
    seen.push(await measure(server, map, view, false));
    mute.push(await measure(server, map, view, true));
  }
  const { shown, faults, missing, drawn } = seen[0];
  if (shown) for (const kind of ["first", "whole", "last"]) fs.writeFileSync(path.join(pictures, `${file}-${kind}.png`), toPng(shown[kind]));
  console.log(`\n${name}`);
  console.log(`  first picture, by pixels:          ${told(seen, "first")}`);
  console.log(`  whole picture, by pixels:          ${told(seen, "whole")}`);
  console.log(`  ground handed to the renderer:     ${told(seen, "handed")}`);
  console.log(`  whole, as it says itself:          ${told(seen, "told")}`);
  console.log(`  nothing drawn: ground handed over: ${told(mute, "handed")}`);
  console.log(`  nothing drawn: whole:              ${told(mute, "told")}`);
  console.log(`  frames ${drawn}; not found: ${missing.length} ${missing.slice(0, 3).join(" ")}; errors: ${faults.length} ${faults[0] ?? ""}`);
}

const wanted = Object.entries(MAPS).filter(([name]) => named.length === 0 || named.some((one) => name.startsWith(one)));
for (const [name, map] of wanted) {
  if (Number(runs) === 0) {
    await showFaults({ openBrowser, watch, server, name, map, view, pictures });
    continue;
  }
  // One that fails does not keep the others from being measured.
  await compare(name, map).catch((error) => {
    console.log(`\n${name}: failed: ${error.message.split("\n")[0]}`);
    process.exitCode = 1;
  });
}
server.close();
