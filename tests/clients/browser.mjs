// Chromium on a plain file server, and functions for its images.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { PNG } from "pngjs";
import { fail } from "./files.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json", ".css": "text/css" };
/** The background: where it is visible below the horizon, there is a hole. */
const MAGENTA = [255, 0, 255];
const BOTTOM_ROWS = 30;

/** A server for the pages of SITE, with FOLDER below /data/, and a browser of one size. If it does not start, the program ends with the reason. */
export async function startBrowser(folder, site, size) {
  // Like any static host.
  const places = [["/node_modules/", path.join(here, "node_modules")], ["/data/", folder], ["/", site]];
  const server = http.createServer((request, answer) => {
    const asked = decodeURIComponent(new URL(request.url, "http://local").pathname);
    const [prefix, root] = places.find(([prefix]) => asked.startsWith(prefix));
    const file = path.join(root, asked.slice(prefix.length));
    if (!fs.existsSync(file) || !fs.statSync(file).isFile()) return answer.writeHead(404).end();
    answer.writeHead(200, { "Content-Type": TYPES[path.extname(file)] ?? "application/octet-stream" });
    fs.createReadStream(file).pipe(answer);
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  const origin = `http://127.0.0.1:${server.address().port}`;
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  }).catch((error) => {
    console.error(`skipped: Chromium does not start here, so no page is opened: ${error.message.split("\n")[0]}`);
    process.exit(0);
  });

  /** Opens a page after `prepare`; failed and foreign requests and script errors are faults. */
  async function open(address, prepare = async () => {}) {
    const page = await browser.newPage({ viewport: size });
    await prepare(page);
    page.on("request", (request) => {
      if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(origin)) fail(`asks ${request.url()}`);
    });
    page.on("response", (answer) => { if (answer.status() >= 400) fail(`${answer.status()} for ${answer.url()}`); });
    page.on("pageerror", (error) => fail(`${address}: ${error}`));
    await page.goto(`${origin}/${address}`);
    await page.waitForFunction(() => window.corniche, null, { timeout: 60_000 });
    return page;
  }

  async function close() {
    await browser.close();
    server.close();
  }
  return { open, close };
}

/** Hides the texts of pages, which would cover the images. */
export const hideTexts = (page) =>
  page.addStyleTag({ content: "#said, #credit, .cesium-viewer-bottom, .cesium-viewer-toolbar { display: none !important; }" });

export async function picture(page, file) {
  return PNG.sync.read(await page.screenshot({ path: file }));
}

const isNear = (data, at, color, within = 2) => color.every((channel, k) => Math.abs(data[at + k] - channel) <= within);

/** Magenta pixels below ground: those below the first row of ground in a column. */
export function holes(png) {
  let count = 0;
  for (let x = 0; x < png.width; x += 1) {
    let seen = false;
    for (let y = 0; y < png.height; y += 1) {
      const isMagenta = isNear(png.data, 4 * (y * png.width + x), MAGENTA, 20);
      if (!isMagenta) seen = true;
      else if (seen && y < png.height - BOTTOM_ROWS) count += 1;
    }
  }
  return count;
}

/** The fraction of pixels that are not magenta. */
export function covered(png) {
  let count = 0;
  for (let at = 0; at < png.data.length; at += 4) if (!isNear(png.data, at, MAGENTA, 20)) count += 1;
  return count / (png.width * png.height);
}

/** The position of a package, and its height. */
export function extentOf(folder, name) {
  const { manifest } = JSON.parse(fs.readFileSync(path.join(folder, `${name}.json`)));
  const [west, south, east, north] = ["min_x", "min_y", "max_x", "max_y"].map((side) => manifest.wgs84_bounds[side]);
  const at = (u, v) => [west + (east - west) * u, south + (north - south) * v];
  return { manifest, at, high: manifest.vertical.range_m[1], across: (north - south) * 111_000 };
}
