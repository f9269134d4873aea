//! Crossings of bridges that are drawn by hand.

use super::*;

fn piece(way_id: i64, layer: i8, ends: [[i64; 2]; 2], heights_m: [f64; 2]) -> RunPiece {
    let ends = ends.map(|[u, v]| LatticePoint::new(u, v));
    let kind = SpanKind::Bridge;
    RunPiece { way_id, kind, layer, ends, is_end: [false; 2], heights_m }
}

/// The crossings of a bridge of layer 1 along the first axis with another one across it, at a
/// quarter of the first.
fn crossed_by(other: RunPiece) -> Vec<OrderedCrossing> {
    let own = piece(1, 1, [[0, 0], [400, 0]], [10.0, 14.0]);
    let one = crossings(&[own, other], &StepBudget::new(100)).unwrap();
    assert_eq!(crossings(&[other, own], &StepBudget::new(100)).unwrap(), one, "in any order");
    one
}

#[test]
fn the_upper_layer_is_above() {
    let over = piece(2, 2, [[100, -50], [100, 50]], [12.0, 14.0]);
    let found = crossed_by(over);
    assert_eq!(found, [OrderedCrossing { way_ids: [2, 1], free_m: 2.0 }]);
    let beneath = RunPiece { heights_m: [10.0, 10.0], ..over };
    assert!((crossed_by(beneath)[0].free_m + 1.0).abs() < 1e-12);
    // A lift has a point of its own at the crossing: the two pieces that meet there cross once.
    let lifted = [
        piece(2, 2, [[100, -50], [100, 0]], [12.0, 14.0]),
        piece(2, 2, [[100, 0], [100, 50]], [14.0, 12.0]),
    ];
    let own = piece(1, 1, [[0, 0], [400, 0]], [10.0, 14.0]);
    let all = [&lifted[..], &[own]].concat();
    assert_eq!(crossings(&all, &StepBudget::new(100)).unwrap().len(), 1);
    assert!(crossings(&all, &StepBudget::new(1)).is_err());
}

#[test]
fn what_has_no_order_is_left_out() {
    let over = piece(2, 2, [[100, -50], [100, 50]], [12.0, 14.0]);
    let same_layer = piece(2, 1, [[100, -50], [100, 50]], [12.0, 14.0]);
    assert!(crossed_by(same_layer).is_empty(), "two of one layer");
    let untagged = RunPiece { layer: 0, ..over };
    assert_eq!(crossed_by(untagged)[0].way_ids, [1, 2], "without a layer, under one with layer 1");
    let tunnel = RunPiece { kind: SpanKind::Tunnel, layer: -2, ..over };
    assert!(crossed_by(tunnel).is_empty(), "the ground lies between");
    let beside = piece(2, 2, [[100, 10], [100, 50]], [12.0, 14.0]);
    assert!(crossed_by(beside).is_empty());
    // A run that is rounded to a step beyond the line on which it ends does not cross; one that
    // continues does.
    let on =
        RunPiece { is_end: [true, false], ..piece(2, 2, [[100, -1], [100, 50]], [12.0, 14.0]) };
    assert!(crossed_by(on).is_empty());
    assert_eq!(crossed_by(RunPiece { is_end: [false, true], ..on }).len(), 1);
    let joined = piece(2, 2, [[400, 0], [0, 1]], [14.0, 20.0]);
    assert!(crossed_by(joined).is_empty());
}
