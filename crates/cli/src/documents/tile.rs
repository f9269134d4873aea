//! The JSON document of `corniche tile`.

use corniche_roads::Oneway;
use corniche_tileset::RoadRecord;
use serde::{Serialize, Serializer};

use super::{areas::TileAreaDocument, lines::TileBoundaryDocument, spans::TileSpanDocument};

/// A list whose items are made one after the other while it is written: together they would take several times the memory of the tile.
pub(crate) struct Written<'a, Item> {
    count: usize,
    item: Box<dyn Fn(usize) -> Item + 'a>,
}

impl<'a, Item> Written<'a, Item> {
    /// Each of these as an item.
    pub(crate) fn of<T>(all: &'a [T], item: impl Fn(&'a T) -> Item + 'a) -> Self {
        Self { count: all.len(), item: Box::new(move |index| item(&all[index])) }
    }
}

impl<Item: Serialize> Serialize for Written<'_, Item> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.count).map(&self.item))
    }
}

/// A tile, decoded.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileDocument<'a> {
    /// Level, column from the west, row from the north: "z/x/y".
    pub(crate) id: String,
    /// CRS of the package.
    pub(crate) crs: String,
    /// What x and y are: "working" metres, or coordinates of the package's "crs".
    pub(crate) coordinates: &'static str,
    /// Working metres to a unit of the CRS's coordinates, east and north.
    pub(crate) metres_per_unit: [f64; 2],
    /// Smallest x and y, largest x and y.
    pub(crate) bounds: [f64; 4],
    /// Spacing of the level's nodes, east and north, working metres.
    pub(crate) cell_m: [f64; 2],
    /// Meshing tolerance of the level.
    pub(crate) max_error_m: Option<f64>,
    /// Error of drawing this tile instead of the full-resolution DEM; null without ground.
    pub(crate) geometric_error_m: Option<f64>,
    /// Heights of the lowest and the highest full-resolution node beneath the tile; null without ground.
    pub(crate) height_range_m: Option<[f64; 2]>,
    /// Full-resolution nodes with data beneath that the triangles do not cover; null without ground.
    pub(crate) uncovered_nodes: Option<u64>,
    /// The ground.
    pub(crate) tin: TinDocument,
    /// Roads as geometry, on the triangles.
    pub(crate) roads_geo: Vec<GeoRoadDocument>,
    /// Roads as plan lines, for shadow volumes.
    #[cfg_attr(test, schemars(with = "Vec<SvRoadDocument>"))]
    pub(crate) roads_sv: Written<'a, SvRoadDocument>,
    /// What is known of each way that occurs in the tile, sorted by way id.
    #[cfg_attr(test, schemars(with = "Vec<WayDocument>"))]
    pub(crate) attributes: Written<'a, WayDocument>,
    /// Parts of areas that lie in the tile; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) areas: Vec<TileAreaDocument>,
    /// Parts of boundaries near the tile; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) boundaries: Vec<TileBoundaryDocument>,
    /// Stretches of bridges that are above the ground, and of tunnels that are below; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) spans: Vec<TileSpanDocument>,
}

/// Triangles of the ground.
#[derive(Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TinDocument {
    /// x, y and height in metres of each vertex.
    pub(crate) vertices: Vec<[f64; 3]>,
    /// Unit normal of the DEM at each vertex, in working axes: east, north, up. Stored in steps of 1/127.
    pub(crate) normals: Vec<[f64; 3]>,
    /// Three vertices of each triangle, counter-clockwise seen from above in working metres.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// A piece of a road on the triangles.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct GeoRoadDocument {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// Number of this piece along the way within the tile, from 0.
    pub(crate) part: u32,
    /// Functional road class.
    pub(crate) frc: u8,
    /// x, y and height in metres of each point.
    pub(crate) line: Vec<[f64; 3]>,
}

/// A piece of a road in plan.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SvRoadDocument {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// Number of this piece along the way within the tile, from 0.
    pub(crate) part: u32,
    /// Functional road class.
    pub(crate) frc: u8,
    /// x and y of each point.
    pub(crate) line: Vec<[f64; 2]>,
    /// Lowest and highest ground near each segment.
    pub(crate) ground_range_m: Vec<[f64; 2]>,
}

/// What is known of a way.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct WayDocument {
    /// OSM's id of the way.
    way_id: i64,
    /// How it is built: `ordinary`, `dual_carriageway`, `link` or `roundabout`.
    form: &'static str,
    /// What carries it: "ground", "bridge" or "tunnel".
    structure: &'static str,
    /// OSM's `layer`.
    layer: i8,
    /// Permitted direction along the way: "no" (both), "forward" or "backward".
    oneway: &'static str,
    /// `name`; null without.
    name: Option<String>,
    /// `ref`; null without.
    #[serde(rename = "ref")]
    reference: Option<String>,
    /// `surface`; null without.
    surface: Option<String>,
    /// `highway`; null in packages that do not hold it.
    highway: Option<String>,
    /// `lanes`, in both directions together; null without.
    lanes: Option<u8>,
    /// `width`, metres; null without.
    width_m: Option<f64>,
    /// `maxspeed`: a number is km/h, "30 mph" miles an hour, else as tagged; null without.
    maxspeed: Option<String>,
    /// `sac_scale`; null without.
    sac_scale: Option<String>,
    /// `tracktype`; null without.
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

/// A unit vector from its octahedron code, in steps of 1/127; it points upwards.
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
