//! The manifest of a package: everything that a reader must know before it reads a tile.

use corniche_geom::{
    Bounds, ClipRecord, CoordinateTable, DatumOperationRecord, GridFrame, LatticePoint, NodeIndex,
    ScaleRecord,
};
use corniche_settings::SettingsRecord;
use serde::{Deserialize, Serialize};

use crate::{
    layer_slot::LayerSlot,
    manifest::{
        counts::{GrowthRow, ManifestCounts},
        inputs::{InputKind, InputRecord},
        layers::LayerRecord,
        levels::{LevelRecord, SectionLevelRecord},
        sv_tails::SvTail,
    },
};

/// The table of contents of a package: its JSON metadata.
///
/// Nothing here depends on threads, memory, dates or paths: inputs are named by file name and hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the encodings; readers reject all other versions.
    pub format_version: u32,
    /// Program and version that wrote the package, with the versions of GDAL and PROJ.
    pub generator: String,
    /// A text which says that z/x/y is a local quadtree in the working CRS, not the quadtree of web
    /// maps.
    pub tiling: String,
    /// The CRS: "EPSG:…" if it has a code, else its name. Its coordinates times `metres_per_unit`
    /// are working metres.
    pub crs: String,
    /// The CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres per unit of the CRS's coordinates, [east, north]; negative where an axis
    /// counts westwards or southwards.
    pub metres_per_unit: [f64; 2],
    /// Working metres per true metre at the centre: the geometric mean along both axes.
    pub point_scale: f64,
    /// Working metres per true metre along each axis, at the centre and along the edge of the data.
    pub scale: ScaleRecord,
    /// The grid.
    pub frame: GridFrame,
    /// Rectangle of the DEM's nodes, in working metres.
    pub data_bounds: Bounds,
    /// Rectangle of the DEM's nodes, in WGS84 degrees.
    pub wgs84_bounds: Bounds,
    /// The part of the elevation files that the package covers (`--bounds`, `--polygon`); omitted
    /// if it covers all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipRecord>,
    /// The outline of the elevation files on the lattice: polygons, each with its outer ring and
    /// its holes, of [u, v]. Omitted where the files fill the rectangle of their nodes, and in
    /// packages of older versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    /// How nodes relate to the DEM's samples, as text: "nodes are the DEM's samples", "bilinear
    /// from …".
    pub resampling: String,
    /// Whether nodes and the DEM's samples are the same points; if they are, error bounds hold at
    /// every sample.
    pub nodes_are_samples: bool,
    /// Heights: their step, unit and datum.
    pub vertical: VerticalRecord,
    /// The operations that transform positions from one datum to another. Omitted where all datums
    /// are that of WGS84, and in packages of older versions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub datum_operations: Vec<DatumOperationRecord>,
    /// The table that converts between WGS84 and the working CRS without PROJ.
    pub coordinates: CoordinateTable,
    /// One record per level, root first.
    pub levels: Vec<LevelRecord>,
    /// Settings that determine the bytes.
    pub settings: SettingsRecord,
    /// SHA-256 of the settings as JSON.
    pub settings_sha256: String,
    /// The input files.
    pub inputs: Vec<InputRecord>,
    /// The attribution of the data sources, which must be shown wherever the package is shown.
    pub attribution: Vec<String>,
    /// Numbers of samples and roads: read, kept, and lost by reason.
    pub counts: ManifestCounts,
    /// Growth per level and class: the vertices and bytes that clipping to the terrain adds.
    pub growth: Vec<GrowthRow>,
    /// The photos of each level that has any, root first; omitted if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub photos: Vec<PhotoLevelRecord>,
    /// The layers, from the lowest to the highest; omitted in packages without layers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerRecord>,
    /// Spans (bridges and tunnels between two points on the ground); omitted in packages that were
    /// built without spans.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spans: Option<SpansRecord>,
    /// The tiles whose SV roads, at the end of the payload, take the most bytes, in the order of
    /// tiles in the package. Omitted if no tile has many, and in packages of older versions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sv_tails: Vec<SvTail>,
}

