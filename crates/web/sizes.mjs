// Sizes of the files of a page: node sizes.mjs FOLDER
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";

const [folder] = process.argv.slice(2);
const brotli = (bytes) =>
  zlib.brotliCompressSync(bytes, { params: { [zlib.constants.BROTLI_PARAM_QUALITY]: 11, [zlib.constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } });
const total = [0, 0, 0];
const row = (name, sizes) => console.log(name.padEnd(24), ...sizes.map((size) => size.toLocaleString("en").padStart(11)));
console.log("file".padEnd(24), ...["raw", "gzip", "brotli"].map((head) => head.padStart(11)));
for (const name of fs.readdirSync(folder).sort()) {
  const file = path.join(folder, name);
  if (!fs.statSync(file).isFile() || name.endsWith(".d.ts") || !/\.(js|css|wasm|html)$/.test(name)) continue;
  const bytes = fs.readFileSync(file);
  const sizes = [bytes.length, zlib.gzipSync(bytes, { level: 9 }).length, brotli(bytes).length];
  sizes.forEach((size, k) => (total[k] += size));
  row(name, sizes);
}
row("all", total);
