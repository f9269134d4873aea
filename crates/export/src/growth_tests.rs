//! Ends at borders and bounds do not count as points of the way.

use corniche_geom::LatticePoint;
use corniche_roads::RoadAttributes;

use super::*;
use crate::piece::PieceKey;

/// A piece from one place to another; each end is a point of the line or not.
fn piece(ends: [([f64; 2], bool); 2], goes_on: [bool; 2]) -> WayPiece {
    WayPiece {
        key: PieceKey { way_id: 1, tile: 0, part: 0, cut: 0 },
        class: FunctionalRoadClass::new(0).unwrap(),
        attributes: RoadAttributes::default(),
        vertices: ends.map(|(at, is_source)| Vertex { at, z_m: 0.0, is_source }).to_vec(),
        goes_on,
        heights: crate::piece::PieceHeights {
            tolerance_m: Some(0.5),
            ground_m: None,
            on_deck: false,
            has_deck: false,
        },
    }
}

#[test]
fn ends_at_borders_and_at_bounds_are_cuts_and_others_are_points() {
    let clip = Some(LatticeBounds {
        min: LatticePoint { u: 10, v: -10 },
        max: LatticePoint { u: 90, v: 70 },
    });
    let inside = ([50.0, 30.0], true);
    for (end, goes_on, is_cut, is_cut_by_bounds) in [
        // In a tile, on its border, on each side of the bounds.
        (([20.0, 30.0], true), false, false, false),
        (([20.0, 30.0], true), true, true, true),
        (([10.0, 30.0], true), false, false, true),
        (([90.0, 30.0], true), false, false, true),
        (([20.0, -10.0], true), false, false, true),
        (([20.0, 70.0], true), false, false, true),
        // Where the ground ends there is never a point.
        (([10.0, 30.0], false), false, false, false),
    ] {
        for pieces in
            [[piece([end, inside], [goes_on, false])], [piece([inside, end], [false, goes_on])]]
        {
            assert_eq!(cut_ends(&pieces, None), u64::from(is_cut), "{end:?}");
            assert_eq!(cut_ends(&pieces, clip), u64::from(is_cut_by_bounds), "{end:?}");
        }
    }
}
