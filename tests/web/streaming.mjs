// Requests to the server and memory use while the map moves.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, checkFaults, openMap, settled } from "./browser.mjs";

const MIB = 1 << 20;
/** Positions all over the sample, as fractions of its extent, close enough for the finest tiles. */
const PLACES = [0.12, 0.3, 0.5, 0.7, 0.88].flatMap((u) => [0.2, 0.5, 0.8].map((v) => [u, v]));

/** Moves the map to each position in turn; returns the reports of all frames. */
const lookAround = (page, places, rest_ms) =>
  ask(
    page,
    async (map, { places, rest_ms }) => {
      const [west, south, east, north] = map.about.bounds;
      const reports = [];
      const wait = (time) => new Promise((done) => setTimeout(done, time));
      for (const [u, v] of places) {
        const place = { lon: west + u * (east - west), lat: south + v * (north - south), distance: 900, heading: 360 * u, pitch: 55 };
        try {
          map.lookAt(place, { jump: true });
        } catch (error) {
          // A void of the sample has no ground for the target.
          if (!/ground/.test(error.message)) throw error;
          continue;
        }
        for (let time = 0; time < rest_ms; time += 50) {
          await wait(50);
          const { gpu_bytes, tiles, requests, bytes } = map.report;
          reports.push({ gpu_bytes, tiles, requests, bytes });
        }
      }
      return reports;
    },
    { places, rest_ms },
  );

export function tests({ browser, server }) {
  test("a long way over the map stays within the memory for tiles, whatever was seen before", async () => {
    server.behave();
    const memory = 3;
    const size = { width: 500, height: 400 };
    const countUploads = () => {
      window.uploaded = 0;
      const buffer = GPUDevice.prototype.createBuffer;
      GPUDevice.prototype.createBuffer = function (descriptor) {
        if (["tile", "roads"].includes(descriptor.label)) window.uploaded += descriptor.size;
        return buffer.call(this, descriptor);
      };
      const texture = GPUQueue.prototype.writeTexture;
      GPUQueue.prototype.writeTexture = function (to, data, layout, size) {
        window.uploaded += layout.bytesPerRow * (size.height ?? size[1]);
        return texture.call(this, to, data, layout, size);
      };
    };
    const page = await openMap(browser, server, { memory: String(memory), controls: "none" }, { ...size, before: countUploads });
    const reports = await lookAround(page, [...PLACES, ...PLACES], 400);
    assert.ok(reports.length > 100, `${reports.length} reports`);
    const most = Math.max(...reports.map(({ gpu_bytes: [used] }) => used));
    const uploaded = await page.evaluate(() => window.uploaded);
    console.log(`# at most ${(most / MIB).toFixed(2)} MiB of ${memory}, ${(uploaded / MIB).toFixed(1)} MiB uploaded on the way`);
    for (const { gpu_bytes } of reports) assert.deepEqual(gpu_bytes[1], memory * MIB);
    assert.ok(most <= memory * MIB, `${most} bytes of tiles`);
    // Some of it had to be evicted.
    assert.ok(uploaded > memory * MIB, `only ${uploaded} bytes were uploaded: the memory was never full`);
    await settled(page);
    checkFaults(page);
    await page.end();
  });

  test("tiles that are out of view are not waited for: their requests are stopped", async () => {
    server.behave();
    const page = await openMap(browser, server, { controls: "none", inertia: "off" }, { width: 500, height: 400 });
    server.behave();
    // So slow that no tile is loaded before the map moves elsewhere.
    Object.assign(server.state, { delay_ms: 50, bytes_per_ms: 15 });
    const isStopped = () => server.state.requests.some((request) => request.isStopped);
    const reports = [];
    for (let turn = 0; turn < 8 && !isStopped(); turn += 1) {
      reports.push(...(await lookAround(page, [turn % 2 === 0 ? [0.3, 0.2] : [0.7, 0.8]], 100)));
      // Frames are slow here: the map must have requested the visible tiles, and then others.
      await page.waitForFunction(() => document.querySelector("corniche-map").report.tiles.loading > 0);
      await page.waitForTimeout(300);
    }
    const stopped = server.state.requests.filter((request) => request.isStopped).length;
    const asked = server.state.requests.length;
    console.log(`# ${stopped} of ${asked} requests were stopped`);
    assert.ok(stopped > 0, `none of ${asked} requests was stopped`);
    assert.ok(Math.max(...reports.map(({ tiles }) => tiles.loading)) <= 12, "tiles under way");
    // Wanted tiles are still loaded.
    Object.assign(server.state, { delay_ms: 0, bytes_per_ms: 0 });
    await settled(page);
    const report = await ask(page, (map) => map.report);
    assert.deepEqual([report.tiles.missing, report.notices], [0, []]);
    checkFaults(page);
    await page.end();
    server.behave();
  });

  test("what was read is not asked for again", async () => {
    server.behave();
    const page = await openMap(browser, server, { controls: "none" }, { width: 500, height: 400 });
    await lookAround(page, PLACES.slice(3, 9), 0);
    await settled(page);
    // With the other method all tiles are decoded again, from the cached bytes.
    for (const roads of ["geo", "sv"]) {
      await ask(
        page,
        (map, roads) => {
          map.roads = roads;
        },
        roads,
      );
      for (const place of PLACES.slice(3, 9)) {
        await lookAround(page, [place], 0);
        await settled(page);
      }
    }
    const ranges = server.state.requests
      .filter(({ range, isStopped }) => range && !isStopped)
      .map(({ range }) => range.slice("bytes=".length).split("-").map(Number))
      .sort(([a], [b]) => a - b);
    assert.ok(ranges.length > 6, `${ranges.length} ranges`);
    // A request may be cancelled when its answer is already on its way, and the bytes between
    // neighbours are fetched with them: a little is fetched twice.
    const all = ranges.reduce((sum, [first, last]) => sum + last - first + 1, 0);
    const twice = ranges.slice(1).reduce((sum, [first], place) => sum + Math.max(0, ranges[place][1] - first + 1), 0);
    console.log(`# ${twice} of ${all} bytes were asked for twice`);
    assert.ok(twice < 0.3 * all, `${twice} of ${all} bytes were asked for twice`);
    await page.end();
  });
}
