// Code that the pages share.

/**
 * The query of the address: ?tileset=URL, with ?roads=URL for roads as a second tileset, or ?terrain=URL, and for images
 * ?view=lon,lat,height,heading,pitch, ?background=COLOUR and ?sun=azimuth,elevation.
 */
export function options() {
  const asked = new URLSearchParams(location.search);
  return {
    tilesetUrl: asked.get("tileset") ?? "tiles/tileset.json",
    roadsUrl: asked.get("roads"),
    terrainUrl: asked.get("terrain") ?? "terrain",
    sun: asked.get("sun")?.split(",").map(Number),
    view: asked.get("view")?.split(",").map(Number),
    background: asked.get("background"),
  };
}

/** The attribution of the data, which must be displayed with the tiles. */
export async function attribution(tilesetUrl) {
  const { asset } = await (await fetch(tilesetUrl)).json();
  return asset.copyright ?? "";
}

/** A road in words. */
export function described(road) {
  if (!road) return "No road there.";
  const name = [road.name, road.ref].filter(Boolean).join(", ") || "without a name";
  const structure = road.structure ? `, ${road.structure}` : "";
  return `${name}: ${road.highway}, class ${road.class}${structure} (OpenStreetMap way ${road.way_id})`;
}
