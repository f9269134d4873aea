// Pixels of the page are those of `corniche render` on the same driver.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ask, openMap, pixelsOf, settled } from "./browser.mjs";
import { difference, hasDriver, rendered } from "./rendering.mjs";

const SIZE = [640, 400];
const VIEWS = { pass: [9.51, 46.91, 4000, 30, 60], liechtenstein: [9.521, 47.141, 5000, 60, 65] };
const usual = [9, 46, 5000, 0, 60];

export function tests({ browser, server, packages, corniche }) {
  const names = fs.readdirSync(packages).filter((name) => name.endsWith(".pmtiles")).map((name) => name.slice(0, -".pmtiles".length)).sort();
  const skip = hasDriver() ? false : "Chromium's Vulkan driver is not where it is with Debian: set CHROMIUM_DRIVER";

  function compare(name, picture, options, what) {
    const size = `${picture.width}x${picture.height}`;
    const native = rendered(corniche, path.join(packages, `${name}.pmtiles`), ["--size", size, ...options]);
    assert.deepEqual([picture.width, picture.height], [native.width, native.height]);
    const { compared, bytes } = difference(picture, native);
    console.log(`# ${what}: ${bytes} of ${4 * compared} bytes differ`);
    assert.equal(bytes, 0, `${what}: bytes that differ from render`);
  }

  for (const name of names) {
    for (const roads of ["geo", "sv"]) {
      test(`${name}, ${roads}: the whole package and a view equal render`, { skip }, async () => {
        server.behave();
        const page = await openMap(browser, server, { src: `/packages/${name}.pmtiles`, controls: "none", roads, samples: "2" }, { width: SIZE[0], height: SIZE[1] });
        compare(name, await pixelsOf(page), ["--roads", roads], `${name} ${roads} whole`);
        const [lon, lat, distance, heading, pitch] = VIEWS[name] ?? usual;
        if (VIEWS[name]) {
          // Opened there: a view that is reached by moving may have other tiles and is compared below.
          const near = await openMap(browser, server, { src: `/packages/${name}.pmtiles`, controls: "none", roads, samples: "2", "look-at": [lon, lat, distance, heading, pitch].join() }, { width: SIZE[0], height: SIZE[1] });
          compare(name, await pixelsOf(near), ["--roads", roads, "--look-at", `${lon},${lat}`, "--distance", `${distance}`, "--heading", `${heading}`, "--pitch", `${pitch}`], `${name} ${roads} near`);
          await near.end();
        }
        await page.end();
      });
    }
  }

  test("after a flight to a place, the picture is that of render", { skip }, async () => {
    const page = await openMap(browser, server, { controls: "none", samples: "1" }, { width: SIZE[0], height: SIZE[1] });
    const [lon, lat, distance, heading, pitch] = VIEWS.pass;
    await ask(page, (map, place) => map.lookAt(place), { lon, lat, distance, heading, pitch });
    await settled(page);
    // Where the flight ends, the ground may be known more coarsely than `render` knows it: the place is looked at again.
    await ask(page, (map, place) => map.lookAt(place, { jump: true }), { lon, lat, distance, heading, pitch });
    await settled(page);
    const options = ["--roads", "geo", "--supersampling", "1", "--look-at", `${lon},${lat}`, "--distance", `${distance}`, "--heading", `${heading}`, "--pitch", `${pitch}`];
    compare("pass", await pixelsOf(page), options, "after a flight");
    await page.end();
  });

  test("after resizing, and at two pixels a point, the picture is that of render", { skip }, async () => {
    const page = await openMap(browser, server, { controls: "none", samples: "1" }, { width: 500, height: 500, size: { width: "300px", height: "200px" }, deviceScaleFactor: 2 });
    const first = await pixelsOf(page);
    assert.deepEqual([first.width, first.height], [600, 400]);
    compare("pass", first, ["--roads", "geo", "--supersampling", "1"], "two pixels a point");
    await ask(page, async (map) => {
      map.style.width = "400px";
      map.style.height = "250px";
      await new Promise((done) => setTimeout(done, 300));
      map.command("reset");
    });
    await settled(page);
    const { camera, size } = await ask(page, async (map) => ({ camera: map.camera, size: [(await map.readPixels()).width, (await map.readPixels()).height] }));
    assert.deepEqual(size, [800, 500]);
    await ask(page, (map, place) => map.lookAt(place, { jump: true }), camera);
    await settled(page);
    const { lon, lat, height, distance, heading, pitch } = await ask(page, (map) => map.camera);
    const options = ["--roads", "geo", "--supersampling", "1", "--look-at", `${lon},${lat}`, "--distance", `${distance}`, "--heading", `${heading}`, "--pitch", `${pitch}`];
    compare("pass", await pixelsOf(page), height === undefined ? options : [...options, "--height", `${height}`], "after resizing");
    await page.end();
  });
}
