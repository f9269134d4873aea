// How long the first picture takes on a slow link: 20 Mbit/s and 50 ms a request, everything cold.
//
//   node first_picture.mjs SITE PACKAGES NAME [LOOK-AT]
//
// Prints milliseconds from the beginning of the navigation, and requests and bytes of the package.
import { startChromium } from "./browser.mjs";
import { startServer } from "./server.mjs";

const DELAY_MS = 50;
const BYTES_PER_MS = 2500;
const RUNS = 5;

const [site, packages, name, place] = process.argv.slice(2);
const browser = await startChromium();
if (!browser) process.exit(0);
const server = await startServer({ site, packages });

/** Notes when a map is ready, which is when its first frame has been handed to the device, and when nothing is missing any more. */
const watch = () => {
  document.addEventListener("DOMContentLoaded", () => {
    const map = document.querySelector("corniche-map");
    map.addEventListener("ready", async () => {
      const { requests, bytes } = map.report;
      window.first = { ms: performance.now(), requests, bytes, tiles: map.report.tiles };
      await map.settled();
      window.all = { ms: performance.now(), requests: map.report.requests, bytes: map.report.bytes, tiles: map.report.tiles };
    });
  });
};

async function run(slow) {
  server.behave();
  Object.assign(server.state, { compresses: true }, slow ? { delay_ms: DELAY_MS, bytes_per_ms: BYTES_PER_MS } : {});
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  await page.addInitScript(watch);
  await page.goto(`${server.origin}/index.html?src=packages/${name}.pmtiles${place ? `#${place}` : ""}`);
  await page.waitForFunction(() => window.all, null, { timeout: 60_000 });
  const result = await page.evaluate(() => ({
    first: window.first,
    all: window.all,
    files: performance
      .getEntriesByType("resource")
      .map((entry) => [entry.name.split("/").pop(), Math.round(entry.startTime), Math.round(entry.responseEnd)]),
  }));
  await context.close();
  return result;
}

// The first run warms the server and the driver.
await run(false);
for (let time = 0; time < RUNS; time += 1) {
  const { first, all, files } = await run(true);
  const told = ({ ms, requests, bytes, tiles }) =>
    `${ms.toFixed(0)} ms, ${requests} requests, ${(bytes / 1000).toFixed(0)} kB, ${tiles.drawn} tiles drawn, ${tiles.missing} missing`;
  console.log(`first frame ${told(first)}; all ${told(all)}`);
  if (time === 0) for (const [file, begin, end] of files) console.log(`  ${begin} to ${end} ms  ${file}`);
}
await browser.close();
server.close();
