//! Positions on the globe, in metres from the middle of the data.

use std::ops::{Mul, Sub};

use corniche_geom::wgs84::{ECCENTRICITY_2, SEMI_MAJOR_M};

/// A position from the earth's centre: x towards longitude 0, y towards 90° E, z towards the north
/// pole (EPSG:4978).
///
/// Source: IOGP 2019, *Guidance Note 7-2*, section 4.1.1.
pub(crate) fn geocentric_m([lon_deg, lat_deg, height_m]: [f64; 3]) -> [f64; 3] {
    let ((sin_lon, cos_lon), (sin_lat, cos_lat)) =
        (lon_deg.to_radians().sin_cos(), lat_deg.to_radians().sin_cos());
    let across_m = SEMI_MAJOR_M / (1.0 - ECCENTRICITY_2 * sin_lat * sin_lat).sqrt();
    let from_axis_m = (across_m + height_m) * cos_lat;
    [
        from_axis_m * cos_lon,
        from_axis_m * sin_lon,
        (across_m * (1.0 - ECCENTRICITY_2) + height_m) * sin_lat,
    ]
}

/// East, north and up on the ellipsoid.
fn local_axes([lon_deg, lat_deg]: [f64; 2]) -> [[f64; 3]; 3] {
    let ((sin_lon, cos_lon), (sin_lat, cos_lat)) =
        (lon_deg.to_radians().sin_cos(), lat_deg.to_radians().sin_cos());
    [
        [-sin_lon, cos_lon, 0.0],
        [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat],
        [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat],
    ]
}

/// The direction upwards on the ellipsoid.
pub(crate) fn up_at([lon_deg, lat_deg, _]: [f64; 3]) -> [f64; 3] {
    let [.., up] = local_axes([lon_deg, lat_deg]);
    up
}

/// The coordinate frame of all tiles: east, north and up at its origin on the ellipsoid.
#[derive(Clone, Copy)]
pub(crate) struct RootFrame {
    origin_m: [f64; 3],
    axes: [[f64; 3]; 3],
}

impl RootFrame {
    /// Returns the frame at a longitude and latitude in degrees.
    pub(crate) fn at(place_deg: [f64; 2]) -> Self {
        let [lon, lat] = place_deg;
        Self { origin_m: geocentric_m([lon, lat, 0.0]), axes: local_axes(place_deg) }
    }

    /// Converts longitude and latitude in degrees and metres above the ellipsoid to this frame.
    pub(crate) fn position_in_root(&self, place: [f64; 3]) -> [f64; 3] {
        let at = geocentric_m(place);
        let from = between(self.origin_m, at);
        self.axes.map(|axis| dot(axis, from))
    }

    /// The upward direction at a longitude and latitude, in this frame.
    pub(crate) fn up_at(&self, place_deg: [f64; 2]) -> [f64; 3] {
        let [.., up] = local_axes(place_deg);
        self.axes.map(|axis| dot(axis, up))
    }

    /// The matrix from this frame to the earth-centred one, by columns.
    pub(crate) fn to_earth(self) -> [f64; 16] {
        let [e, n, u] = self.axes;
        let o = self.origin_m;
        [e[0], e[1], e[2], 0.0, n[0], n[1], n[2], 0.0, u[0], u[1], u[2], 0.0, o[0], o[1], o[2], 1.0]
    }
}

pub(crate) fn dot(one: [f64; 3], other: [f64; 3]) -> f64 {
    one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
}

pub(crate) fn cross<T: Copy + Mul<Output = T> + Sub<Output = T>>(
    [a, b, c]: [T; 3],
    [x, y, z]: [T; 3],
) -> [T; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The vector from one place to another.
pub(crate) fn between(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| to[axis] - from[axis])
}

pub(crate) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = dot(vector, vector).sqrt();
    vector.map(|axis| axis / length)
}

/// The least and the largest of some numbers.
pub(crate) fn range_of(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    numbers.fold(nothing, |[low, high], number| [low.min(number), high.max(number)])
}

/// The middle of the box around some places.
pub(crate) fn middle_of(places: &(impl Iterator<Item = [f64; 3]> + Clone)) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let [low, high] = range_of(places.clone().map(|at: [f64; 3]| at[axis]));
        f64::midpoint(low, high)
    })
}

#[cfg(test)]
#[path = "globe_tests.rs"]
mod tests;
