// A map opens, describes itself, and draws.
import assert from "node:assert/strict";
import { test } from "node:test";
import { addMap, ask, checkFaults, checkWorkersEnd, openMap, openPage, pixelsOf, settled } from "./browser.mjs";
import { colours } from "./rendering.mjs";

export function tests({ browser, server }) {
  test("a map opens, is ready, and shows ground and roads", async () => {
    server.behave();
    const page = await openMap(browser, server, { controls: "none" });
    const about = await ask(page, (map) => map.about);
    assert.equal(about.name, "pass");
    assert.match(about.attribution.join(), /OpenStreetMap/);
    assert.ok(about.classes.length >= 8 && about.classes.every(({ color }) => /^#[0-9a-f]{6}$/.test(color)));
    assert.ok(about.is_software);
    const picture = await pixelsOf(page);
    assert.deepEqual([picture.width, picture.height], [800, 600]);
    assert.ok(colours(picture) > 100, `only ${colours(picture)} colours: is the canvas blank?`);
    // The displayed pixels are the rendered ones: the canvas itself is not blank.
    const shot = await page.locator("corniche-map").screenshot();
    assert.ok(shot.length > 20_000, `a screenshot of ${shot.length} bytes has no map`);
    const credit = page.locator("corniche-map .credit");
    assert.match(await credit.textContent(), /OpenStreetMap contributors/);
    assert.ok(await credit.isVisible(), "credits are shown on bare maps too");
    const report = await ask(page, (map) => map.report);
    assert.ok(report.is_settled && report.next === "asked" && report.tiles.drawn > 0, JSON.stringify(report));
    checkFaults(page);
    await page.end();
  });

  test("at rest no frames are drawn", async () => {
    const page = await openMap(browser, server, {});
    const frames = await ask(page, async (map) => {
      const asked = [];
      const native = window.requestAnimationFrame;
      window.requestAnimationFrame = (call) => {
        asked.push(call);
        return native(call);
      };
      await new Promise((done) => setTimeout(done, 1000));
      return asked.length;
    });
    assert.equal(frames, 0);
    await page.end();
  });

  test("look-at, settings and the hash set the first view", async () => {
    const page = await openMap(browser, server, {
      "look-at": "9.51,46.91,4000,45,50",
      roads: "sv",
      "map-style": "dark",
      exaggeration: "1.5",
      hash: "",
    });
    const { camera, settings } = await ask(page, (map) => ({ camera: map.camera, settings: map.settings }));
    assert.ok(Math.abs(camera.lon - 9.51) < 1e-4 && Math.abs(camera.lat - 46.91) < 1e-4, JSON.stringify(camera));
    assert.ok(
      Math.abs(camera.distance - 4000) < 40 && Math.abs(camera.heading - 45) < 0.1 && Math.abs(camera.pitch - 50) < 0.1,
      JSON.stringify(camera),
    );
    assert.deepEqual([settings.roads, settings.style, settings.exaggeration, settings.samples], ["sv", "dark", 1.5, 1]);
    // With these heights a slope may hide the next point.
    await ask(page, (map) => {
      map.exaggeration = 1;
    });
    // A change of the hash moves the map, and a move changes the hash.
    await page.evaluate(() => {
      location.hash = "#9.5,46.92,3000,10,40";
    });
    await page.waitForFunction(() => Math.abs(document.querySelector("corniche-map").camera.distance - 3000) < 30);
    await ask(page, (map) => map.lookAt({ lon: 9.52, lat: 46.9, distance: 2500 }, { jump: true }));
    await page.waitForFunction(() => location.hash.startsWith("#9.52,"));
    const hash = await page.evaluate(() => location.hash);
    const [lon, lat, distance, heading, pitch] = hash.slice(1).split(",").map(Number);
    assert.ok(Math.abs(lon - 9.52) < 1e-4 && Math.abs(lat - 46.9) < 1e-4 && Math.abs(distance - 2500) < 25, hash);
    assert.ok(Math.abs(heading - 10) < 0.2 && Math.abs(pitch - 40) < 0.2, `${hash}: what a place leaves out stays`);
    await page.end();
    // The page opens at the position in the hash.
    const again = await openPage(browser, server, `/blank.html${hash}`);
    await addMap(again, { src: "/packages/pass.pmtiles", samples: "1", hash: "" });
    await settled(again);
    const camera2 = await ask(again, (map) => map.camera);
    assert.ok(Math.abs(camera2.lon - lon) < 1e-4 && Math.abs(camera2.distance - distance) < 25, JSON.stringify(camera2));
    await again.end();
  });

  test("attributes, properties and settings change the picture, and wrong ones are refused", async () => {
    const page = await openMap(browser, server, { controls: "none" }, { width: 400, height: 300 });
    const first = await pixelsOf(page);
    const differs = async (what) => {
      await settled(page);
      const now = await pixelsOf(page);
      const isOther = !now.data.equals(first.data);
      assert.ok(isOther, `${what} changes nothing`);
    };
    await ask(page, (map) => {
      map.setAttribute("map-style", "dark");
    });
    await differs("map-style");
    await ask(page, (map) => {
      map.mapStyle = "road-atlas";
      map.roads = "none";
    });
    await differs("roads");
    await ask(page, (map) => {
      map.roads = "geo";
      map.settings = { classes: map.settings.classes.map((_, k) => k > 3) };
    });
    await differs("classes");
    await ask(page, (map) => {
      map.settings = { classes: map.settings.classes.map(() => true) };
    });
    await settled(page);
    assert.ok((await pixelsOf(page)).data.equals(first.data), "with the first settings, the first picture");
    const error = await ask(page, (map) => {
      try {
        map.settings = { style: "no-such" };
        return "";
      } catch (error) {
        return `${error.name}: ${error.message}`;
      }
    });
    assert.match(error, /RangeError.*no-such/);
    checkFaults(page);
    await page.end();
  });

  test("a map that is taken out of the page lets everything go, and opens again when it is put back", async () => {
    const page = await openMap(browser, server, {}, { width: 400, height: 300 });
    assert.ok(page.workers().length >= 2, `${page.workers().length} workers`);
    await page.evaluate(() => {
      window.kept = document.querySelector("corniche-map");
      window.kept.remove();
    });
    await page.waitForFunction(() => window.kept.about === null);
    await checkWorkersEnd(page);
    await page.evaluate(
      () =>
        new Promise((ready) => {
          window.kept.addEventListener("ready", ready, { once: true });
          document.querySelector("main").append(window.kept);
        }),
    );
    await settled(page);
    assert.ok(colours(await pixelsOf(page)) > 100);
    checkFaults(page);
    await page.end();
  });

  test("another src opens another package, and the first one in a hurry does no harm", async () => {
    const page = await openPage(browser, server, "/blank.html", { width: 400, height: 300 });
    const opened = await page.evaluate(
      () =>
        new Promise((resolve) => {
          const map = document.createElement("corniche-map");
          document.querySelector("main").append(map);
          map.addEventListener("ready", (event) => resolve(event.detail.src), { once: true });
          map.src = "/as/missing/pass.pmtiles";
          setTimeout(() => {
            map.src = "/packages/pass.pmtiles";
          }, 0);
        }),
    );
    assert.match(opened, /packages\/pass/);
    assert.equal(await page.locator("corniche-map [role=alert]").count(), 0);
    checkFaults(page);
    await page.end();
  });
}
