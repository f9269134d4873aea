//! A way is connected to its continuation in a tile of another level, and to nothing else.

use corniche_roads::FunctionalRoadClass;

use super::*;
use crate::tiles::roads::ends::TileSide;

fn end(way_id: i64, side: TileSide, at_m: [f64; 2], height_m: f64) -> RoadEnd {
    let class = FunctionalRoadClass::new(3).expect("a class");
    RoadEnd {
        way_id,
        kind: RoadKind::plain(class),
        side,
        at_m,
        height_range_m: [height_m; 2],
        width_factor: 1.0,
    }
}

/// Compares the connectors between a coarse tile of 200 m (1/0/0) and the finer tile of 100 m to
/// its east (2/2/0).
fn check(coarse: &[RoadEnd], fine: &[RoadEnd], expected: &[[[f64; 2]; 2]]) {
    let id = |z, x, y| TileId::new(z, x, y).expect("a tile");
    let tiles = [
        BorderTile {
            id: id(1, 0, 0),
            side_m: 200.0,
            skirt_depth_m: 5.0,
            reference_m: [0.0; 3],
            ends: coarse,
        },
        BorderTile {
            id: id(2, 2, 0),
            side_m: 100.0,
            skirt_depth_m: 3.0,
            reference_m: [0.0; 3],
            ends: fine,
        },
    ];
    let found: Vec<_> = level_connectors(&tiles).iter().map(|connector| connector.ends_m).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_way_is_connected_to_where_it_goes_on() {
    let coarse = [
        end(7, TileSide::East, [200.0, 150.0], 10.0),
        end(7, TileSide::East, [200.0, 141.0], 10.0),
        end(8, TileSide::East, [200.0, 140.0], 10.0),
    ];
    let fine = [end(7, TileSide::West, [200.0, 140.0], 12.0)];
    check(&coarse, &fine, &[[[200.0, 140.0], [200.0, 141.0]]]);
}

#[test]
fn ends_far_apart_or_on_other_sides_are_not_connected() {
    let coarse = [end(7, TileSide::East, [200.0, 150.0], 10.0)];
    check(&coarse, &[end(7, TileSide::West, [200.0, 140.0], 12.0)], &[]);
    check(&coarse, &[end(7, TileSide::North, [200.0, 150.0], 12.0)], &[]);
    check(&[], &[end(7, TileSide::West, [200.0, 150.0], 12.0)], &[]);
}

#[test]
fn a_connector_reaches_over_both_heights_and_the_deeper_skirt() {
    let id = |z, x, y| TileId::new(z, x, y).expect("a tile");
    let coarse = [end(7, TileSide::East, [200.0, 150.0], 10.0)];
    let fine = [end(7, TileSide::West, [200.0, 150.0], 12.0)];
    let tiles = [
        BorderTile {
            id: id(1, 0, 0),
            side_m: 200.0,
            skirt_depth_m: 5.0,
            reference_m: [0.0; 3],
            ends: &coarse,
        },
        BorderTile {
            id: id(2, 2, 0),
            side_m: 100.0,
            skirt_depth_m: 3.0,
            reference_m: [0.0; 3],
            ends: &fine,
        },
    ];
    let found = level_connectors(&tiles);
    assert_eq!((found[0].fine, found[0].coarse), (1, 0));
    let [low_m, high_m] = found[0].height_range_m;
    assert!((low_m - 5.0).abs() < 1e-9 && (high_m - 17.0).abs() < 1e-9);
}
