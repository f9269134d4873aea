//! The JSON document of `corniche tile`.

use corniche_roads::Oneway;
use corniche_tileset::RoadRecord;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use super::{layers::TileLayerDocument, spans::TileSpanDocument};

/// A list whose items are computed one by one during serialization: all of them together would need
/// several times the memory of the tile.
pub(crate) struct StreamedList<'a, Item> {
    count: usize,
    item: Box<dyn Fn(usize) -> Item + 'a>,
}

impl<'a, Item> StreamedList<'a, Item> {
    /// Creates a list that converts each element of a slice to an item.
    pub(crate) fn from_slice<T>(all: &'a [T], item: impl Fn(&'a T) -> Item + 'a) -> Self {
        Self { count: all.len(), item: Box::new(move |index| item(&all[index])) }
    }
}

impl<Item: Serialize> Serialize for StreamedList<'_, Item> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.count).map(&self.item))
    }
}

/// A decoded tile.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TileDocument<'a> {
    /// Id of the tile, "z/x/y": level, column from the west, row from the north.
    pub id: String,
    /// CRS of the package.
    pub crs: String,
    /// The coordinates x and y: "working" metres, or coordinates of the package's "crs".
    pub coordinates: &'static str,
    /// Working metres per unit of the CRS's coordinates, east and north.
    pub metres_per_unit: [f64; 2],
    /// Smallest x and y, largest x and y.
    pub bounds: [f64; 4],
    /// Cell size of the level, east and north, working metres.
    pub cell_m: [f64; 2],
    /// Meshing tolerance of the level, at the nodes of the level's own grid.
    pub max_error_m: Option<f64>,
    /// Error of this tile at the nodes of the finest level; null if the tile has no ground.
    pub geometric_error_m: Option<f64>,
    /// Heights of the lowest and the highest node of the finest level within the tile; null if the
    /// tile has no ground.
    pub height_range_m: Option<[f64; 2]>,
    /// Number of nodes of the finest level within the tile that have a height but no triangle; null
    /// if the tile has no ground.
    pub uncovered_nodes: Option<u64>,
    /// The terrain.
    pub tin: TinDocument,
    /// Roads as geometry on the triangles (GEO).
    pub roads_geo: Vec<GeoRoadDocument>,
    /// Roads as plan lines for shadow volumes (SV).
    #[schemars(with = "Vec<SvRoadDocument>")]
    pub roads_sv: StreamedList<'a, SvRoadDocument>,
    /// Attributes of each OSM way in the tile, sorted by id.
    #[schemars(with = "Vec<WayDocument>")]
    pub attributes: StreamedList<'a, WayDocument>,
    /// The objects of layers in or near the tile; layers without any are omitted.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<TileLayerDocument>,
    /// Stretches of bridges above the ground, and of tunnels below it; omitted if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spans: Vec<TileSpanDocument>,
}

/// The triangles of the terrain (TIN).
#[derive(Default, Serialize, JsonSchema)]
pub(crate) struct TinDocument {
    /// Position (x, y and height in metres) of each vertex.
    pub vertices: Vec<[f64; 3]>,
    /// Unit normal of the DEM at each vertex, in working axes: east, north, up. Stored in steps of
    /// 1/127.
    pub normals: Vec<[f64; 3]>,
    /// Indices of the three vertices of each triangle, counter-clockwise from above in working
    /// metres.
    pub triangles: Vec<[u32; 3]>,
}

/// A piece of a road on the triangles.
#[derive(Serialize, JsonSchema)]
pub(crate) struct GeoRoadDocument {
    /// OSM id of the way.
    pub way_id: i64,
    /// Index of this piece along the OSM way within the tile, from 0.
    pub part: u32,
    /// Functional road class (FRC).
    pub frc: u8,
    /// Position (x, y and height in metres) of each point.
    pub line: Vec<[f64; 3]>,
}

/// A piece of a road in plan.
#[derive(Serialize, JsonSchema)]
pub(crate) struct SvRoadDocument {
    /// OSM id of the way.
    pub way_id: i64,
    /// Index of this piece along the OSM way within the tile, from 0.
    pub part: u32,
    /// Functional road class (FRC).
    pub frc: u8,
    /// Position (x and y) of each point.
    pub line: Vec<[f64; 2]>,
    /// Lowest and highest ground near each segment.
    pub ground_range_m: Vec<[f64; 2]>,
}

/// The attributes of an OSM way. Invalid values of tags are null.
#[derive(Serialize, JsonSchema)]
pub(crate) struct WayDocument {
    /// OSM id of the way.
    way_id: i64,
    /// Form of the road: `ordinary`, `dual_carriageway`, `link` or `roundabout`.
    form: &'static str,
    /// Structure that carries the road: "ground", "bridge" or "tunnel".
    structure: &'static str,
    /// OSM's `layer`.
    layer: i8,
    /// Permitted direction along the OSM way: "no" (both), "forward" or "backward".
    oneway: &'static str,
    /// OSM's `name`; null if untagged.
    name: Option<String>,
    /// OSM's `ref`; null if untagged.
    #[serde(rename = "ref")]
    reference: Option<String>,
    /// OSM's `surface`; null if untagged.
    surface: Option<String>,
    /// OSM's `highway`; null in packages without this value.
    highway: Option<String>,
    /// OSM's `lanes`, of both directions together; null if untagged.
    lanes: Option<u8>,
    /// OSM's `width`, metres; null if untagged.
    width_m: Option<f64>,
    /// OSM's `maxspeed`: a number means km/h, "30 mph" miles per hour; other values are as tagged;
    /// null if untagged.
    maxspeed: Option<String>,
    /// OSM's `sac_scale`; null if untagged.
    sac_scale: Option<String>,
    /// OSM's `tracktype`; null if untagged.
    tracktype: Option<String>,
}

impl From<&RoadRecord> for WayDocument {
    fn from(record: &RoadRecord) -> Self {
        let attributes = &record.attributes;
        let text = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        Self {
            way_id: record.way_id,
            form: attributes.form.name(),
            structure: attributes.structure.name(),
            layer: attributes.layer,
            oneway: match attributes.oneway {
                Oneway::No => "no",
                Oneway::Forward => "forward",
                Oneway::Backward => "backward",
            },
            name: text(&attributes.name),
            reference: text(&attributes.reference),
            surface: text(&attributes.surface),
            highway: text(&attributes.highway),
            lanes: attributes.lanes.map(std::num::NonZeroU8::get),
            width_m: attributes.width_m(),
            maxspeed: text(&attributes.max_speed),
            sac_scale: text(&attributes.sac_scale),
            tracktype: text(&attributes.tracktype),
        }
    }
}

/// The unit vector of an octahedron code, in steps of 1/127; it points upwards.
///
/// Source: Meyer et al. 2010, *On Floating-Point Normal Vectors*, section 3.
pub(crate) fn normal([u, v]: [i8; 2]) -> [f64; 3] {
    let [x, y] = [u, v].map(|step| f64::from(step) / 127.0);
    let z = (1.0 - x.abs() - y.abs()).max(0.0);
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|side| side / length)
}

#[cfg(test)]
#[path = "tile_tests.rs"]
mod tests;
