// All tests of the page in a real browser.
//
//   node run.mjs SITE PACKAGES CORNICHE PICTURES SOURCES
//
// SITE is the folder that scripts/web creates, PACKAGES contains pass.pmtiles and others, CORNICHE
// is the program, PICTURES a folder for images of the page, SOURCES the folder of the element's
// modules. node --test-reporter=spec --test-name-pattern=PATTERN run.mjs … runs a selection.
import fs from "node:fs";
import path from "node:path";
import { after, describe } from "node:test";
import { startChromium } from "./browser.mjs";
import { startServer } from "./server.mjs";
import { someOf } from "./tier.mjs";

const [site, packages, corniche, pictures, sources] = process.argv.slice(2).map((name) => path.resolve(name));
if (!sources) {
  console.error("usage: node run.mjs SITE PACKAGES CORNICHE PICTURES SOURCES");
  process.exit(2);
}
const browser = await startChromium();
if (!browser) process.exit(0);
fs.mkdirSync(pictures, { recursive: true });
const server = await startServer({ site, packages });
const other = await startServer({ site, packages });

/** Shared by all tests. `other` is another host. */
const world = { browser, server, other, site, packages, corniche, pictures, sources, package: path.join(packages, "pass.pmtiles") };
const usual = ["units", "opening", "pixels", "sizes", "served", "failures"];
// Tests of user interaction, and images of it, take longest; in CI they alternate by day.
const uses = ["drags", "access", "keys", "streaming", "embedding", "pictures", "own_styles", "links", "gestures"];
const names = [...usual, ...someOf(uses, 5)];
const parts = await Promise.all(names.map((name) => import(`./${name}.mjs`)));
describe("the page of the browser viewer", () => {
  for (const { tests } of parts) tests(world);
  after(async () => {
    await browser.close();
    server.close();
    other.close();
  });
});
