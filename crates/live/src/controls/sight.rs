//! Checks whether a view shows some of the data, so that users cannot lose the map.

use corniche_geom::Bounds;
use glam::{DVec2, DVec3};

use super::view::CameraView;

/// The inner share of the image's sides in which some of the data must be visible. Panel, compass
/// and notices are outside it in all but small windows.
const INNER_SHARE: f64 = 0.6;

/// Whether the inner part of an image of this size shows a part of the data's rectangle at the
/// height `lowest_m` of its lowest ground.
///
/// If so, ground or the wall at the data's edge is visible there, voids aside: a ray from an eye
/// above the ground, or outside the data, to a point below all ground crosses the ground or the
/// wall on its way.
///
/// The rectangle is clipped by the four sides of the pyramid between the eye and the inner part of
/// the image: Sutherland & Hodgman 1974, *Reentrant Polygon Clipping*.
pub(crate) fn sees_data(view: &CameraView, size_px: [u32; 2], data: Bounds, lowest_m: f64) -> bool {
    // A view from above shows the same part of the plane at that height as perspective from the
    // distance of the focus.
    let eye = view.eye_in_world;
    let view = match view.from_above {
        None => *view,
        Some(_) => CameraView {
            eye_in_world: eye.with_z(lowest_m + view.focus_m),
            ..view.in_perspective()
        },
    };
    let camera = view.camera(size_px);
    let [width, height] = size_px.map(f64::from);
    let middle_px = DVec2::new(width, height) / 2.0;
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let rays =
        signs.map(|sign| camera.ray_in_world(middle_px * (1.0 + DVec2::from(sign) * INNER_SHARE)));
    let ahead = camera.ray_in_world(middle_px);
    let Bounds { min_x, min_y, max_x, max_y } = data;
    let mut seen: Vec<DVec3> = [[min_x, min_y], [max_x, min_y], [max_x, max_y], [min_x, max_y]]
        .map(|[x, y]| DVec3::new(x, y, lowest_m) - view.eye_in_world)
        .into();
    for (ray, next) in rays.iter().zip(rays.iter().cycle().skip(1)) {
        let side = ray.cross(*next);
        seen = clipped(&seen, side * side.dot(ahead).signum());
    }
    !seen.is_empty()
}

/// The part of a polygon on the side of a plane through the origin that `normal` points to.
fn clipped(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (from, to) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let [before, after] = [from, to].map(|point| point.dot(normal));
        if before >= 0.0 {
            kept.push(*from);
        }
        if (before >= 0.0) != (after >= 0.0) {
            kept.push(from.lerp(*to, before / (before - after)));
        }
    }
    kept
}

#[cfg(test)]
#[path = "sight_tests.rs"]
mod tests;
