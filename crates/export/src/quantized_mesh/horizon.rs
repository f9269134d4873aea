//! Facts that a viewer needs before it draws a tile: its position, and when the earth hides it.

use corniche_geom::wgs84::{ECCENTRICITY_2, SEMI_MAJOR_M};

use super::mesh::QuantizedTile;
use crate::globe::{between, cross, dot, middle_of, unit};

/// Represents a point that is infinitely far away, in the earth's radii.
const FAR_AWAY: f64 = 1e9;

/// Returns the middle and radius of a sphere that contains all vertices, and so all triangles, from
/// the earth's centre.
pub(crate) fn sphere(mesh: &QuantizedTile) -> ([f64; 3], f64) {
    let middle = middle_of(&mesh.vertices.iter().map(|vertex| vertex.at_m));
    let distance_m = |at: [f64; 3]| {
        let from = between(middle, at);
        dot(from, from).sqrt()
    };
    let radius_m = mesh.vertices.iter().map(|vertex| distance_m(vertex.at_m)).fold(0.0, f64::max);
    (middle, radius_m)
}

/// Returns the horizon occlusion point, which is behind the horizon only when the whole tile is,
/// from the earth's centre in the ellipsoid's radii.
///
/// ```text
///        P        in the direction of the tile's middle, so far out that the tangent through each vertex,
///       / \       the lower one of two, meets that direction below P
///     _/_ _\_
///    /       \
/// ```
///
/// Tiles as wide as half the globe have no such point. They get a point at infinity, which is exact
/// for a smooth hemisphere.
///
/// Source: Ring 2013, *Computing the horizon occlusion point* (Cesium's blog), after Cozzi & Ring
/// 2011, *3D Engine Design for Virtual Globes*.
pub(crate) fn occlusion_point(mesh: &QuantizedTile, middle_m: [f64; 3]) -> [f64; 3] {
    let semi_minor_m = SEMI_MAJOR_M * (1.0 - ECCENTRICITY_2).sqrt();
    let radii_m = [SEMI_MAJOR_M, SEMI_MAJOR_M, semi_minor_m];
    let scaled = |at_m: [f64; 3]| [0, 1, 2].map(|axis| at_m[axis] / radii_m[axis]);
    let towards = unit(scaled(middle_m));
    let far = mesh.vertices.iter().map(|vertex| {
        let at = scaled(vertex.at_m);
        // Places below the ellipsoid count as being on it.
        let out = dot(at, at).sqrt().max(1.0);
        let direction = unit(at);
        let across = cross(direction, towards);
        let [cos_alpha, sin_alpha] = [dot(direction, towards), dot(across, across).sqrt()];
        let [cos_beta, sin_beta] = [1.0 / out, (out * out - 1.0).sqrt() / out];
        let reach = cos_alpha * cos_beta - sin_alpha * sin_beta;
        if reach > 1.0 / FAR_AWAY { 1.0 / reach } else { FAR_AWAY }
    });
    let far = far.fold(0.0, f64::max);
    towards.map(|axis| axis * far)
}
