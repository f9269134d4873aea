//! A table of WGS84 positions over the working CRS, by which readers convert coordinates without
//! PROJ.

use serde::{Deserialize, Serialize};

use crate::{Bounds, ProjectError, Projection, Seam, line_length_m, ring_area_m2, wgs84};

/// WGS84 positions sampled over the working CRS, from which a reader interpolates in both
/// directions without PROJ.
///
/// The table is a regular grid of `size × size` samples over `bounds`, interpolated by Lagrange's
/// cubic through the nearest four samples on each axis: its error falls with the fourth power of
/// the spacing, so a few dozen samples per side are enough for a country. The inverse is computed
/// by Newton's method on that interpolation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "TableRecord")]
pub struct CoordinateTable {
    bounds: Bounds,
    size: usize,
    /// Pairs `[lon_deg, lat_deg]`, row by row from the south. Longitudes are continuous: they
    /// continue past ±180 across the antimeridian.
    samples_deg: Vec<[f64; 2]>,
}

/// A [`CoordinateTable`] as it is read, before it is checked.
#[derive(Deserialize)]
struct TableRecord {
    bounds: Bounds,
    size: usize,
    samples_deg: Vec<[f64; 2]>,
}

impl TryFrom<TableRecord> for CoordinateTable {
    type Error = CoordinateTableError;

    fn try_from(record: TableRecord) -> Result<Self, CoordinateTableError> {
        let TableRecord { bounds, size, samples_deg } = record;
        let usable = (4..=MAX_SIZE).contains(&size)
            && samples_deg.len() == size * size
            && bounds.width() > 0.0
            && bounds.height() > 0.0
            && bounds
                .to_array()
                .iter()
                .chain(samples_deg.as_flattened())
                .all(|value| value.is_finite());
        if usable {
            Ok(Self { bounds, size, samples_deg })
        } else {
            Err(CoordinateTableError::Damaged)
        }
    }
}

/// Why a coordinate table could not be computed or read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CoordinateTableError {
    /// The projection failed.
    #[error("the package's corners have no longitude and latitude")]
    Project(#[from] ProjectError),
    /// The table that was read is invalid.
    #[error("the table of longitudes and latitudes is damaged")]
    Damaged,
    /// No table of permitted size is accurate enough, for example because the extent touches a
    /// pole.
    #[error(
        "longitude and latitude cannot be tabulated to {tolerance_m} m; the best accuracy reached is {reached_m} m"
    )]
    TooCurved {
        /// The requested accuracy.
        tolerance_m: f64,
        /// The error of the largest table that was tried.
        reached_m: f64,
    },
}

const MAX_SIZE: usize = 129;
/// The distance, in working metres, over which the scale is measured: long enough for the table's
/// rounding not to matter, short enough for the scale to be nearly constant.
const SCALE_SPAN_M: f64 = 1000.0;
/// Metres per degree of latitude, accurate enough to convert a tolerance to degrees.
const METRES_PER_DEGREE: f64 = 111_320.0;

impl CoordinateTable {
    /// Tabulates `projection` over `bounds` so that positions interpolated halfway between samples,
    /// where a cubic is least accurate, are within `tolerance_m` of the projected ones.
    ///
    /// # Errors
    /// When the projection fails or no table of permitted size is accurate enough.
    pub fn sample(
        projection: &dyn Projection,
        bounds: Bounds,
        tolerance_m: f64,
    ) -> Result<Self, CoordinateTableError> {
        let mut size = 5;
        loop {
            let table = Self::of_size(projection, bounds, size)?;
            let reached_m = table.error_m(projection)?;
            if reached_m <= tolerance_m {
                return Ok(table);
            }
            size = 2 * size - 1;
            if size > MAX_SIZE {
                return Err(CoordinateTableError::TooCurved { tolerance_m, reached_m });
            }
        }
    }

    /// The longitude and latitude of each sample, in degrees.
    #[must_use]
    pub fn samples_deg(&self) -> &[[f64; 2]] {
        &self.samples_deg
    }

