// The camera in the fragment of the page's address: #lon,lat,distance,heading,pitch, or #NAME=… where a page has several maps. From above with parallel
// rays it is #lon,lat,metres in a pixel,heading,0,above.

const NUMBER = /^[+-]?\d+(\.\d+)?$/;

/**
 * A place as text; `null` where it is none.
 *
 * @param {string | null} text
 * @returns {import("./corniche-map.js").Target | null}
 */
export function placeOf(text) {
  const parts = (text ?? "").split(",").map((part) => part.trim());
  const above = parts.length === 6 && parts[5] === "above";
  if (above) parts.pop();
  if (parts.length < 2 || parts.length > 5 || !parts.every((part) => NUMBER.test(part))) return null;
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

/** The place in a fragment, under a name or, with "", alone. */
export function placeInHash(/** @type {string} */ hash, /** @type {string} */ name) {
  for (const part of partsOf(hash)) {
    if (name === "") {
      const place = placeOf(part);
      if (place) return place;
    } else if (part.startsWith(`${name}=`)) return placeOf(part.slice(name.length + 1));
  }
  return null;
}

/** The fragment with the place in it; parts that belong to others stay. */
export function hashWith(/** @type {string} */ hash, /** @type {string} */ name, /** @type {import("./corniche-map.js").Place} */ place) {
  const others = partsOf(hash).filter((part) => (name === "" ? !placeOf(part) : !part.startsWith(`${name}=`)));
  return "#" + [...others, name === "" ? textOf(place) : `${name}=${textOf(place)}`].join("&");
}
