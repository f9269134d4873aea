// Links contain manual changes; removed attributes have no further effect.
import assert from "node:assert/strict";
import { test } from "node:test";
import { addMap, ask, checkFaults, openMap, openPage, settled } from "./browser.mjs";

const VIEW = "9.51,46.91,4000,10,50";
const SIZE = { width: 1280, height: 800 };
const CLIPBOARD = { ...SIZE, permissions: ["clipboard-read", "clipboard-write"] };

/** A page that is opened with a fragment, and its map. */
async function opened(browser, server, fragment, attributes = {}, options = SIZE) {
  const page = await openPage(browser, server, `/blank.html${fragment}`, options);
  const { ready } = await addMap(page, { src: "/packages/pass.pmtiles", samples: "1", hash: "", ...attributes }, { height: `${options.height}px` });
  assert.ok(ready, "the map did not open");
  await settled(page);
  return page;
}

const settings = (page) => ask(page, (map) => map.settings);
const hashEnds = (page, end) => page.waitForFunction((end) => location.hash.endsWith(end), end);
const copied = async (page) => {
  await page.locator("corniche-map canvas").focus();
  await page.keyboard.press("v");
  await page.locator("corniche-map .notice").filter({ hasText: "copied" }).waitFor();
  return page.evaluate(() => navigator.clipboard.readText());
};

