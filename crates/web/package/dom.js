// Creates elements without markup in strings, so that neither a strict content security policy nor
// a hostile package matters.

const SVG = "http://www.w3.org/2000/svg";

/**
 * An element with properties and children. Names with a dash, and `role`, `for` and `part`, are
 * attributes; `on…` are listeners.
 *
 * @param {string} tag
 * @param {Record<string, any>} [properties]
 * @param {...(Node | string | null | undefined)} children
 * @returns {any}
 */
export function make(tag, properties = {}, ...children) {
  const element = /** @type {any} */ (document.createElement(tag));
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "class") element.className = value;
    else if (name.includes("-") || name === "role" || name === "for" || name === "part") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** A drawing of 24 by 24 units from the data of paths. Screen readers skip it. */
export function drawing(/** @type {string[]} */ ...paths) {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  for (const data of paths) {
    const path = document.createElementNS(SVG, "path");
    path.setAttribute("d", data);
    svg.append(path);
  }
  return svg;
}

/** Sets a text only if it changes: otherwise a live region would be read again, and layout would run again. */
export function setText(/** @type {Element} */ element, /** @type {string} */ text) {
  if (element.textContent !== text) element.textContent = text;
}

/** A text as a sentence: messages of the library begin in lower case and have no full stop. */
export function sentence(/** @type {string} */ text) {
  const whole = text.trim();
  return whole.charAt(0).toUpperCase() + whole.slice(1) + (/[.!?…]$/.test(whole) ? "" : ".");
}

/** Offers data as a file to download. */
export function download(/** @type {Blob} */ data, /** @type {string} */ name) {
  const address = URL.createObjectURL(data);
  make("a", { href: address, download: name }).click();
  // The download begins after the click; the delay is for slow disks.
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Asks the user for a file. */
export function askForFile(/** @type {string} */ accept) {
  return new Promise((resolve) => {
    const input = make("input", { type: "file", accept });
    input.addEventListener("change", () => resolve(input.files[0] ?? null));
    input.addEventListener("cancel", () => resolve(null));
    input.click();
  });
}
