// Files of an export.
import fs from "node:fs";
import path from "node:path";

/** All files below a folder that end so, from there, sorted. */
export function filesOf(folder, ending) {
  return fs.readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(ending)).sort()
    .map((name) => path.join(folder, name));
}

/** Says what is wrong and makes the program fail. */
export function fail(text) {
  console.error(`wrong: ${text}`);
  process.exitCode = 1;
}
