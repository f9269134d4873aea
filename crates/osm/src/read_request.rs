//! The request to read an extract: the file, the table, the memory limit, and the receiver of
//! progress reports.

use std::path::{Path, PathBuf};

use corniche_geom::{LatticePoint, Seam};
use corniche_roads::FrcTable;
use corniche_store::ScratchSpace;

/// Maps `[longitude, latitude]` (WGS84, degrees) to points of the package's lattice, one point for
/// each position. A position has the same point in every call, whatever other positions are in the
/// call. `None` if the projection has no point there. Called from several threads.
pub type ToLattice<'a> = dyn Fn(&[[f64; 2]]) -> Vec<Option<LatticePoint>> + Sync + 'a;

/// Returns the area inside a ring of `[longitude, latitude]` (WGS84, degrees) in square metres,
/// negative for a clockwise ring. Called from several threads.
pub type RingArea<'a> = dyn Fn(&[[f64; 2]]) -> f64 + Sync + 'a;

/// Receives the progress: what is done, and the total. Both are in bytes of the files, and each
/// byte counts twice: once when relations and ways are read, once when nodes are read. The progress
/// never decreases and ends at the total, which does not change.
pub type OnProgress<'a> = dyn Fn(u64, u64) + 'a;

/// The extracts to read, and the settings for reading them.
#[derive(Clone, Copy)]
pub struct ReadRequest<'a> {
    /// The extract, `.osm.pbf`.
    pub path: &'a Path,
    /// Further extracts, which are read with the first as if they were one: see
    /// [`read_extract`](crate::read_extract).
    pub others: &'a [PathBuf],
    /// The table that says which ways are roads.
    pub table: &'a FrcTable,
    /// The conversion of positions to the lattice.
    pub place: &'a ToLattice<'a>,
    /// The true area inside a ring of longitudes and latitudes whose sides are straight on the
    /// lattice's map.
    pub ring_area_m2: &'a RingArea<'a>,
    /// The seam at which the lattice's map of the Earth is cut open, if there is one. Lines across
    /// the seam are cut there.
    pub seam: Option<Seam>,
    /// Side of a finest tile in lattice steps: ways that go to and fro over a square of this side
    /// more often than a road can are skipped and reported.
    pub square_steps: i64,
    /// Whether roads include the ids of their fixed nodes, which takes a few bytes more for each
    /// node.
    pub node_ids: bool,
    /// The thread pool in which blobs are decoded and points converted.
    pub pool: &'a rayon::ThreadPool,
    /// The approximate memory limit for the ways and nodes of all layers, bytes; what does not fit
    /// goes to `scratch`. The blobs that are being decoded take additional memory. The result is
    /// the same with any limit.
    pub memory_bytes: u64,
    /// The scratch space in which ways and nodes are sorted that do not fit in memory.
    pub scratch: &'a dyn ScratchSpace,
    /// Called from the thread that reads, after every few blobs.
    pub on_progress: Option<&'a OnProgress<'a>>,
}

/// The conversion of positions to the package's lattice.
#[derive(Clone, Copy)]
pub(crate) struct LatticePlacement<'a> {
    pub(crate) place: &'a ToLattice<'a>,
    pub(crate) ring_area_m2: &'a RingArea<'a>,
    pub(crate) seam: Option<Seam>,
    pub(crate) square_steps: i64,
}

impl ReadRequest<'_> {
    pub(crate) fn placing(&self) -> LatticePlacement<'_> {
        let Self { place, ring_area_m2, seam, square_steps, .. } = *self;
        LatticePlacement { place, ring_area_m2, seam, square_steps }
    }

    /// Returns the path of one of the extracts, by its number: 0 is the first.
    pub(crate) fn extract(&self, number: u32) -> PathBuf {
        let further = (number as usize).checked_sub(1).and_then(|number| self.others.get(number));
        further.map_or(self.path, PathBuf::as_path).to_path_buf()
    }
}