impl Manifest {
    /// The input files of a kind, in the order in which they were given.
    pub fn inputs_of(&self, kind: InputKind) -> impl Iterator<Item = &InputRecord> {
        self.inputs.iter().filter(move |input| kind.is_of(input))
    }

    /// The layers with their positions, from the lowest to the highest.
    pub fn layers(&self) -> impl Iterator<Item = (LayerSlot, &LayerRecord)> {
        let slots = (0..self.layers.len()).filter_map(LayerSlot::new);
        slots.zip(&self.layers)
    }

    /// The layer with this id, and its position.
    #[must_use]
    pub fn layer(&self, id: &str) -> Option<(LayerSlot, &LayerRecord)> {
        self.layers().find(|(_, layer)| layer.table.id == id)
    }

    /// Whether the package was built with an OSM extract, so that it may have roads.
    #[must_use]
    pub fn has_extract(&self) -> bool {
        self.inputs_of(InputKind::Osm).next().is_some()
    }

    /// The rectangle in degrees for which PROJ chooses its operations: that of all elevation files.
    #[must_use]
    pub fn area_deg(&self) -> Bounds {
        self.clip.as_ref().map_or(self.wgs84_bounds, |clip| clip.whole_wgs84_bounds)
    }

    /// The outline of the elevation files: polygons, each with its outer ring and its holes; `None`
    /// where the files fill their rectangle.
    #[must_use]
    pub fn data_outline(&self) -> Option<Vec<Vec<Vec<LatticePoint>>>> {
        let ring =
            |ring: &Vec<[i64; 2]>| ring.iter().map(|&[u, v]| LatticePoint { u, v }).collect();
        let polygon = |rings: &Vec<Vec<[i64; 2]>>| rings.iter().map(ring).collect();
        self.outline.as_ref().map(|polygons| polygons.iter().map(polygon).collect())
    }

    /// Whether a longitude and a latitude are in the rectangle of the data, in which longitudes may
    /// continue past 180 degrees.
    #[must_use]
    pub fn covers_deg(&self, [lon, lat]: [f64; 2]) -> bool {
        let is_inside = |turn: f64| self.wgs84_bounds.contains([lon + turn, lat]);
        [0.0, 360.0, -360.0].into_iter().any(is_inside)
    }

    /// Describes the area that the package covers, for messages about a position outside, or says
    /// that the position would be inside if its two numbers were swapped.
    #[must_use]
    pub fn covered_text(&self, [lon, lat]: [f64; 2]) -> String {
        if !self.covers_deg([lon, lat]) && self.covers_deg([lat, lon]) {
            format!("longitude comes first: {lat},{lon} is inside the package")
        } else {
            format!("the package covers {}", self.wgs84_bounds.degrees_text())
        }
    }

    /// South-western and north-eastern node of the rectangle of the data.
    #[must_use]
    pub fn data_nodes(&self) -> [NodeIndex; 2] {
        let ([west, south], [east_m, north_m]) =
            (self.frame.origin_m(), self.frame.cell().to_array());
        let node = |x: f64, y: f64| NodeIndex {
            i: ((x - west) / east_m).round() as i64,
            j: ((y - south) / north_m).round() as i64,
        };
        let bounds = &self.data_bounds;
        [node(bounds.min_x, bounds.min_y), node(bounds.max_x, bounds.max_y)]
    }

    /// Rectangle of the nodes of all elevation files, in working metres.
    #[must_use]
    pub fn whole_data_bounds(&self) -> Bounds {
        self.clip.as_ref().map_or(self.data_bounds, |clip| clip.whole_data_bounds)
    }
}

