use std::path::Path;

use corniche_geom::LatticePoint;
use corniche_roads::FrcTable;

/// Maps `[longitude, latitude]` (WGS84, degrees) to points of the package's lattice, one point for each position. A
/// position gives the same point in every call, whatever positions are with it. `None` where the projection has none.
/// Called from several threads.
pub type Place<'a> = dyn Fn(&[[f64; 2]]) -> Vec<Option<LatticePoint>> + Sync + 'a;

/// What to read and how.
#[derive(Clone, Copy)]
pub struct ReadRequest<'a> {
    /// The extract, `.osm.pbf`.
    pub path: &'a Path,
    /// Which ways are roads.
    pub table: &'a FrcTable,
    /// Where positions lie on the lattice.
    pub place: &'a Place<'a>,
    /// Where blobs are decoded and points placed.
    pub pool: &'a rayon::ThreadPool,
}
