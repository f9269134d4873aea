// Opens an address on which a page shows a map, and checks that a map is drawn:
// `node shown.mjs ADDRESS PICTURE.png`.
import assert from "node:assert/strict";
import fs from "node:fs";
import { PNG } from "pngjs";
import { checkFaults, openPage, startChromium } from "./browser.mjs";

/** A map has more colours than an error page. */
const FEWEST_COLORS = 200;

/** Opens the address and saves an image of the page. Returns the seconds until the map was displayed. */
export async function checkShown(browser, address, picture) {
  const begun = performance.now();
  const { origin } = new URL(address);
  const before = () => addEventListener("error", ({ detail }) => (window.failureOfMap = detail ?? window.failureOfMap), { capture: true });
  const page = await openPage(browser, { origin }, address.slice(origin.length), { width: 800, height: 600, before });
  const shown = () => document.querySelector("corniche-map")?.report?.is_settled || window.failureOfMap;
  // An element that is never defined reports nothing.
  await page.waitForFunction(shown, null, { timeout: 60_000 }).catch((error) => page.faults.errors.push(error.message));
  assert.equal(await page.evaluate(() => window.failureOfMap), undefined, `no map is shown at ${address}`);
  assert.deepEqual(page.faults.errors, [], `no map is shown at ${address}; on the console: ${page.faults.console}`);
  const seconds = (performance.now() - begun) / 1000;
  checkFaults(page);
  assert.ok(page.workers().length > 0, "workers decode tiles");
  const shot = PNG.sync.read(await page.screenshot({ path: picture }));
  const colors = new Set();
  for (let at = 0; at < shot.data.length; at += 4) colors.add(shot.data.readUInt32BE(at));
  assert.ok(colors.size >= FEWEST_COLORS, `a picture of ${colors.size} colours`);
  await page.end();
  return seconds;
}

if (process.argv[1] === import.meta.filename || fs.realpathSync(process.argv[1]) === import.meta.filename) {
  const [address, picture] = process.argv.slice(2);
  const browser = await startChromium();
  if (browser) {
    const seconds = await checkShown(browser, address, picture);
    console.log(`${address} shows a map after ${seconds.toFixed(1)} s; ${picture}`);
    await browser.close();
  }
}