    fn of_size(
        projection: &dyn Projection,
        bounds: Bounds,
        size: usize,
    ) -> Result<Self, CoordinateTableError> {
        let mut samples_deg = positions(bounds, size, size, 0.0);
        projection.wgs84_from_working(&mut samples_deg)?;
        // Each longitude is moved next to its neighbour's: a table may be wider than half the
        // earth.
        let center = size / 2;
        let unwrap = |samples_deg: &mut [[f64; 2]], at: usize, beside: usize| {
            samples_deg[at][0] = near_longitude(samples_deg[at][0], samples_deg[beside][0]);
        };
        for row in (0..center).rev() {
            unwrap(&mut samples_deg, row * size + center, (row + 1) * size + center);
        }
        for row in center + 1..size {
            unwrap(&mut samples_deg, row * size + center, (row - 1) * size + center);
        }
        for row in 0..size {
            for column in (0..center).rev() {
                unwrap(&mut samples_deg, row * size + column, row * size + column + 1);
            }
            for column in center + 1..size {
                unwrap(&mut samples_deg, row * size + column, row * size + column - 1);
            }
        }
        TableRecord { bounds, size, samples_deg }.try_into()
    }

    /// The largest distance between interpolated and projected positions at the midpoints of all
    /// samples.
    fn error_m(&self, projection: &dyn Projection) -> Result<f64, ProjectError> {
        let positions = positions(self.bounds, self.size, self.size - 1, 0.5);
        let mut truth = positions.clone();
        projection.wgs84_from_working(&mut truth)?;
        Ok(positions.iter().zip(&truth).fold(0.0, |worst: f64, (position, truth)| {
            let [lon, lat] = self.wgs84_from_working(*position);
            let east = (lon - near_longitude(truth[0], lon)) * truth[1].to_radians().cos();
            let distance_m = east.hypot(lat - truth[1]) * METRES_PER_DEGREE;
            if distance_m.is_nan() { f64::INFINITY } else { worst.max(distance_m) }
        }))
    }

    /// The rectangle of the table, in the working CRS.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The number of samples along each side.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Converts a position in the working CRS to `[lon_deg, lat_deg]`. Outside the table's bounds
    /// it extrapolates.
    #[must_use]
    pub fn wgs84_from_working(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let last = (self.size - 1) as f64;
        let (column, weights_x) =
            cubic((x - self.bounds.min_x) / self.bounds.width() * last, self.size);
        let (row, weights_y) =
            cubic((y - self.bounds.min_y) / self.bounds.height() * last, self.size);
        let mut sum = [0.0; 2];
        for (r, wy) in weights_y.iter().enumerate() {
            for (c, wx) in weights_x.iter().enumerate() {
                let sample = self.samples_deg[(row + r) * self.size + column + c];
                sum[0] += wx * wy * sample[0];
                sum[1] += wx * wy * sample[1];
            }
        }
        sum
    }

    /// The true length of the straight line between two positions in the working CRS, in metres.
    #[must_use]
    pub fn line_length_m(&self, ends: [[f64; 2]; 2]) -> f64 {
        line_length_m(ends, &|at| self.wgs84_from_working(at))
    }

    /// The true area inside a closed line of positions in the working CRS, in square metres;
    /// negative for a clockwise line.
    #[must_use]
    pub fn ring_area_m2(&self, ring: &[[f64; 2]]) -> f64 {
        let degrees = |at| self.wgs84_from_working(at);
        let ring_deg: Vec<[f64; 2]> = ring.iter().copied().map(degrees).collect();
        ring_area_m2(&ring_deg, &|side| side.map(|corner| ring[corner]), &degrees)
    }

    /// Working metres per true metre at a position, along the working CRS's east and north: from
    /// the change of longitude and latitude between half a kilometre on one side and half a
    /// kilometre on the other, and the radii of curvature of the WGS84 ellipsoid there. `None` if
    /// the result is not a positive number.
    #[must_use]
    pub fn scale_at(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let [_, lat_deg] = self.wgs84_from_working(at);
        let [parallel_m, meridian_m] = wgs84::radii_m(lat_deg);
        let along = |axis: usize| {
            let beside = |by_m: f64| {
                let mut beside = at;
                beside[axis] += by_m;
                self.wgs84_from_working(beside)
            };
            let (behind, ahead) = (beside(-SCALE_SPAN_M / 2.0), beside(SCALE_SPAN_M / 2.0));
            let east_m = (ahead[0] - behind[0]).to_radians() * parallel_m;
            let north_m = (ahead[1] - behind[1]).to_radians() * meridian_m;
            SCALE_SPAN_M / libm::hypot(east_m, north_m)
        };
        let scale = [along(0), along(1)];
        scale.iter().all(|scale| scale.is_finite() && *scale > 0.0).then_some(scale)
    }

