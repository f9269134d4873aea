//! Compares a child's TIN with its parent's TIN at every finest node that both cover.

use std::sync::Arc;

use corniche_geom::{GridFrame, TILE_NODES, TileId};

use super::{
    checks::Findings,
    triangle_soup::{HEIGHT_ROUNDING_M, TriangleSoup},
};

/// A tile's ground and its geometric error.
pub(crate) struct Level {
    pub id: TileId,
    pub ground: Arc<TriangleSoup>,
    pub error_m: f64,
}

/// Compares the TINs above a finest tile: `levels` are this tile and all of its ancestors that have
/// ground, from the finest up. Nodes that the finest level does not cover may be void, and are not
/// compared.
pub(crate) fn verify(frame: &GridFrame, levels: &[Level], findings: &mut Findings) {
    let Some(finest) = levels.first() else { return };
    let corner = frame.tile_corner(finest.id);
    let mut has_data: Vec<bool> = Vec::new();
    let mut below: Option<(&Level, Vec<f64>)> = None;
    for level in levels {
        let id = level.id;
        let (own, stride) = (frame.tile_corner(id), frame.stride(id.z()) as f64);
        let first = [(corner.i - own.i) as f64 / stride, (own.j - corner.j) as f64 / stride];
        let heights_m = level.ground.raster(first, 1.0 / stride, TILE_NODES);
        match &below {
            None => has_data = heights_m.iter().map(|height_m| !height_m.is_nan()).collect(),
            // If a level between the two has no ground, the two are not child and parent.
            Some((child, child_m)) if child.id.z() == id.z() + 1 => {
                let allowed_m = level.error_m + child.error_m + HEIGHT_ROUNDING_M;
                let worst_m = heights_m
                    .iter()
                    .zip(child_m)
                    .zip(&has_data)
                    .filter(|&(_, &has_data)| has_data)
                    // NaN where one of the two has no ground; `f64::max` ignores NaN.
                    .map(|((above_m, below_m), _)| (above_m - below_m).abs())
                    .fold(0.0, f64::max);
                look!(
                    findings,
                    Levels,
                    worst_m <= allowed_m,
                    "tiles {} and {id} are {worst_m} m apart, their errors allow {allowed_m} m",
                    child.id
                );
            }
            Some(_) => {}
        }
        below = Some((level, heights_m));
    }
}
