//! The contents of a package in working metres, from `tile --json`, and their positions on the
//! earth, from PROJ: an oracle for all exports.

#![allow(clippy::unwrap_used, reason = "what is not there ends the test")]

use std::path::{Path, PathBuf};

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use serde_json::Value;

use crate::{json, text};

/// Number of squares along each side of a tile's spatial index.
const SQUARES: usize = 64;

/// Tolerance at the edge of the ground for rounding and for the chords of curved lines.
const BESIDE_M: f64 = 0.005;

/// The terrain of a tile in the package's CRS.
pub struct Ground {
    /// Positions in working metres, with heights.
    pub corners: Vec<[f64; 3]>,
    /// Indices of corners.
    pub triangles: Vec<[usize; 3]>,
    /// West, south, east, north of the tile.
    pub bounds: [f64; 4],
    /// Centre-lines with way id and class.
    pub roads: Vec<(i64, u8, Vec<[f64; 2]>)>,
    squares: Vec<Vec<u32>>,
}

fn vector<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

impl Ground {
    /// Reads a tile, named like `3/4/2`, through `tile --json`.
    ///
    /// # Panics
    /// When the tile cannot be read.
    #[must_use]
    pub fn read(package: &Path, tile: &str) -> Self {
        let document = json(&["tile", text(package), tile, "--json"]);
        let list = |value: &Value| value.as_array().unwrap().clone();
        let corners = list(&document["tin"]["vertices"]).iter().map(vector).collect();
        let triangles = list(&document["tin"]["triangles"])
            .iter()
            .map(|triangle| vector::<3>(triangle).map(|k| k as usize))
            .collect();
        // Tunnels are not on the ground.
        let is_tunnel = |way: &Value| {
            let ways = document["attributes"].as_array().unwrap();
            ways.iter().any(|known| known["way_id"] == *way && known["structure"] == "tunnel")
        };
        let roads = list(&document["roads_geo"])
            .iter()
            .filter(|road| !is_tunnel(&road["way_id"]))
            .map(|road| {
                let way = road["way_id"].as_i64().unwrap();
                let class = u8::try_from(road["frc"].as_u64().unwrap()).unwrap();
                (way, class, list(&road["line"]).iter().map(vector).collect())
            })
            .collect();
        let bounds = vector(&document["bounds"]);
        let squares = vec![Vec::new(); SQUARES * SQUARES];
        let mut ground = Self { corners, triangles, bounds, roads, squares };
        let beside_m = ground.chord_m() + BESIDE_M;
        for (number, triangle) in ground.triangles.iter().enumerate() {
            let range = |axis: usize| {
                let at = triangle.map(|k| ground.corners[k][axis]);
                at.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], next| {
                    [low.min(next - beside_m), high.max(next + beside_m)]
                })
            };
            let [[west, east], [south, north]] = [range(0), range(1)];
            let [low, high] = [ground.square([west, south]), ground.square([east, north])];
            for row in low[1]..=high[1] {
                for column in low[0]..=high[0] {
                    ground.squares[row * SQUARES + column].push(number as u32);
                }
            }
        }
        ground
    }

    /// The tolerance for chords. On tiles of more than 57 km, chords may be farther from the
    /// earth's surface, because a 128th of a side is not divided. The step of positions counts if
    /// it is more than 4 mm.
    #[must_use]
    pub fn chord_m(&self) -> f64 {
        let [west, south, east, north] = self.bounds;
        let part_m = (east - west).max(north - south) / 128.0;
        let sag_m = part_m * part_m / (8.0 * 6_335_400.0) * 4.0 / 3.0;
        let reach_m = 64.0 * part_m * 1.1;
        let step_m = 2.0_f64.powi(reach_m.log2().ceil() as i32 - 24);
        // Lines of degrees are also curved sideways.
        let chord_m = if sag_m > 0.004 * 4.0 / 3.0 { 1.5 * sag_m } else { 0.0 };
        chord_m + if step_m > 0.004 { step_m } else { 0.0 }
    }

    fn square(&self, [x, y]: [f64; 2]) -> [usize; 2] {
        let [west, south, east, north] = self.bounds;
        let of = |share: f64| ((share * SQUARES as f64).max(0.0) as usize).min(SQUARES - 1);
        [of((x - west) / (east - west)), of((y - south) / (north - south))]
    }

    /// The height at a position; `None` off the ground, with a tolerance for rounding and chords of
    /// curved lines.
    #[must_use]
    pub fn height(&self, at: [f64; 2]) -> Option<f64> {
        let [column, row] = self.square(at);
        let near = &self.squares[row * SQUARES + column];
        let best = near.iter().map(|number| {
            let corners = self.triangles[*number as usize].map(|k| self.corners[k]);
            let shares = shares(corners.map(|[x, y, _]| [x, y]), at);
            // The distance of the position outside each edge, metres.
            let outside = |k: usize| {
                let [a, b, c] = [0, 1, 2].map(|turn| corners[(k + turn) % 3]);
                let length = (b[0] - c[0]).hypot(b[1] - c[1]);
                let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                -shares[k] * twice.abs() / length
            };
            let outside_m = (0..3).map(outside).fold(f64::NEG_INFINITY, f64::max);
            (outside_m, (0..3).map(|k| shares[k] * corners[k][2]).sum::<f64>())
        });
        let (outside_m, height) = best.min_by(|one, other| one.0.total_cmp(&other.0))?;
        (outside_m <= self.chord_m() + BESIDE_M).then_some(height)
    }
}

