// All functions are available with the keyboard.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, checkFaults, openMap, settled } from "./browser.mjs";

const camera = (page) => ask(page, (map) => map.camera);
const focused = (page) =>
  ask(page, (map) => {
    const element = map.shadowRoot.activeElement;
    return element
      ? `${element.tagName.toLowerCase()} ${element.getAttribute("aria-label") ?? element.textContent.trim() ?? ""}`.trim()
      : "";
  });

export function tests({ browser, server }) {
  test("keys move, turn, tilt and zoom the map", async () => {
    server.behave();
    const page = await openMap(browser, server, { "look-at": "9.51,46.91,4000,0,50", inertia: "off" });
    await page.locator("corniche-map canvas").focus();
    const press = async (key) => {
      const before = await camera(page);
      await page.keyboard.press(key);
      await page.waitForTimeout(50);
      await settled(page);
      return [before, await camera(page)];
    };
    let [before, after] = await press("ArrowRight");
    assert.ok(after.lon > before.lon + 1e-4, "to the right");
    [before, after] = await press("ArrowUp");
    assert.ok(after.lat > before.lat + 1e-4, "ahead");
    [before, after] = await press("+");
    assert.ok(after.distance < 0.8 * before.distance, "nearer");
    [before, after] = await press("-");
    assert.ok(after.distance > 1.2 * before.distance, "farther");
    [before, after] = await press("Shift+ArrowRight");
    assert.ok(Math.abs(after.heading - before.heading) > 5, "turned");
    [before, after] = await press("Shift+ArrowUp");
    assert.ok(Math.abs(after.pitch - before.pitch) > 3, "tilted");
    [before, after] = await press("n");
    assert.ok(Math.abs(after.heading) < 0.1, "north up");
    [before, after] = await press("t");
    assert.equal(after.above, true, "from above");
    [before, after] = await press("t");
    assert.ok(!after.above, "back");
    await page.keyboard.press("f");
    await page.waitForFunction(() => document.querySelector("corniche-map").report.mode === "fly");
    before = await camera(page);
    await page.keyboard.down("w");
    await page.waitForTimeout(500);
    await page.keyboard.up("w");
    await page.waitForTimeout(200);
    after = await ask(page, (map) => map.report.view);
    assert.notDeepEqual(after, before, "flown");
    await page.keyboard.press("f");
    [, after] = await press("r");
    assert.ok(Math.abs(after.lon - 9.51) < 1e-3, "the first view");
    checkFaults(page);
    await page.end();
  });

  test("Tab reaches every control, Escape closes, and Tab leaves the map", async () => {
    const page = await openMap(browser, server, { hash: "" }, { width: 1280, height: 800 });
    await page.evaluate(() => {
      const end = document.createElement("button");
      end.id = "after";
      end.textContent = "after the map";
      document.querySelector("main").append(end);
      document.body.tabIndex = -1;
      document.body.focus();
    });
    const seen = [];
    for (let step = 0; step < 80; step += 1) {
      await page.keyboard.press("Tab");
      if (await page.evaluate(() => document.activeElement.id === "after")) break;
      seen.push(await focused(page));
      const isVisible = await ask(page, (map) => {
        const element = map.shadowRoot.activeElement;
        return element.matches(":focus-visible");
      });
      assert.ok(isVisible, `${seen.at(-1)} shows that it has the focus`);
    }
    assert.ok(await page.evaluate(() => document.activeElement.id === "after"), "Tab leaves the map");
    for (const name of [
      /^canvas Map/,
      /Panel/,
      /North up/,
      /Zoom in/,
      /Zoom out/,
      /Mouse, touch and keys/,
      /Go to/,
      /Fly/,
      /From above/,
      /First view/,
      /Copy link/,
      /Save image/,
      /Record flight/,
      /Play flight/,
      /Hide the panel/,
      /summary Advanced/,
    ]) {
      assert.ok(
        seen.some((one) => name.test(one)),
        `${name} is not reached: ${seen.join("; ")}`,
      );
    }
    await page.locator("corniche-map canvas").focus();
    await page.keyboard.press("?");
    assert.ok(await page.locator("corniche-map dialog").isVisible());
    await page.keyboard.press("Escape");
    assert.ok(!(await page.locator("corniche-map dialog").isVisible()));
    assert.match(await focused(page), /^canvas/, "the focus is back");
    await page.keyboard.press("m");
    assert.ok(!(await page.locator("corniche-map .panel").isVisible()));
    await page.keyboard.press("m");
    await page.locator("corniche-map .panel summary").first().focus();
    await page.keyboard.press("Escape");
    assert.ok(!(await page.locator("corniche-map .panel").isVisible()));
    assert.match(await focused(page), /Panel/);
    await page.end();
  });

  test("Enter asks for the road in the middle; the card says what it is", async () => {
    const page = await openMap(browser, server, {}, { width: 800, height: 600 });
    // The way nearest to the centre is moved there. The picked way may be some pixels off, which
    // are fewer metres the closer the camera is.
    let road = null;
    for (const distance of [6000, 2500, 1200, 600, 600]) {
      road = await ask(
        page,
        async (map, way) => {
          for (let round = 0; round < 280; round += 7) {
            for (let turn = 0; turn < Math.max(1, round / 3); turn += 1) {
              const angle = (turn * 6 * Math.PI) / Math.max(1, round);
              const found = await map.pick(400 + round * Math.cos(angle), 300 + round * Math.sin(angle));
              if (found?.road && (way === null || found.road.way === way) && Object.keys(found.road.attributes).length > 0) return found;
            }
          }
          return null;
        },
        road?.road.way ?? null,
      );
      assert.ok(road, "there is a road");
      await ask(page, (map, place) => map.lookAt(place, { jump: true }), { lon: road.lon, lat: road.lat, distance, pitch: 10 });
      await settled(page);
    }
    const picked = ask(
      page,
      (map) => new Promise((resolve) => map.addEventListener("pick", (event) => resolve(event.detail), { once: true })),
    );
    await page.locator("corniche-map canvas").focus();
    await page.keyboard.press("Enter");
    const { road: found } = await picked;
    assert.equal(found?.way, road.road.way);
    const card = page.locator("corniche-map .place-card");
    await card.waitFor({ state: "visible" });
    assert.match(await card.textContent(), new RegExp(`${found.way}`));
    assert.match(await card.textContent(), /° N, .*° E/);
    await page.keyboard.press("Escape");
    assert.ok(!(await card.isVisible()));
    // A page may show the panel itself.
    await ask(page, (map) => map.addEventListener("pick", (event) => event.preventDefault()));
    await page.keyboard.press("Enter");
    await page.waitForTimeout(500);
    assert.ok(!(await card.isVisible()));
    checkFaults(page);
    await page.end();
  });

  test("go to takes a place and says what is wrong with a text that is none", async () => {
    const page = await openMap(browser, server, { inertia: "off" }, { width: 1280, height: 800 });
    const field = page.locator("corniche-map .go-to input");
    await field.fill("somewhere");
    await field.press("Enter");
    assert.ok((await page.locator("corniche-map .wrong").textContent()).length > 5);
    assert.equal(await field.getAttribute("aria-invalid"), "true");
    await field.fill("9.52, 46.90");
    await field.press("Enter");
    assert.equal(await field.getAttribute("aria-invalid"), "false");
    await page.waitForFunction(() => Math.abs(document.querySelector("corniche-map").camera.lon - 9.52) < 1e-3);
    await page.end();
  });
}
