//! Windows over several blocks have the heights of their own nodes, and each block is sampled once.

use std::cell::Cell;

use proptest::prelude::*;

use super::*;
use crate::quantized_mesh::Tiling;

const NODES: RasterNodes =
    RasterNodes { tiling: Tiling::Geographic, level: 6, per_tile: 64, parts: 1 };

proptest! {
    #[test]
    fn of_nodes_is_what_the_sampler_tells_of_each(
        windows in prop::collection::vec((-70_i64..70, 2000_i64..2070, 0_i64..40, 0_i64..40), 1..6),
    ) {
        let sampled = Cell::new(0_usize);
        let height_m = |[lon, lat]: [f64; 2]| 1000.0 * lon + lat;
        let sample = |places: &[[f64; 2]]| {
            sampled.set(sampled.get() + places.len());
            Ok(places.iter().map(|&place| height_m(place)).collect())
        };
        let heights = NodeHeights::new();
        for (west, south, columns, rows) in windows {
            let (east, north) = (west + columns, south + rows);
            let found = heights.of_nodes(NODES, [west, south], [east, north], sample).unwrap();
            let nodes = (south..=north).flat_map(|j| (west..=east).map(move |i| [i, j]));
            let wanted: Vec<f64> =
                nodes.map(|[i, j]| height_m([NODES.lon_deg(i), NODES.lat_deg(j)])).collect();
            prop_assert_eq!(&found, &wanted);
            let before = sampled.get();
            let again = heights.of_nodes(NODES, [west, south], [east, north], sample).unwrap();
            prop_assert_eq!(again, wanted);
            prop_assert_eq!(sampled.get(), before, "nothing is sampled twice");
        }
    }
}