/// The barycentric coordinates of a position in a triangle.
#[must_use]
pub fn shares([a, b, c]: [[f64; 2]; 3], [x, y]: [f64; 2]) -> [f64; 3] {
    let twice = |p: [f64; 2], q: [f64; 2]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
    let parts = [twice(b, c), twice(c, a), twice(a, b)];
    let whole: f64 = parts.iter().sum();
    parts.map(|part| part / whole)
}

/// The transformation from geocentric coordinates to a CRS with heights: two steps of PROJ, through
/// EPSG:4979.
pub struct FromEarth {
    to_degrees: CoordTransform,
    to_crs: CoordTransform,
    metres_per_unit: [f64; 2],
}

/// The region of a package.
#[derive(Clone)]
pub struct Region {
    /// Its CRS with heights, such as "EPSG:32632+5773".
    pub crs: String,
    /// Working metres per unit of the CRS, east and north.
    pub metres_per_unit: [f64; 2],
    /// The DEM that the package was built from.
    pub dem: PathBuf,
}

impl FromEarth {
    /// The transformation to working metres and heights.
    ///
    /// # Panics
    /// When PROJ does not know the CRS.
    #[must_use]
    pub fn to(region: &Region) -> Self {
        let of = |text: &str| {
            let mut crs = SpatialRef::from_definition(text).unwrap();
            crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
            crs
        };
        let degrees = of("EPSG:4979");
        Self {
            to_degrees: CoordTransform::new(&of("EPSG:4978"), &degrees).unwrap(),
            to_crs: CoordTransform::new(&degrees, &of(&region.crs)).unwrap(),
            metres_per_unit: region.metres_per_unit,
        }
    }

    /// Transforms geocentric positions; heights stay in metres.
    ///
    /// # Panics
    /// When PROJ fails.
    #[must_use]
    pub fn carry(&self, at: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.to_crs_of(&Self::step(&self.to_degrees, at))
    }

    /// Transforms the positions within a rectangle of degrees (west, south, east, north), because a
    /// projection may fail far from its centre.
    ///
    /// # Panics
    /// When PROJ fails.
    #[must_use]
    pub fn carry_within(&self, at: &[[f64; 3]], bounds_deg: [f64; 4]) -> Vec<[f64; 3]> {
        let [west, south, east, north] = bounds_deg;
        let mut degrees = Self::step(&self.to_degrees, at);
        degrees.retain(|[lon, lat, _]| {
            // Bounds across 180° continue beyond it.
            let is_between = |lon: f64| (west..=east).contains(&lon);
            (is_between(*lon) || is_between(lon + 360.0)) && (south..=north).contains(lat)
        });
        self.to_crs_of(&degrees)
    }

    fn to_crs_of(&self, at: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let [east, north] = self.metres_per_unit;
        let carried = Self::step(&self.to_crs, at);
        carried.into_iter().map(|[x, y, z]| [x * east, y * north, z]).collect()
    }

    fn step(transform: &CoordTransform, at: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut axes: Vec<Vec<f64>> =
            (0..3).map(|axis| at.iter().map(|p| p[axis]).collect()).collect();
        let [x, y, z] = axes.get_disjoint_mut([0, 1, 2]).unwrap();
        transform.transform_coords(x, y, z).unwrap();
        (0..at.len()).map(|k| [axes[0][k], axes[1][k], axes[2][k]]).collect()
    }
}
