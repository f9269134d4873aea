// Measures how fast the module decodes tiles, without a browser: node decoding.mjs SITE PACKAGE…
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { PMTiles } from "pmtiles";

const [site, ...packages] = process.argv.slice(2);
const ROUNDS = 5;
/** The sections of tiles that are read: bits by section kind (FORMAT.md). */
const LOOKS = { ground: 1, "ground and relief": 1 | (1 << 5), "what GEO draws": 1 | (1 << 1) | (1 << 9) | (1 << 3) | (1 << 4) | (1 << 5) };

class File {
  constructor(name) {
    this.file = fs.openSync(name);
    this.name = name;
  }
  getKey() {
    return this.name;
  }
  async getBytes(offset, length) {
    const bytes = Buffer.alloc(length);
    const read = fs.readSync(this.file, bytes, 0, length, offset);
    return { data: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + read) };
  }
}

// Node requires this extension for modules.
const script = path.join(fs.mkdtempSync("/tmp/corniche-"), "glue.mjs");
fs.copyFileSync(path.join(site, "corniche_web.js"), script);
const { initSync, work } = await import(pathToFileURL(script).href);
initSync({ module: fs.readFileSync(path.join(site, "corniche_web_bg.wasm")) });
for (const name of packages) {
  const archive = new PMTiles(new File(name));
  const metadata = await archive.getMetadata();
  const { minZoom, maxZoom } = await archive.getHeader();
  work({ metadata: new TextEncoder().encode(JSON.stringify(metadata)) });
  const tiles = [];
  for (let z = minZoom; z <= maxZoom; z += 1) {
    for (let x = 0; x < 2 ** z; x += 1) {
      for (let y = 0; y < 2 ** z; y += 1) {
        const tile = await archive.getZxy(z, x, y);
        if (tile) tiles.push({ z, x, y, payload: new Uint8Array(tile.data) });
      }
    }
  }
  const vertices = metadata.corniche.levels.reduce((sum, level) => sum + level.vertices, 0);
  for (const [look, sections] of Object.entries(LOOKS)) {
    const decoder = JSON.stringify({ sections, has_photos: false, layers: [], mapping: "OnTriangles" });
    let total = 0;
    let longest = 0;
    for (const [k, tile] of tiles.entries()) {
      let best = Infinity;
      for (let round = 0; round < ROUNDS; round += 1) {
        // CPU time, which does not depend on other programs.
        const begun = process.cpuUsage();
        const answer = work({ job: k, decoder, ...tile });
        const { user, system } = process.cpuUsage(begun);
        best = Math.min(best, (user + system) / 1000);
        if (answer.error) throw new Error(answer.error);
      }
      total += best;
      longest = Math.max(longest, best);
    }
    console.log(
      `${path.basename(name)}, ${look}: ${tiles.length} tiles, ${(total / tiles.length).toFixed(1)} ms a tile, longest ${longest.toFixed(1)} ms; ${((1000 * total) / vertices).toFixed(2)} µs a vertex (${((34e-3 * vertices) / total).toFixed(0)} MB/s of 34 bytes)`,
    );
  }
}
