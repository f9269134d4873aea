// Sizes of the files of a page: node sizes.mjs FOLDER
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";

const [folder] = process.argv.slice(2);
const brotli = (bytes) =>
  zlib.brotliCompressSync(bytes, { params: { [zlib.constants.BROTLI_PARAM_QUALITY]: 11, [zlib.constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } });
/** Files that a page fetches only when they are needed. */
const LATER = new Map([
  ["only with a custom style", ["style_reader.js", "corniche_web_styles_bg.wasm"]],
  ["only where a flight is played", ["toml_reader.js"]],
]);
const row = (name, sizes) => console.log(name.padEnd(32), ...sizes.map((size) => size.toLocaleString("en").padStart(11)));

function list(head, names, sum) {
  console.log(head.padEnd(32), ...["raw", "gzip", "brotli"].map((column) => column.padStart(11)));
  const total = [0, 0, 0];
  for (const name of names) {
    const bytes = fs.readFileSync(path.join(folder, name));
    const sizes = [bytes.length, zlib.gzipSync(bytes, { level: 9 }).length, brotli(bytes).length];
    sizes.forEach((size, k) => (total[k] += size));
    row(name, sizes);
  }
  row(sum, total);
}

const names = fs
  .readdirSync(folder)
  .sort()
  .filter((name) => fs.statSync(path.join(folder, name)).isFile() && !name.endsWith(".d.ts") && /\.(js|css|wasm|html)$/.test(name));
const later = [...LATER.values()].flat();
list("every map", names.filter((name) => !later.includes(name)), "total");
for (const [when, files] of LATER) {
  console.log();
  list(when, files, "total");
}
