// axe-core finds no serious accessibility violation, in both colour schemes, on desktop and phone.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { test } from "node:test";
import { ask, openMap, openPage, addMap } from "./browser.mjs";
import { FAILURES } from "./failing.mjs";

const AXE = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

async function checkPage(page, what) {
  await page.addScriptTag({ path: AXE });
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    const { violations, passes } = await page.evaluate(() => window.axe.run());
    const told = violations
      .filter(({ impact }) => impact === "serious" || impact === "critical")
      .map(
        ({ id, nodes }) => `${id}: ${nodes.map(({ target, failureSummary }) => `${target.flat().join(" ")} ${failureSummary}`).join("; ")}`,
      );
    assert.deepEqual(told, [], `${what}, ${colorScheme}`);
    assert.ok(passes.length > 10, "axe looked at the page");
  }
}

export function tests({ browser, server }) {
  for (const [name, options] of [
    ["desktop", { width: 1280, height: 800 }],
    ["phone", { width: 390, height: 844, hasTouch: true, isMobile: true }],
  ]) {
    test(`axe-core finds nothing serious: ${name}`, async () => {
      server.behave();
      const page = await openMap(browser, server, { hash: "", label: "Map of a pass" }, options);
      await ask(page, (map) => {
        const { shadowRoot } = map;
        if (shadowRoot.querySelector(".panel").hidden) shadowRoot.querySelector("[aria-label=Panel]").click();
        for (const details of shadowRoot.querySelectorAll("details")) details.open = true;
      });
      await checkPage(page, "with the panel open");
      await ask(page, (map) => {
        map.settings = { compare: "split" };
        map.shadowRoot.querySelector("[aria-label='Hide the panel']").click();
      });
      await checkPage(page, "with the divider, without the panel");
      // A place with ground, which the card describes.
      await ask(page, async (map) => {
        map.lookAt({ lon: 9.51, lat: 46.91, distance: 4000, heading: 30, pitch: 60 }, { jump: true });
        await map.settled();
      });
      await page.locator("corniche-map canvas").focus();
      await page.keyboard.press("Enter");
      await page.locator("corniche-map .place-card").waitFor({ state: "visible" });
      await checkPage(page, "with the card");
      await page.keyboard.press("?");
      await checkPage(page, "with the dialog");
      await page.end();
    });
  }

  test("axe-core finds nothing serious: a failure, the chooser", async () => {
    const page = await openPage(browser, server, "/blank.html", { before: FAILURES[0].before });
    await addMap(page, { src: "/packages/pass.pmtiles" });
    await checkPage(page, "a failure");
    await page.end();
    const chooser = await openPage(browser, server, "/index.html");
    await chooser.getByText("There is no map next to this page").waitFor();
    await checkPage(chooser, "the chooser");
    await chooser.end();
  });

  test("on a phone everything that is touched is 44 points high", async () => {
    const page = await openMap(browser, server, { hash: "" }, { width: 360, height: 740, hasTouch: true, isMobile: true });
    const small = await ask(page, (map) => {
      const { shadowRoot } = map;
      if (shadowRoot.querySelector(".panel").hidden) shadowRoot.querySelector("[aria-label=Panel]").click();
      for (const details of shadowRoot.querySelectorAll("details")) details.open = true;
      return [...shadowRoot.querySelectorAll("button, select, summary, input[type=text], input[type=range], label.check, .row span")]
        .filter((one) => {
          const box = one.getBoundingClientRect();
          return box.height > 0 && box.height < 40;
        })
        .map((one) => `${one.className || one.tagName} ${one.textContent.slice(0, 20)} ${one.getBoundingClientRect().height}`);
    });
    assert.deepEqual(small, []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `the page is ${wide} points wide`);
    await page.end();
  });
}
