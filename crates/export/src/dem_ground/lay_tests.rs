//! Lines on bilinear ground: where their vertices are, and how far they are from it between them.

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
    // Through a node both lines of the grid are crossed at once.
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

/// A parabola that is largest between its places, at an end, and where it changes its sign.
#[test]
fn the_largest_value_of_a_parabola_is_found() {
    let along = |a: f64, b: f64, c: f64| {
        let at = |t: f64| a + t * (b + t * c);
        let found = largest(at(0.0), at(0.5), at(1.0));
        let expected = (0..=10_000).map(|k| at(f64::from(k) / 1e4).abs()).fold(0.0, f64::max);
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    };
    for [a, b, c] in
        [[1.0, 4.0, -5.0], [0.0, 0.0, 0.0], [2.0, -9.0, 9.0], [0.0, 1.0, 0.0], [1.0, -3.0, 1.4]]
    {
        along(a, b, c);
    }
}
