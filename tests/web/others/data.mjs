// The same ground and roads for each map, below FOLDER/site/data: a package, raster DEM tiles, terrain tiles, 3D Tiles, GeoJSON, vector tiles, a recording.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import zlib from "node:zlib";
import { PNG } from "pngjs";

/** The square that the heights are of, or a part of it: west, south, east, north. */
const SQUARE = [9, 47, 10, 48];
const TILE_PX = 512;
/** On the finest zoom a pixel is 52 m wide in Liechtenstein; the samples are 63 × 93 m. */
export const DEM_ZOOMS = { coarsest: 5, finest: 10 };
const ROAD_ZOOMS = { coarsest: 6, finest: 13 };
/** Half the length of the equator in the projection of tiles. */
const HALF_WORLD_M = 20_037_508.342789244;

const run = (program, ...options) => execFileSync(program, options.map(String), { stdio: ["ignore", "pipe", "inherit"], maxBuffer: 1 << 30 });

/** Makes what is not there yet. */
export function makeData({ folder, corniche, heights, extract }) {
  const work = path.join(folder, "work");
  const data = path.join(folder, "site", "data");
  fs.mkdirSync(work, { recursive: true });
  fs.mkdirSync(data, { recursive: true });
  const at = (name) => path.join(data, name);

  const once = (name, make) => {
    if (fs.existsSync(at(name))) return;
    const begun = Date.now();
    fs.rmSync(at(`new-${name}`), { recursive: true, force: true });
    make(at(`new-${name}`));
    fs.renameSync(at(`new-${name}`), at(name));
    console.log(`made ${name} in ${((Date.now() - begun) / 1000).toFixed(1)} s`);
  };

  once("li.pmtiles", (file) => run(corniche, "build", "-q", "--dem", heights, "--dem-vertical-crs", "EPSG:5773", "--osm", extract, "-o", file));
  once("terrain", (to) => run(corniche, "export", "quantized-mesh", at("li.pmtiles"), "-q", "--heights", "as-is", "-o", to));
  once("tiles", (to) => run(corniche, "export", "3dtiles", at("li.pmtiles"), "-q", "--heights", "as-is", "-o", to));
  once("roads.geojson", (file) => makeRoads(corniche, at("li.pmtiles"), extract, work, file));
  once("roads", (to) => {
    run("ogr2ogr", "-q", "-f", "MVT", to, at("roads.geojson"), "-nln", "roads", "-dsco", `MINZOOM=${ROAD_ZOOMS.coarsest}`, "-dsco", `MAXZOOM=${ROAD_ZOOMS.finest}`, "-dsco", "COMPRESS=NO");
  });
  once("dem", (to) => makeDemTiles(heights, work, to));
}

/** A recording for rerun, whose first view is part of it. */
export function makeRecording({ folder, corniche, python, view, height_m }) {
  const at = (name) => path.join(folder, "site", "data", name);
  if (fs.existsSync(at("li.rrd"))) return;
  console.log(String(run(python, fileURLToPath(new URL("recording.py", import.meta.url)), corniche, at("li.pmtiles"), at("li.rrd"), height_m, ...view.split(","))).trim());
}

/** The ways that the package has, as OpenStreetMap draws them, with their class; six decimals, which is a decimetre. */
function makeRoads(corniche, packagePath, extract, work, file) {
  const kept = path.join(work, "kept.csv");
  run(corniche, "export", "roads", packagePath, "-q", "-O", "-o", kept);
  const [head, ...rows] = fs.readFileSync(kept, "utf8").trim().split("\n");
  const columns = head.split(",");
  // Only lines as WKT and names hold commas, and stand in quotes.
  const plain = (row) => row.match(/("[^"]*"|[^,"])+|(?<=,|^)(?=,|$)/g).map((field) => field.replaceAll('"', ""));
  const classes = new Map(rows.map(plain).map((row) => [row[columns.indexOf("way_id")], Number(row[columns.indexOf("class")])]));
  const all = path.join(work, "ways.geojson");
  fs.rmSync(all, { force: true });
  run("ogr2ogr", "-q", "-f", "GeoJSON", all, extract, "lines", "-where", "highway IS NOT NULL", "-lco", "COORDINATE_PRECISION=6", "-select", "osm_id");
  const { features } = JSON.parse(fs.readFileSync(all));
  const roads = features.flatMap(({ properties, geometry }) => {
    const road_class = classes.get(String(properties.osm_id));
    return road_class === undefined ? [] : [{ type: "Feature", properties: { class: road_class }, geometry }];
  });
  console.log(`${roads.length} of ${classes.size} roads of the package`);
  if (roads.length < classes.size * 0.95) throw new Error("roads of the package are missing in the extract");
  fs.writeFileSync(file, JSON.stringify({ type: "FeatureCollection", features: roads }));
}