    /// Converts `[lon_deg, lat_deg]` to a position in the working CRS; `None` if the table has no
    /// such position (far outside).
    #[must_use]
    pub fn working_from_wgs84(&self, [lon, lat]: [f64; 2]) -> Option<[f64; 2]> {
        let mut at = self.bounds.center();
        let center_lon = self.wgs84_from_working(at)[0];
        let target = [near_longitude(lon, center_lon), lat];
        // Central differences over a hundredth of the table: its cubic is smooth at this scale.
        let h = [self.bounds.width() / 100.0, self.bounds.height() / 100.0];
        for _ in 0..30 {
            let here = self.wgs84_from_working(at);
            let miss = [target[0] - here[0], target[1] - here[1]];
            let slope = |step: [f64; 2], span: f64| {
                let ahead = self.wgs84_from_working([at[0] + step[0], at[1] + step[1]]);
                let behind = self.wgs84_from_working([at[0] - step[0], at[1] - step[1]]);
                [(ahead[0] - behind[0]) / span, (ahead[1] - behind[1]) / span]
            };
            let (dx, dy) = (slope([h[0], 0.0], 2.0 * h[0]), slope([0.0, h[1]], 2.0 * h[1]));
            let determinant = dx[0] * dy[1] - dx[1] * dy[0];
            let step = [
                (miss[0] * dy[1] - miss[1] * dy[0]) / determinant,
                (dx[0] * miss[1] - dx[1] * miss[0]) / determinant,
            ];
            at = [at[0] + step[0], at[1] + step[1]];
            if !at[0].is_finite() || !at[1].is_finite() {
                return None;
            }
            if step[0].hypot(step[1]) < 1e-6 {
                let reach = 2.0;
                let inside = |value: f64, low: f64, span: f64| {
                    (low - reach * span..=low + (1.0 + reach) * span).contains(&value)
                };
                let known = inside(at[0], self.bounds.min_x, self.bounds.width())
                    && inside(at[1], self.bounds.min_y, self.bounds.height());
                return known.then_some(at);
            }
        }
        None
    }
}

/// Working metres across a line per true metre across it, if a true metre is `scale` working metres
/// east and north. `direction` is the direction of the line in the working CRS, of any length above
/// 0; a direction of length 0 counts as eastwards.
///
/// ```text
///     true: a band 1 wide             working: stretched by [sx, sy]
///
///       ╱ ╱                              _.-' _.-'        Areas grow by sx · sy and lengths along the line by s, so
///      ╱ ╱ ⟂ 1                        .-' _.-' ⟂ f        its width grows by f = sx · sy / s. Where d is the working
///     ╱ ╱                            _.-'                 direction of length 1, s is 1 / |[dx / sx, dy / sy]|.
/// ```
#[must_use]
pub fn width_factor(scale: [f64; 2], direction: [f64; 2]) -> f64 {
    let length = libm::hypot(direction[0], direction[1]);
    let [dx, dy] = if length > 0.0 { direction.map(|part| part / length) } else { [1.0, 0.0] };
    let [sx, sy] = scale;
    sx * sy * libm::hypot(dx / sx, dy / sy)
}

/// Positions of `count × count` samples of a table of `size × size` samples, or positions shifted
/// from each of them by a fraction of their spacing.
fn positions(bounds: Bounds, size: usize, count: usize, beside: f64) -> Vec<[f64; 2]> {
    let last = (size - 1) as f64;
    let share = |index: usize| (index as f64 + beside) / last;
    let position = |index: usize| {
        [
            bounds.min_x + bounds.width() * share(index % count),
            bounds.min_y + bounds.height() * share(index / count),
        ]
    };
    (0..count * count).map(position).collect()
}

/// The first sample and the four weights of Lagrange's cubic at `t`, in units of the spacing.
fn cubic(t: f64, size: usize) -> (usize, [f64; 4]) {
    let first = (t.floor() - 1.0).clamp(0.0, (size - 4) as f64);
    let s = t - first;
    let weights = [
        -(s - 1.0) * (s - 2.0) * (s - 3.0) / 6.0,
        s * (s - 2.0) * (s - 3.0) / 2.0,
        -s * (s - 1.0) * (s - 3.0) / 2.0,
        s * (s - 1.0) * (s - 2.0) / 6.0,
    ];
    (first as usize, weights)
}

/// The longitude equal to `lon` modulo 360 that is nearest to `center`.
fn near_longitude(lon: f64, center: f64) -> f64 {
    Seam::of_degrees().around(center).image(lon)
}

#[cfg(test)]
#[path = "coordinate_table_tests.rs"]
mod tests;
