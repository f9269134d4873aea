//! The manifest of a package: everything that a reader must know before it reads a tile.

use corniche_areas::ClassedLayer;
use corniche_geom::{
    Bounds, ClipRecord, CoordinateTable, DatumOperationRecord, GridFrame, LatticePoint, NodeIndex,
    ScaleRecord,
};
use corniche_settings::SettingsRecord;
use serde::{Deserialize, Serialize};

use crate::manifest::counts::{Counts, GrowthRow};
use crate::manifest::inputs::{InputKind, InputRecord};
use crate::manifest::levels::LevelRecord;
use crate::manifest::sv_tails::SvTail;

/// The table of contents of a package: its JSON metadata.
///
/// Nothing here depends on threads, memory, dates or paths: inputs are named by file name and hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the encodings; readers refuse any other.
    pub format_version: u32,
    /// Program and version that wrote the package, with its GDAL and PROJ.
    pub generator: String,
    /// Says that z/x/y is a local quadtree in the working CRS, not the web's.
    pub tiling: String,
    /// CRS: "EPSG:…" where it has a code, else its name. Its coordinates times `metres_per_unit` are working metres.
    pub crs: String,
    /// CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres to a unit of the CRS's coordinates, east and north; negative where an axis counts westwards or
    /// southwards.
    pub metres_per_unit: [f64; 2],
    /// Working metres to a true metre, at the centre: the geometric mean along both axes.
    pub point_scale: f64,
    /// The same along each axis, at the centre and over the data's rim.
    pub scale: ScaleRecord,
    /// The grid.
    pub frame: GridFrame,
    /// Rectangle of the DEM's nodes, working metres.
    pub data_bounds: Bounds,
    /// The same in WGS84 degrees.
    pub wgs84_bounds: Bounds,
    /// The part of the elevation files that the package is of (`--bounds`, `--polygon`); left out where it is of all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipRecord>,
    /// The outline of the elevation files on the lattice: polygons, each of its outer ring and its holes, of [u, v]. Left out where they fill the rectangle of
    /// their nodes, and in packages of before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    /// How nodes relate to the DEM's samples, in words: "nodes are the DEM's samples", "bilinear from …".
    pub resampling: String,
    /// Whether nodes and the DEM's samples are the same points: the error bounds then hold at every sample.
    pub nodes_are_samples: bool,
    /// What heights are: their step, unit and datum.
    pub vertical: VerticalRecord,
    /// How positions come from one datum to another; left out where all datums are that of WGS84, and in packages of before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub datum_operations: Vec<DatumOperationRecord>,
    /// WGS84 ⇄ working CRS without PROJ.
    pub coordinates: CoordinateTable,
    /// One record per level, root first.
    pub levels: Vec<LevelRecord>,
    /// Settings that determine the bytes.
    pub settings: SettingsRecord,
    /// SHA-256 of the settings as JSON.
    pub settings_sha256: String,
    /// What was read.
    pub inputs: Vec<InputRecord>,
    /// Credits to show wherever the package is shown.
    pub attribution: Vec<String>,
    /// What came in, what was kept, what was lost and why.
    pub counts: Counts,
    /// What clipping costs, per level and class.
    pub growth: Vec<GrowthRow>,
    /// The photos of each level that has some, root first; left out without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub photos: Vec<PhotoLevelRecord>,
    /// The areas; left out in packages made without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub areas: Option<AreasRecord>,
    /// The boundaries; left out in packages made without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundaries: Option<LinesRecord>,
    /// Bridges and tunnels off the ground; left out in packages made without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spans: Option<SpansRecord>,
    /// The tiles that end with most SV roads, in the order of tiles in the package; left out where none has many, and in packages of before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sv_tails: Vec<SvTail>,
}

impl Manifest {
    /// The input files of a kind, in the order in which they were named.
    pub fn inputs_of(&self, kind: InputKind) -> impl Iterator<Item = &InputRecord> {
        self.inputs.iter().filter(move |input| kind.is_of(input))
    }

