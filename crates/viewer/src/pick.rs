//! Which ground lies under a pixel: rays against the triangles that are drawn, f64, no GPU.
//!
//! The depth buffer would tell the same some frames later; a drag must not wait for it.

use glam::DVec3;

use crate::{camera::WorldBox, tiles::TileGeometry};
use corniche_geom::Bounds;

/// Where a ray meets the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundHit {
    /// The place, world metres.
    pub at_in_world: DVec3,
    /// How many rays' lengths it is away: for a ray of depth 1, its view depth.
    pub depth: f64,
}

/// A share by which triangles are larger than they are, so that no ray slips between two of them: their corners were
/// rounded to f32, 2^-24 of a tile.
const SLACK: f64 = 1e-6;

/// The first ground that the ray from `eye_in_world` along `ray_in_world` meets, seen from above or below. Heights are
/// `vertical_scale` times the true ones. Skirts are no ground.
///
/// Source of the intersection: Möller & Trumbore 1997, *Fast, Minimum Storage Ray/Triangle Intersection*.
pub fn ground_at<'a>(
    tiles: impl Iterator<Item = &'a TileGeometry>,
    vertical_scale: f64,
    eye_in_world: DVec3,
    ray_in_world: DVec3,
) -> Option<GroundHit> {
    let mut met: Vec<(f64, &TileGeometry)> = tiles
        .filter_map(|tile| {
            let enters = entry(&world_box(tile, vertical_scale)?, eye_in_world, ray_in_world)?;
            Some((enters, tile))
        })
        .collect();
    met.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nearest = f64::INFINITY;
    for (enters, tile) in met {
        if enters > nearest {
            break;
        }
        let [x, y, height_m] = tile.reference_m;
        let eye_in_tile = eye_in_world - DVec3::new(x, y, height_m * vertical_scale);
        nearest = nearest.min(first_in_tile(tile, vertical_scale, eye_in_tile, ray_in_world));
    }
    nearest
        .is_finite()
        .then(|| GroundHit { at_in_world: eye_in_world + ray_in_world * nearest, depth: nearest })
}

/// Depth of the first hit; infinite without one.
fn first_in_tile(tile: &TileGeometry, vertical_scale: f64, eye: DVec3, ray: DVec3) -> f64 {
    let scale = DVec3::new(1.0, 1.0, vertical_scale);
    let corner = |index: u32| {
        let [x, y, z] = tile.ground.vertices[index as usize].position_in_tile.map(f64::from);
        DVec3::new(x, y, z) * scale
    };
    let surface = &tile.ground.indices[..tile.ground.surface_indices];
    surface
        .chunks_exact(3)
        .filter_map(|corners| {
            let a = corner(corners[0]);
            let (ab, ac) = (corner(corners[1]) - a, corner(corners[2]) - a);
            let across = ray.cross(ac);
            let volume = ab.dot(across);
            if volume == 0.0 {
                return None;
            }
            let from_a = eye - a;
            let b_share = from_a.dot(across) / volume;
            let above = from_a.cross(ab);
            let c_share = ray.dot(above) / volume;
            let depth = ac.dot(above) / volume;
            let is_inside =
                b_share >= -SLACK && c_share >= -SLACK && b_share + c_share <= 1.0 + SLACK;
            (is_inside && depth > 0.0).then_some(depth)
        })
        .fold(f64::INFINITY, f64::min)
}

/// All ground of a tile; `None` without any.
fn world_box(tile: &TileGeometry, vertical_scale: f64) -> Option<WorldBox> {
    let range_m = tile.summary?.height_range_m;
    let [x, y, _] = tile.reference_m;
    let half_m = tile.width_m / 2.0;
    let plan =
        Bounds { min_x: x - half_m, min_y: y - half_m, max_x: x + half_m, max_y: y + half_m };
    // Heights were rounded to f32 with the rest.
    let slack_m = tile.width_m * SLACK;
    Some(WorldBox::new(
        plan,
        [range_m[0] * vertical_scale - slack_m, range_m[1] * vertical_scale + slack_m],
    ))
}

/// Where the ray enters the box, 0 inside it; `None` when it misses.
///
/// Source: Kay & Kajiya 1986, *Ray Tracing Complex Scenes*: the latest entry into three slabs, before the first exit.
fn entry(subject: &WorldBox, eye: DVec3, ray: DVec3) -> Option<f64> {
    let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        if ray[axis] == 0.0 {
            if eye[axis] < subject.min[axis] || eye[axis] > subject.max[axis] {
                return None;
            }
            continue;
        }
        let ends = [subject.min, subject.max].map(|side| (side[axis] - eye[axis]) / ray[axis]);
        enters = enters.max(ends[0].min(ends[1]));
        leaves = leaves.min(ends[0].max(ends[1]));
    }
    (enters <= leaves).then_some(enters)
}

#[cfg(test)]
#[path = "pick_tests.rs"]
mod tests;
