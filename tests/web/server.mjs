// A static host for the tests: ranges, delays, a limited rate, and misbehaviour on demand.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import zlib from "node:zlib";

const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".json": "application/json",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".png": "image/png",
  ".toml": "text/plain",
};

const BLANK = `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><meta name="color-scheme" content="light dark"><title>A map</title><link rel="icon" href="data:,">
<style>body { margin: 0; background: light-dark(#fff, #111); }</style><main></main>
<script type="module" src="/corniche-map.js"></script></html>`;

/** Headers without those that allow pages of other hosts to read. */
const bare = (head) => Object.fromEntries(Object.entries(head).filter(([name]) => !name.startsWith("Access-Control")));

/** The misbehaviour of a host under /as/HOW/. `range` is the requested range, or `null`. */
const WAYS = {
  missing: (answer) => answer.writeHead(404).end("no"),
  forbidden: (answer) => answer.writeHead(403).end("no"),
  "no-ranges": (answer, { bytes, head }) => answer.writeHead(200, head).end(bytes),
  gzip(answer, { part, head }) {
    answer.writeHead(206, { ...head, "Content-Encoding": "gzip" }).end(zlib.gzipSync(part));
  },
  truncated: (answer, { part, head, range }) => answer.writeHead(206, head).end(range[0] > 0 ? part.subarray(0, part.length - 1) : part),
  closing(answer, { part, head, range }) {
    if (range[0] > 0) answer.destroy();
    else answer.writeHead(206, head).end(part);
  },
  changed: (answer, { part, head, count }) => answer.writeHead(206, { ...head, ETag: `"${count}"` }).end(part),
  unexposed: (answer, { part, head }) => answer.writeHead(206, { ...head, "Access-Control-Expose-Headers": "" }).end(part),
  "no-cors": (answer, { part, head }) => answer.writeHead(206, bare(head)).end(part),
};

/** Invalid files, derived from a valid one. */
const FILES = {
  foreign: () => Buffer.from(`<!doctype html>${" ".repeat(70_000)}`),
  // A header of PMTiles 3 with tiles of another kind: vector tiles.
  pmtiles(whole) {
    const other = Buffer.from(whole);
    other[99] = 1;
    return other;
  },
  cut: (whole) => whole.subarray(0, Math.floor(whole.length * 0.3)),
  flipped(whole) {
    const other = Buffer.from(whole);
    for (let at = 127; at < other.length; at += 997) other[at] ^= 0xff;
    return other;
  },
  noise(whole) {
    const other = Buffer.from(whole);
    for (let at = 8; at < other.length; at += 1) other[at] = (at * 2654435761) >>> 24;
    return other;
  },
  empty: () => Buffer.alloc(0),
};

/**
 * Serves the files of `site`, packages of `packages` under /packages/, bad hosts under /as/HOW/NAME and bad files under /bad/HOW/NAME.
 * Other pages may read all of them.
 */