    /// Whether the package was built with an extract, and so may have roads.
    #[must_use]
    pub fn has_extract(&self) -> bool {
        self.inputs_of(InputKind::Osm).next().is_some()
    }

    /// The rectangle in degrees for which PROJ chooses its operations: that of all elevation files.
    #[must_use]
    pub fn area_deg(&self) -> Bounds {
        self.clip.as_ref().map_or(self.wgs84_bounds, |clip| clip.whole_wgs84_bounds)
    }

    /// The outline of the elevation files: polygons, each of its outer ring and its holes; `None` where they fill their rectangle.
    #[must_use]
    pub fn data_outline(&self) -> Option<Vec<Vec<Vec<LatticePoint>>>> {
        let ring =
            |ring: &Vec<[i64; 2]>| ring.iter().map(|&[u, v]| LatticePoint { u, v }).collect();
        let polygon = |rings: &Vec<Vec<[i64; 2]>>| rings.iter().map(ring).collect();
        self.outline.as_ref().map(|polygons| polygons.iter().map(polygon).collect())
    }

    /// Whether a longitude and a latitude lie in the rectangle of the data, in which longitudes may run on past 180 degrees.
    #[must_use]
    pub fn covers_deg(&self, [lon, lat]: [f64; 2]) -> bool {
        let is_inside = |turn: f64| self.wgs84_bounds.contains([lon + turn, lat]);
        [0.0, 360.0, -360.0].into_iter().any(is_inside)
    }

    /// What the data covers, for whoever named a place outside; and that the two numbers of the place would fit the other way around, where they would.
    #[must_use]
    pub fn covered_text(&self, [lon, lat]: [f64; 2]) -> String {
        let swapped = if !self.covers_deg([lon, lat]) && self.covers_deg([lat, lon]) {
            format!("; longitude comes first: {lat},{lon} lies inside")
        } else {
            String::new()
        };
        format!("{}{swapped}", self.wgs84_bounds.degrees_text())
    }

    /// South-western and north-eastern node of the data's rectangle.
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

    /// What is recorded of a layer of lines; `None` in packages made without.
    #[must_use]
    pub const fn lines(&self, layer: ClassedLayer) -> Option<&LinesRecord> {
        match layer {
            ClassedLayer::Boundaries => self.boundaries.as_ref(),
        }
    }

    /// Rectangle of the nodes of all elevation files, working metres.
    #[must_use]
    pub fn whole_data_bounds(&self) -> Bounds {
        self.clip.as_ref().map_or(self.data_bounds, |clip| clip.whole_data_bounds)
    }
}

/// Heights: step, unit, datum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerticalRecord {
    /// One step of `height_q`, metres; a power of two.
    pub quantum_m: f64,
    /// Always "metre": other units are converted on reading.
    pub unit: String,
    /// Vertical datum as far as the inputs name one, else "unknown".
    pub datum: String,
    /// What was done to the inputs' heights, in words: "as in the files", a transformation, a shift.
    pub treatment: String,
    /// The step between heights that the DEM can tell apart, metres: 1 where all are whole metres; left out where they have
    /// fractions. Slopes of reliefs are taken from heights that are low-passed by it.
    #[serde(default, skip_serializing_if = "is_no_step")]
    pub height_step_m: f64,
    /// Lowest and highest node, metres. Values that no land has tell of an undeclared "no data".
    pub range_m: [f64; 2],
}

/// Whether heights have no step.
fn is_no_step<Step: PartialOrd + Default>(step_m: &Step) -> bool {
    *step_m <= Step::default()
}

impl VerticalRecord {
    /// The datum of inputs that name none.
    pub const UNKNOWN_DATUM: &str = "unknown";

    /// Ratios of errors are taken of errors at least so large: below, they are ratios of rounding.
    ///
    /// A height quantum over √2. Errors that are simple fractions of a quantum are common (they are differences of
    /// heights that are whole steps), and none of them lies on this limit, so that two ways of computing them agree
    /// on which side of it they are.
    #[must_use]
    pub fn least_measured_error_m(quantum_m: f64) -> f64 {
        quantum_m * std::f64::consts::FRAC_1_SQRT_2
    }
}

