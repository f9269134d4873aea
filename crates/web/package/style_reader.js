// Reads custom styles: fetched with the first of them, together with a module that reads TOML.
import init, { style_table } from "./corniche_web_styles.js";

/** The largest file that the module reads; an endless file is cut off. */
const MOST_BYTES = 1 << 20;
/** The time limit for the answer of the server. */
const MOST_MS = 20_000;
const MODULE = "corniche_web_styles_bg.wasm";

/** @type {Promise<unknown> | null} */
let module = null;

async function load() {
  const answer = await fetch(new URL("./corniche_web_styles_bg.wasm", import.meta.url));
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  await init({ module_or_path: answer });
}

/** A module that failed to load is requested again with the next style. */
function loadModule() {
  module ??= load().catch((error) => {
    module = null;
    console.warn(error);
    throw new Error(`${MODULE} of corniche-map is missing`);
  });
  return module;
}

async function bytesOf(/** @type {string} */ address) {
  let answer;
  try {
    answer = await fetch(new URL(address, document.baseURI), { signal: AbortSignal.timeout(MOST_MS) });
  } catch (error) {
    throw new Error(`it cannot be fetched: ${/** @type {Error} */ (error).message}`);
  }
  if (!answer.ok || !answer.body) throw new Error(`the server answers ${answer.status}`);
  const parts = [];
  let length = 0;
  for (const reader = answer.body.getReader(); ; ) {
    const { done, value } = await reader.read().catch((error) => {
      throw new Error(`the download was cut off: ${error.message}`);
    });
    if (done) return new Blob(parts).arrayBuffer();
    parts.push(value);
    length += value.length;
    if (length > MOST_BYTES) {
      void reader.cancel();
      throw new Error(`it is longer than ${MOST_BYTES} bytes`);
    }
  }
}

function textOf(/** @type {ArrayBuffer} */ bytes) {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new Error("it is not UTF-8 text");
  }
}

/** The reason in one line: the TOML parser draws the position and lists all known entries. */
function inShort(/** @type {string} */ why) {
  const [, line, reason] = /^TOML parse error at line (\d+)[^]*\|[^\n]*\n([^]+)/.exec(why) ?? [];
  if (!line) return why;
  const [short, list = ""] = reason.trim().split(/, (?=expected one of)/);
  return `line ${line}: ${list.length < 40 ? reason.trim() : short}`;
}

/**
 * @param {string} address
 * @param {string} what the style, for the user
 */
export async function readStyle(address, what) {
  try {
    const [bytes] = await Promise.all([bytesOf(address), loadModule()]);
    return style_table(address, textOf(bytes));
  } catch (error) {
    const why = typeof error === "string" ? error : /** @type {Error} */ (error).message;
    const short = inShort(why);
    if (short !== why) console.warn(`${what}: ${why}`);
    throw new Error(`${what}: ${short}`);
  }
}
