//! Finds the ground or the bridge under a pixel by rays against the drawn triangles and the decks,
//! in f64, without GPU.
//!
//! The depth buffer has the same answer, but only some frames later; dragging with the mouse must
//! not wait for it.

use glam::DVec3;

use crate::{
    camera::WorldBox,
    tiles::{TileGeometry, shares_in},
};

/// Where a ray meets the ground, or a bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundHit {
    /// The position of the hit, world metres.
    pub at_in_world: DVec3,
    /// Distance to the hit in lengths of the ray vector; if that vector has depth 1, this is the
    /// view depth.
    pub depth: f64,
}

/// Triangles are enlarged by this share, so that no ray passes between two neighbours: their
/// corners were rounded to f32, that is to 2^-24 of a tile.
const SLACK: f64 = 1e-6;

/// Half the width of a bridge, true metres. The drawn width depends on the style, which dragging
/// need not know.
const HALF_DECK_M: f64 = 5.0;

/// Returns the first ground, or road of a bridge, that the ray from `eye_in_world` along
/// `ray_in_world` hits, from above or below. Heights are `vertical_scale` times the true ones.
/// Skirts do not count as ground.
///
/// Source of the intersection: Möller & Trumbore 1997, *Fast, Minimum Storage Ray/Triangle
/// Intersection*.
pub fn ground_at<'a>(
    tiles: impl Iterator<Item = &'a TileGeometry>,
    vertical_scale: f64,
    eye_in_world: DVec3,
    ray_in_world: DVec3,
) -> Option<GroundHit> {
    let mut met: Vec<([f64; 2], &TileGeometry)> = tiles
        .filter_map(|tile| {
            let met = depths_within(&world_box(tile, vertical_scale)?, eye_in_world, ray_in_world)?;
            Some((met, tile))
        })
        .collect();
    met.sort_by(|([a, _], _), ([b, _], _)| a.total_cmp(b));
    let mut nearest = f64::INFINITY;
    for ([enters, leaves], tile) in met {
        if enters > nearest {
            break;
        }
        let [x, y, height_m] = tile.reference_m;
        let eye_in_tile = eye_in_world - DVec3::new(x, y, height_m * vertical_scale);
        let ray = Ray { eye: eye_in_tile, way: ray_in_world, enters, leaves };
        nearest = nearest.min(ray.first_in_tile(tile, vertical_scale));
    }
    nearest
        .is_finite()
        .then(|| GroundHit { at_in_world: eye_in_world + ray_in_world * nearest, depth: nearest })
}

/// A ray relative to a tile's reference point, and the depths at which it enters and leaves the
/// tile's box.
struct Ray {
    eye: DVec3,
    way: DVec3,
    enters: f64,
    leaves: f64,
}

impl Ray {
    /// Depth of the first hit; infinite without a hit. Tests the triangles below the ray, column by
    /// column of the tile's grid of triangles, and stops when a hit is nearer than all remaining
    /// columns.
    fn first_in_tile(&self, tile: &TileGeometry, vertical_scale: f64) -> f64 {
        let plan = |depth: f64| (self.eye + self.way * depth).truncate().to_array();
        let mut nearest = self.first_deck(tile, vertical_scale);
        for (share, triangles) in
            tile.ground.triangle_grid.along(plan(self.enters), plan(self.leaves))
        {
            if self.enters + share * (self.leaves - self.enters) > nearest {
                break;
            }
            let hits = triangles.filter_map(|triangle| {
                self.hit(
                    tile.ground
                        .corners(triangle)
                        .map(|[x, y, height_m]| DVec3::new(x, y, height_m * vertical_scale)),
                )
            });
            nearest = hits.fold(nearest, f64::min);
        }
        nearest
    }

    /// Depth of the first road or line on a bridge; infinite without a hit.
    fn first_deck(&self, tile: &TileGeometry, vertical_scale: f64) -> f64 {
        let lines = std::iter::once(&tile.roads).chain(tile.lines.0.values());
        let hits = lines.flat_map(|lines| lines.decks.all()).filter_map(|piece| {
            let place = |at: [f32; 3]| {
                let [x, y, height_m] = at.map(f64::from);
                DVec3::new(x, y, height_m * vertical_scale)
            };
            let [start, end] = [piece.start_in_tile, piece.end_in_tile].map(place);
            let along = (end - start).truncate().normalize_or_zero();
            let aside = (along.perp() * HALF_DECK_M * f64::from(piece.width_factor)).extend(0.0);
            let halves = [
                [start - aside, end - aside, end + aside],
                [start - aside, end + aside, start + aside],
            ];
            halves.into_iter().find_map(|half| self.hit(half))
        });
        hits.fold(f64::INFINITY, f64::min)
    }

    /// Depth at which the ray hits a triangle.
    fn hit(&self, [a, b, c]: [DVec3; 3]) -> Option<f64> {
        let (ab, ac) = (b - a, c - a);
        let across = self.way.cross(ac);
        let volume = ab.dot(across);
        if volume == 0.0 {
            return None;
        }
        let from_a = self.eye - a;
        let b_share = from_a.dot(across) / volume;
        let above = from_a.cross(ab);
        let c_share = self.way.dot(above) / volume;
        let depth = ac.dot(above) / volume;
        let is_inside = b_share >= -SLACK && c_share >= -SLACK && b_share + c_share <= 1.0 + SLACK;
        (is_inside && depth > 0.0).then_some(depth)
    }
}

/// A box around all ground of a tile and its bridges; `None` without ground.
fn world_box(tile: &TileGeometry, vertical_scale: f64) -> Option<WorldBox> {
    let [low_m, high_m] = tile.summary?.height_range_m.map(|height_m| height_m * vertical_scale);
    // Some slack, because positions were rounded to f32 and triangles are enlarged.
    let [east_m, north_m] = tile.size_m;
    let slack_m = 2.0 * SLACK * (east_m.max(north_m) + high_m - low_m);
    let plan = tile.plan_bounds().expanded([slack_m; 2]);
    Some(WorldBox::new(plan, [low_m - slack_m, high_m + slack_m]))
}

/// The depths at which the ray enters the box (0 inside it) and leaves it; `None` if it misses the
/// box.
///
/// Source: Kay & Kajiya 1986, *Ray Tracing Complex Scenes*: the latest entry into three slabs,
/// before the first exit.
fn depths_within(subject: &WorldBox, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let around = [0, 1, 2].map(|axis: usize| [subject.min[axis], subject.max[axis]]);
    let [enters, leaves] = shares_in(eye.to_array(), ray.to_array(), around, f64::INFINITY);
    (enters <= leaves).then_some([enters, leaves])
}

#[cfg(test)]
#[path = "pick_tests.rs"]
mod tests;
