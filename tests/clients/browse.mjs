// Opens the example pages in Chromium: node browse.mjs FOLDER NAME PACKAGE SITE PICTURES
//
// FOLDER has the exports NAME-none and NAME-meshopt and NAME.json, the output of `corniche info`.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { PNG } from "pngjs";
import { extentOf, hideTexts, holes, picture, startBrowser } from "./browser.mjs";
import { fail, filesOf } from "./files.mjs";

const [folder, name, packagePath, site, pictures] = process.argv.slice(2);
/** Other packages take longer, and show the same. */
const ALL_VIEWS = process.env.CORNICHE_ALL_VIEWS === "1";
const isSample = name === "pass";
const SIZE = { width: 1000, height: 700 };

const { manifest, at, high, across } = extentOf(folder, name);
/** Where there is no ground, images have nothing to check. */
const hasVoids = manifest.counts.samples.void > 0;
const { open, close } = await startBrowser(folder, site, SIZE);
const kept = (file) => path.join(pictures, file);
const tileset = `/data/${name}-meshopt/tileset.json`;

/** Longitude, latitude and height of the camera, heading and pitch. Packages other than the sample are viewed at Liechtenstein. */
const all = {
  far: isSample ? [...at(0.5, -0.35), high + across * 0.5, 0, -30] : [9.55, 47.02, 14000, 5, -25],
  near: isSample ? [...at(0.47, 0.66), 1700, 15, -25] : [9.515, 47.1, 1400, 15, -12],
  steep: isSample ? [...at(0.5, 0.5), high + 1500, 0, -89] : [9.53, 47.14, 6000, 0, -89],
};
const views = Object.entries(all).filter(([view]) => ALL_VIEWS || view !== "steep");

function check(client, view, png, triangles) {
  const found = holes(png);
  if (triangles < 100) fail(`${client}, ${view}: next to nothing is drawn`);
  if (found > 0 && !hasVoids) fail(`${client}, ${view}: ${found} pixels of holes`);
  return found;
}

const PICKS = 10;

/** Roads that CesiumJS finds at some pixels in the middle of lines of a mask; a pixel at an edge may belong to a neighbour. */
async function roadsAt(page, mask) {
  const isMiddle = (k) => [0, 1, -1, SIZE.width, -SIZE.width].every((beside) => mask[k + beside]);
  const pixels = [...mask.keys()].filter(isMiddle);
  const asked = Array.from({ length: PICKS }, (_, k) => pixels[Math.floor((pixels.length * k) / PICKS)] ?? 0)
    .map((k) => ({ x: k % SIZE.width, y: Math.floor(k / SIZE.width) }));
  const found = await page.evaluate((asked) => asked.map((pixel) => {
    const road = window.corniche.roadAt(pixel);
    return road && { ...road, way_id: String(road.way_id) };
  }), asked);
  return found.filter((road) => road?.way_id && road.highway);
}

// CesiumJS.
for (const [view, numbers] of views) {
  const page = await open(`cesium.html?tileset=${tileset}&view=${numbers}&background=magenta`);
  await hideTexts(page);
  const begin = Date.now();
  await page.evaluate(() => new Promise((done) => {
    let idle = 0;
    const { viewer, tileset } = window.corniche;
    viewer.scene.postRender.addEventListener(() => {
      idle = tileset.tilesLoaded ? idle + 1 : 0;
      if (idle === 6) done();
    });
  }));
  const png = await picture(page, kept(`${name}-cesium-${view}.png`));
  const statistics = await page.evaluate(() => {
    const { selected, numberOfTrianglesSelected, numberOfTilesWithContentReady } = window.corniche.tileset.statistics;
    return { selected, triangles: numberOfTrianglesSelected, ready: numberOfTilesWithContentReady };
  });
  const found = check("CesiumJS", view, png, statistics.triangles);
  console.log("CesiumJS", name, view, { ms: Date.now() - begin, holes: found, ...statistics });
  if (view === "near") {
    // Only roads have strong colours. Checking all pixels takes minutes.
    const strong = Uint8Array.from({ length: SIZE.width * SIZE.height }, (_, k) => {
      const [red, green, blue] = png.data.subarray(4 * k, 4 * k + 3);
      return Math.max(red, green, blue) - Math.min(red, green, blue) > 120 && blue < 150 ? 1 : 0;
    });
    const picked = await roadsAt(page, strong);
    console.log("  picked", picked.length, picked[0]);
    if (picked.length < PICKS) fail(`only ${picked.length} of ${PICKS} pixels of roads could be picked in CesiumJS`);
  }
  await page.close();
}

