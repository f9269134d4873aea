//! Bridges over bridges, drawn by hand.

use super::*;

fn piece(way_id: i64, layer: i8, ends: [[i64; 2]; 2], heights_m: [f64; 2]) -> Piece {
    let ends = ends.map(|[u, v]| LatticePoint::new(u, v));
    let kind = SpanKind::Bridge;
    Piece { way_id, kind, layer, ends, is_end: [false; 2], heights_m }
}

/// The crossings of a bridge of layer 1 along the first axis with another one across it, a quarter along the first.
fn crossed_by(other: Piece) -> Vec<OrderedCrossing> {
    let own = piece(1, 1, [[0, 0], [400, 0]], [10.0, 14.0]);
    let one = crossings(&[own, other], &Work::new(100)).unwrap();
    assert_eq!(crossings(&[other, own], &Work::new(100)).unwrap(), one, "in any order");
    one
}

#[test]
fn the_upper_layer_is_above() {
    let over = piece(2, 2, [[100, -50], [100, 50]], [12.0, 14.0]);
    let found = crossed_by(over);
    assert_eq!(found, [OrderedCrossing { way_ids: [2, 1], free_m: 2.0 }]);
    let beneath = Piece { heights_m: [10.0, 10.0], ..over };
    assert!((crossed_by(beneath)[0].free_m + 1.0).abs() < 1e-12);
    // A lift has a point of its own at the crossing: the two pieces that meet there cross once.
    let lifted = [
        piece(2, 2, [[100, -50], [100, 0]], [12.0, 14.0]),
        piece(2, 2, [[100, 0], [100, 50]], [14.0, 12.0]),
    ];
    let own = piece(1, 1, [[0, 0], [400, 0]], [10.0, 14.0]);
    let all = [&lifted[..], &[own]].concat();
    assert_eq!(crossings(&all, &Work::new(100)).unwrap().len(), 1);
    assert!(crossings(&all, &Work::new(1)).is_err());
}

#[test]
fn what_has_no_order_is_left_out() {
    let over = piece(2, 2, [[100, -50], [100, 50]], [12.0, 14.0]);
    let same_layer = piece(2, 1, [[100, -50], [100, 50]], [12.0, 14.0]);
    assert!(crossed_by(same_layer).is_empty(), "two of one layer");
    let untagged = Piece { layer: 0, ..over };
    assert_eq!(crossed_by(untagged)[0].way_ids, [1, 2], "without a layer, under one with layer 1");
    let tunnel = Piece { kind: SpanKind::Tunnel, layer: -2, ..over };
    assert!(crossed_by(tunnel).is_empty(), "the ground lies between");
    let beside = piece(2, 2, [[100, 10], [100, 50]], [12.0, 14.0]);
    assert!(crossed_by(beside).is_empty());
    // Rounded to a step beyond the line that it ends on; one that goes on there crosses.
    let on = Piece { is_end: [true, false], ..piece(2, 2, [[100, -1], [100, 50]], [12.0, 14.0]) };
    assert!(crossed_by(on).is_empty());
    assert_eq!(crossed_by(Piece { is_end: [false, true], ..on }).len(), 1);
    let joined = piece(2, 2, [[400, 0], [0, 1]], [14.0, 20.0]);
    assert!(crossed_by(joined).is_empty());
}
