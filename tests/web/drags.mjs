// Drags with mouse and fingers keep the grabbed ground point under the pointer.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, checkFaults, openMap, settled, touches } from "./browser.mjs";

const METRES_PER_DEGREE = 111_320;
/** The largest distance between the ground points before and after, pixels. */
const MOST_PX = 0.5;
const VIEW = { "look-at": "9.51,46.91,4000,30,55" };

const pickAt = (page, [x, y]) => ask(page, (map, at) => map.pick(...at), [x, y]);

function metres(a, b) {
  const east = (b.lon - a.lon) * METRES_PER_DEGREE * Math.cos((a.lat * Math.PI) / 180);
  return Math.hypot(east, (b.lat - a.lat) * METRES_PER_DEGREE, b.height - a.height);
}

/** The distance in pixels between a position and the one at [x, y], measured relative to the nearer neighbouring pixel. */
async function pixelsApart(page, [x, y], ground) {
  const here = await pickAt(page, [x, y]);
  assert.ok(here, "there is ground where the pointer is");
  const beside = [await pickAt(page, [x + 1, y]), await pickAt(page, [x, y + 1])].filter(Boolean);
  const pixel_m = Math.min(...beside.map((place) => metres(here, place)));
  return metres(here, ground) / pixel_m;
}

async function checkKept(page, what, at, ground) {
  await settled(page);
  const apart = await pixelsApart(page, at, ground);
  console.log(`# ${what}: ${apart.toFixed(4)} px`);
  assert.ok(apart <= MOST_PX, `${what}: the ground is ${apart.toFixed(3)} pixels away`);
}

/** A map without inertia: the map stops after a drag, so that positions can be compared. */
const still = (browser, server, more = {}, options = {}) =>
  openMap(browser, server, { ...VIEW, inertia: "off", controls: "none", ...more }, options);

