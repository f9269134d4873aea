// Images of the page for human inspection, on desktop and phone, in both colour schemes.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ask, openPage, settled } from "./browser.mjs";
import { someOf } from "./tier.mjs";

const SCREENS = [
  ["desktop", { width: 1280, height: 800 }],
  ["phone", { width: 390, height: 844, hasTouch: true, isMobile: true, deviceScaleFactor: 2 }],
];

export function tests({ browser, server, packages, pictures }) {
  const name = fs.existsSync(path.join(packages, "liechtenstein.pmtiles")) ? "liechtenstein" : "pass";
  const all = SCREENS.flatMap((screen) => ["light", "dark"].map((colorScheme) => [screen, colorScheme]));
  for (const [[screen, options], colorScheme] of someOf(all, 4)) {
    test(`pictures: ${screen}, ${colorScheme}`, async () => {
      server.behave();
      const where = name === "liechtenstein" ? "#9.521,47.141,5000,60,62" : "#9.51,46.91,4000,30,60";
      const page = await openPage(browser, server, `/index.html?src=packages/${name}.pmtiles${where}`, { ...options, colorScheme });
      const take = (what) => page.screenshot({ path: path.join(pictures, `${screen}-${what}-${colorScheme}.png`) });
      await page.waitForFunction(() => document.querySelector("corniche-map").about !== null, null, { timeout: 60_000 });
      await settled(page);
      await take("map");
      const click = (label) => ask(page, (map, label) => map.shadowRoot.querySelector(`[aria-label="${label}"]`).click(), label);
      if (screen === "phone") {
        await click("Panel");
        await take("panel");
        await click("Panel");
      } else {
        await ask(page, (map) =>
          map.shadowRoot.querySelectorAll("details").forEach((details, k) => {
            details.open = k === 2 || k === 3;
          }),
        );
        await take("panel");
        await ask(page, (map) =>
          map.shadowRoot.querySelectorAll("details").forEach((details, k) => {
            details.open = k < 3;
          }),
        );
      }
      await ask(page, async (map) => {
        const { clientWidth, clientHeight } = map;
        for (let y = clientHeight * 0.4; y < clientHeight * 0.9; y += 7) {
          for (let x = clientWidth * 0.3; x < clientWidth * 0.6; x += 7) {
            const found = await map.pick(x, y);
            if (!found?.road?.attributes.name) continue;
            const canvas = map.shadowRoot.querySelector("canvas");
            for (const type of ["pointerdown", "pointerup"])
              canvas.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, button: 0, pointerId: 1, bubbles: true }));
            return;
          }
        }
      }).catch(() => {});
      await page.waitForTimeout(400);
      await take("road");
      await ask(page, (map) => {
        map.settings = { compare: "split" };
      });
      await settled(page);
      await take("split");
      await page.keyboard.press("Escape");
      await click("Mouse, touch and keys");
      await take("help");
      assert.equal(page.faults.foreign.length, 0);
      await page.end();
    });
  }

  test("pictures: chooser and examples", async () => {
    server.state.replaced.set("/packages.json", {
      bytes: Buffer.from(`[{"name":"Liechtenstein","src":"packages/${name}.pmtiles"},{"name":"A pass","src":"packages/pass.pmtiles"}]`),
      type: "application/json",
    });
    for (const [screen, options] of SCREENS) {
      const page = await openPage(browser, server, "/index.html", options);
      await page.getByText("Choose a map").waitFor();
      await page.screenshot({ path: path.join(pictures, `${screen}-chooser.png`) });
      await page.end();
    }
    for (const example of someOf(["two-maps", "events", "attributes", "article", "maplibre"], 5)) {
      const page = await openPage(browser, server, `/examples/${example}.html`, { width: 1000, height: 800 });
      await page.waitForFunction(() => [...document.querySelectorAll("corniche-map")].every((map) => map.report?.is_settled), null, {
        timeout: 60_000,
      });
      await page.screenshot({ path: path.join(pictures, `example-${example}.png`) });
      await page.end();
    }
    server.behave();
  });
}
