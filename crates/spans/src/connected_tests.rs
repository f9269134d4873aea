//! Lines form groups by shared nodes, by common points, and where they may cross.

use super::*;

#[test]
fn lines_hang_together_by_nodes_places_and_crossings() {
    let at = |u, v| LatticePoint::new(u, v);
    let lines = [
        (vec![at(0, 0), at(100, 0)], vec![(0, 1), (1, 2)]),
        // Shares a node with the first line.
        (vec![at(100, 0), at(200, 0)], vec![(0, 2), (1, 3)]),
        // Crosses the second line.
        (vec![at(150, -50), at(150, 50)], vec![(0, 4), (1, 5)]),
        // Begins at a node at the position of node 5, outside all boxes.
        (vec![at(150, 1000), at(150, 2000)], vec![(0, 6)]),
        // Has no contact.
        (vec![at(900, 900), at(990, 990)], vec![(0, 7), (1, 8)]),
    ];
    let lines: Vec<SpanLine<'_>> =
        lines.iter().map(|(points, nodes)| SpanLine { points, nodes }).collect();
    assert_eq!(connected(&lines, &[[5, 6]]), [0, 0, 0, 0, 4]);
    assert_eq!(connected(&lines, &[]), [0, 0, 0, 3, 4]);
}

/// A line of very many points is not compared point by point with all others.
#[test]
fn a_zigzag_of_a_million_points_is_one_group() {
    let points: Vec<LatticePoint> =
        (0..1_000_000).map(|k| LatticePoint::new(k % 2 * 1_000_000, k)).collect();
    let line = SpanLine { points: &points, nodes: &[] };
    assert_eq!(connected(&[line, line], &[]), [0, 0]);
}
