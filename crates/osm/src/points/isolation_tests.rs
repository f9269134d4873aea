//! Distances to the nearest higher node, against all pairs.

use proptest::prelude::*;

use super::*;

/// The distance between two places by the haversine formula, metres.
fn haversine_m(one: Location, other: Location) -> f64 {
    let [[lon, lat], [lon_2, lat_2]] =
        [one, other].map(|at| at.map(|angle| (f64::from(angle) / 1e7).to_radians()));
    let half = |angle: f64| (angle / 2.0).sin().powi(2);
    let share = half(lat_2 - lat) + lat.cos() * lat_2.cos() * half(lon_2 - lon);
    2.0 * EARTH_RADIUS_M * share.sqrt().asin()
}

proptest! {
    #[test]
    fn the_nearest_higher_node_is_that_of_all_pairs(
        nodes in prop::collection::vec(
            (-1_800_000_000_i32..=1_800_000_000, -900_000_000_i32..=900_000_000, 0_i32..40),
            0..60,
        ),
    ) {
        let high = nodes.iter().enumerate().map(|(number, &(lon, lat, height))| HighNode {
            number: number as u64,
            at: [lon, lat],
            height: height.into(),
        });
        let found = distances(high.collect(), |_| Ok::<_, ()>(())).unwrap();
        for (number, &(lon, lat, height)) in nodes.iter().enumerate() {
            let higher = nodes.iter().enumerate().filter(|&(other, &(_, _, above))| {
                above > height || above == height && other < number
            });
            let all = higher.map(|(_, &(x, y, _))| haversine_m([lon, lat], [x, y]));
            let expected = all.fold(PI * EARTH_RADIUS_M, f64::min);
            let (of, own) = found[number];
            prop_assert!(of == number as u64 && (own - expected).abs() < 1.0, "{own} {expected}");
        }
    }
}
