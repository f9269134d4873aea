//! Lines on bilinear ground: the positions of their vertices, and their distance from the ground
//! between vertices.

use super::*;

const STEPS: [f64; 2] = [100.0, 200.0];

#[test]
fn a_line_has_vertices_at_cell_lines_and_in_the_middle_of_cells() {
    let found = places_between([50.0, 100.0], [250.0, 100.0], STEPS);
    let expected = [
        [75.0, 100.0],
        [100.0, 100.0],
        [150.0, 100.0],
        [200.0, 100.0],
        [225.0, 100.0],
        [250.0, 100.0],
    ];
    assert_eq!(found.concat(), expected);
    // At a node both lines of the grid are crossed at once.
    let found = places_between([50.0, 100.0], [150.0, 300.0], STEPS);
    assert_eq!(found.concat(), [[75.0, 150.0], [100.0, 200.0], [125.0, 250.0], [150.0, 300.0]]);
    // Along a line of the grid.
    let found = places_between([100.0, 0.0], [100.0, 400.0], STEPS);
    assert_eq!(found.concat(), [[100.0, 100.0], [100.0, 200.0], [100.0, 300.0], [100.0, 400.0]]);
}

#[test]
fn both_directions_have_the_same_places() {
    let mut from = [13.0, -7.0];
    for k in 0..200_u32 {
        let to = [f64::from(k * 7919 % 1000) - 500.0, f64::from(k * 104_729 % 900) - 400.0];
        let there = places_between(from, to, STEPS).concat();
        let back = places_between(to, from, STEPS).concat();
        assert_eq!((there.last(), back.last()), (Some(&to), Some(&from)));
        let inner = there.len() - 1;
        assert!(there[..inner].iter().eq(back[..back.len() - 1].iter().rev()), "{from:?} {to:?}");
        from = to;
    }
}
