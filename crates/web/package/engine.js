// The renderer: its module is fetched and compiled once per page, however many maps there are.

const ALL_FILES = "Put all files of the package corniche-map into one folder of the server.";

/** A failure, with the texts that the element shows. */
export class Failure extends Error {
  /**
   * @param {string} kind
   * @param {string} message
   * @param {string} [advice]
   */
  constructor(kind, message, advice = "") {
    super(message);
    this.kind = kind;
    this.advice = advice;
  }
}

/** A text without its technical part: browsers add the position in the script to errors. */
const plain = (/** @type {unknown} */ text) => String(text ?? "").replace(/JsValue\((?:\w*Error: )?([^\n)]*)[^)]*\)/g, "$1");

/** Converts anything that was thrown to a failure. */
export function failureOf(/** @type {any} */ error) {
  if (error instanceof Failure) return error;
  if (error && typeof error === "object" && typeof error.kind === "string")
    return new Failure(error.kind, plain(error.message), String(error.advice ?? ""));
  if (error instanceof WebAssembly.RuntimeError)
    return new Failure("other", `The renderer stopped: ${error.message}`, "Reload the page. If it happens again, please report it.");
  return new Failure("other", error instanceof Error ? error.message : String(error));
}

/** @type {{ module: Promise<WebAssembly.Module>, ready: Promise<any> } | null} */
let engine = null;

/** Reports at once if this browser cannot show a map, before anything is fetched. */
export function checkBrowser() {
  if ("gpu" in navigator && navigator.gpu) return;
  if (!window.isSecureContext) {
    throw new Failure(
      "no-webgpu",
      `Browsers offer WebGPU only to pages with a secure address; this one is ${location.origin}.`,
      "Open the page with https://, or from localhost.",
    );
  }
  throw new Failure(
    "no-webgpu",
    "This browser does not offer WebGPU, which the map needs.",
    "Use a current Chrome, Edge, Firefox or Safari. On Linux, you may have to enable WebGPU in the browser's settings.",
  );
}

async function fetchModule() {
  const address = new URL("./corniche_web_bg.wasm", import.meta.url).href;
  const name = "corniche_web_bg.wasm";
  let answer;
  try {
    answer = await fetch(address);
  } catch (error) {
    throw new Failure(
      "files",
      `${name} cannot be fetched: ${/** @type {Error} */ (error).message}.`,
      "Check the network, and whether the page's security policy (connect-src) allows it.",
    );
  }
  if (!answer.ok)
    throw new Failure("files", `The server answers ${answer.status} for ${name}.`, ALL_FILES);
  // A server that sends a wrong type still sends the right bytes; they are only compiled later.
  const isTyped = (answer.headers.get("Content-Type") ?? "").startsWith("application/wasm");
  const bytes = isTyped ? null : await answer.arrayBuffer();
  if (bytes && new DataView(bytes).byteLength < 8) throw new Failure("files", `${name} is empty.`, "Copy the file to the server again.");
  if (bytes && new DataView(bytes).getUint32(0) !== 0x00_61_73_6d) {
    throw new Failure(
      "files",
      `The server sends something else for ${name}, of type ${answer.headers.get("Content-Type") ?? "unknown"}.`,
      ALL_FILES,
    );
  }
  try {
    return await (bytes ? WebAssembly.compile(bytes) : WebAssembly.compileStreaming(answer));
  } catch (error) {
    const text = String(/** @type {Error} */ (error).message);
    const isPolicy = /Content Security Policy|unsafe-eval/i.test(text);
    throw new Failure(
      "files",
      isPolicy ? "The page's security policy forbids WebAssembly." : `${name} cannot be compiled: ${text}.`,
      isPolicy
        ? "Add 'wasm-unsafe-eval' to script-src of the Content-Security-Policy."
        : "Copy the file to the server again: it may be truncated.",
    );
  }
}

/** The module's glue, with the module loaded. */
async function start(/** @type {Promise<WebAssembly.Module>} */ module) {
  const script = import("./corniche_web.js").catch((error) => {
    throw new Failure("files", `corniche_web.js cannot be loaded: ${error.message}.`, ALL_FILES);
  });
  // The browser sets up its graphics meanwhile. The renderer reports later whether there is an
  // adapter.
  /** @type {any} */ (navigator).gpu?.requestAdapter().catch(() => {});
  const [compiled, glue] = await Promise.all([module, script]);
  await glue.default({ module_or_path: compiled });
  return glue;
}

/** The renderer: `module` for workers, `ready` for views. A failure is not cached: the next call tries again. */
export function loadEngine() {
  if (!engine) {
    const module = fetchModule();
    engine = { module, ready: start(module) };
    engine.ready.catch(() => {
      engine = null;
    });
  }
  return engine;
}
