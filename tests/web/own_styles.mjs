// Custom styles: TOML files next to the page, read by a module that is loaded only for them.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, test } from "node:test";
import { ask, checkFaults, openMap, pixelsOf, settled } from "./browser.mjs";
import { difference, hasDriver, rendered } from "./rendering.mjs";

/** A style that differs from all presets: the roads of the sample are wide and green. */
const MINE = (sources) =>
  fs
    .readFileSync(path.join(sources, "../../../config/styles/dark.toml"), "utf8")
    .replace(/^outline_px = .*$/m, "outline_px = 2")
    .replace(/^color = .*$/gm, 'color = "#1db954"')
    .replace(/^width_m = .*$/gm, "width_m = 30.0");
const READER = ["/style_reader.js", "/corniche_web_styles_bg.wasm"];
const SIZE = { width: 640, height: 400 };

export function tests({ browser, server, packages, sources, corniche, pictures }) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "corniche-"));
  after(() => fs.rmSync(folder, { recursive: true }));
  const mine = MINE(sources);
  const file = path.join(folder, "mine.toml");
  fs.writeFileSync(file, mine);

  const toml = (text) => ({ bytes: Buffer.from(text), type: "application/toml" });
  const lay = () => {
    server.behave();
    server.state.replaced.set("/styles/mine.toml", toml(mine));
  };
  const asked = (name) => server.state.requests.filter(({ path }) => path === name).length;
  const warned = (page) => page.locator("corniche-map .notice.warn");
  const style = (page) => ask(page, (map) => [map.settings.style, map.mapStyle]);

  test("an own style: pixels equal those of render --style", { skip: hasDriver() ? false : "without Chromium's Vulkan driver" }, async () => {
    lay();
    const native = rendered(corniche, path.join(packages, "pass.pmtiles"), ["--size", "640x400", "--roads", "geo", "--style", file]);
    const usual = rendered(corniche, path.join(packages, "pass.pmtiles"), ["--size", "640x400", "--roads", "geo"]);
    assert.ok(difference(usual, native).bytes > 10_000, "the style is another one");
    const check = async (page, what) => {
      await settled(page);
      assert.equal(difference(await pixelsOf(page), native).bytes, 0, what);
      assert.deepEqual(await style(page), ["styles/mine.toml", "styles/mine.toml"]);
      checkFaults(page);
    };
    const early = await openMap(browser, server, { "map-style": "styles/mine.toml", controls: "none", samples: "2" }, SIZE);
    await check(early, "from the beginning");
    await early.end();
    const late = await openMap(browser, server, { controls: "none", samples: "2" }, SIZE);
    for (const name of READER) assert.equal(asked(name), 1, `${name} is fetched with the first own style alone`);
    await ask(late, (map) => {
      map.settings = { style: "styles/mine.toml" };
    });
    await check(late, "by settings");
    for (const name of READER) assert.equal(asked(name), 2);
    await ask(late, (map) => {
      map.mapStyle = "dark";
      map.mapStyle = "styles/mine.toml";
      map.mapStyle = "relief";
    });
    await settled(late);
    assert.deepEqual(await style(late), ["relief", "relief"], "the last one counts");
    await ask(late, (map) => {
      map.mapStyle = "styles/mine.toml";
    });
    await check(late, "by the property");
    for (const name of READER) assert.equal(asked(name), 2, `${name} is fetched once for a page`);
    await late.end();
  });

  test("without an own style, nothing that reads one is fetched", async () => {
    lay();
    const page = await openMap(browser, server, { "map-style": "dark" }, SIZE);
    await ask(page, (map) => {
      map.mapStyle = "relief";
    });
    await settled(page);
    for (const name of READER) assert.equal(asked(name), 0, name);
    await page.end();
  });

  for (const [what, answer, told] of [
    ["is not there", { bytes: null, status: 404 }, /^Style bad\.toml: the server answers 404/i],
    ["is a page", { bytes: Buffer.from("<!doctype html>"), type: "text/html" }, /^Style bad\.toml: line 1: /i],
    ["has an unknown entry", toml(`neon = true\n${mine}`), /bad\.toml: line 1: unknown field `neon`/i],
    ["has a number out of range", toml(mine.replace("outline_px = 2", "outline_px = 9")), /bad\.toml: outline_px of 9 is out of range; it must be 0 to 4/i],
    ["is too long", toml(`${mine}\n#${" ".repeat(1 << 21)}`), /^Style bad\.toml: it is longer than 1048576 bytes/i],
    ["is no text", { bytes: Buffer.from([0x61, 0xff, 0xfe]), type: "application/toml" }, /bad\.toml: it is not UTF-8 text/i],
  ]) {
    test(`an own style that ${what} is told, and the one before stays`, async () => {
      lay();
      server.state.replaced.set("/styles/bad.toml", answer);
      const page = await openMap(browser, server, { "map-style": "dark" }, { width: 360, height: 500 });
      await ask(page, (map) => {
        map.mapStyle = "styles/bad.toml";
      });
      await warned(page).waitFor();
      assert.match(await warned(page).textContent(), told);
      const lines = await warned(page)
        .locator("span")
        .evaluate((span) => Math.round((span.clientHeight - 2 * parseFloat(getComputedStyle(span).paddingTop)) / parseFloat(getComputedStyle(span).lineHeight)));
      assert.ok(lines <= 2, `${lines} lines`);
      await page.screenshot({ path: path.join(pictures, `own-style-that-${what.replace(/\W+/g, "-")}.png`) });
      await settled(page);
      assert.equal((await style(page))[0], "dark");
      assert.deepEqual(page.faults.errors, []);
      await page.end();
      server.behave();
    });
  }

  test("a map opens in the usual style where its own one cannot be read", async () => {
    lay();
    for (const [name, answer] of [
      ["/styles/mine.toml", toml("no style")],
      ["/style_reader.js", { bytes: null, status: 404 }],
      ["/corniche_web_styles_bg.wasm", { bytes: null, status: 404 }],
    ]) {
      lay();
      server.state.replaced.set(name, answer);
      const page = await openMap(browser, server, { "map-style": "styles/mine.toml", hash: "" }, { width: 360, height: 500 });
      assert.match(await warned(page).textContent(), /^Style mine\.toml: (line 1: .|(style_reader\.js|corniche_web_styles_bg\.wasm) of corniche-map is missing)/);
      assert.equal((await style(page))[0], "road-atlas");
      assert.deepEqual(page.faults.errors, []);
      await page.end();
    }
    server.behave();
  });

  test("the panel names an own style by its file, and one can go back to it", async () => {
    lay();
    const page = await openMap(browser, server, { "map-style": "styles/mine.toml", hash: "" }, { width: 1280, height: 800 });
    const select = page.locator("corniche-map .panel .field").filter({ hasText: "Style" }).locator("select").first();
    assert.equal(await select.inputValue(), "styles/mine.toml");
    assert.match(await select.locator("option:checked").textContent(), /^mine\.toml$/);
    await select.selectOption("dark");
    await page.waitForFunction(() => location.hash.endsWith(";map-style=dark"));
    await select.selectOption("styles/mine.toml");
    await page.waitForFunction(() => location.hash !== "" && !location.hash.includes("map-style"));
    assert.equal((await style(page))[0], "styles/mine.toml");
    assert.equal(asked("/styles/mine.toml"), 1, "it is kept");
    checkFaults(page);
    await page.end();
  });
}
