//! What the manifest records of each level: its tiles, its errors and its sizes.

use corniche_geom::Cell;
use serde::{Deserialize, Serialize};

/// What a level is, and how close it is to the data.
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
    /// [`VerticalRecord::least_measured_error_m`](crate::VerticalRecord::least_measured_error_m); `None` where there is no such tile.
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
    /// Stored bytes of their relief sections.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub relief_bytes: u64,
    /// Full-resolution nodes with data that the level's TINs do not cover, next to voids and data edges.
    pub uncovered_nodes: u64,
}

/// Serde asks this: packages without relief say nothing of it.
fn is_zero<N: Default + PartialEq>(count: &N) -> bool {
    *count == N::default()
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

/// The distribution of values, as nearest-rank quantiles.
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
    /// The distribution of `values`, in any order; `None` without any.
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
