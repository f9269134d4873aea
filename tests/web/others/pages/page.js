// What the pages of the others have in common.

const asked = new URLSearchParams(location.search);
const [lon, lat, distance, heading, pitch] = asked.get("view").split(",").map(Number);
/** The place looked at with its height, metres from there to the eye, and degrees: heading from north, pitch from straight down, and from the bottom to the top of the picture. */
export const view = { lon, lat, height: Number(asked.get("height")), distance, heading, pitch, fov: 45 };
export const roads = asked.get("roads");
/** Where the data lies: a folder that is not there shows what a map does without it. */
export const data = `${location.origin}/${asked.get("data") ?? "data"}`;

/** Colours and widths in pixels of the classes of roads, from motorways to paths. */
export const ROADS = [
  ["#d9603b", 3],
  ["#e08a3c", 2.5],
  ["#e6b04a", 2.5],
  ["#ecd06a", 2],
  ["#f5efc8", 1.5],
  ["#ffffff", 1.5],
  ["#ffffff", 1],
  ["#ffffff", 1],
  ["#b58a63", 1],
];
/** Colours of the ground by height in metres. */
export const HEIGHTS = [
  [400, "#a9c18f"],
  [800, "#c3cf9f"],
  [1500, "#d8d3ab"],
  [2200, "#cbb999"],
  [3000, "#ece8e2"],
];

/** Told to the script that measures: the first frame with ground was handed to the renderer, and all is there. */
export const tell = (what) => (window.others.told[what] ??= performance.now());
