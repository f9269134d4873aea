// Failures are described in words in place of the map: there is never a blank canvas or a panic.
import assert from "node:assert/strict";
import path from "node:path";
import { test } from "node:test";
import { rendered, colours } from "./rendering.mjs";
import { addMap, ask, checkWorkersEnd, openMap, openPage, pixelsOf, settled } from "./browser.mjs";
import { FAILURES, LATER, keepDevices } from "./failing.mjs";
import { PNG } from "pngjs";

/** A page with a map that fails like this. */
async function failing(browser, server, other, failure, options = {}) {
  server.behave();
  server.state.policy = failure.policy ?? "";
  for (const [name, what] of Object.entries(failure.replaced ?? {})) server.state.replaced.set(name, what);
  const page = await openPage(browser, server, "/blank.html", { width: 700, height: 500, before: failure.before, ...options });
  const opened = await addMap(
    page,
    { src: failure.src.replace("OTHER", other.origin), samples: "1", ...failure.attributes },
    { height: `${options.height ?? 500}px` },
  );
  return { page, opened };
}

/** Images of a failure on desktop and phone, in both colour schemes. */
async function takeAll(page, pictures, name) {
  const before = page.viewportSize();
  for (const [screen, size] of [
    ["desktop", before],
    ["phone", { width: 360, height: 640 }],
  ]) {
    await page.setViewportSize(size);
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      await page.screenshot({ path: path.join(pictures, `failure-${name.replace(/\W+/g, "-")}-${screen}-${colorScheme}.png`) });
    }
  }
  await page.setViewportSize(before);
}

