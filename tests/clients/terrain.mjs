// Shows terrain tiles in CesiumJS and queries heights: node terrain.mjs FOLDER NAME PACKAGE SITE
// PICTURES
//
// FOLDER has the export NAME-terrain, with the package's heights as they are, and NAME.json, the
// output of `corniche info`.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { covered, extentOf, hideTexts, holes, picture, startBrowser } from "./browser.mjs";
import { fail } from "./files.mjs";

const [folder, name, packagePath, site, pictures] = process.argv.slice(2);
const SIZE = { width: 800, height: 500 };
const PLACES = 500;
/** Azimuth and elevation of the light: so low that each fault of the surface casts a shadow. */
const RAKING = "250,10";
const LEAST_GROUND = 0.5;
/** The tolerance of the root mean square at random points over the reported one, which is computed from many more points. */
const MOST_OF_RMS = 1.25;

const { at, high, across } = extentOf(folder, name);
const layer = JSON.parse(fs.readFileSync(path.join(folder, `${name}-terrain`, "layer.json")));
const { open, close } = await startBrowser(folder, site, SIZE);
const terrain = `/data/${name}-terrain`;
const page = await open(`terrain.html?terrain=${terrain}&background=magenta&sun=${RAKING}`);

const credit = await page.evaluate(() => document.getElementById("credit").textContent);
if (!credit || credit !== layer.attribution) fail(`the page says "${credit}" of whose data it is`);
if (await page.evaluate(() => Cesium.Ion.defaultAccessToken) !== "") fail("the page has a token");
await hideTexts(page);

const views = {
  far: [...at(0.5, -0.6), high + across * 0.5, 0, -30],
  // Packages other than the sample are viewed at Liechtenstein.
  near: name === "pass" ? [...at(0.47, 0.6), high + 300, 20, -20] : [9.515, 47.1, 1400, 15, -12],
  steep: [...at(0.5, 0.5), high + across * 0.4, 0, -88],
};
for (const [view, numbers] of Object.entries(views)) {
  const begin = Date.now();
  const tiles = await page.evaluate(([lon, lat, height, heading, pitch]) => new Promise((done) => {
    const { viewer } = window.corniche;
    viewer.camera.setView({
      destination: Cesium.Cartesian3.fromDegrees(lon, lat, height),
      orientation: { heading: Cesium.Math.toRadians(heading), pitch: Cesium.Math.toRadians(pitch), roll: 0 },
    });
    let idle = 0;
    const stop = viewer.scene.postRender.addEventListener(() => {
      idle = viewer.scene.globe.tilesLoaded ? idle + 1 : 0;
      if (idle < 6) return;
      stop();
      // This is not in Cesium's documentation, but it is the only way to know that the image
      // contains borders.
      const drawn = viewer.scene.globe._surface._tilesToRender;
      done({ drawn: drawn.length, finest: Math.max(...drawn.map((tile) => tile.level)) });
    });
  }), numbers);
  const png = await picture(page, path.join(pictures, `${name}-terrain-${view}.png`));
  const found = holes(png);
  console.log("CesiumJS terrain", name, view, { ms: Date.now() - begin, holes: found, ...tiles });
  // Where a package has voids, the ground continues here, so that holes are never allowed.
  if (found > 0) fail(`${view}: ${found} pixels of holes`);
  if (tiles.drawn < 4) fail(`${view}: only ${tiles.drawn} tiles are drawn, so no border is looked at`);
  if (covered(png) < LEAST_GROUND) fail(`${view}: next to no ground is seen`);
}

// Removed tiles must be detected as holes, otherwise the absence of holes means nothing.
await page.evaluate(([west, south, east, north]) => {
  const { scene } = window.corniche.viewer;
  const positions = Cesium.Cartesian3.fromDegreesArray([west, south, east, south, east, north, west, north]);
  scene.globe.clippingPolygons = new Cesium.ClippingPolygonCollection({ polygons: [new Cesium.ClippingPolygon({ positions })] });
  return new Promise((done) => {
    let frames = 0;
    scene.postRender.addEventListener(() => { if ((frames += 1) === 6) done(); });
  });
}, [...at(0.45, 0.45), ...at(0.55, 0.55)]);
if (holes(await picture(page, path.join(pictures, `${name}-terrain-cut.png`))) < 100) fail("a hole that was cut is not counted");

// Points all over the package, with its own heights. The vertices that `corniche profile` adds
// where lines cross edges are skipped.
let state = 1;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const wanted = Array.from({ length: PLACES }, () => at(random(), random()));
const lines = path.join(folder, `${name}-places.geojson`);
fs.writeFileSync(lines, JSON.stringify({ type: "LineString", coordinates: wanted }));
const list = path.join(folder, `${name}-places.csv`);
execFileSync(process.env.CORNICHE, ["profile", packagePath, "--line", lines, "--csv", list, "-q", "-O"]);
const rows = fs.readFileSync(list, "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
const key = (lon, lat) => `${lon.toFixed(5)},${lat.toFixed(5)}`;
const byPlace = new Map(rows.map(([, , , height, , lon, lat]) => [key(lon, lat), { lon, lat, height }]));
const known = wanted.map(([lon, lat]) => byPlace.get(key(lon, lat))).filter(Boolean);

const heights = await page.evaluate(async (places) => {
  const positions = places.map(({ lon, lat }) => Cesium.Cartographic.fromDegrees(lon, lat));
  const { terrainProvider } = window.corniche.viewer;
  return (await Cesium.sampleTerrainMostDetailed(terrainProvider, positions)).map((position) => position.height);
}, known);
const off = known.map(({ height }, k) => Math.abs(heights[k] - height)).sort((one, other) => one - other);
const told = layer.corniche.levels.at(-1);
const largest = off.at(-1);
const rms = Math.sqrt(off.reduce((sum, one) => sum + one * one, 0) / off.length);
console.log("CesiumJS terrain", name, { places: off.length, largest_m: largest, rms_m: rms, told_m: told.deviation_m, told_rms_m: told.deviation_rms_m });
if (off.length < PLACES / 2) fail(`only ${off.length} of ${PLACES} places have a height in the package`);
if (!(largest <= told.deviation_m)) fail(`a height of Cesium's is ${largest} m from the package's, not ${told.deviation_m}`);
if (!(rms <= told.deviation_rms_m * MOST_OF_RMS)) fail(`heights of Cesium's are ${rms} m (rms) from the package's, not ${told.deviation_rms_m}`);

await page.close();
await close();
