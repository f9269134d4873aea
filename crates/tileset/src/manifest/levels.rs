//! The records of the levels in the manifest: tiles, errors and sizes.

use corniche_geom::Cell;
use serde::{Deserialize, Serialize};

/// The tiles of a level, their sizes, and how close they are to the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Level, 0 = root.
    pub level: u8,
    /// Spacing of its nodes, east and north, in working metres.
    pub cell_m: Cell,
    /// Meshing tolerance against the level's own raster, in metres.
    pub max_error_m: f64,
    /// Largest stored geometric error of its tiles, in metres.
    pub geometric_error_m: f64,
    /// Stored geometric errors of its tiles, in metres; `None` on a level without tiles.
    pub errors_m: Option<Distribution>,
    /// How far the TINs of the level are from the DEM's own samples.
    pub sample_error: SampleErrorRecord,
    /// The stored error divided by the largest true error of the tile and its children, for the
    /// tiles in which this true error is at least
    /// [`VerticalRecord::least_measured_error_m`](crate::VerticalRecord::least_measured_error_m);
    /// `None` if there is no such tile.
    pub tightness: Option<Distribution>,
    /// Least important class that is shown on this level; `None` if no roads are shown.
    pub least_class: Option<u8>,
    /// Tolerance of the simplification of roads, in metres; 0 keeps every point.
    pub simplify_tolerance_m: f64,
    /// How far SV lines reach outside their tile, in metres; larger half widths must not be drawn.
    pub width_margin_m: f64,
    /// Tiles with ground.
    pub tiles: u64,
    /// Triangles in them.
    pub triangles: u64,
    /// TIN vertices in them.
    pub vertices: u64,
    /// Stored bytes of their terrain sections.
    pub terrain_bytes: u64,
    /// Stored bytes of their relief sections.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub relief_bytes: u64,
    /// Full-resolution nodes with data that the level's TINs do not cover, next to voids and the
    /// edges of the data.
    pub uncovered_nodes: u64,
}

/// For serde: packages without relief omit this field.
fn is_zero<N: Default + PartialEq>(count: &N) -> bool {
    *count == N::default()
}

/// How far the TINs of a level are from the DEM's own samples. Counts the samples from which nodes
/// are computed, each once, after nodata, units and vertical shift, at the nearest lattice point;
/// samples on a border belong to the tile east or south of it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SampleErrorRecord {
    /// Samples with a triangle.
    pub on_tin: u64,
    /// Samples without a triangle: next to voids and the edge of the data, or in tiles without
    /// ground.
    pub off_tin: u64,
    /// Largest vertical distance, in metres.
    pub max_m: f64,
    /// Root mean square of the distances, in metres.
    pub rms_m: f64,
    /// Distance in metres that 99 % of the samples do not exceed; too large by at most one height
    /// quantum, or by a 4096th of itself.
    pub p99_m: f64,
}

/// The distribution of values, as nearest-rank quantiles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Distribution {
    /// Number of values.
    pub count: u64,
    /// Smallest value.
    pub min: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Largest value.
    pub max: f64,
}

impl Distribution {
    /// Returns the distribution of `values`, in any order; `None` if there are none.
    #[must_use]
    pub fn from_values(mut values: Vec<f64>) -> Option<Self> {
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

/// The sections of a level with the objects of a layer, or with runs of spans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SectionLevelRecord {
    /// Level, 0 = root.
    pub level: u8,
    /// Tiles with a section.
    pub tiles: u64,
    /// Objects, or parts of them, in these tiles; an object in several tiles counts in each of
    /// them.
    pub parts: u64,
    /// Points of all parts.
    pub points: u64,
    /// Stored bytes of the sections.
    pub bytes: u64,
}

impl SectionLevelRecord {
    /// The level, and the numbers in the order of the fields.
    #[must_use]
    pub fn figures(&self) -> (u8, [u64; 4]) {
        (self.level, [self.tiles, self.parts, self.points, self.bytes])
    }
}