/** Tiles of 512 pixels in Terrarium's code: metres + 32768 as red · 256 + green, in whole metres as the samples are. Where there are no heights, it is 0. */
function makeDemTiles(heights, work, to) {
  const filled = path.join(work, "filled.tif");
  run("gdal_fillnodata.py", "-q", "-md", "200", heights, filled);
  for (let z = DEM_ZOOMS.coarsest; z <= DEM_ZOOMS.finest; z += 1) {
    const [west, south, east, north] = SQUARE;
    const edge = 1e-9;
    const [x0, y0] = tileAt(west + edge, north - edge, z);
    const [x1, y1] = tileAt(east - edge, south + edge, z);
    const side_m = (2 * HALF_WORLD_M) / 2 ** z;
    const size = [(x1 - x0 + 1) * TILE_PX, (y1 - y0 + 1) * TILE_PX];
    const bounds = [x0 * side_m - HALF_WORLD_M, HALF_WORLD_M - (y1 + 1) * side_m, (x1 + 1) * side_m - HALF_WORLD_M, HALF_WORLD_M - y0 * side_m];
    const raw = path.join(work, `dem-${z}.bin`);
    run("gdalwarp", "-q", "-overwrite", "-t_srs", "EPSG:3857", "-te", ...bounds, "-ts", ...size, "-r", z === DEM_ZOOMS.finest ? "bilinear" : "average", "-dstnodata", "0", "-ot", "Int16", "-of", "ENVI", filled, raw);
    const values = new Int16Array(fs.readFileSync(raw).buffer);
    for (let y = y0; y <= y1; y += 1) {
      for (let x = x0; x <= x1; x += 1) {
        fs.mkdirSync(path.join(to, `${z}/${x}`), { recursive: true });
        fs.writeFileSync(path.join(to, `${z}/${x}/${y}.png`), demTile(values, size[0], (x - x0) * TILE_PX, (y - y0) * TILE_PX));
      }
    }
  }
}

function demTile(values, wide, left, top) {
  const png = new PNG({ width: TILE_PX, height: TILE_PX, colorType: 2 });
  for (let row = 0; row < TILE_PX; row += 1) {
    for (let column = 0; column < TILE_PX; column += 1) {
      const code = values[(top + row) * wide + left + column] + 32768;
      png.data.set([code >> 8, code & 255, 0, 255], 4 * (row * TILE_PX + column));
    }
  }
  return PNG.sync.write(png, { colorType: 2, inputHasAlpha: true, deflateLevel: 9 });
}

function tileAt(lon, lat, z) {
  const angle = (lat * Math.PI) / 180;
  return [((lon + 180) / 360) * 2 ** z, ((1 - Math.asinh(Math.tan(angle)) / Math.PI) / 2) * 2 ** z].map(Math.floor);
}

/** NAME.br beside all files that web servers compress; those that are compressed in themselves go as they are. */
export function compressAll(site) {
  for (const name of fs.readdirSync(site, { recursive: true })) {
    const file = path.join(site, name);
    if (!/\.(html|css|js|mjs|json|geojson|wasm|terrain|pbf)$/.test(name) || fs.existsSync(`${file}.br`) || !fs.statSync(file).isFile()) continue;
    fs.writeFileSync(`${file}.br`, zlib.brotliCompressSync(fs.readFileSync(file)));
  }
}

/** The ground's height where a view looks, metres. */
export function heightAt(heights, view) {
  const [lon, lat] = view.split(",");
  return Number(run("gdallocationinfo", "-valonly", "-wgs84", heights, lon, lat));
}
