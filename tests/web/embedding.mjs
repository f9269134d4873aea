// Several maps on a page, pages of the site, images, flights, and the types.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import zlib from "node:zlib";
import { PNG } from "pngjs";
import { addMap, ask, checkFaults, openMap, openPage, settled } from "./browser.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const ready = (page, count = 1) =>
  page.waitForFunction(
    (count) => {
      const maps = [...document.querySelectorAll("corniche-map")];
      return maps.length >= count && maps.every((map) => map.report?.is_settled);
    },
    count,
    { timeout: 120_000 },
  );

export function tests({ browser, server, other, site, sources, package: file }) {
  test("two maps of a page have nothing in common but the program", async () => {
    server.behave();
    const page = await openPage(browser, server, "/blank.html", { width: 800, height: 500 });
    await addMap(page, { src: "/packages/pass.pmtiles", samples: "1", hash: "a", "map-style": "dark" }, { height: "240px" });
    await addMap(page, { src: "/packages/pass.pmtiles", samples: "1", hash: "b", roads: "sv" }, { height: "240px" });
    await ready(page, 2);
    await page.evaluate(async () => {
      const [a, b] = document.querySelectorAll("corniche-map");
      for (const [map, distance] of [
        [a, 3000],
        [b, 5000],
      ])
        map.lookAt({ lon: 9.51, lat: 46.91, distance }, { jump: true });
    });
    await page.waitForFunction(() => /a=9\.51,.*b=9\.51,/.test(location.hash));
    const [hash, settings] = await page.evaluate(() => [
      location.hash,
      [...document.querySelectorAll("corniche-map")].map((map) => [map.settings.style, map.settings.roads]),
    ]);
    assert.match(hash, /a=9\.51,46\.91\d*,30\d\d,.*&b=9\.51,46\.91\d*,50\d\d,/);
    assert.deepEqual(settings, [
      ["dark", "geo"],
      ["road-atlas", "sv"],
    ]);
    assert.equal(server.state.requests.filter(({ path }) => path.endsWith(".wasm")).length, 1, "the module is fetched once");
    assert.deepEqual(await page.evaluate(() => Object.keys(window).filter((name) => /corniche/i.test(name))), [], "nothing global");
    checkFaults(page);
    await page.end();
  });

  test("the viewer's page takes ?src=, the only package, or lets one choose", async () => {
    const page = await openPage(browser, server, "/index.html?src=packages/pass.pmtiles", { width: 600, height: 400 });
    await ready(page);
    assert.match(await page.title(), /pass/);
    checkFaults(page);
    server.state.replaced.set("/packages.json", {
      bytes: Buffer.from('[{"name":"Pass","src":"packages/pass.pmtiles"}]'),
      type: "application/json",
    });
    await page.goto(`${server.origin}/`);
    await ready(page);
    assert.match(await page.title(), /Pass/);
    server.state.replaced.set("/packages.json", {
      bytes: Buffer.from('[{"name":"Pass","src":"packages/pass.pmtiles","layers":"none"},{"name":"Other","src":"packages/other.pmtiles"}]'),
      type: "application/json",
    });
    await page.goto(`${server.origin}/`);
    await page.getByRole("link", { name: "Pass" }).click();
    await ready(page);
    assert.deepEqual(await ask(page, (map) => map.settings.layers), [], "the layers of the list are shown at first");
    server.state.replaced.set("/packages.json", { bytes: null });
    await page.goto(`${server.origin}/`);
    await page.getByText("There is no map next to this page").waitFor();
    checkFaults(page);
    server.behave();
    await page.end();
  });

  test("a file of this computer is opened", async () => {
    const page = await openPage(browser, server, "/index.html", { width: 600, height: 400 });
    server.state.requests = [];
    await page.locator("#file").setInputFiles(file);
    await ready(page);
    assert.equal(await ask(page, (map) => map.about.name), "pass");
    assert.ok(
      server.state.requests.every(({ path }) => !path.endsWith(".pmtiles")),
      "the file goes nowhere",
    );
    checkFaults(page);
    await page.end();
  });

  test("a package of another host that allows it is shown", async () => {
    other.behave();
    const page = await openPage(browser, server, "/blank.html", { width: 400, height: 300 });
    const opened = await addMap(page, { src: `${other.origin}/packages/pass.pmtiles`, samples: "1" });
    assert.ok(opened.ready, JSON.stringify(opened));
    assert.ok(
      page.faults.foreign.every((address) => address === `${other.origin}/packages/pass.pmtiles`),
      "and nothing else is asked for",
    );
    await page.end();
  });

  test("the element works from another host, workers too", async () => {
    other.behave();
    server.state.replaced.set("/foreign.html", {
      bytes: Buffer.from(
        `<!doctype html><link rel="icon" href="data:,"><main></main><script type="module" src="${other.origin}/corniche-map.js"></script>`,
      ),
      type: "text/html",
    });
    const foreign = await openPage(browser, server, "/foreign.html", { width: 400, height: 300 });
    const opened = await addMap(foreign, { src: `${server.origin}/packages/pass.pmtiles`, samples: "1" });
    assert.ok(opened.ready, JSON.stringify(opened));
    await settled(foreign);
    assert.deepEqual(foreign.faults.errors, []);
    server.behave();
    await foreign.end();
  });

  test("a strict security policy is enough", async () => {
    server.state.policy =
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; img-src 'self' data: blob:; style-src 'self'";
    server.state.replaced.set("/strict.html", {
      bytes: Buffer.from(
        '<!doctype html><link rel="icon" href="data:,"><main></main><script type="module" src="corniche-map.js"></script>',
      ),
      type: "text/html",
    });
    const page = await openPage(browser, server, "/strict.html", { width: 400, height: 300 });
    const opened = await addMap(page, { src: "/packages/pass.pmtiles", samples: "1" });
    assert.ok(opened.ready, JSON.stringify(opened));
    await settled(page);
    const offences = page.faults.console.filter((text) => /Content Security Policy/.test(text));
    assert.deepEqual(offences, []);
    server.behave();
    await page.end();
  });

  test("examples open without a fault", async () => {
    server.state.replaced.set("/packages.json", {
      bytes: Buffer.from('[{"name":"Pass","src":"packages/pass.pmtiles"}]'),
      type: "application/json",
    });
    for (const [name, maps] of [
      ["two-maps", 2],
      ["events", 1],
      ["attributes", 1],
      ["article", 1],
      ["maplibre", 1],
    ]) {
      const page = await openPage(browser, server, `/examples/${name}.html`, { width: 800, height: 700 });
      await ready(page, maps);
      if (name === "events") {
        // Another event may follow, and then the page shows that one.
        await page.evaluate(() => {
          const keep = () => {
            window.toldOfPick = document.querySelector("pre").textContent;
          };
          document.querySelector("corniche-map").addEventListener("pick", keep);
        });
        await page.locator("corniche-map").click({ position: { x: 300, y: 200 } });
        await page.waitForFunction(() => window.toldOfPick?.startsWith("pick"));
      }
      if (name === "attributes") {
        await page.locator('select[name="map-style"]').selectOption("dark");
        await page.waitForFunction(() => document.querySelector("corniche-map").settings.style === "dark");
      }
      if (name === "article") {
        assert.equal(await ask(page, (map) => map.settings.style), "./sepia.toml");
        assert.equal(await page.locator("corniche-map .notice.warn").count(), 0);
      }
      if (name === "two-maps") {
        await page.evaluate(() =>
          document.querySelector("corniche-map").lookAt({ lon: 9.51, lat: 46.91, distance: 3000, heading: 20, pitch: 40 }, { jump: true }),
        );
        await page.waitForFunction(() => Math.abs(document.querySelectorAll("corniche-map")[1].camera.distance - 3000) < 30);
      }
      checkFaults(page);
      await page.end();
    }
    server.behave();
  });

  test("a picture is a PNG of the map with its credits", async () => {
    const page = await openMap(browser, server, { hash: "" }, { width: 800, height: 500 });
    const download = page.waitForEvent("download");
    await page.locator("corniche-map canvas").focus();
    await page.keyboard.press("p");
    const saved = await download;
    assert.equal(saved.suggestedFilename(), "pass.png");
    const png = PNG.sync.read(fs.readFileSync(await saved.path()));
    assert.deepEqual([png.width, png.height], [800, 500]);
    const { data } = await ask(page, async (map) => {
      const { data } = await map.readPixels();
      return { data: [...data.subarray(0, 400)] };
    });
    assert.deepEqual([...png.data.subarray(0, 400)], data, "the pixels of the map");
    // In the corner the map is visible through the attribution: light, with dark letters.
    let dark = 0;
    for (let y = png.height - 18; y < png.height - 2; y += 1)
      for (let x = png.width - 150; x < png.width; x += 1) if (png.data[4 * (y * png.width + x)] < 90) dark += 1;
    assert.ok(dark > 60, `${dark} dark pixels of letters`);
    await page.end();
  });

  test("a flight is recorded, saved and played", async () => {
    const page = await openMap(browser, server, { hash: "", inertia: "off" }, { width: 500, height: 400 });
    await page.locator("corniche-map canvas").focus();
    const before = await ask(page, (map) => map.camera);
    await page.keyboard.press("c");
    await page.waitForFunction(() => document.querySelector("corniche-map").report.recording_s !== null);
    for (let step = 0; step < 4; step += 1) {
      await page.keyboard.press("ArrowRight");
      await page.waitForTimeout(200);
    }
    const download = page.waitForEvent("download");
    await page.keyboard.press("c");
    const saved = await download;
    assert.equal(saved.suggestedFilename(), "pass-flight.toml");
    const flight = fs.readFileSync(await saved.path(), "utf8");
    assert.match(flight, /=/);
    const after = await ask(page, (map) => map.camera);
    assert.notDeepEqual(after, before);
    await ask(page, (map) => map.command("reset"));
    await settled(page);
    await ask(page, (map, flight) => map.play(flight), flight);
    await page.waitForFunction(() => document.querySelector("corniche-map").report.is_playing === false, null, { timeout: 30_000 });
    await settled(page);
    const played = await ask(page, (map) => map.camera);
    assert.ok(
      Math.abs(played.lon - after.lon) < 1e-4 && Math.abs(played.lat - after.lat) < 1e-4,
      `${JSON.stringify(played)} ${JSON.stringify(after)}`,
    );
    const why = await ask(page, async (map) => {
      try {
        await map.play("no flight");
        return "";
      } catch (error) {
        return error.message;
      }
    });
    assert.ok(why.length > 5);
    checkFaults(page);
    await page.end();
  });

  test("a link to the view is copied", async () => {
    const page = await openMap(
      browser,
      server,
      { hash: "", "look-at": "9.51,46.91,4000,10,50" },
      { width: 500, height: 400, permissions: ["clipboard-read", "clipboard-write"] },
    );
    await page.locator("corniche-map canvas").focus();
    await page.keyboard.press("v");
    await page.locator("corniche-map .notice").filter({ hasText: "copied" }).waitFor();
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /blank\.html#9\.51,46\.91,4000,10,50$/);
    await page.end();
  });

  test("the types fit the code, and a page's use of them", () => {
    const compiler = path.join(here, "node_modules", "typescript", "bin", "tsc");
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), "corniche-"));
    for (const name of fs.readdirSync(sources).filter((name) => /\.(js|d\.ts)$/.test(name)))
      fs.copyFileSync(path.join(sources, name), path.join(folder, name));
    fs.symlinkSync(path.join(here, "node_modules"), path.join(folder, "node_modules"));
    // The glue code is generated, and its types are not those of the element.
    fs.writeFileSync(
      path.join(folder, "corniche_web.d.ts"),
      "export default function init(options: object): Promise<any>;\nexport const MapView: any;\n",
    );
    fs.writeFileSync(
      path.join(folder, "corniche_web_styles.d.ts"),
      "export default function init(options: object): Promise<unknown>;\nexport function style_table(name: string, text: string): Uint8Array;\n",
    );
    fs.writeFileSync(
      path.join(folder, "use.ts"),
      `import { CornicheMap, type Pick } from "./corniche-map.js";
const map = document.createElement("corniche-map");
map.addEventListener("pick", (event) => { const pick: Pick | null = event.detail; console.log(pick?.road?.way.toFixed(0), pick?.road?.attributes["name"]); });
map.addEventListener("ready", ({ detail }) => console.log(detail.classes[0]?.label, map instanceof CornicheMap));
map.settings = { roads: "sv" };
// @ts-expect-error there is no such method
map.settings = { roads: "lines" };
map.lookAt({ lon: 9, lat: 47 }, { jump: true });
const pixels: Promise<{ width: number }> = map.readPixels();
void pixels;
`,
    );
    const options = {
      allowJs: true,
      checkJs: true,
      noEmit: true,
      strict: true,
      target: "es2022",
      module: "es2022",
      moduleResolution: "bundler",
      lib: ["es2023", "dom", "dom.iterable"],
      skipLibCheck: true,
      types: [],
    };
    fs.writeFileSync(path.join(folder, "tsconfig.json"), JSON.stringify({ compilerOptions: options, files: ["use.ts", "element.js"] }));
    try {
      execFileSync(process.execPath, [compiler, "-p", folder], { stdio: "pipe" });
    } catch (error) {
      assert.fail(String(error.stdout));
    } finally {
      fs.rmSync(folder, { recursive: true });
    }
  });

  test("scripts and styles of the element are small", () => {
    const bytes = ["corniche-map.js", "worker.js"]
      .map((name) => zlib.brotliCompressSync(fs.readFileSync(path.join(site, name))).length)
      .reduce((sum, one) => sum + one, 0);
    console.log(`# the element and its worker: ${bytes} bytes of brotli`);
    assert.ok(bytes > 10_000 && bytes < 26_000, `${bytes} bytes`);
  });
}
