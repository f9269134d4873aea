//! The request to read an extract: which file, which table, how much memory, and who is told of progress.

use std::path::{Path, PathBuf};

use corniche_geom::{LatticePoint, Seam};
use corniche_roads::FrcTable;
use corniche_store::Scratch;

/// Maps `[longitude, latitude]` (WGS84, degrees) to points of the package's lattice, one point for each position. A
/// position gives the same point in every call, whatever positions are with it. `None` where the projection has none.
/// Called from several threads.
pub type ToLattice<'a> = dyn Fn(&[[f64; 2]]) -> Vec<Option<LatticePoint>> + Sync + 'a;

/// The area inside a ring of `[longitude, latitude]` (WGS84, degrees), square metres, negative for a clockwise one. Called from several
/// threads.
pub type RingArea<'a> = dyn Fn(&[[f64; 2]]) -> f64 + Sync + 'a;

/// Is told how much of the reading is done, of how much. Both are counted in bytes of the files, each of them twice: read for its relations
/// and ways, read for its nodes. What is done never shrinks and ends at the whole, which does not change.
pub type OnProgress<'a> = dyn Fn(u64, u64) + 'a;

/// What to read and how.
#[derive(Clone, Copy)]
pub struct ReadRequest<'a> {
    /// The extract, `.osm.pbf`.
    pub path: &'a Path,
    /// Further extracts, read with the first as if they were one: see [`read_extract`](crate::read_extract).
    pub others: &'a [PathBuf],
    /// Which ways are roads.
    pub table: &'a FrcTable,
    /// Where positions lie on the lattice.
    pub place: &'a ToLattice<'a>,
    /// The true area inside a ring of longitudes and latitudes whose sides are straight on the lattice's map.
    pub ring_area_m2: &'a RingArea<'a>,
    /// Where the lattice's map of the earth is cut open, if it is: lines over it are cut there.
    pub seam: Option<Seam>,
    /// Side of a finest tile in lattice steps: ways that go to and fro over a square of this side
    /// more often than a road can are skipped and reported.
    pub square_steps: i64,
    /// Whether roads come with the ids of their fixed nodes, which takes a few bytes more for each node.
    pub node_ids: bool,
    /// Where blobs are decoded and points placed.
    pub pool: &'a rayon::ThreadPool,
    /// About how much the ways and nodes of all layers may take, bytes; what does not fit goes to `scratch`. The blobs that
    /// are being decoded come on top. The result is the same with any number.
    pub memory_bytes: u64,
    /// Where ways and nodes are sorted that do not fit.
    pub scratch: &'a dyn Scratch,
    /// Called from the thread that reads, after every few blobs.
    pub on_progress: Option<&'a OnProgress<'a>>,
}

/// How positions come to the package's lattice.
#[derive(Clone, Copy)]
pub(crate) struct Placing<'a> {
    pub(crate) place: &'a ToLattice<'a>,
    pub(crate) ring_area_m2: &'a RingArea<'a>,
    pub(crate) seam: Option<Seam>,
    pub(crate) square_steps: i64,
}

impl ReadRequest<'_> {
    pub(crate) fn placing(&self) -> Placing<'_> {
        let Self { place, ring_area_m2, seam, square_steps, .. } = *self;
        Placing { place, ring_area_m2, seam, square_steps }
    }

    /// One of the extracts, by its number: 0 is the first.
    pub(crate) fn extract(&self, number: u32) -> PathBuf {
        let further = (number as usize).checked_sub(1).and_then(|number| self.others.get(number));
        further.map_or(self.path, PathBuf::as_path).to_path_buf()
    }
}