/// The areas of a package.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AreasRecord {
    /// What became of the extract's.
    pub counts: AreaCounts,
    /// What each level has that has some, root first.
    pub levels: Vec<AreaLevelRecord>,
}

/// Objects of the extract with the tags of an area: `objects` = those of `kept` + those of `lost`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AreaCounts {
    /// How many there are.
    pub objects: u64,
    /// Areas that objects became, by class, wherever they lie.
    pub kept: Vec<AreaClassRecord>,
    /// Objects that became no area: reason, how many.
    pub lost: Vec<(String, u64)>,
}

/// Areas of one class.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AreaClassRecord {
    /// The class's number.
    pub class: u8,
    /// How many.
    pub areas: u64,
    /// The true area of the objects, square kilometres, wherever they lie; where areas overlap, each counts.
    pub area_km2: f64,
}

/// The areas of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaLevelRecord {
    /// Level, 0 = root.
    pub level: u8,
    /// Tiles with areas.
    pub tiles: u64,
    /// Areas of these tiles; one that lies in several tiles counts in each.
    pub areas: u64,
    /// Points of all rings.
    pub points: u64,
    /// Stored bytes of their areas sections.
    pub bytes: u64,
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
    /// What was found in the extract.
    pub counts: SpanCounts,
    /// The runs off the ground that tiles have, by level; levels without any are left out.
    pub levels: Vec<LineLevelRecord>,
    /// Ground on which they are carried and which the package does not have: where bounds cut them, that of the finest tiles without bounds. Ascending.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outer_grounds: Vec<OuterGround>,
}

/// The ground at a place of the lattice: u, v, and its height in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "(i64, i64, f64)", into = "(i64, i64, f64)")]
pub struct OuterGround {
    /// Where it is.
    pub at: LatticePoint,
    /// Its height, metres.
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

/// Bridges and tunnels, each with all ways that it connects.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpanCounts {
    /// Bridges.
    pub bridges: u64,
    /// Tunnels.
    pub tunnels: u64,
    /// The true length in plan of the ways of bridges that are kept at the finest level, micrometres: a part of `roads_kept_um`.
    #[serde(default)]
    pub bridges_um: u64,
    /// The same of all tunnels.
    #[serde(default)]
    pub tunnels_um: u64,
    /// Where they cross other roads or each other.
    pub crossings: u64,
    /// How often there is a reason to look at one.
    pub reasons: Vec<(String, u64)>,
}

/// A layer of lines of a package.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinesRecord {
    /// What was in the extract.
    pub counts: LineCounts,
    /// What tiles have of them, by level; levels without any are left out.
    pub levels: Vec<LineLevelRecord>,
}

/// Lines of a layer of the extract.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineCounts {
    /// Ways that have a class; each counts once, in its most important class.
    pub ways: u64,
    /// Ways that were read, by class, wherever they lie.
    pub kept: Vec<LineClassRecord>,
    /// Ways that were left out, by reason.
    pub lost: Vec<(String, u64)>,
}

/// Lines of one class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineClassRecord {
    /// Number of the class.
    pub class: u8,
    /// How many ways.
    pub ways: u64,
    /// The true length of the ways in plan, micrometres, wherever they lie.
    pub length_um: u64,
}

/// The lines of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineLevelRecord {
    /// The level.
    pub level: u8,
    /// Tiles with some.
    pub tiles: u64,
    /// Parts of lines in these tiles; what comes near several tiles counts in each.
    pub parts: u64,
    /// The number of their points.
    pub points: u64,
    /// Stored bytes of their sections of the layer.
    pub bytes: u64,
}

impl LineLevelRecord {
    /// Its level, and its numbers in the order of the fields.
    #[must_use]
    pub fn figures(&self) -> (u8, [u64; 4]) {
        (self.level, [self.tiles, self.parts, self.points, self.bytes])
    }
}
