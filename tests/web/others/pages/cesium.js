// CesiumJS with terrain tiles and roads of GeoJSON laid on them, or with 3D Tiles that hold both.
import { HEIGHTS, ROADS, data, roads, tell, view } from "./page.js";

const PLAIN = {
  baseLayer: false, skyBox: false, skyAtmosphere: false, baseLayerPicker: false, geocoder: false, animation: false, timeline: false, homeButton: false,
  sceneModePicker: false, navigationHelpButton: false, fullscreenButton: false, infoBox: false, selectionIndicator: false,
  // Frames only when something is new: the processor draws here, and what it draws in vain would delay what is measured.
  requestRenderMode: true,
};

/** @param Cesium the library, as one object */
export async function show(Cesium) {
  // Nothing is asked of any other server.
  Cesium.Ion.defaultAccessToken = "";
  const viewer = new Cesium.Viewer("map", { ...PLAIN, globe: roads === "cut" ? false : undefined });
  window.viewer = viewer;
  const { scene } = viewer;
  scene.backgroundColor = Cesium.Color.fromCssColorString("#dfe6e9");
  if (scene.sun) scene.sun.show = false;
  if (scene.moon) scene.moon.show = false;
  const { lon, lat, height, distance, heading, pitch, fov } = view;
  const middle = Cesium.Cartesian3.fromDegrees(lon, lat, height);
  const radians = Cesium.Math.toRadians;
  // Its angle is that of the longer side.
  viewer.camera.frustum.fov = 2 * Math.atan(Math.tan(radians(fov) / 2) * (innerWidth / innerHeight));
  viewer.camera.lookAt(middle, new Cesium.HeadingPitchRange(radians(heading), radians(pitch - 90), distance));
  viewer.camera.lookAtTransform(Cesium.Matrix4.IDENTITY);
  // Light from the north-west, 30° above the horizon.
  const away = Cesium.Cartesian3.normalize(new Cesium.Cartesian3(1, -1, -0.8), new Cesium.Cartesian3());
  scene.light = new Cesium.DirectionalLight({
    direction: Cesium.Matrix4.multiplyByPointAsVector(Cesium.Transforms.eastNorthUpToFixedFrame(middle), away, new Cesium.Cartesian3()),
    intensity: 2,
  });
  const [hasGround, isWhole] = roads === "cut" ? await showTiles(Cesium, viewer) : await showTerrain(Cesium, viewer);
  scene.postRender.addEventListener(() => hasGround() && tell("handed"));
  // In frames on demand, some states are only seen in the next frame.
  let idle = 0;
  const timer = setInterval(() => {
    idle = isWhole() ? idle + 1 : 0;
    if (idle < 3) return scene.requestRender();
    clearInterval(timer);
    tell("whole");
  }, 200);
}

async function showTiles(Cesium, viewer) {
  const tileset = await Cesium.Cesium3DTileset.fromUrl(`${data}/tiles/tileset.json`, { maximumScreenSpaceError: 2, showCreditsOnScreen: true });
  viewer.scene.primitives.add(tileset);
  return [() => tileset.statistics.numberOfTrianglesSelected > 1000, () => tileset.tilesLoaded && tileset.statistics.numberOfTrianglesSelected > 1000];
}

async function showTerrain(Cesium, viewer) {
  const { globe } = viewer.scene;
  globe.showGroundAtmosphere = false;
  globe.enableLighting = true;
  const ramp = document.createElement("canvas");
  const lowest = HEIGHTS[0][0];
  const highest = HEIGHTS.at(-1)[0];
  ramp.width = 256;
  ramp.height = 1;
  const paint = ramp.getContext("2d");
  const colours = paint.createLinearGradient(0, 0, 256, 0);
  for (const [height, colour] of HEIGHTS) colours.addColorStop((height - lowest) / (highest - lowest), colour);
  paint.fillStyle = colours;
  paint.fillRect(0, 0, 256, 1);
  globe.material = Cesium.Material.fromType("ElevationRamp", { image: ramp, minimumHeight: lowest, maximumHeight: highest });
  let are_roads_there = false;
  const lines = Cesium.GeoJsonDataSource.load(`${data}/roads.geojson`, { clampToGround: true, credit: "© OpenStreetMap contributors" }).then((source) => {
    for (const { polyline, properties } of source.entities.values) {
      const [colour, width] = ROADS[properties.class.getValue()] ?? ROADS.at(-1);
      polyline.material = Cesium.Color.fromCssColorString(colour);
      polyline.width = width;
    }
    are_roads_there = true;
    return viewer.dataSources.add(source);
  });
  viewer.terrainProvider = await Cesium.CesiumTerrainProvider.fromUrl(`${data}/terrain`, { requestVertexNormals: true });
  void lines;
  // Not in its documents, but the only way to know which tiles a frame has. Level 7 has tiles of 1.4°.
  const drawn = () => globe._surface._tilesToRender.filter((tile) => tile.level >= 7 && tile.data?.renderedMesh);
  return [() => drawn().length > 0, () => are_roads_there && globe.tilesLoaded && viewer.dataSourceDisplay.ready && drawn().length > 0];
}
