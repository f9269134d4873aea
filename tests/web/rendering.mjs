// Pictures of `corniche render` on the driver of Chromium, and how far pixels are from them.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { PNG } from "pngjs";

const DRIVER = process.env.CHROMIUM_DRIVER ?? "/usr/lib/chromium/vk_swiftshader_icd.json";
/** Credits are drawn into pictures of `render`; on a page they are text. They lie in this corner. */
const CREDITS = { width: 300, height: 30 };

export const hasDriver = () => fs.existsSync(DRIVER);

export function rendered(corniche, file, options) {
  const out = path.join(fs.mkdtempSync(path.join(os.tmpdir(), "corniche-")), "map.png");
  const env = { ...process.env, VK_DRIVER_FILES: DRIVER, VK_ICD_FILENAMES: DRIVER };
  execFileSync(corniche, ["render", file, "-o", out, "--quiet", ...options], { env, stdio: ["ignore", "ignore", "pipe"] });
  const png = PNG.sync.read(fs.readFileSync(out));
  fs.rmSync(path.dirname(out), { recursive: true });
  return png;
}

/** How many pixels are compared, and how many bytes of them differ. */
export function difference(a, b) {
  let compared = 0;
  let bytes = 0;
  for (let y = 0; y < a.height; y += 1) {
    for (let x = 0; x < a.width; x += 1) {
      if (y >= a.height - CREDITS.height && x >= a.width - CREDITS.width) continue;
      const at = 4 * (y * a.width + x);
      compared += 1;
      for (let k = 0; k < 4; k += 1) if (a.data[at + k] !== b.data[at + k]) bytes += 1;
    }
  }
  return { compared, bytes };
}

/** How many colours there are: a blank canvas has one. */
export function colours(picture) {
  const seen = new Set();
  for (let at = 0; at < picture.data.length; at += 4) seen.add(picture.data.readUInt32LE(at));
  return seen.size;
}