// three.js from the same positions.
for (const [view, numbers] of ALL_VIEWS ? views : []) {
  const page = await open(`three.html?tileset=${tileset}&view=${numbers}&background=magenta`);
  await hideTexts(page);
  await page.evaluate(() => {
    const { camera, tiles, renderer } = window.corniche;
    // Cesium's angle, which applies to the longer side.
    camera.fov = (2 * Math.atan(Math.tan(Math.PI / 6) / camera.aspect) * 180) / Math.PI;
    camera.updateProjectionMatrix();
    tiles.setResolutionFromRenderer(camera, renderer);
  });
  await page.waitForFunction(() => {
    const { tiles } = window.corniche;
    const isIdle = tiles.root && tiles.visibleTiles.size > 0 && tiles.stats.downloading === 0 && tiles.stats.parsing === 0 && tiles.stats.queued === 0;
    window.idle = isIdle ? (window.idle ?? 0) + 1 : 0;
    return window.idle > 20;
  }, null, { timeout: 240_000, polling: 100 });
  const png = await picture(page, kept(`${name}-three-${view}.png`));
  const { triangles, tiles } = await page.evaluate(() => {
    const { renderer, tiles } = window.corniche;
    return { triangles: renderer.info.render.triangles, tiles: tiles.visibleTiles.size };
  });
  console.log("three.js", name, view, { holes: check("three.js", view, png, triangles), tiles, triangles });
  await page.close();
}

/** The differences between two images. */
const isDifferent = (one, other, at) => [0, 1, 2].some((k) => Math.abs(one.data[at + k] - other.data[at + k]) > 12);
function mask(one, other) {
  const found = new Uint8Array(one.width * one.height);
  for (let k = 0; k < found.length; k += 1) found[k] = isDifferent(one, other, 4 * k) ? 1 : 0;
  return found;
}

// Roads as vector content, which only CesiumJS supports: they are drawn in the style's colours, and
// can be picked.
{
  const page = await open(`cesium.html?tileset=/data/${name}-vector/tileset.json&roads=/data/${name}-vector/roads/tileset.json&view=${all.near}&background=magenta`);
  await hideTexts(page);
  const begin = Date.now();
  const shot = (areShown, file) => page.evaluate((areShown) => new Promise((done) => {
    const { viewer, tileset, roads } = window.corniche;
    roads.show = areShown;
    let idle = 0;
    const stop = viewer.scene.postRender.addEventListener(() => {
      // Hidden content is not loaded either.
      idle = tileset.tilesLoaded && (roads.tilesLoaded || !areShown) ? idle + 1 : 0;
      if (idle < 6) return;
      stop();
      done();
    });
  }), areShown).then(() => picture(page, kept(file)));
  const png = await shot(true, `${name}-vector.png`);
  const without = await shot(false, `${name}-vector-without.png`);
  await shot(true, `${name}-vector.png`);
  const drawn = mask(png, without);
  const roadPixels = drawn.reduce((sum, one) => sum + one, 0);
  const picked = await roadsAt(page, drawn);
  console.log("CesiumJS vectors", name, { ms: Date.now() - begin, roadPixels, picked: picked.length, such_as: picked[0] });
  if (roadPixels < 1000) fail(`only ${roadPixels} pixels of roads as vectors`);
  if (picked.length < PICKS) fail(`only ${picked.length} of ${PICKS} pixels of roads as vectors could be picked in CesiumJS`);
  await page.close();
}

// Road pixels compared with `corniche render` from the same camera: where an image with roads
// differs from one without.
const LEAST_IOU = 0.85;
/** Flatter views, measured from straight down, show mostly roads thinner than a pixel: corniche widens some and omits others, according to its style. */
const FLATTEST_DEG = 45;
const zone = /^EPSG:32[67](\d\d)$/.exec(manifest.crs);
/** Packages whose north is that of a UTM grid. */
const meridian = zone ? 6 * Number(zone[1]) - 183 : null;
const looks = isSample ? [[9.47, 46.938, 1000, 2500, 10], [9.47, 46.938, 1000, 2500, 35]] : [[9.5215, 47.139, 460, 1500, 30], [9.5215, 47.139, 460, 2500, 60]];
for (const [number, [lon, lat, height, distance, pitch]] of (ALL_VIEWS ? looks : looks.slice(1)).entries()) {
  const file = (kind) => kept(`${name}-same-${number}-${kind}.png`);
  for (const roads of ["sv", "none"]) {
    execFileSync(process.env.CORNICHE, ["render", packagePath, "-q", "-O", "-o", file(roads), "--roads", roads,
      "--look-at", `${lon},${lat}`, "--height", height, "--distance", distance, "--pitch", pitch,
      "--size", `${SIZE.width}x${SIZE.height}`, "--outline", "none", "--width-growth", "none"]);
  }
  // Directions of corniche are those of its grid.
  const heading = meridian === null ? 0 : (lon - meridian) * Math.sin((lat * Math.PI) / 180);
  const shots = [];
  for (const kind of ["meshopt", "bare"]) {
    const page = await open(`cesium.html?tileset=/data/${name}-${kind}/tileset.json&view=${lon},${lat},9000,0,-90`);
    await hideTexts(page);
    await page.evaluate(([lon, lat, height, heading, distance, pitch, aspect]) => new Promise((done) => {
      const { viewer, tileset } = window.corniche;
      const frustum = viewer.camera.frustum;
      // corniche's images cover 45 degrees vertically; Cesium's angle applies to the longer side.
      frustum.fov = 2 * Math.atan(Math.tan(Math.PI / 8) * aspect);
      viewer.camera.lookAt(Cesium.Cartesian3.fromDegrees(lon, lat, height),
        new Cesium.HeadingPitchRange(Cesium.Math.toRadians(heading), Cesium.Math.toRadians(pitch - 90), distance));
      let idle = 0;
      viewer.scene.postRender.addEventListener(() => {
        idle = tileset.tilesLoaded ? idle + 1 : 0;
        if (idle === 6) done();
      });
    }), [lon, lat, height, heading, distance, pitch, SIZE.width / SIZE.height]);
    shots.push(await picture(page, kept(`${name}-same-${number}-${kind}.png`)));
    await page.close();
  }
  const read = (kind) => PNG.sync.read(fs.readFileSync(file(kind)));
  const [ours, theirs] = [mask(read("sv"), read("none")), mask(...shots)];
  let [both, either] = [0, 0];
  for (let k = 0; k < ours.length; k += 1) {
    both += ours[k] & theirs[k];
    either += ours[k] | theirs[k];
  }
  const iou = both / either;
  console.log("CesiumJS against corniche render", name, { distance, pitch, roadPixels: either, iou: Number(iou.toFixed(4)) });
  // Degrees are true to scale on one parallel only, so elsewhere corniche's own image is stretched,
  // by 1 % in Liechtenstein.
  if (zone && pitch <= FLATTEST_DEG && !(iou > LEAST_IOU)) fail(`roads of Cesium and of corniche differ: ${iou}`);
}

