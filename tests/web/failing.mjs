// All failures of a map: the change to the page or its host, and the kind that the element reports.

/** Removes WebGPU, as in browsers without it. */
const withoutWebGpu = () => Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined, configurable: true });
const withoutAdapter = () => {
  GPU.prototype.requestAdapter = async () => null;
};
const withoutDevice = () => {
  GPUAdapter.prototype.requestDevice = () =>
    Promise.reject(new DOMException("the limits are beyond those of the adapter", "OperationError"));
};

/** Stores the devices of the page, so that a test can destroy them. */
export const keepDevices = () => {
  const native = GPUAdapter.prototype.requestDevice;
  GPUAdapter.prototype.requestDevice = async function requestDevice(...options) {
    const device = await native.apply(this, options);
    window.devices = [...(window.devices ?? []), device];
    return device;
  };
};

const text = (bytes, type = "text/html") => ({ bytes: Buffer.from(bytes), type });

/** Name, kind, URL of the package, and further changes. */
export const FAILURES = [
  { name: "no WebGPU", kind: "no-webgpu", src: "/packages/pass.pmtiles", before: withoutWebGpu },
  { name: "no adapter", kind: "no-adapter", src: "/packages/pass.pmtiles", before: withoutAdapter },
  { name: "an adapter that is too small", kind: "limits", src: "/packages/pass.pmtiles", before: withoutDevice },
  { name: "404", kind: "not-found", src: "/as/missing/pass.pmtiles" },
  { name: "403", kind: "not-found", src: "/as/forbidden/pass.pmtiles" },
  { name: "no ranges", kind: "no-ranges", src: "/as/no-ranges/pass.pmtiles" },
  { name: "gzip", kind: "compressed", src: "/as/gzip/pass.pmtiles" },
  { name: "no host", kind: "network", src: "http://127.0.0.1:9/pass.pmtiles" },
  { name: "no CORS", kind: "cors", src: "OTHER/as/no-cors/pass.pmtiles" },
  { name: "hidden headers", kind: "cors", src: "OTHER/as/unexposed/pass.pmtiles" },
  { name: "a page instead of a package", kind: "foreign", src: "/bad/foreign/pass.pmtiles" },
  { name: "another PMTiles", kind: "foreign", src: "/bad/pmtiles/pass.pmtiles" },
  { name: "a cut file", kind: ["damaged", "changed", "network"], src: "/bad/cut/pass.pmtiles" },
  { name: "flipped bytes", kind: ["damaged", "foreign", "old-format"], src: "/bad/flipped/pass.pmtiles" },
  { name: "noise", kind: ["damaged", "foreign", "old-format"], src: "/bad/noise/pass.pmtiles" },
  { name: "an empty file", kind: ["changed", "foreign", "damaged"], src: "/bad/empty/pass.pmtiles" },
  { name: "a place off the ground", kind: "off-ground", src: "/packages/pass.pmtiles", attributes: { "look-at": "20,50" } },
  { name: "no module", kind: "files", src: "/packages/pass.pmtiles", replaced: { "/corniche_web_bg.wasm": { status: 404, bytes: null } } },
  {
    name: "a page instead of the module",
    kind: "files",
    src: "/packages/pass.pmtiles",
    replaced: { "/corniche_web_bg.wasm": text("<!doctype html> not here") },
  },
  {
    name: "a cut module",
    kind: "files",
    src: "/packages/pass.pmtiles",
    replaced: { "/corniche_web_bg.wasm": { bytes: Buffer.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, 200]), type: "application/wasm" } },
  },
  { name: "no glue", kind: "files", src: "/packages/pass.pmtiles", replaced: { "/corniche_web.js": { status: 404, bytes: null } } },
  { name: "no worker", kind: "files", src: "/packages/pass.pmtiles", replaced: { "/worker.js": { status: 404, bytes: null } } },
  { name: "a worker of the wrong type", kind: "files", src: "/packages/pass.pmtiles", replaced: { "/worker.js": text("<!doctype html>") } },
  {
    name: "a policy without WebAssembly",
    kind: "files",
    src: "/packages/pass.pmtiles",
    policy: "default-src 'none'; script-src 'self'; worker-src 'self'; connect-src 'self'; style-src 'unsafe-inline'; img-src data:",
  },
  {
    name: "a policy without workers",
    kind: "files",
    src: "/packages/pass.pmtiles",
    policy:
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'none'; connect-src 'self'; style-src 'unsafe-inline'; img-src data:",
  },
];

/** Hosts that fail after the beginning of the package, when the map is already open. The message is a notice if the coarse map stays; otherwise it replaces the map. */
export const LATER = [
  { name: "cut answers", stays: true, says: /truncated/, src: "/as/truncated/pass.pmtiles" },
  { name: "closed connections", stays: true, says: /closes the connection|cannot be reached/, src: "/as/closing/pass.pmtiles" },
  { name: "a changing file", says: /has changed/, src: "/as/changed/pass.pmtiles" },
];
