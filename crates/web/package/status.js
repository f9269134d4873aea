// The line below the map: the place under the pointer, the direction of the camera, tiles being
// loaded.
import { make, setText } from "./dom.js";
import { lengthText } from "./scalebar.js";

/** Degrees with five decimals: about a metre. */
export function coordinatesText(/** @type {{ lon: number, lat: number }} */ place) {
  const side = (/** @type {number} */ value, /** @type {string} */ positive, /** @type {string} */ negative) =>
    `${Math.abs(value).toFixed(5)}° ${value < 0 ? negative : positive}`;
  return `${side(place.lat, "N", "S")}, ${side(place.lon, "E", "W")}`;
}

const heightText = (/** @type {number | undefined} */ height) => (height === undefined || height === null ? "" : `${Math.round(height)} m`);

function cameraText(/** @type {import("./corniche-map.js").Place} */ view) {
  const heading = `heading ${((Math.round(view.heading) % 360) + 360) % 360}°`;
  if (view.above || view.distance === undefined) return `from above, ${heading}`;
  return `${lengthText(+view.distance.toPrecision(3))} away, ${heading}, pitch ${Math.round(view.pitch)}°`;
}

export function makeStatus() {
  const place = make("span", { class: "place" });
  const camera = make("span", { class: "camera" });
  const loading = make("span", { class: "loading" });
  return {
    element: make("div", { class: "status" }, place, camera, loading),
    /** @param {import("./corniche-map.js").FrameReport} report */
    show(report) {
      const { view, cursor, tiles } = report;
      setText(place, cursor ? `${coordinatesText(cursor)}  ${heightText(cursor.height)}` : "");
      setText(camera, view ? cameraText(view) : "");
      const rest = tiles.loading + tiles.missing;
      setText(loading, rest > 0 ? `${rest} ${rest === 1 ? "tile" : "tiles"} loading` : "");
    },
  };
}
