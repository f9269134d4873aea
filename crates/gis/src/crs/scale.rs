//! The scale of working metres: working metres per true metre.

use std::ops::RangeInclusive;

use corniche_geom::wgs84::{ECCENTRICITY_2, SEMI_MAJOR_M};

use crate::CrsError;
use crate::crs::operation::CrsOperation;

/// Half the length over which the scale is measured: long enough that PROJ's rounding does not
/// matter, short enough that the curvature of coordinate lines does not matter.
const HALF_SPAN_M: f64 = 500.0;

/// The scales that a package can record. At a pole a degree of longitude has no length, and the
/// scale is infinite.
pub const SCALES: RangeInclusive<f64> = 0.001..=1000.0;

/// The scale around a point: working metres per true metre.
#[derive(Debug, Clone, Copy)]
pub struct LocalScale {
    /// The scale along x and along y.
    pub along: [f64; 2],
    /// The largest deviation from 1 along x, y and both diagonals; infinite if y is not to the left
    /// of x.
    pub deviation: f64,
}

/// The scale at each of `points_m`, in working metres; `None` where the CRS ends.
///
/// # Errors
/// When PROJ knows no operation.
pub fn scales(
    wgs84_from_working: &CrsOperation,
    points_m: &[[f64; 2]],
) -> Result<Vec<Option<LocalScale>>, CrsError> {
    let diagonal = HALF_SPAN_M / std::f64::consts::SQRT_2;
    let ways =
        [[HALF_SPAN_M, 0.0], [0.0, HALF_SPAN_M], [diagonal, diagonal], [diagonal, -diagonal]];
    let mut ends = Vec::with_capacity(points_m.len() * 8);
    for [x, y] in points_m {
        for [dx, dy] in ways {
            ends.extend([[x - dx, y - dy], [x + dx, y + dy]]);
        }
    }
    wgs84_from_working.apply(&mut ends)?;
    Ok(ends.chunks_exact(8).map(scale).collect())
}

/// The scale from the end points of the four lines.
fn scale(ends_deg: &[[f64; 2]]) -> Option<LocalScale> {
    let vectors: Vec<[f64; 3]> = ends_deg
        .chunks_exact(2)
        .map(|pair| {
            let (from, to) = (geocentric_m(pair[0]), geocentric_m(pair[1]));
            [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
        })
        .collect();
    // The chord is shorter than the arc by one part in 10^9 here.
    let scales: Vec<f64> = vectors.iter().map(|v| 2.0 * HALF_SPAN_M / dot(v, v).sqrt()).collect();
    if scales.iter().any(|scale| scale.is_nan()) {
        return None;
    }
    let (x, y, up) = (vectors[0], vectors[1], normal(ends_deg[0]));
    let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    let deviation = if dot(&cross, &up) > 0.0 {
        scales.iter().fold(0.0_f64, |worst, scale| worst.max((scale - 1.0).abs()))
    } else {
        f64::INFINITY
    };
    Some(LocalScale { along: [scales[0], scales[1]], deviation })
}

/// The middle of positions on the ellipsoid, longitude and latitude: the mean of their normals, so
/// that neither the antimeridian nor a pole affects it. `None` if the positions surround the earth
/// evenly, or there are none.
#[must_use]
pub fn center_deg(points_deg: &[[f64; 2]]) -> Option<[f64; 2]> {
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for &point in points_deg.iter().filter(|point| point[0].is_finite() && point[1].is_finite()) {
        for (total, part) in sum.iter_mut().zip(normal(point)) {
            *total += part;
        }
        count += 1.0;
    }
    let length = dot(&sum, &sum).sqrt();
    let is_decided = length > 1e-6 * count;
    is_decided.then(|| [sum[1].atan2(sum[0]).to_degrees(), (sum[2] / length).asin().to_degrees()])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normal([lon, lat]: [f64; 2]) -> [f64; 3] {
    let ((sin_lon, cos_lon), (sin_lat, cos_lat)) =
        (lon.to_radians().sin_cos(), lat.to_radians().sin_cos());
    [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat]
}

fn geocentric_m(point_deg: [f64; 2]) -> [f64; 3] {
    let n = normal(point_deg);
    let radius_m = SEMI_MAJOR_M / (1.0 - ECCENTRICITY_2 * n[2] * n[2]).sqrt();
    [radius_m * n[0], radius_m * n[1], radius_m * (1.0 - ECCENTRICITY_2) * n[2]]
}

#[cfg(test)]
#[path = "scale_tests.rs"]
mod tests;
