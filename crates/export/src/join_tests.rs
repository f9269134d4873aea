//! Pieces of a way are joined across tiles, each exactly once, and gaps stay gaps.

use corniche_roads::{FunctionalRoadClass, RoadAttributes};

use super::*;
use crate::piece::PieceKey;

/// A piece of a tile through these places, all at one height.
fn piece(tile: u64, part: u32, places: &[[f64; 2]], goes_on: [bool; 2]) -> WayPiece {
    let vertices = places.iter().map(|&at| Vertex { at, z_m: 5.0, is_source: true });
    WayPiece {
        key: PieceKey { way_id: 1, tile, part, cut: 0 },
        class: FunctionalRoadClass::new(0).unwrap(),
        attributes: RoadAttributes::default(),
        vertices: vertices.collect(),
        goes_on,
        heights: crate::piece::PieceHeights {
            tolerance_m: Some(0.5),
            ground_m: None,
            on_deck: false,
            has_deck: false,
        },
    }
}

fn places(line: &JoinedLine) -> Vec<[f64; 2]> {
    line.vertices.iter().map(|vertex| vertex.at).collect()
}

/// A way from west to east through three tiles, whose pieces come in the package's order, is one
/// line with each place once.
#[test]
fn pieces_that_meet_on_a_border_are_one_line() {
    let pieces = [
        piece(1, 0, &[[20.0, 0.0], [25.0, 1.0], [30.0, 0.0]], [true, false]),
        piece(2, 0, &[[10.0, 0.0], [20.0, 0.0]], [true, true]),
        piece(3, 0, &[[0.0, 0.0], [10.0, 0.0]], [false, true]),
    ];
    let [line] = &lines(&pieces)[..] else { panic!("{:?}", lines(&pieces)) };
    assert_eq!(places(line), [[0.0, 0.0], [10.0, 0.0], [20.0, 0.0], [25.0, 1.0], [30.0, 0.0]]);
    assert_eq!(line.joins, [1, 2]);
}

/// Lines end where there is no ground, and where the heights on a border differ.
#[test]
fn gaps_stay_gaps() {
    let mut pieces = [
        piece(1, 0, &[[0.0, 0.0], [4.0, 0.0]], [false, false]),
        piece(1, 1, &[[6.0, 0.0], [10.0, 0.0]], [false, true]),
        piece(2, 0, &[[10.0, 0.0], [20.0, 0.0]], [true, false]),
        piece(3, 0, &[[20.0, 0.0], [30.0, 0.0]], [true, false]),
    ];
    let parts: Vec<_> = lines(&pieces).iter().map(places).collect();
    assert_eq!(
        parts,
        [
            vec![[0.0, 0.0], [4.0, 0.0]],
            vec![[6.0, 0.0], [10.0, 0.0], [20.0, 0.0]],
            vec![[20.0, 0.0], [30.0, 0.0]],
        ]
    );
    pieces[2].vertices[0].z_m += 1e-3;
    assert_eq!(lines(&pieces).len(), 4);
}

/// A ring begins where the way begins, if that is inside a tile, and is closed; a ring inside one
/// tile is unchanged.
#[test]
fn rings_stay_rings() {
    let pieces = [
        piece(1, 0, &[[5.0, 0.0], [10.0, 0.0]], [false, true]),
        piece(1, 1, &[[10.0, 9.0], [5.0, 0.0]], [true, false]),
        piece(2, 0, &[[10.0, 0.0], [20.0, 5.0], [10.0, 9.0]], [true, true]),
    ];
    let [line] = &lines(&pieces)[..] else { panic!("{:?}", lines(&pieces)) };
    assert_eq!(places(line), [[5.0, 0.0], [10.0, 0.0], [20.0, 5.0], [10.0, 9.0], [5.0, 0.0]]);
    // Begins on the border.
    let pieces = [
        piece(1, 0, &[[10.0, 9.0], [10.0, 0.0]], [true, true]),
        piece(2, 0, &[[10.0, 0.0], [20.0, 5.0], [10.0, 9.0]], [true, true]),
    ];
    let [line] = &lines(&pieces)[..] else { panic!("{:?}", lines(&pieces)) };
    assert_eq!(places(line).len(), 4);
    let alone = [piece(1, 0, &[[10.0, 0.0], [5.0, 5.0], [10.0, 0.0]], [true, true])];
    assert_eq!(lines(&alone).len(), 1);
}

/// If a way touches a border twice at one place, every piece is in exactly one line.
#[test]
fn each_piece_is_in_one_line() {
    let meet = [10.0, 0.0];
    let pieces = [
        piece(1, 0, &[[0.0, 0.0], meet], [false, true]),
        piece(1, 1, &[meet, [5.0, 5.0], meet], [true, true]),
        piece(2, 0, &[meet, [20.0, 0.0], meet], [true, true]),
    ];
    let found = lines(&pieces);
    let segments: usize = found.iter().map(|line| line.vertices.len() - 1).sum();
    assert_eq!(segments, 5, "{found:?}");
    assert_eq!(found.len(), 1, "{found:?}");
}
