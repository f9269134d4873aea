// The canvas has the size of the element in device pixels, whatever happens to it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, checkFaults, openMap, openPage, addMap, pixelsOf, settled } from "./browser.mjs";
import { colours } from "./rendering.mjs";

const sizeOf = (page) =>
  ask(page, (map) => {
    const { width, height } = map.shadowRoot.querySelector("canvas");
    return [width, height];
  });

export function tests({ browser, server }) {
  test("the canvas follows the element", async () => {
    server.behave();
    const page = await openMap(browser, server, { controls: "none" }, { size: { width: "300px", height: "200px" } });
    assert.deepEqual(await sizeOf(page), [300, 200]);
    for (const [width, height] of [
      [417, 233],
      [120, 500],
      [640, 90],
    ]) {
      await ask(page, (map, [width, height]) => Object.assign(map.style, { width: `${width}px`, height: `${Math.max(height, 160)}px` }), [
        width,
        height,
      ]);
      await page.waitForTimeout(150);
      await settled(page);
      assert.deepEqual(await sizeOf(page), [width, Math.max(height, 160)]);
      assert.ok(colours(await pixelsOf(page)) > 20);
    }
    checkFaults(page);
    await page.end();
  });

  test("two pixels a point make a canvas of twice the size", async () => {
    const page = await openMap(browser, server, { controls: "none" }, { size: { width: "301px", height: "200px" }, deviceScaleFactor: 2 });
    assert.deepEqual(await sizeOf(page), [602, 400]);
    await page.end();
  });

  test("a map in a part of the page that is not shown opens once it is", async () => {
    const page = await openPage(browser, server, "/blank.html", { width: 400, height: 300 });
    await page.evaluate(() => {
      document.querySelector("main").style.display = "none";
    });
    const opened = addMap(page, { src: "/packages/pass.pmtiles", samples: "1" }, { height: "300px" });
    await page.waitForTimeout(400);
    assert.equal(await ask(page, (map) => map.about), null);
    await page.evaluate(() => {
      document.querySelector("main").style.display = "block";
    });
    assert.ok((await opened).ready);
    // Hidden again: nothing is drawn, and nothing fails.
    await page.evaluate(() => {
      document.querySelector("main").style.display = "none";
    });
    await page.waitForTimeout(300);
    await page.evaluate(() => {
      document.querySelector("main").style.display = "block";
    });
    await settled(page);
    assert.ok(colours(await pixelsOf(page)) > 20);
    checkFaults(page);
    await page.end();
  });
}
