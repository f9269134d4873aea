// Measures the page: the first image over a slow network, and tasks of the main thread during a
// flight.
//
//   node figures.mjs SITE PACKAGES [NAME…]
//
// 20 Mbit/s and 50 ms for each answer, files of the page compressed as static hosts do it. The
// renderer is a program on the processor here, which takes most of the time of a picture; so the
// time until a frame is handed to it is told, too.
import path from "node:path";
import { openPage, startChromium } from "./browser.mjs";
import { startServer } from "./server.mjs";

const [site, packages, ...named] = process.argv.slice(2);
const names = named.length > 0 ? named : ["pass"];
const browser = await startChromium();
if (!browser) process.exit(77);
const server = await startServer({ site: path.resolve(site), packages: path.resolve(packages) });
const SLOW = { delay_ms: 50, bytes_per_ms: 2500, compresses: true };

/** Records, in the page, when frames begin and end, their reports, and messages of workers. */
function watch() {
  window.corniche_frames = [];
  window.corniche_decoded = [];
  const make = window.Worker;
  window.Worker = class extends make {
    constructor(...all) {
      super(...all);
      this.addEventListener("message", (event) => {
        if (event.data?.tile) window.corniche_decoded.push([performance.now(), event.data.tile.byteLength]);
      });
    }
  };
  window.corniche_watch = (view) => {
    const frame = view.prototype.frame;
    view.prototype.frame = function (now) {
      const begun = performance.now();
      const text = frame.call(this, now);
      const { tiles, is_settled, requests, bytes, triangles } = JSON.parse(text);
      window.corniche_frames.push({ begun, took: performance.now() - begun, ...tiles, is_settled, requests, bytes, triangles });
      return text;
    };
  };
}

/**
 * The durations of the tasks of a page's main thread of at least a millisecond, the longest first, from a trace. `of` names the time: `dur` is wall-clock time,
 * `tdur` CPU time, which does not depend on other programs.
 */
function mainTasks(events, of) {
  const main = new Set(
    events.filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain").map(({ pid, tid }) => `${pid} ${tid}`),
  );
  // Starting and ending the trace use the thread, too.
  const [begins, ends] = ["flight begins", "flight ends"].map((mark) => events.find(({ name }) => name === mark).ts);
  return events
    .filter(({ ts }) => ts > begins && ts < ends)
    .filter(({ name, ph, pid, tid }) => name === "RunTask" && ph === "X" && main.has(`${pid} ${tid}`))
    .map((event) => {
      if (!(of in event)) throw new Error(`the trace does not tell ${of} of tasks`);
      return event;
    })
    .map((event) => event[of] / 1000)
    .filter((task) => task >= 1)
    .sort((a, b) => b - a);
}

/** Median, 95th percentile and largest of some times. */
function spread(times) {
  const sorted = [...times].sort((a, b) => a - b);
  const at = (share) => (sorted[Math.floor(share * (sorted.length - 1))] ?? 0).toFixed(1);
  return `median ${at(0.5)} ms, 95 % ${at(0.95)} ms, longest ${at(1)} ms`;
}

const kB = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
const ms = (time) => `${time.toFixed(0)} ms`;

// Files are compressed at their first request, which takes seconds.
server.state.compresses = true;
await (await openPage(browser, server, "/", {})).end();
await new Promise((done) => setTimeout(done, 8000));

for (const name of names) {
  server.behave();
  Object.assign(server.state, SLOW);
  const before = async (page) => page.addInitScript(watch);
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  await before(page);
  // The module's class is wrapped as soon as the page has loaded it.
  await page.addInitScript(() => {
    const timer = setInterval(async () => {
      if (!document.querySelector("corniche-map")) return;
      clearInterval(timer);
      window.corniche_watch((await import("/corniche_web.js")).MapView);
    }, 1);
  });
  await page.goto(`${server.origin}/?src=/packages/${name}.pmtiles`);
  await page.waitForFunction(() => window.corniche_frames?.some((frame) => frame.is_settled), null, { timeout: 120_000 });
  const frames = await page.evaluate(() => window.corniche_frames);
  const first = frames.find((frame) => frame.drawn > 0);
  const last = frames.find((frame) => frame.is_settled);
  const decoded = await page.evaluate(() => window.corniche_decoded);
  console.log(
    `${name}: first coarse picture handed to the renderer after ${ms(first.begun + first.took)}, ${first.requests} requests and ${kB(first.bytes)} of the package; ` +
      `whole picture after ${ms(last.begun + last.took)} (the processor draws), ${last.requests} requests, ${kB(last.bytes)}; ${decoded.length} tiles decoded`,
  );
  const files = server.state.requests.filter(({ path: asked }) => !asked.startsWith("/packages/")).length;
  console.log(`${name}: ${files} files of the page, ${server.state.requests.length} requests in all until then`);
  await context.close();

  // A flight over the package, on a fast network.
  server.behave();
  const flight = await openPage(browser, server, `/?src=/packages/${name}.pmtiles`, { width: 640, height: 400, before: watch });
  await flight.waitForFunction(() => document.querySelector("corniche-map")?.camera);
  await browser.startTracing(flight, { categories: ["toplevel", "disabled-by-default-devtools.timeline", "devtools.timeline", "blink.user_timing", "__metadata"] });
  const told = await flight.evaluate(async () => {
    const map = document.querySelector("corniche-map");
    window.corniche_watch((await import("/corniche_web.js")).MapView);
    const [west, south, east, north] = map.about.bounds;
    window.corniche_decoded.length = 0;
    performance.mark("flight begins");
    const begun = performance.now();
    for (let step = 0; step <= 8; step += 1) {
      const share = 0.15 + 0.7 * (step / 8);
      const lat = south + (0.3 + 0.4 * (step % 2)) * (north - south);
      const place = { lon: west + share * (east - west), lat, distance: 4000, heading: 40 * step, pitch: 60 };
      try {
        map.lookAt(place);
      } catch {
        // The point has no ground; the map stays where it is.
      }
      await new Promise((done) => setTimeout(done, 1500));
    }
    await map.settled?.();
    const seconds = (performance.now() - begun) / 1000;
    performance.mark("flight ends");
    return {
      frames: window.corniche_frames.map((frame) => frame.took),
      decoded: window.corniche_decoded.length,
      bytes: window.corniche_decoded.reduce((sum, [, bytes]) => sum + bytes, 0),
      seconds,
      memory: performance.memory?.usedJSHeapSize,
    };
  });
  const { traceEvents } = JSON.parse(String(await browser.stopTracing()));
  console.log(
    `${name}: flight of ${told.seconds.toFixed(0)} s: ${told.decoded} tiles decoded (${(told.decoded / told.seconds).toFixed(1)} a second, ${kB(told.bytes)} of geometry), ${told.frames.length} frames; ` +
      `in the page for a frame ${spread(told.frames)}`,
  );
  for (const [of, what] of [
    ["dur", "on the clock"],
    ["tdur", "of the processor"],
  ]) {
    const tasks = mainTasks(traceEvents, of);
    const longest = tasks.slice(0, 5).map((task) => task.toFixed(1));
    console.log(`${name}: ${tasks.length} tasks of the main thread of a millisecond and more, ${what}: ${spread(tasks)}; the longest ${longest.join(", ")} ms`);
  }
  await flight.end();
}

await browser.close();
server.close();
