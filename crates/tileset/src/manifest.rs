mod check;

use corniche_geom::{Bounds, Cell, CoordinateTable, Frame};
use serde::{Deserialize, Serialize};

pub(crate) use check::{MAX_MEASURE_M, is_height_quantum};

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
    pub frame: Frame,
    /// Rectangle of the DEM's nodes, working metres.
    pub data_bounds: Bounds,
    /// The same in WGS84 degrees.
    pub wgs84_bounds: Bounds,
    /// How nodes relate to the DEM's samples, in words: "nodes are the DEM's samples", "bilinear from …".
    pub resampling: String,
    /// Whether nodes and the DEM's samples are the same points: the error bounds then hold at every sample.
    pub nodes_are_samples: bool,
    /// Heights.
    pub vertical: VerticalRecord,
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
}

/// Working metres to a true metre, along x and along y.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScaleRecord {
    /// In the middle of the data.
    pub center: [f64; 2],
    /// The smallest over corners, middles of sides and centre of every file.
    pub least: [f64; 2],
    /// The largest.
    pub largest: [f64; 2],
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
    /// Lowest and highest node, metres. Values that no land has tell of an undeclared "no data".
    pub range_m: [f64; 2],
}

impl VerticalRecord {
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

/// What a level is and how good it came out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Level, 0 = root.
    pub level: u8,
    /// Spacing of its nodes, east and north.
    pub cell_m: Cell,
    /// Meshing tolerance against the level's own raster.
    pub max_error_m: f64,
    /// Largest stored geometric error of its tiles.
    pub geometric_error_m: f64,
    /// Stored geometric errors of its tiles; `None` on a level without tiles.
    pub errors_m: Option<Distribution>,
    /// How far its TINs are from the DEM's own samples.
    pub sample_error: SampleErrorRecord,
    /// Stored error over the largest true one of the tile and its children, over the tiles where that is at least
    /// [`VerticalRecord::least_measured_error_m`]; `None` where there is no such tile.
    pub tightness: Option<Distribution>,
    /// Least important class shown on this level; `None` shows no road.
    pub least_class: Option<u8>,
    /// Tolerance of the simplification of roads; 0 keeps every point.
    pub simplify_tolerance_m: f64,
    /// How far outside a tile its SV lines reach; half widths beyond it must not be drawn.
    pub width_margin_m: f64,
    /// Tiles with ground.
    pub tiles: u64,
    /// Triangles in them.
    pub triangles: u64,
    /// TIN vertices in them.
    pub vertices: u64,
    /// Stored bytes of their terrain sections.
    pub terrain_bytes: u64,
    /// Full-resolution nodes with data that the level's TINs do not cover, next to voids and data edges.
    pub uncovered_nodes: u64,
}

/// How far a level's TINs are from the DEM's own samples: those that nodes are made from, each once, after nodata, units
/// and shift, at the nearest lattice point; samples that lie on a border belong to the tile east or south of it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SampleErrorRecord {
    /// Samples at which there is a TIN.
    pub on_tin: u64,
    /// Samples at which there is none: next to voids and the data's edge, or on tiles without ground.
    pub off_tin: u64,
    /// Largest vertical distance.
    pub max_m: f64,
    /// Root mean square.
    pub rms_m: f64,
    /// Distance that 99 % do not exceed, up to one height quantum, or a 4096th of itself, too large.
    pub p99_m: f64,
}

/// How values lie: nearest-rank quantiles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Distribution {
    /// How many values.
    pub count: u64,
    /// Smallest.
    pub min: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Largest.
    pub max: f64,
}

impl Distribution {
    /// Of `values`, in any order; `None` of none.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let rank = |share: f64| values[(last as f64 * share).round() as usize];
        Some(Self {
            count: values.len() as u64,
            min: values[0],
            median: rank(0.5),
            p95: rank(0.95),
            max: values[last],
        })
    }
}

