// Custom styles: files in TOML, named by their addresses. Their reader is fetched with the first
// one.

/** Bundled styles have names; addresses contain a slash or end in .toml. */
export const isAddress = (/** @type {unknown} */ style) => typeof style === "string" && /\/|\.toml(\?.*)?$/i.test(style);

/** The name of a style's file, for the user. */
export function fileOf(/** @type {string} */ address) {
  const name = address.replace(/[?#].*/, "").split("/").pop() || address;
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

/**
 * Fetches and checks a style: a table for the renderer. Throws an error with the file and the
 * reason.
 *
 * @param {string} address
 * @returns {Promise<Uint8Array>}
 */
export async function readStyle(address) {
  const what = `style ${fileOf(address)}`;
  const reader = await import("./style_reader.js").catch((error) => {
    console.warn(error);
    throw new Error(`${what}: style_reader.js of corniche-map is missing`);
  });
  return reader.readStyle(address, what);
}