/// Heights: their step, unit and datum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerticalRecord {
    /// One step of `height_q`, in metres; a power of two.
    pub quantum_m: f64,
    /// Always "metre": other units are converted on reading.
    pub unit: String,
    /// Vertical datum as far as the inputs name one, else "unknown".
    pub datum: String,
    /// How the heights of the inputs were treated, as text: "as in the files", a transformation, a
    /// shift.
    pub treatment: String,
    /// The step between heights that the DEM can distinguish, in metres: 1 if all heights are whole
    /// metres. Omitted if heights have fractions. Slopes of reliefs are computed from heights that
    /// are low-pass filtered with this step.
    #[serde(default, skip_serializing_if = "is_no_step")]
    pub height_step_m: f64,
    /// Lowest and highest node, in metres. Implausible values indicate an undeclared nodata value.
    pub range_m: [f64; 2],
}

/// Whether heights have no step.
fn is_no_step<Step: PartialOrd + Default>(step_m: &Step) -> bool {
    *step_m <= Step::default()
}

impl VerticalRecord {
    /// The datum recorded for inputs that name none.
    pub const UNKNOWN_DATUM: &str = "unknown";

    /// The smallest error for which ratios of errors are computed: ratios of smaller errors only
    /// show rounding.
    ///
    /// It is a height quantum divided by √2. Errors that are simple fractions of a quantum are
    /// common (they are differences of heights that are whole steps), and none of them equals this
    /// limit, so two ways of computing an error agree on which side of the limit it is.
    #[must_use]
    pub fn least_measured_error_m(quantum_m: f64) -> f64 {
        quantum_m * std::f64::consts::FRAC_1_SQRT_2
    }
}

/// The photos of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PhotoLevelRecord {
    /// Level, 0 = root.
    pub level: u8,
    /// Tiles with a photo.
    pub tiles: u64,
    /// Stored bytes of their photo sections.
    pub bytes: u64,
}

/// The bridges and tunnels of a package, whose heights are estimates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpansRecord {
    /// Numbers of spans found in the extract.
    pub counts: SpanCounts,
    /// The runs of the tiles, by level (a run is a stretch of a span that is off the ground);
    /// levels without runs are omitted.
    pub levels: Vec<SectionLevelRecord>,
    /// Ground on which spans are carried and which the package does not contain: where bounds cut
    /// spans, the ground of the finest tiles without bounds. In ascending order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outer_grounds: Vec<OuterGround>,
}

/// The ground at a lattice point: u, v, and the height in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "(i64, i64, f64)", into = "(i64, i64, f64)")]
pub struct OuterGround {
    /// The lattice point.
    pub at: LatticePoint,
    /// The height, in metres.
    pub height_m: f64,
}

impl From<(i64, i64, f64)> for OuterGround {
    fn from((u, v, height_m): (i64, i64, f64)) -> Self {
        Self { at: LatticePoint::new(u, v), height_m }
    }
}

impl From<OuterGround> for (i64, i64, f64) {
    fn from(OuterGround { at, height_m }: OuterGround) -> Self {
        (at.u, at.v, height_m)
    }
}

/// Numbers of bridges and tunnels, each with all ways that it connects.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpanCounts {
    /// Number of bridges of roads.
    pub bridges: u64,
    /// Number of tunnels of roads.
    pub tunnels: u64,
    /// The true length in plan of the ways of bridges, as far as they are kept at the finest level,
    /// in micrometres: a part of `roads_kept_um`.
    #[serde(default)]
    pub bridges_um: u64,
    /// The true length in plan of the ways of tunnels, as far as they are kept at the finest level,
    /// in micrometres: a part of `roads_kept_um`.
    #[serde(default)]
    pub tunnels_um: u64,
    /// Number of bridges of railways alone.
    pub railway_bridges: u64,
    /// Number of tunnels of railways alone.
    pub railway_tunnels: u64,
    /// Numbers of crossings with other roads and railways and with each other: what is above, what
    /// is below ("roads" or "railways"), and the number; sorted, each pair once.
    pub crossings: Vec<(String, String, u64)>,
    /// Reasons to inspect a span, each with its number of occurrences.
    pub reasons: Vec<(String, u64)>,
}

impl SpanCounts {
    /// Returns the number of all crossings.
    #[must_use]
    pub fn crossings(&self) -> u64 {
        self.crossings.iter().fold(0, |sum, (.., count)| sum.saturating_add(*count))
    }
}