/// Settings that determine the bytes of a package.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingsRecord {
    /// `--max-error`.
    pub max_error_m: f64,
    /// `--fill-voids`.
    pub fill_voids: u32,
    /// Each `--nodata`, in their order.
    pub nodata: Vec<f64>,
    /// `--height-range`, if given.
    pub height_range_m: Option<[f64; 2]>,
    /// `--dem-crs`, if given.
    pub dem_crs: Option<String>,
    /// `--dem-vertical-crs`, if given.
    pub dem_vertical_crs: Option<String>,
    /// `--vertical-crs`, if given.
    pub vertical_crs: Option<String>,
    /// `--vertical-shift`; 0 when not given.
    pub vertical_shift_m: f64,
    /// `--crs`, if given.
    pub crs: Option<String>,
    /// `--cell`, if given.
    pub cell_m: Option<Cell>,
    /// `--cell-every`, if given.
    pub cell_every: Option<u32>,
    /// `--scale-latitude`, if given.
    pub scale_latitude_deg: Option<f64>,
    /// Name of the FRC table.
    pub frc_table: String,
    /// SHA-256 of the FRC table's text.
    pub frc_table_sha256: String,
    /// Coarsest cell, metres, at which each class is still shown; by class, 0 first; `None`: on every level.
    pub class_max_cell_m: Vec<Option<f64>>,
    /// Simplification tolerance in cells of the level; 0 is off.
    pub simplify_cells: f64,
}

/// An input file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputRecord {
    /// "dem"; "dem-part", a file that the one before it refers to or that belongs to it; or "osm".
    pub kind: String,
    /// File name without folders.
    pub name: String,
    /// Size of the file; of a file inside an archive or on a server, of what GDAL delivers.
    pub bytes: u64,
    /// SHA-256 of as many bytes.
    pub sha256: String,
}

/// What came in, what was kept, what was lost and why.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Samples of the DEM.
    pub samples: SampleCounts,
    /// Roads read from the extract (ways that the FRC table knows).
    pub roads_in: u64,
    /// Their true length in plan, micrometres.
    pub roads_in_um: u64,
    /// Roads of which anything is kept at the finest level.
    pub roads_kept: u64,
    /// True length in plan kept at the finest level, micrometres.
    pub roads_kept_um: u64,
    /// The difference by reason; counts and lengths add up with what is kept to what came in.
    pub roads_lost: Vec<RoadLoss>,
    /// Defects met in the extract, by name: missing nodes, one-node ways and so on. Sorted by name.
    pub defects: Vec<(String, u64)>,
    /// Ways by `highway` value that the FRC table does not know. Sorted by value.
    pub unknown_highways: Vec<(String, u64)>,
    /// Tags of roads that are taken for something else than they say ("layer=1000", "tunnel=culvert"): on how many ways.
    /// Sorted by tag.
    pub tags_taken_otherwise: Vec<(String, u64)>,
    /// Blobs of the extract of a type that readers pass over, as its format asks; 0 in the extracts of common tools.
    pub blobs_passed_over: u64,
    /// Ways with a `highway` tag in the extract.
    pub highways_in: u64,
    /// Those of them that are no roads here, by reason. With the ways that became roads they add up.
    pub highways_left_out: Vec<(String, u64)>,
    /// Roads per class, 0 first: count and true micrometres in.
    pub classes: Vec<(u64, u64)>,
}

/// Nodes of the finest grid over the data's rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SampleCounts {
    /// All nodes of the rectangle.
    pub nodes: u64,
    /// With a height from the DEM.
    pub with_data: u64,
    /// Filled from their surroundings.
    pub filled: u64,
    /// Left void.
    pub void: u64,
}

/// Roads lost for one reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoadLoss {
    /// Why, in words.
    pub reason: String,
    /// Roads lost altogether for this reason.
    pub roads: u64,
    /// True length in plan lost for this reason, micrometres.
    pub length_um: u64,
}

/// What one class costs on one level.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GrowthRow {
    /// Level.
    pub level: u8,
    /// Functional road class.
    pub class: u8,
    /// Points of the source lines of this class that lie in tiles with ground.
    pub source_vertices: u64,
    /// Points of the level's simplified lines, before cutting at tile borders, that lie in tiles with ground.
    pub simplified_vertices: u64,
    /// Vertices of the clipped lines in all tiles of the level.
    pub geo_vertices: u64,
    /// Points of the plan lines of the SV sections.
    pub sv_vertices: u64,
    /// Bytes of the source lines as plain f64 pairs.
    pub source_bytes: u64,
    /// Bytes of the simplified lines as plain f64 pairs.
    pub simplified_bytes: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    pub geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored, the section's bytes shared out by each class's encoded length.
    pub geo_stored_bytes: u64,
    /// Bytes of the SV lines as stored, shared out likewise.
    pub sv_stored_bytes: u64,
}
