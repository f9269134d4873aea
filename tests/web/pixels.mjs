// Pixels of the page are those of the native program on the same driver: of `render` where a view
// was asked for, and of a flight's frames after a flight. (A view that was asked for has its haze
// by the distance to the place looked at; once it moves, by the height of the eye, as flights do.)
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ask, openMap, pixelsOf, settled } from "./browser.mjs";
import { difference, flown, hasDriver, rendered } from "./rendering.mjs";
import { someOf } from "./tier.mjs";

const SIZE = { width: 640, height: 400 };
/**
 * Bytes of a picture that may differ by one step. All that is handed to the graphics device is the same there; the browser has another compiler of shaders than the
 * program.
 */
const MOST_BYTES = { swellendam: 1, portland: 1 };
/** Packages with a comparison of all views; others have the first view and one in perspective. */
const isWhole = (name) => name === "pass" || process.env.CORNICHE_ALL_VIEWS === "1";
/** Cameras in perspective: a position as a fraction of the package's extent, and distance, heading and pitch. */
const VIEW = { share: [0.52, 0.55], distance: 4000, heading: 30, pitch: 60 };

export function tests({ browser, server, packages, corniche }) {
  const names = fs
    .readdirSync(packages)
    .filter((name) => name.endsWith(".pmtiles"))
    .map((name) => name.slice(0, -".pmtiles".length))
    .sort();
  const skip = hasDriver() ? false : "Chromium's Vulkan driver is not where it is with Debian: set CHROMIUM_DRIVER";
  const fileOf = (name) => path.join(packages, `${name}.pmtiles`);

  function check(what, picture, native, most = 0) {
    assert.deepEqual([picture.width, picture.height], [native.width, native.height]);
    const { compared, bytes, steps } = difference(picture, native);
    console.log(`# ${what}: ${bytes} of ${4 * compared} bytes differ`);
    assert.ok(bytes <= most && steps <= most, `${what}: ${bytes} bytes differ, by up to ${steps} of 255`);
  }

  /** From above, at the distance at which the whole package is visible, or half of it. */
  async function checkFromAbove(page, name, what, options, pixels) {
    const [west, south, east, north] = await ask(page, (map) => map.about.bounds);
    const [lon, lat] = [(west + east) / 2, (south + north) / 2];
    const pixel_m = +(((north - south) * 111_000) / pixels).toFixed(2);
    await ask(page, (map, place) => map.lookAt(place, { jump: true }), { lon, lat, above: true, pixel_m, heading: 20 });
    await settled(page);
    const picture = await pixelsOf(page);
    const size = `${picture.width}x${picture.height}`;
    check(
      what,
      picture,
      rendered(corniche, fileOf(name), [
        "--size",
        size,
        "--ortho",
        "--look-at",
        `${lon},${lat}`,
        "--pixel",
        `${pixel_m}`,
        "--heading",
        "20",
        ...options,
      ]),
    );
  }

  // In CI, one of the real packages per day.
  const real = names.filter((name) => name !== "pass");
  for (const name of ["pass", ...someOf(real, real.length)]) {
    for (const roads of ["geo", "sv"]) {
      test(`${name}, ${roads}: pixels equal those of the native program`, { skip }, async () => {
        server.behave();
        const page = await openMap(browser, server, { src: `/packages/${name}.pmtiles`, controls: "none", roads, samples: "2" }, SIZE);
        const size = ["--size", `${SIZE.width}x${SIZE.height}`, "--roads", roads];
        check(`${name} ${roads}, first view`, await pixelsOf(page), rendered(corniche, fileOf(name), size), MOST_BYTES[name]);
        if (isWhole(name)) {
          await checkFromAbove(page, name, `${name} ${roads}, whole, from above`, ["--roads", roads], 300);
          await checkFromAbove(page, name, `${name} ${roads}, near, from above`, ["--roads", roads], 2000);
        }
        const [west, south, east, north] = await ask(page, (map) => map.about.bounds);
        const {
          share: [u, v],
          ...view
        } = VIEW;
        const place = { lon: west + (east - west) * u, lat: south + (north - south) * v, ...view };
        await ask(page, (map, place) => map.lookAt(place, { jump: true }), place);
        await settled(page);
        const there = [
          "--look-at",
          `${place.lon},${place.lat}`,
          "--distance",
          `${view.distance}`,
          "--heading",
          `${view.heading}`,
          "--pitch",
          `${view.pitch}`,
        ];
        check(`${name} ${roads}, a place in perspective`, await pixelsOf(page), rendered(corniche, fileOf(name), [...size, ...there]), MOST_BYTES[name]);
        if (!isWhole(name)) return page.end();
        // After a flight that ends at rest.
        const recorded = await ask(page, async (map) => {
          map.startRecording();
          await new Promise((done) => setTimeout(done, 100));
          return map.stopRecording();
        });
        await ask(page, (map) => map.command("reset"));
        await settled(page);
        await ask(page, (map, flight) => map.play(flight), recorded);
        await page.waitForFunction(() => !document.querySelector("corniche-map").report.is_playing);
        await settled(page);
        check(
          `${name} ${roads}, in perspective, after a flight`,
          await pixelsOf(page),
          flown(corniche, fileOf(name), recorded, [...size, "--supersampling", "2"]),
        );
        await page.end();
      });
    }
  }

  test("after resizing, and at two pixels a point, pixels equal those of the native program", { skip }, async () => {
    server.behave();
    const page = await openMap(
      browser,
      server,
      { controls: "none", samples: "1" },
      { width: 500, height: 500, size: { width: "300px", height: "200px" }, deviceScaleFactor: 2 },
    );
    const sizeOf = () =>
      ask(page, async (map) => {
        const { width, height } = await map.readPixels();
        return [width, height];
      });
    assert.deepEqual(await sizeOf(), [600, 400]);
    const options = ["--roads", "geo", "--supersampling", "1"];
    await checkFromAbove(page, "pass", "two pixels a point", options, 900);
    await ask(page, async (map) => {
      Object.assign(map.style, { width: "401px", height: "250px" });
      await new Promise((done) => setTimeout(done, 300));
    });
    await settled(page);
    assert.deepEqual(await sizeOf(), [802, 500]);
    await checkFromAbove(page, "pass", "after resizing", options, 1200);
    await page.end();
  });
}
