// Files of an export.
import fs from "node:fs";
import path from "node:path";

/** All files below a folder with this suffix, as sorted relative paths. */
export function filesOf(folder, ending) {
  return fs.readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(ending)).sort()
    .map((name) => path.join(folder, name));
}

/** Prints an error and makes the program fail. */
export function fail(text) {
  console.error(`wrong: ${text}`);
  process.exitCode = 1;
}
