//! Which tiles the first view will need, told before any of them is there.

use corniche_geom::{Bounds, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::{
    camera::Camera,
    lod::{self, GroundSummary, Node, Quality, TileTree},
    tiles::TileCatalog,
};

/// More tiles than these are not foreseen: the guess may be wrong.
const MOST_TILES: usize = 24;

/// A tree in which each tile has the usual error of its level.
struct Guessed<'a> {
    catalog: &'a dyn TileCatalog,
    manifest: &'a Manifest,
    heights_m: [f64; 2],
}

impl TileTree for Guessed<'_> {
    fn node(&self, id: TileId) -> Node {
        if !self.catalog.exists(id) {
            return Node::Absent;
        }
        let errors = self.manifest.levels.get(usize::from(id.z())).and_then(|level| level.errors_m);
        let geometric_error_m = errors.map_or(0.0, |errors| errors.median);
        Node::Loaded(Some(GroundSummary { geometric_error_m, height_range_m: self.heights_m }))
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.catalog.frame().tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.catalog.frame().max_level()
    }
}

/// The tiles that a view will probably need, coarse ones first. A page asks for them at once: else it would learn of each level's tiles only when those
/// above have come, one round of the network after the other.
pub(crate) fn foreseen(
    catalog: &dyn TileCatalog,
    manifest: &Manifest,
    heights_m: [f64; 2],
    camera: &Camera,
    quality: Quality,
) -> Vec<TileId> {
    let selection = lod::select(&Guessed { catalog, manifest, heights_m }, camera, quality);
    let mut wanted: Vec<TileId> = Vec::new();
    for drawn in selection.drawn {
        wanted.extend(std::iter::successors(Some(drawn.id), |id| id.parent()));
    }
    wanted.sort_unstable();
    wanted.dedup();
    wanted.truncate(MOST_TILES);
    wanted
}
