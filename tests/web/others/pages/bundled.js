// What the page takes of CesiumJS, so that a bundler can leave out the rest.
import {
  Cartesian3, CesiumTerrainProvider, Cesium3DTileset, Color, DirectionalLight, GeoJsonDataSource, HeadingPitchRange, Ion, Material, Math, Matrix4, Transforms, Viewer,
} from "cesium";
import { show } from "./cesium.js";

await show({
  Cartesian3, CesiumTerrainProvider, Cesium3DTileset, Color, DirectionalLight, GeoJsonDataSource, HeadingPitchRange, Ion, Material, Math, Matrix4, Transforms, Viewer,
});
