//! The coordinate table is accurate to a centimetre in both directions, and its scale agrees with
//! closed forms.

use super::*;

/// A sphere in Mercator's projection around longitude 179: curved, and across the antimeridian.
struct Mercator;
const R: f64 = 6_371_000.0;

impl Projection for Mercator {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for p in points {
            let lon = near_longitude(p[0], 179.0) - 179.0;
            *p = [R * lon.to_radians(), R * p[1].to_radians().tan().asinh()];
        }
        Ok(())
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for p in points {
            *p = [
                near_longitude(179.0 + (p[0] / R).to_degrees(), 0.0),
                (p[1] / R).sinh().atan().to_degrees(),
            ];
        }
        Ok(())
    }
}

fn table() -> CoordinateTable {
    let bounds = Bounds { min_x: -2e5, min_y: 5.9e6, max_x: 3e5, max_y: 6.4e6 };
    CoordinateTable::sample(&Mercator, bounds, 0.01).unwrap()
}

#[test]
fn is_within_a_centimetre_both_ways_across_the_antimeridian() {
    let table = table();
    for k in 0..200 {
        let at = [-2e5 + 2500.0 * f64::from(k), 5.9e6 + 2500.0 * f64::from((k * 37) % 200)];
        let mut truth = [at];
        Mercator.wgs84_from_working(&mut truth).unwrap();
        let [lon, lat] = table.wgs84_from_working(at);
        let east = near_longitude(truth[0][0] - lon, 0.0) * lat.to_radians().cos();
        assert!(east.hypot(truth[0][1] - lat) * METRES_PER_DEGREE < 0.01);
        let back = table.working_from_wgs84(truth[0]).unwrap();
        assert!((back[0] - at[0]).hypot(back[1] - at[1]) < 0.03, "{at:?} came back as {back:?}");
    }
}

/// Degrees times two factors, like the working metres of a geographic DEM.
struct Geographic([f64; 2]);

impl Projection for Geographic {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for p in points {
            *p = [p[0] * self.0[0], p[1] * self.0[1]];
        }
        Ok(())
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for p in points {
            *p = [p[0] / self.0[0], p[1] / self.0[1]];
        }
        Ok(())
    }
}

/// Degrees of the WGS84 ellipsoid at 47° N, from tables: 76 056.0 m of longitude, 111 170.8 m of
/// latitude.
#[test]
fn the_scale_of_degrees_is_what_tables_of_their_lengths_say() {
    let factors = [80_000.0, 100_000.0];
    let bounds = Bounds { min_x: 9.0 * 8e4, min_y: 46.5e5, max_x: 10.0 * 8e4, max_y: 47.5e5 };
    let table = CoordinateTable::sample(&Geographic(factors), bounds, 0.01).unwrap();
    let [east, north] = table.scale_at([9.5 * 8e4, 47.0e5]).unwrap();
    assert!((east - factors[0] / 76_056.0).abs() < 1e-5, "{east}");
    assert!((north - factors[1] / 111_170.8).abs() < 1e-5, "{north}");
}

/// On a sphere of radius R Mercator's scale is 1 / cos φ in both directions; on the ellipsoid it
/// differs by the ellipsoid's radii.
#[test]
fn the_scale_of_mercator_is_one_over_the_cosine() {
    let table = table();
    for y in [5.95e6, 6.1e6, 6.3e6] {
        let lat_rad = (y / R).sinh().atan();
        let [parallel_m, meridian_m] = wgs84::radii_m(lat_rad.to_degrees());
        let [east, north] = table.scale_at([1e5, y]).unwrap();
        assert!((east - R / parallel_m).abs() < 1e-6, "{east} at {y}");
        // Over a kilometre the length of a degree of latitude is nearly constant.
        assert!((north - R / lat_rad.cos() / meridian_m).abs() < 1e-6, "{north} at {y}");
    }
    assert_eq!(table.scale_at([f64::NAN, 6e6]), None);
}

/// A true circle is an ellipse in working metres: the distance between two of its tangents in a
/// direction is twice the radius across the direction, multiplied by the factor.
#[test]
fn a_circle_is_as_wide_across_any_direction_as_the_factor_says() {
    let scale = [1.5, 0.8];
    for k in 0..36 {
        let (sin, cos) = (f64::from(k) * 0.17).sin_cos();
        let across = (0..10_000)
            .map(|n| {
                let (y, x) = (f64::from(n) * std::f64::consts::TAU / 10_000.0).sin_cos();
                scale[1] * y * cos - scale[0] * x * sin
            })
            .fold(0.0, f64::max);
        let factor = width_factor(scale, [cos * 7.0, sin * 7.0]);
        assert!((factor - across).abs() < 1e-6, "{factor} {across}");
    }
    assert!((width_factor([2.0, 2.0], [0.3, -4.0]) - 2.0).abs() < 1e-12);
    assert!((width_factor(scale, [0.0; 2]) - 0.8).abs() < 1e-12);
}

#[test]
fn survives_being_written_and_refuses_a_damaged_one() {
    let CoordinateTable { bounds, samples_deg, .. } = table();
    let record = TableRecord { bounds, size: 4, samples_deg };
    assert!(CoordinateTable::try_from(record).is_err());
}
