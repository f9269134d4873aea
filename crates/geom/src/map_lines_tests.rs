//! Lines and areas on maps agree with closed forms, or with sums over very many short pieces.

use std::f64::consts::FRAC_PI_4;

use super::*;

/// The isometric latitude of a latitude in radians (Snyder 1987, equation 7-7 divided by the
/// radius).
fn isometric(lat: f64) -> f64 {
    let e = wgs84::ECCENTRICITY_2.sqrt();
    let e_sin = e * lat.sin();
    ((FRAC_PI_4 + lat / 2.0).tan() * ((1.0 - e_sin) / (1.0 + e_sin)).powf(e / 2.0)).ln()
}

/// Mercator's map of the ellipsoid, in radians at the equator.
fn mercator([x, y]: [f64; 2]) -> [f64; 2] {
    // Newton's method with the slope on the sphere.
    let mut lat = y.sinh().atan();
    for _ in 0..50 {
        lat += (y - isometric(lat)) * lat.cos();
    }
    [x.to_degrees(), lat.to_degrees()]
}

fn on_mercator([lon_deg, lat_deg]: [f64; 2]) -> [f64; 2] {
    [lon_deg.to_radians(), isometric(lat_deg.to_radians())]
}

/// A perspective map of the southern polar region: positions are angles at the pole, in all
/// directions.
fn polar([x, y]: [f64; 2]) -> [f64; 2] {
    [x.atan2(y).to_degrees(), 2.0 * x.hypot(y).atan().to_degrees() - 90.0]
}

/// The length of the meridian between two latitudes in degrees, by Simpson's rule.
fn meridian_m(from_deg: f64, to_deg: f64) -> f64 {
    let count = 20_000;
    let step = (to_deg - from_deg) / f64::from(count);
    let radius = |k: i32| wgs84::radii_m(from_deg + f64::from(k) * step)[1];
    let weight = |k: i32| if k == 0 || k == count { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
    (0..=count).map(|k| weight(k) * radius(k)).sum::<f64>() * step.to_radians() / 3.0
}

/// A line that is straight in Mercator's map has a constant angle to meridians, so its length is
/// that of the meridian divided by a cosine.
#[test]
fn loxodromes_are_as_long_as_the_meridian_says() {
    for (from, to) in [
        ([9.0, 47.0], [9.8, 47.3]),
        ([13.7, 70.1], [15.3, 70.9]),
        ([0.0, 0.0], [9.5, 47.0]),
        ([0.0, 60.0], [60.0, 84.0]),
        ([170.0, -17.0], [175.0, 17.5]),
    ] {
        let ends = [from, to].map(on_mercator);
        let [east, north] = [0, 1].map(|axis: usize| ends[1][axis] - ends[0][axis]);
        let expected_m = meridian_m(from[1], to[1]) * east.hypot(north) / north;
        let found_m = line_length_m(ends, &mercator);
        assert!((found_m / expected_m - 1.0).abs() < 2e-10, "{found_m} {expected_m}");
    }
    let along_m = wgs84::radii_m(70.0)[0] * 2_f64.to_radians();
    let found_m = line_length_m([[9.0, 70.0], [11.0, 70.0]], &|at| at);
    assert!((found_m - along_m).abs() < 1e-5, "{found_m} {along_m}");
}

/// Straight lines near a pole, for which a formula with their ends alone is wrong by metres, and
/// one line through it.
#[test]
fn lines_beside_a_pole_are_as_long_as_their_pieces() {
    for ends in [
        [[-0.002, -0.1], [0.005, -0.095]],
        [[-0.1, 0.01], [0.1, 0.01]],
        [[-0.01, 0.0], [0.02, 0.0]],
    ] {
        let at = |share: f64| {
            [0, 1].map(|axis: usize| ends[0][axis] + share * (ends[1][axis] - ends[0][axis]))
        };
        let count = 300_000;
        let places: Vec<[f64; 2]> =
            (0..=count).map(|k| polar(at(f64::from(k) / f64::from(count)))).collect();
        let pieces_m: f64 =
            places.array_windows().map(|&[from, to]| wgs84::short_distance_m(from, to)).sum();
        let found_m = line_length_m(ends, &polar);
        // The piece over the pole itself is measured inaccurately.
        assert!(
            (found_m - pieces_m).abs() < 1e-9 * pieces_m + 5.0 * f64::from(ends[1][1] == 0.0),
            "{found_m} {pieces_m}"
        );
        if ends[1][1] != 0.0 {
            let of_ends_m = wgs84::short_distance_m(places[0], places[places.len() - 1]);
            assert!((of_ends_m - found_m).abs() > 1.0, "{of_ends_m} {found_m}");
        }
    }
}

/// Short lines are measured by their ends, to the bit, and positions outside the map give no
/// number.
#[test]
fn short_lines_are_measured_by_their_ends() {
    let ends = [[9.5, 47.0], [9.505, 47.005]];
    let of_ends_m = wgs84::short_distance_m(ends[0], ends[1]);
    assert_eq!(line_length_m(ends, &|at| at).to_bits(), of_ends_m.to_bits());
    assert!(line_length_m([[9.5, 47.0], [9.9, 47.0]], &|_| [f64::NAN; 2]).is_nan());
    let torn = |[x, y]: [f64; 2]| if x > 9.6 && x < 9.8 { [f64::NAN; 2] } else { [x, y] };
    assert!(line_length_m([[9.5, 47.0], [9.9, 47.0]], &torn).is_nan());
}

/// Areas agree with those of the same ring with very many corners along its sides, and of a box in
/// degrees in closed form.
#[test]
fn areas_are_those_of_what_the_sides_surround() {
    let maps: [(&Degrees<'_>, Vec<[f64; 2]>); 3] = [
        (&mercator, [[8.0, 46.0], [12.0, 46.5], [11.0, 49.0]].map(on_mercator).to_vec()),
        (&polar, vec![[0.05, 0.05], [0.3, 0.06], [0.2, 0.2], [0.06, 0.1]]),
        (&|at| at, vec![[9.5, -17.4], [10.5, -17.4], [10.5, -16.4], [9.5, -16.4]]),
    ];
    for (degrees, ring) in maps {
        let ring_deg: Vec<[f64; 2]> = ring.iter().map(|&corner| degrees(corner)).collect();
        let found_m2 = ring_area_m2(&ring_deg, &|side| side.map(|corner| ring[corner]), degrees);
        let dense = ring.iter().zip(ring.iter().cycle().skip(1)).flat_map(|(&from, &to)| {
            let at = move |share: f64| {
                [0, 1].map(|axis: usize| from[axis] + share * (to[axis] - from[axis]))
            };
            (0..20_000).map(move |k| degrees(at(f64::from(k) / 2e4)))
        });
        let expected_m2 = wgs84::area_m2(&dense.collect::<Vec<_>>());
        assert!((found_m2 / expected_m2 - 1.0).abs() < 1e-9, "{found_m2} {expected_m2}");
    }
}
