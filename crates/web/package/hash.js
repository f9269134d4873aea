// The camera in the fragment of the page's address: #lon,lat,distance,heading,pitch, or #NAME=… if
// a page has several maps. From above with parallel rays it is #lon,lat,metres per
// pixel,heading,0,above. The user's changes follow after semicolons:
// #9.52,47.14,6000,30,60;roads=sv

const NUMBER = /^[+-]?\d+(\.\d+)?$/;

/**
 * Parses a place; returns `null` if the text is not a place.
 *
 * @param {string | null} text
 * @returns {import("./corniche-map.js").Target | null}
 */
export function placeOf(text) {
  const parts = (text ?? "").split(",").map((part) => part.trim());
  const above = parts.length === 6 && parts[5] === "above";
  if (above) parts.pop();
  if (parts.length < 2 || parts.length > 5 || !parts.every((part) => NUMBER.test(part) && Number.isFinite(Number(part)))) return null;
  const [lon, lat, distance, heading, pitch] = parts.map(Number);
  if (Math.abs(lon) > 180 || Math.abs(lat) > 90) return null;
  /** @type {any} */
  const place = { lon, lat };
  if (distance !== undefined) place[above ? "pixel_m" : "distance"] = distance;
  if (heading !== undefined) place.heading = heading;
  if (pitch !== undefined) place.pitch = pitch;
  if (above) return { ...place, pitch: 0, above: true };
  return place;
}

/** @param {import("./corniche-map.js").Place} place */
export function textOf(place) {
  const rounded = (/** @type {number | undefined} */ value, /** @type {number} */ digits) => +(value ?? 0).toFixed(digits);
  const metres = (place.above ? place.pixel_m : place.distance) ?? 0;
  const parts = [
    rounded(place.lon, 6),
    rounded(place.lat, 6),
    rounded(metres, metres < 100 ? 4 : 0),
    rounded(place.heading, 1),
    rounded(place.pitch, 1),
  ];
  return parts.join(",") + (place.above ? ",above" : "");
}

const partsOf = (/** @type {string} */ hash) => hash.replace(/^#/, "").split("&").filter(Boolean);

/** The map's own part of a fragment: under its name or, with "", the first that is a place; `null` if there is none. */
export function partInHash(/** @type {string} */ hash, /** @type {string} */ name) {
  const part = partsOf(hash).find((one) => (name === "" ? placeOf(placeText(one)) : one.startsWith(`${name}=`)));
  return part === undefined ? null : part.slice(name === "" ? 0 : name.length + 1);
}

/** Splits a part into the place and the changes. */
const placeText = (/** @type {string} */ part) => part.split(";", 1)[0];
export const changesAfter = (/** @type {string} */ part) => part.slice(placeText(part).length + 1);

/** The place in the map's own part. */
export const placeBefore = (/** @type {string | null} */ part) => (part === null ? null : placeOf(placeText(part)));

/**
 * The fragment with the place and changes of settings as text; parts of others are preserved.
 *
 * @param {string} hash
 * @param {string} name
 * @param {import("./corniche-map.js").Place} place
 */
export function hashWith(hash, name, place, changes = "") {
  const others = partsOf(hash).filter((part) => (name === "" ? !placeOf(placeText(part)) : !part.startsWith(`${name}=`)));
  const own = [textOf(place), changes].filter(Boolean).join(";");
  return "#" + [...others, name === "" ? own : `${name}=${own}`].join("&");
}