export function tests({ browser, server, other, packages, corniche, pictures }) {
  for (const failure of FAILURES) {
    test(`told in words: ${failure.name}`, async () => {
      const { page, opened } = await failing(browser, server, other, failure);
      assert.ok(opened.error, "it must not open");
      assert.ok([failure.kind].flat().includes(opened.error.kind), `${opened.error.kind}: ${opened.error.message}`);
      const alert = page.locator("corniche-map [role=alert]");
      assert.ok(await alert.isVisible());
      const said = await alert.textContent();
      const isSaid = (text) => said.toLowerCase().includes(text.toLowerCase());
      assert.ok(isSaid(opened.error.message) && opened.error.message.length > 15, said);
      assert.ok(isSaid(opened.error.advice) && opened.error.advice.length > 10, `advice: ${opened.error.advice}`);
      assert.doesNotMatch(said, /undefined|\[object|panicked|unreachable|RuntimeError/, said);
      assert.ok(await page.locator("corniche-map").getByRole("button", { name: "Try again" }).isVisible());
      await checkWorkersEnd(page);
      assert.deepEqual(page.faults.errors, []);
      const panics = page.faults.console.filter((text) => /panicked/.test(text));
      assert.deepEqual(panics, []);
      await takeAll(page, pictures, failure.name);
      await page.end();
      server.behave();
    });
  }

  for (const failure of LATER) {
    test(`told in words after the beginning: ${failure.name}`, async () => {
      const { page, opened } = await failing(browser, server, other, failure);
      assert.ok(opened.ready, JSON.stringify(opened.error));
      const told = page.locator(failure.stays ? "corniche-map .notice.warn" : "corniche-map [role=alert]").first();
      await told.waitFor();
      assert.match(await told.textContent(), failure.says);
      if (failure.stays) assert.ok(colours(await pixelsOf(page)) > 100, "the coarse map is gone");
      assert.deepEqual(page.faults.errors, []);
      await takeAll(page, pictures, failure.name);
      await page.end();
    });
  }

  test("a failure that is gone: Try again opens the map", async () => {
    const failure = FAILURES.find(({ name }) => name === "no module");
    const { page } = await failing(browser, server, other, failure);
    server.behave();
    await page.locator("corniche-map").getByRole("button", { name: "Try again" }).click();
    await page.waitForFunction(() => document.querySelector("corniche-map").about !== null);
    await settled(page);
    assert.ok(colours(await pixelsOf(page)) > 100);
    await page.end();
  });

  test("without WebGPU, a picture beside the package is shown, with its credit", async () => {
    const failure = FAILURES[0];
    const png = rendered(corniche, path.join(packages, "pass.pmtiles"), ["--size", "700x500"]);
    const replaced = { "/packages/pass.png": { bytes: PNG.sync.write(png), type: "image/png" } };
    for (const [attributes, address] of [
      [{}, "/packages/pass.png"],
      [{ still: "/still.png" }, "/still.png"],
    ]) {
      const { page, opened } = await failing(browser, server, other, {
        ...failure,
        attributes,
        replaced: { ...replaced, "/still.png": replaced["/packages/pass.png"] },
      });
      assert.equal(opened.error.kind, "no-webgpu");
      await page.locator("corniche-map img.still").waitFor({ state: "visible" });
      assert.ok((await page.locator("corniche-map img.still").getAttribute("src")).endsWith(address));
      assert.match(await page.locator("corniche-map .still-credit").textContent(), /OpenStreetMap contributors/);
      assert.ok(await page.locator("corniche-map .still-credit").isVisible());
      await takeAll(page, pictures, "no WebGPU with a picture");
      await page.end();
    }
    server.behave();
  });

  test("a device that is lost is replaced, and the map is where it was", async () => {
    server.behave();
    const page = await openMap(
      browser,
      server,
      { "look-at": "9.51,46.91,4000,30,50", "map-style": "dark" },
      { width: 500, height: 400, before: keepDevices },
    );
    await ask(page, (map) => map.lookAt({ lon: 9.52, lat: 46.9, distance: 2500 }, { jump: true }));
    await settled(page);
    const before = await ask(page, (map) => map.camera);
    const again = ask(page, (map) => new Promise((resolve) => map.addEventListener("ready", () => resolve(true), { once: true })));
    await page.evaluate(() => {
      window.devices.at(-1).destroy();
    });
    await page.locator("corniche-map .notice").filter({ hasText: "device was lost" }).waitFor();
    assert.ok(await again);
    await settled(page);
    const after = await ask(page, (map) => map.camera);
    for (const part of ["lon", "lat"])
      assert.ok(Math.abs(after[part] - before[part]) < 1e-3, `${JSON.stringify(after)} ${JSON.stringify(before)}`);
    assert.equal(await ask(page, (map) => map.settings.style), "dark");
    assert.ok(colours(await pixelsOf(page)) > 50);
    // If the device is lost repeatedly, the element gives up with a message.
    for (let loss = 0; loss < 3; loss += 1) {
      const next = ask(
        page,
        (map) =>
          new Promise((resolve) => {
            map.addEventListener("ready", () => resolve("ready"), { once: true });
            map.addEventListener("error", (event) => resolve(event.detail.kind), { once: true });
          }),
      );
      await page.evaluate(() => {
        window.devices.at(-1).destroy();
      });
      const what = await next;
      if (what !== "ready") {
        assert.equal(what, "device-lost");
        assert.equal(loss, 2);
      }
      await page.waitForTimeout(200);
    }
    assert.ok(await page.locator("corniche-map [role=alert]").isVisible());
    await takeAll(page, pictures, "device lost");
    await page.end();
  });

  test("full graphics memory is told", async () => {
    server.behave();
    const page = await openMap(browser, server, {}, { width: 500, height: 400, before: keepDevices });
    const failed = ask(
      page,
      (map) => new Promise((resolve) => map.addEventListener("error", (event) => resolve(event.detail), { once: true })),
    );
    await page.evaluate(() => {
      const event = new GPUUncapturedErrorEvent("uncapturederror", { error: new GPUOutOfMemoryError("no memory for a buffer") });
      window.devices.at(-1).dispatchEvent(event);
    });
    const { kind, message } = await failed;
    assert.equal(kind, "out-of-memory", message);
    await takeAll(page, pictures, "out of memory");
    await page.end();
  });

  test("a host that fails later is told in a notice, once for all tiles", async () => {
    server.behave();
    const page = await openMap(browser, server, { "look-at": "9.51,46.91,9000,30,50" }, { width: 500, height: 400 });
    server.state.replaced.set("/packages/pass.pmtiles", { bytes: null, status: 404 });
    await ask(page, (map) => map.lookAt({ lon: 9.53, lat: 46.93, distance: 700 }, { jump: true }));
    await page.locator("corniche-map .notice.warn").first().waitFor({ timeout: 20_000 });
    assert.match(await page.locator("corniche-map .notice.warn").first().textContent(), /no such file|404/);
    await page.waitForTimeout(1500);
    assert.ok((await page.locator("corniche-map .notice.warn").count()) <= 2, "not one for each tile");
    await takeAll(page, pictures, "later");
    await page.end();
    server.behave();
  });

  test("a road that cannot be fetched is told in words, not taken for no road", async () => {
    server.behave();
    const page = await openMap(browser, server, { "look-at": "9.51,46.91,9000,30,50" }, { width: 500, height: 400 });
    await settled(page);
    server.state.replaced.set("/packages/pass.pmtiles", { bytes: null, status: 404 });
    // Somewhere in the view is a tile whose SV roads were skipped; they are requested when a road
    // is picked.
    const failed = await ask(page, async (map) => {
      for (let y = 50; y < 400; y += 50) {
        for (let x = 50; x < 500; x += 50) {
          try {
            await map.pick(x, y);
          } catch (error) {
            return { at: [x, y], kind: error.kind };
          }
        }
      }
      return null;
    });
    assert.equal(failed?.kind, "not-found");
    assert.equal(await page.locator("corniche-map .notice.warn").count(), 0);
    await page.locator("corniche-map canvas").click({ position: { x: failed.at[0], y: failed.at[1] } });
    await page.locator("corniche-map .notice.warn").first().waitFor();
    assert.match(await page.locator("corniche-map .notice.warn").first().textContent(), /no such file|404/);
    await page.end();
    server.behave();
  });
}
