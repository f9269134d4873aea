//! Tiles of a package as terrain tiles look at them.

use corniche_geom::{LatticeBounds, TileId};
use corniche_tin::{NO_TWIN, Surface};
use corniche_work::Recent;

/// What is kept of the package's tiles, about: a square degree of SRTM at its default bound, which the coarse levels look at again and again. Where less
/// than that is kept, tiles are decoded so often that it takes more time, and, for what is made meanwhile, not less memory.
pub(crate) const KEPT_BYTES: u64 = 112 << 20;
/// What a triangle takes with its half of a vertex, about: corners and twins 24 bytes, lists by vertex and by square some 30, of the vertex some 24.
const TRIANGLE_BYTES: u64 = 96;

/// The tiles that were read last; `None` for those without ground.
pub(crate) type Surfaces = Recent<TileId, Option<SurfaceTile>>;

/// The ground of a tile of the package.
#[derive(Debug)]
pub(crate) struct SurfaceTile {
    pub(crate) surface: Surface,
    /// Longitude, latitude and height, as it was asked for, of each vertex; the height is NaN where the finest level has no ground.
    pub(crate) places: Vec<[f64; 3]>,
}

impl SurfaceTile {
    /// What it takes in memory, about.
    pub(crate) fn bytes(&self) -> u64 {
        self.surface.triangles().len() as u64 * TRIANGLE_BYTES
    }

    /// The edges of all triangles that come near a box, each once.
    pub(crate) fn edges_near(&self, bounds: LatticeBounds) -> Vec<[u32; 2]> {
        let mut is_near = vec![false; self.surface.triangles().len()];
        let mut near = Vec::new();
        self.surface.visit_triangles_near(bounds, |triangle| {
            if !std::mem::replace(&mut is_near[triangle as usize], true) {
                near.push(triangle);
            }
        });
        let sides = near.into_iter().flat_map(|triangle| (0..3).map(move |k| 3 * triangle + k));
        let is_first = |half_edge: &u32| {
            let twin = self.surface.twin(*half_edge);
            twin == NO_TWIN || *half_edge < twin || !is_near[twin as usize / 3]
        };
        sides.filter(is_first).map(|half_edge| self.surface.ends(half_edge)).collect()
    }
}