// three.js, with a plugin that checks that boxes contain their contents.
{
  const page = await open(`three.html?tileset=${tileset}&background=magenta`, async (page) => {
    // No tile is loaded before the plugin is registered.
    let release;
    const isReleased = new Promise((done) => { release = done; });
    await page.exposeFunction("releaseTiles", release);
    await page.route("**/*.glb", async (route) => { await isReleased; await route.continue(); });
  });
  const warnings = [];
  page.on("console", (message) => { if (message.type() === "warning") warnings.push(message.text()); });
  await page.evaluate(async () => {
    const { TilesetValidationPlugin } = await import("/node_modules/3d-tiles-renderer/src/three/plugins/TilesetValidationPlugin.js");
    const { tiles, renderer, camera, controls } = window.corniche;
    window.seen = new Set();
    class Counting extends TilesetValidationPlugin {
      _validateTile(scene, tile) {
        window.seen.add(tile);
        super._validateTile(scene, tile);
      }
    }
    tiles.registerPlugin(new Counting());
    // Every tile is loaded, down to the finest, and nothing is drawn meanwhile, because drawing is
    // slow without a GPU. From afar all tiles are in view.
    tiles.errorTarget = 0;
    tiles.lruCache.maxBytesSize = Infinity;
    let isMoved = false;
    renderer.setAnimationLoop(() => {
      if (tiles.root && !isMoved && controls.target.lengthSq() > 0) {
        window.eye = camera.position.clone();
        camera.position.sub(controls.target).multiplyScalar(4).add(controls.target);
        camera.far *= 10;
        camera.updateProjectionMatrix();
        camera.updateMatrixWorld();
        isMoved = true;
      }
      tiles.update();
    });
    await window.releaseTiles();
  });
  await hideTexts(page);
  await page.waitForFunction(() => {
    const { tiles } = window.corniche;
    const isIdle = tiles.root && tiles.stats.downloading === 0 && tiles.stats.parsing === 0 && tiles.stats.queued === 0;
    window.idle = isIdle ? (window.idle ?? 0) + 1 : 0;
    return window.idle > 20;
  }, null, { timeout: 240_000, polling: 100 });
  const { seen, road } = await page.evaluate(() => {
    const { renderer, scene, camera, roadAt } = window.corniche;
    camera.position.copy(window.eye);
    renderer.setAnimationLoop(() => renderer.render(scene, camera));
    renderer.render(scene, camera);
    for (let y = -0.9; y < 0.5; y += 0.01) {
      for (let x = -0.9; x < 0.9; x += 0.02) {
        const road = roadAt(x, y);
        if (road) return { seen: window.seen.size, road: { ...road, way_id: String(road.way_id) } };
      }
    }
    return { seen: window.seen.size, road: null };
  });
  await picture(page, kept(`${name}-three.png`));
  const tiles = filesOf(path.join(folder, `${name}-meshopt`), ".glb").length;
  const complaints = warnings.filter((text) => /Validation|bounding|outside/i.test(text));
  console.log("three.js", name, { seen, tiles, complaints: complaints.length, picked: road });
  if (seen !== tiles) fail(`the validation plugin saw ${seen} of ${tiles} tiles`);
  if (complaints.length) fail(complaints[0]);
  if (!road?.way_id) fail("no road could be picked in three.js");
  await page.close();
}

await close();