export function tests({ browser, server }) {
  test("a copied link shows what was changed by hand, and is short where nothing was", async () => {
    server.behave();
    // Settings of the page are not manual changes.
    const attributes = { "look-at": VIEW, exaggeration: "1.5", outline: "none" };
    const page = await opened(browser, server, "", attributes, CLIPBOARD);
    await ask(page, (map) => {
      map.settings = { error_px: 3 };
    });
    const short = await copied(page);
    assert.ok(short.endsWith(`/blank.html#${VIEW}`), short);
    const panel = page.locator("corniche-map .panel");
    await panel.getByRole("radio", { name: "SV", exact: true }).check();
    await panel.locator(".legend input").nth(3).uncheck();
    await panel.locator("select").first().selectOption("dark");
    const heights = panel.locator(".slider").filter({ hasText: "Heights" }).locator("input");
    await heights.evaluate((input) => {
      input.value = "2";
      input.dispatchEvent(new Event("input"));
    });
    await page.waitForTimeout(50);
    const link = await copied(page);
    // If the exaggeration is higher, the camera rises with the ground.
    assert.match(link, /#9\.5\d+,46\.9\d+,[34]\d{3},10,50;roads=sv;map-style=dark;exaggeration=2;classes=0,1,2,4,5,6,7,8$/);
    await hashEnds(page, link.slice(link.indexOf(";")));
    const before = await settings(page);
    await page.end();
    const other = await opened(browser, server, new URL(link).hash, attributes, CLIPBOARD);
    assert.deepEqual(await settings(other), { ...before, error_px: 2 });
    const there = await ask(other, (map) => map.camera);
    const [lon, lat] = new URL(link).hash.slice(1).split(",").map(Number);
    assert.ok(Math.abs(there.lon - lon) < 1e-5 && Math.abs(there.lat - lat) < 1e-5, `${JSON.stringify(there)} ${link}`);
    assert.equal(await other.locator("corniche-map .notice.warn").count(), 0);
    assert.equal(new URL(await copied(other)).hash.split(";", 2)[1], "roads=sv", "and it is passed on");
    checkFaults(other);
    await other.end();
  });

  test("a link that is followed in the page shows what it says, and the address stays with the map", async () => {
    const page = await opened(browser, server, `#${VIEW};roads=sv;layers=none`);
    assert.deepEqual([(await settings(page)).roads, (await settings(page)).layers], ["sv", []]);
    await page.evaluate((view) => {
      location.hash = `#${view};compare=split;divider=0.3`;
    }, VIEW.replace("4000", "3000"));
    await page.waitForFunction(() => document.querySelector("corniche-map").settings.compare === "split");
    await settled(page);
    const { roads, layers, divider } = await settings(page);
    assert.deepEqual([roads, layers, +divider.toFixed(3)], ["geo", null, 0.3]);
    assert.ok(Math.abs((await ask(page, (map) => map.camera)).distance - 3000) < 30);
    await page.keyboard.press("Tab");
    await ask(page, (map) => map.lookAt({ lon: 9.515, lat: 46.905 }, { jump: true }));
    await hashEnds(page, ",50;compare=split;divider=0.3");
    // A position alone is not a change of settings.
    await page.evaluate((view) => {
      location.hash = `#${view}`;
    }, VIEW);
    await page.waitForFunction(() => Math.abs(document.querySelector("corniche-map").camera.lon - 9.51) < 1e-4);
    assert.equal((await settings(page)).compare, "split");
    checkFaults(page);
    await page.end();
  });

  test("bad parts of a link are left out and told in two lines; the others are shown", async () => {
    const size = { width: 360, height: 600 };
    for (const [part, shown] of [
      ["roads=both;layers=none", "roads=both"],
      ["neon=1;layers=none;exaggeration=-3", "neon=1 and 1 more"],
      [`layers=none;map-style=https://elsewhere.example/a.toml`, "map-style=https://e…"],
      [`layers=none;classes=77;widths=0:1e9;roads=${"x".repeat(3000)}`, "classes=77 and 2 more"],
      [`%E0%A4%A=%;layers=none;${"<img src=x onerror=alert(1)>"}`, null],
    ]) {
      const page = await opened(browser, server, `#${VIEW};${part}`, {}, size);
      assert.deepEqual((await settings(page)).layers, [], part);
      const notice = page.locator("corniche-map .notice.warn span");
      assert.equal(await notice.count(), 1, part);
      const text = await notice.textContent();
      assert.match(text, /^Skipped in the link: /);
      if (shown) assert.equal(text, `Skipped in the link: ${shown}${shown.endsWith("…") ? "" : "."}`);
      const lines = await notice.evaluate((span) => {
        const style = getComputedStyle(span);
        return Math.round((span.clientHeight - 2 * parseFloat(style.paddingTop)) / parseFloat(style.lineHeight));
      });
      assert.ok(lines <= 2, `${lines} lines: ${text}`);
      checkFaults(page);
      await page.end();
    }
  });

  test("maps of one page keep their changes apart", async () => {
    const page = await openPage(browser, server, `/blank.html#a=${VIEW};roads=sv&chapter-2&b=${VIEW};map-style=dark`, SIZE);
    for (const hash of ["a", "b"]) await addMap(page, { src: "/packages/pass.pmtiles", samples: "1", hash }, { height: "300px" });
    const seen = await page.evaluate(() => [...document.querySelectorAll("corniche-map")].map((map) => [map.settings.roads, map.settings.style]));
    assert.deepEqual(seen, [
      ["sv", "road-atlas"],
      ["geo", "dark"],
    ]);
    await page.evaluate(() => document.querySelector("corniche-map").lookAt({ lon: 9.515, lat: 46.905 }, { jump: true }));
    await page.waitForFunction(() => /a=9\.515,/.test(location.hash));
    const parts = (await page.evaluate(() => location.hash)).slice(1).split("&").sort();
    assert.equal(parts.length, 3, String(parts));
    assert.match(parts[0], /^a=9\.515,46\.905,[^;]*;roads=sv$/);
    // While terrain is loaded, the centre moves by decimetres.
    const [, lon, lat] = parts[1].match(/^b=([\d.]+),([\d.]+),[^;]*;map-style=dark$/) ?? assert.fail(parts[1]);
    assert.ok(Math.hypot(lon - 9.51, lat - 46.91) < 1e-4, parts[1]);
    assert.equal(parts[2], "chapter-2");
    checkFaults(page);
    await page.end();
  });

  test("a link shows what was changed, also on a map that stands in the page's own text", async () => {
    server.behave();
    const map = `<corniche-map src="/packages/pass.pmtiles" roads="geo" map-style="relief" samples="1" exaggeration="1.5" hash style="height: 400px"></corniche-map>`;
    const text = `<!doctype html><html lang="en"><title>A map</title><main>${map}</main><script type="module" src="/corniche-map.js"></script></html>`;
    server.state.replaced.set("/text.html", { bytes: Buffer.from(text), type: "text/html" });
    const page = await openPage(browser, server, `/text.html#${VIEW};roads=sv;map-style=dark`, SIZE);
    await page.waitForFunction(() => document.querySelector("corniche-map")?.about);
    await settled(page);
    const { roads, style, exaggeration } = await settings(page);
    assert.deepEqual([roads, style, exaggeration], ["sv", "dark", 1.5]);
    checkFaults(page);
    await page.end();
    server.behave();
  });

  test("an attribute that is taken away leaves the usual value", async () => {
    const attributes = { roads: "sv", "map-style": "dark", exaggeration: "2", classes: "x", photo: "0.2", samples: "3", inertia: "off" };
    const page = await openMap(browser, server, attributes, { width: 400, height: 300 });
    const usual = { roads: "geo", style: "road-atlas", exaggeration: 1, photo: null, samples: 2, inertia: true };
    const before = await settings(page);
    for (const [setting, value] of Object.entries(usual)) assert.notDeepEqual(before[setting], value, setting);
    for (const name of Object.keys(attributes)) await ask(page, (map, name) => map.removeAttribute(name), name);
    const after = await settings(page);
    for (const [setting, value] of Object.entries(usual)) assert.deepEqual(after[setting], value, setting);
    await page.end();
    // While the map is opening.
    const early = await openPage(browser, server, "/blank.html", { width: 400, height: 300 });
    const roads = await early.evaluate(async () => {
      const map = document.createElement("corniche-map");
      for (const [name, value] of Object.entries({ src: "/packages/pass.pmtiles", samples: "1", roads: "sv", layers: "none" })) map.setAttribute(name, value);
      document.querySelector("main").append(map);
      await new Promise((done) => setTimeout(done, 20));
      map.removeAttribute("roads");
      await new Promise((done) => map.addEventListener("ready", done, { once: true }));
      return [map.settings.roads, map.settings.layers];
    });
    assert.deepEqual(roads, ["geo", []]);
    checkFaults(early);
    await early.end();
  });
}
