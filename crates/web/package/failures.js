// Shows failures in place of the map, with a still image of the package if there is one.
import { make, sentence } from "./dom.js";
import { icons } from "./icons.js";

/** @type {Record<string, string>} */
const HEADINGS = {
  "no-webgpu": "This browser cannot draw the map",
  "no-adapter": "No GPU for the map",
  limits: "The GPU is too limited",
  network: "The map cannot be loaded",
  "not-found": "There is no map at this address",
  cors: "The server does not let this page read the map",
  "no-ranges": "The server does not support range requests",
  compressed: "The server compresses the map",
  changed: "The map has changed",
  damaged: "The map's file is corrupt",
  foreign: "This file is not a Corniche map",
  "old-format": "The map's format is too old",
  "no-ground": "The map has no ground",
  "off-ground": "The place is not on the map",
  "out-of-memory": "The graphics memory is full",
  "device-lost": "The graphics device was lost",
  files: "The map's program cannot be loaded",
  "no-source": "No map is given",
  other: "The map cannot be shown",
};

/** Failures for which a still image helps: the view could be drawn elsewhere. */
const WITH_PICTURE = new Set(["no-webgpu", "no-adapter", "limits", "files", "device-lost", "out-of-memory"]);

/** Images that may be next to a package, the likeliest first. */
export function stillsOf(/** @type {string | null} */ still, /** @type {string} */ src) {
  if (still) return [still];
  if (!src || /^(blob|data):/.test(src) || !URL.canParse(src, document.baseURI)) return [];
  const address = new URL(src, document.baseURI);
  const path = address.pathname;
  return ["png", "jpg"].flatMap((ending) => {
    const names = [path.replace(/\.pmtiles$/, `.${ending}`), `${path}.${ending}`];
    return [...new Set(names)].filter((name) => name !== path).map((name) => new URL(name, address).href);
  });
}

/** An address without user name, password, query and fragment, which may contain secrets. */
export function shownAddress(/** @type {string} */ src) {
  if (/^(blob|data):/.test(src) || !URL.canParse(src, document.baseURI)) return "";
  const { origin, host, protocol, pathname, search } = new URL(src, document.baseURI);
  const server = origin === "null" ? `${protocol}//${host}` : origin;
  return server + pathname + (search ? "?…" : "");
}

/** Shows the first image that exists. */
function tryStills(/** @type {HTMLImageElement} */ image, /** @type {string[]} */ addresses) {
  const [first, ...rest] = addresses;
  if (!first) return;
  image.onerror = () => tryStills(image, rest);
  image.onload = () => {
    image.hidden = false;
  };
  image.src = first;
}

/**
 * @param {import("./engine.js").Failure} failure
 * @param {{ src: string, still: string | null, credit: string, again: () => void }} about
 */
export function makeFailure(failure, about) {
  const image = make("img", { class: "still", alt: "An image of the map", hidden: true });
  if (WITH_PICTURE.has(failure.kind)) tryStills(image, stillsOf(about.still, about.src));
  const credit = make("p", { class: "still-credit pill" }, about.credit);
  const shown = about.src ? shownAddress(about.src) : "";
  const card = make(
    "div",
    { class: "card failure", role: "alert" },
    make("h2", {}, icons.warning(), HEADINGS[failure.kind] ?? HEADINGS.other),
    make("p", {}, sentence(failure.message)),
    failure.advice ? make("p", { class: "advice" }, sentence(failure.advice)) : null,
    shown ? make("p", { class: "address" }, shown) : null,
    make("button", { type: "button", class: "plain", onclick: about.again }, "Try again"),
  );
  return make("div", { class: "failed", "data-kind": failure.kind }, image, credit, card);
}