export function tests({ browser, server }) {
  test("a left drag keeps the ground under the pointer", async () => {
    server.behave();
    const page = await still(browser, server);
    for (const [from, to] of [
      [
        [400, 380],
        [250, 300],
      ],
      [
        [300, 300],
        [520, 450],
      ],
    ]) {
      const ground = await pickAt(page, from);
      const before = await ask(page, (map) => map.camera);
      await page.mouse.move(...from);
      await page.mouse.down();
      await page.mouse.move(...to, { steps: 6 });
      await checkKept(page, `left drag ${from} to ${to}`, to, ground);
      await page.mouse.up();
      const after = await ask(page, (map) => map.camera);
      assert.ok(Math.abs(after.lon - before.lon) + Math.abs(after.lat - before.lat) > 1e-4, "the map moved");
    }
    checkFaults(page);
    await page.end();
  });

  test("right drags turn about the middle, middle drags about the ground under the pointer", async () => {
    const page = await still(browser, server);
    const middle = [400, 300];
    const ground = await pickAt(page, middle);
    const before = await ask(page, (map) => map.camera);
    await page.mouse.move(500, 350);
    await page.mouse.down({ button: "right" });
    await page.mouse.move(560, 340, { steps: 5 });
    await page.mouse.up({ button: "right" });
    await checkKept(page, "right drag", middle, ground);
    const after = await ask(page, (map) => map.camera);
    assert.ok(Math.abs(after.heading - before.heading) > 5, "the map turned");
    const grabbed = [300, 400];
    const under = await pickAt(page, grabbed);
    await page.mouse.move(...grabbed);
    await page.mouse.down({ button: "middle" });
    await page.mouse.move(340, 390, { steps: 5 });
    await page.mouse.up({ button: "middle" });
    await checkKept(page, "middle drag", grabbed, under);
    await page.end();
  });

  test("the wheel and a double click zoom at the pointer", async () => {
    const page = await still(browser, server);
    const at = [300, 380];
    const ground = await pickAt(page, at);
    const before = await ask(page, (map) => map.camera);
    await page.mouse.move(...at);
    for (let notch = 0; notch < 3; notch += 1) await page.mouse.wheel(0, -100);
    await checkKept(page, "wheel in", at, ground);
    const near = await ask(page, (map) => map.camera);
    assert.ok(near.distance < 0.65 * before.distance, `${near.distance} of ${before.distance}`);
    await page.mouse.dblclick(...at);
    await checkKept(page, "double click", at, ground);
    assert.ok((await ask(page, (map) => map.camera)).distance < 0.7 * near.distance);
    await page.end();
  });

  test("with two pixels a point a drag keeps the ground, too", async () => {
    const page = await still(browser, server, {}, { width: 400, height: 300, deviceScaleFactor: 2 });
    const ground = await pickAt(page, [200, 200]);
    await page.mouse.move(200, 200);
    await page.mouse.down();
    await page.mouse.move(130, 150, { steps: 5 });
    await checkKept(page, "left drag at two pixels a point", [130, 150], ground);
    await page.mouse.up();
    await page.end();
  });

  test("one finger keeps the ground under it", async () => {
    const page = await still(browser, server, {}, { hasTouch: true });
    const finger = await touches(page);
    const ground = await pickAt(page, [400, 400]);
    await finger.down([400, 400]);
    for (let step = 1; step <= 6; step += 1) await finger.move([400 - 20 * step, 400 - 12 * step]);
    await checkKept(page, "one finger", [280, 328], ground);
    await finger.up();
    await page.end();
  });

  test("two fingers pinch and turn, and the ground between them stays", async () => {
    const page = await still(browser, server, { "look-at": "9.51,46.91,4000,30,20" }, { hasTouch: true });
    const finger = await touches(page);
    const places = [
      [300, 300],
      [500, 300],
    ];
    const middle = [400, 300];
    const ground = await pickAt(page, middle);
    const before = await ask(page, (map) => map.camera);
    await finger.down(places[0]);
    await finger.down(...places);
    let now = places;
    for (let step = 1; step <= 8; step += 1) {
      now = [
        [300 - 5 * step, 300 + 3 * step],
        [500 + 5 * step, 300 - 3 * step],
      ];
      await finger.move(...now);
    }
    await checkKept(page, "between two fingers", middle, ground);
    const after = await ask(page, (map) => map.camera);
    await finger.up();
    assert.ok(after.distance < 0.9 * before.distance, "the map zoomed");
    assert.ok(Math.abs(after.heading - before.heading) > 3, "the map turned");
    // Without fingers there is no tap.
    assert.equal(await page.locator("corniche-map .place-card:visible").count(), 0);
    checkFaults(page);
    await page.end();
  });

  test("two fingers that go up and down together tilt the map", async () => {
    const page = await still(browser, server, {}, { hasTouch: true });
    const finger = await touches(page);
    const before = await ask(page, (map) => map.camera);
    await finger.down([350, 300]);
    await finger.down([350, 300], [450, 300]);
    for (let step = 1; step <= 8; step += 1) await finger.move([350, 300 + 6 * step], [450, 300 + 6 * step]);
    await settled(page);
    const after = await ask(page, (map) => map.camera);
    assert.ok(Math.abs(after.pitch - before.pitch) > 5, `${before.pitch} to ${after.pitch}`);
    // The remaining finger pans when it moves.
    await finger.left([350, 348]);
    for (let step = 1; step <= 5; step += 1) await finger.move([350 + 12 * step, 348]);
    await settled(page);
    const panned = await ask(page, (map) => map.camera);
    assert.ok(Math.abs(panned.lon - after.lon) + Math.abs(panned.lat - after.lat) > 1e-4, "panned");
    await finger.up();
    await page.end();
  });

  test("a double tap zooms in, even where the second tap is some points away", async () => {
    const page = await still(browser, server, {}, { hasTouch: true });
    const finger = await touches(page);
    const before = await ask(page, (map) => map.camera);
    for (const at of [
      [400, 350],
      [412, 358],
    ]) {
      await finger.down(at);
      await finger.up();
      await page.waitForTimeout(60);
    }
    await settled(page);
    const after = await ask(page, (map) => map.camera);
    assert.ok(after.distance < 0.7 * before.distance, `${after.distance} of ${before.distance}`);
    await page.end();
  });
}