export async function startServer({ site, packages }) {
  const state = { delay_ms: 0, bytes_per_ms: 0, compresses: false, requests: [], replaced: new Map(), policy: "" };
  let free = 0;
  let count = 0;

  /** Waits for the transmission time of this number of bytes: all requests share one link. */
  async function slowly(bytes) {
    if (state.delay_ms > 0) await new Promise((done) => setTimeout(done, state.delay_ms));
    if (state.bytes_per_ms === 0) return;
    const now = performance.now();
    free = Math.max(free, now) + bytes / state.bytes_per_ms;
    await new Promise((done) => setTimeout(done, free - now));
  }

  const kept = new Map();
  /** The replacement of a file: NAME.br next to it, or, for files of the page, a generated one. `null` if it is sent unchanged. */
  function compressed(asked, bytes, type) {
    if (!kept.has(asked)) {
      const beside = path.join(site, `${asked}.br`);
      if (fs.existsSync(beside)) kept.set(asked, fs.readFileSync(beside));
      else if (/html|javascript|css|wasm/.test(type)) kept.set(asked, zlib.brotliCompressSync(bytes));
    }
    return kept.get(asked) ?? null;
  }

  async function whole(name) {
    return fs.promises.readFile(path.join(packages, path.basename(name))).catch(() => null);
  }

  async function found(asked) {
    if (state.replaced.has(asked)) return state.replaced.get(asked);
    if (asked === "/blank.html") return { bytes: Buffer.from(BLANK), type: "text/html" };
    if (asked.startsWith("/packages/")) return { bytes: await whole(asked), type: "application/octet-stream" };
    const [, kind, how, name] = asked.split("/");
    if (kind === "as") return { bytes: await whole(name), type: "application/octet-stream", way: WAYS[how] };
    if (kind === "bad") return { bytes: FILES[how](await whole(name)), type: "application/octet-stream" };
    const file = path.join(site, asked.endsWith("/") ? `${asked}index.html` : asked);
    const bytes = await fs.promises.readFile(file).catch(() => null);
    return { bytes, type: TYPES[path.extname(file)] ?? "application/octet-stream" };
  }

  const server = http.createServer(async (request, answer) => {
    const asked = decodeURIComponent(new URL(request.url, "http://local").pathname);
    const allowed = {
      "Access-Control-Allow-Origin": "*",
      "Access-Control-Allow-Headers": "range",
      "Access-Control-Expose-Headers": "Content-Range, ETag, Content-Encoding",
    };
    if (request.method === "OPTIONS")
      return asked.startsWith("/as/no-cors/") ? answer.writeHead(403).end() : answer.writeHead(204, allowed).end();
    const { bytes, type, way, status } = await found(asked);
    const told = { path: asked, range: request.headers.range ?? null, method: request.method, isStopped: false };
    state.requests.push(told);
    answer.on("close", () => {
      told.isStopped = !answer.writableFinished;
    });
    if (!bytes || status) return answer.writeHead(status ?? 404, allowed).end("no");
    const head = { ...allowed, "Content-Type": type, "Accept-Ranges": "bytes", ETag: `"${bytes.length}"`, "Cache-Control": "no-store" };
    if (state.policy && type === "text/html") head["Content-Security-Policy"] = state.policy;
    const match = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    let part = bytes;
    let code = 200;
    let range = [0, bytes.length - 1];
    if (match) {
      range = [+match[1], Math.min(+match[2], bytes.length - 1)];
      if (range[0] >= bytes.length) return answer.writeHead(416, { ...allowed, "Content-Range": `bytes */${bytes.length}` }).end();
      part = bytes.subarray(range[0], range[1] + 1);
      code = 206;
      head["Content-Range"] = `bytes ${range[0]}-${range[1]}/${bytes.length}`;
    }
    // Like static hosts: files of the page, but never a package.
    const takesBrotli = /\bbr\b/.test(request.headers["accept-encoding"] ?? "");
    const small = state.compresses && takesBrotli && !match ? compressed(asked, bytes, type) : null;
    if (small) {
      part = small;
      head["Content-Encoding"] = "br";
    }
    await slowly(part.length);
    // The time of the last sent byte, in milliseconds since 1970.
    Object.assign(told, { bytes: part.length, sent_ms: performance.timeOrigin + performance.now() });
    if (request.method === "HEAD") {
      if (way === WAYS.gzip) head["Content-Encoding"] = "gzip";
      const told = way === WAYS["no-cors"] ? bare(head) : head;
      return answer.writeHead(200, { ...told, "Content-Length": bytes.length }).end();
    }
    if (way) return way(answer, { bytes, part, head, range, count: (count += 1) });
    answer.writeHead(code, { ...head, "Content-Length": part.length }).end(part);
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  return {
    origin: `http://127.0.0.1:${server.address().port}`,
    state,
    /** A host that stops misbehaving. */
    behave() {
      Object.assign(state, { delay_ms: 0, bytes_per_ms: 0, compresses: false, requests: [], policy: "" });
      state.replaced.clear();
    },
    close: () => server.close(),
  };
}
