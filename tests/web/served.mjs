// The page as `corniche serve` sends it: under its security policy, from other servers, and in a
// frame of another page.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { test } from "node:test";
import { PNG } from "pngjs";
import { ask, openPage } from "./browser.mjs";
import { FAILURES } from "./failing.mjs";

/** The program serves the package and the page; the URL is its output. */
async function serve(corniche, site, file) {
  const child = spawn(corniche, ["serve", file, "--page", site, "--port", "0"], { stdio: ["ignore", "pipe", "inherit"] });
  for await (const line of createInterface({ input: child.stdout })) return { origin: line.replace(/\/$/, ""), end: () => child.kill() };
  throw new Error("it does not start");
}

const opened = (page) => page.waitForFunction(() => document.querySelector("corniche-map")?.about, null, { timeout: 60_000 });

/** Checks that nothing was blocked, and that no script failed. */
function checkAllowed(page) {
  const offences = page.faults.console.filter((text) => /Content.Security.Policy|Refused to/i.test(text));
  assert.deepEqual([offences, page.faults.errors], [[], []]);
}

export function tests({ browser, server, other, site, corniche, package: file }) {
  test("the page and its examples work under the policy of serve, and say nothing of it", async () => {
    const served = await serve(corniche, site, file);
    for (const address of ["/", "/examples/two-maps.html", "/examples/events.html", "/examples/article.html"]) {
      const page = await openPage(browser, served, address, { width: 500, height: 400 });
      await opened(page);
      const policy = (await (await fetch(`${served.origin}${address}`)).headers).get("content-security-policy");
      assert.match(policy, /script-src 'self' 'wasm-unsafe-eval'/, address);
      checkAllowed(page);
      await page.end();
    }
    served.end();
  });

  test("packages of other servers and of this computer are read under the policy", async () => {
    other.behave();
    const served = await serve(corniche, site, file);
    const page = await openPage(browser, served, `/?src=${encodeURIComponent(`${other.origin}/packages/pass.pmtiles`)}`, { width: 500, height: 400 });
    await opened(page);
    assert.equal(await ask(page, (map) => map.about.name), "pass");
    checkAllowed(page);
    await page.end();
    const own = await openPage(browser, served, "/?src=nothing.pmtiles", { width: 500, height: 400 });
    await own.locator("#file").setInputFiles(file);
    await opened(own);
    checkAllowed(own);
    await own.end();
    served.end();
  });

  test("without WebGPU, the picture beside a package of another server is shown under the policy", async () => {
    other.behave();
    other.state.replaced.set("/packages/pass.png", { bytes: PNG.sync.write(new PNG({ width: 40, height: 30 })), type: "image/png" });
    const served = await serve(corniche, site, file);
    const address = `/?src=${encodeURIComponent(`${other.origin}/packages/pass.pmtiles`)}`;
    const page = await openPage(browser, served, address, { width: 500, height: 400, before: FAILURES[0].before });
    await page.locator("corniche-map img.still").waitFor({ state: "visible" });
    checkAllowed(page);
    other.behave();
    await page.end();
    served.end();
  });

  test("a page of another server shows the page of serve in a frame", async () => {
    server.behave();
    const served = await serve(corniche, site, file);
    server.state.replaced.set("/frame.html", {
      bytes: Buffer.from(`<!doctype html><link rel="icon" href="data:,"><iframe src="${served.origin}/" width="400" height="300"></iframe>`),
      type: "text/html",
    });
    const page = await openPage(browser, server, "/frame.html", { width: 500, height: 400 });
    const frame = page.frames().find((frame) => frame.url().startsWith(served.origin)) ?? (await page.waitForEvent("framenavigated"));
    await frame.waitForFunction(() => document.querySelector("corniche-map")?.about, null, { timeout: 60_000 });
    checkAllowed(page);
    server.behave();
    await page.end();
    served.end();
  });

  // Each of these was once an error that stopped the page's script, without any image or message.
  test("addresses that are no text say what is wrong", async () => {
    const served = await serve(corniche, site, file);
    for (const src of ["100%25.pmtiles", "%25E0%25A4.pmtiles", "http%3A%2F%2F%5B"]) {
      const page = await openPage(browser, served, `/?src=${src}`, { width: 500, height: 400 });
      await page.locator("corniche-map .failure").waitFor();
      assert.deepEqual(page.faults.errors, [], src);
      await page.end();
    }
    served.end();
  });
}
