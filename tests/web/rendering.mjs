// Images of `corniche render` on Chromium's driver, and their difference from pixels of the page.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { PNG } from "pngjs";

const DRIVER = process.env.CHROMIUM_DRIVER ?? "/usr/lib/chromium/vk_swiftshader_icd.json";
/** In `render`, attribution is drawn into the image; on a page it is text. It is in this corner. */
const CREDITS = { width: 300, height: 30 };

export const hasDriver = () => fs.existsSync(DRIVER);

/** The output of a program in a temporary folder; `file` is the image in it. */
function drawn(corniche, work, file) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "corniche-"));
  const env = { ...process.env, VK_DRIVER_FILES: DRIVER, VK_ICD_FILENAMES: DRIVER };
  try {
    execFileSync(corniche, work(folder), { env, stdio: ["ignore", "ignore", "pipe"] });
    return PNG.sync.read(fs.readFileSync(path.join(folder, file)));
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
}

/** The image that `render` draws. */
export const rendered = (corniche, file, options) =>
  drawn(corniche, (folder) => ["render", file, "-o", path.join(folder, "map.png"), "--quiet", ...options], "map.png");

/** The last frame of a flight, given as TOML. */
export function flown(corniche, file, flight, options) {
  const roads = options[options.indexOf("--roads") + 1];
  return drawn(
    corniche,
    (folder) => {
      fs.writeFileSync(path.join(folder, "flight.toml"), flight);
      return [
        "fly",
        file,
        "-o",
        path.join(folder, "flight.csv"),
        "--path",
        path.join(folder, "flight.toml"),
        "--frames",
        "4",
        "--png",
        path.join(folder, "frames"),
        "--quiet",
        ...options,
      ];
    },
    path.join("frames", `lod-${roads}-00003.png`),
  );
}

/** The number of compared pixels, the number of differing bytes, and their largest difference. */
export function difference(a, b) {
  let compared = 0;
  let bytes = 0;
  let steps = 0;
  for (let y = 0; y < a.height; y += 1) {
    for (let x = 0; x < a.width; x += 1) {
      if (y >= a.height - CREDITS.height && x >= a.width - CREDITS.width) continue;
      const at = 4 * (y * a.width + x);
      compared += 1;
      for (let k = 0; k < 4; k += 1) {
        const apart = Math.abs(a.data[at + k] - b.data[at + k]);
        if (apart > 0) bytes += 1;
        steps = Math.max(steps, apart);
      }
    }
  }
  return { compared, bytes, steps };
}

/** The number of colours: a blank canvas has one. */
export function colours(picture) {
  const seen = new Set();
  for (let at = 0; at < picture.data.length; at += 4) seen.add(picture.data.readUInt32LE(at));
  return seen.size;
}
