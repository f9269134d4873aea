//! The check of seams finds a missing vertex and a moved one.

use corniche_tin::TinVertex;

use super::*;

fn tile(east_heights: &[(u16, i32)]) -> Tin {
    // A fan from the middle of the west border to the vertices on the east border.
    let mut vertices = vec![TinVertex { row: 128, column: 0, height_q: 0 }];
    vertices.extend(east_heights.iter().map(|&(row, height_q)| TinVertex {
        row,
        column: 256,
        height_q,
    }));
    let triangles: Vec<[u32; 3]> = (1..east_heights.len() as u32).map(|k| [0, k + 1, k]).collect();
    Tin::new(vertices, &triangles).unwrap()
}

#[test]
fn sees_a_missing_vertex_and_a_moved_one() {
    let east = |heights: &[(u16, i32)]| borders(&tile(heights))[TileEdge::East as usize].clone();
    let reference = east(&[(0, 1), (100, 5), (256, 3)]);
    assert!(differences(&reference, &reference).is_empty());
    assert_eq!(differences(&reference, &east(&[(0, 1), (256, 3)])), [100]);
    assert_eq!(differences(&reference, &east(&[(0, 1), (100, 6), (256, 3)])), [100]);
    // Where the ground continues on one side only, its vertices need no partner; where the other
    // side's ground ends, they need one.
    assert!(differences(&reference, &east(&[(0, 1), (100, 5)])).is_empty());
    assert_eq!(differences(&reference, &east(&[(0, 1), (90, 4)])), [90]);
}
