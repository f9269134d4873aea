//! Lines and areas beyond the polygon are found: uncut ones, filled holes and closed notches.
//! Rounding is tolerated.

use corniche_tileset::AreaPolygon;

use super::*;

type Ring = Vec<[i64; 2]>;

fn points(ring: &[[i64; 2]]) -> Vec<LatticePoint> {
    ring.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect()
}

fn square([u, v]: [i64; 2], side: i64) -> Ring {
    vec![[u, v], [u + side, v], [u + side, v + side], [u, v + side]]
}

fn clockwise(mut ring: Ring) -> Ring {
    ring.reverse();
    ring
}

/// A square of 1000 steps with a hole, a notch from the north to the middle, two notches from the
/// south; and another square, which overlaps its north-eastern corner.
fn region() -> LatticeRegion {
    let outer = [
        [0, 0],
        [100, 0],
        [100, 300],
        [200, 300],
        [200, 0],
        [300, 0],
        [300, 300],
        [400, 300],
        [400, 0],
        [1000, 0],
        [1000, 1000],
        [550, 1000],
        [550, 700],
        [450, 700],
        [450, 1000],
        [0, 1000],
    ];
    let hole = square([600, 400], 100);
    let polygons = [vec![points(&outer), points(&hole)], vec![points(&square([900, 900], 300))]];
    LatticeRegion::new(&polygons).unwrap()
}

fn holds(rings: &[Ring]) -> bool {
    let part = AreaPolygon { rings: rings.iter().map(|ring| points(ring)).collect() };
    Cut { region: &region(), beyond: 3.0 }.holds_shape(&LayerShape::Area(vec![part]))
}

#[test]
fn what_was_cut_holds() {
    assert!(holds(&[square([10, 400], 200)]), "far from all outlines");
    assert!(holds(&[square([0, 400], 300)]), "along the outline");
    assert!(holds(&[square([-2, 398], 300)]), "rounded");
    let around_the_hole = [square([560, 360], 180), clockwise(square([600, 400], 100))];
    assert!(holds(&around_the_hole));
    let smaller = [square([560, 360], 180), clockwise(square([603, 402], 96))];
    assert!(holds(&smaller), "rounded");
    assert!(
        holds(&[square([850, 850], 150), square([901, 901], 250)]),
        "corners inside the other polygon"
    );
    let three_sides = vec![
        [0, 400],
        [440, 400],
        [440, 690],
        [560, 690],
        [560, 800],
        [590, 800],
        [590, 310],
        [0, 310],
    ];
    assert!(holds(&[clockwise(three_sides)]));
}

#[test]
fn what_was_not_cut_lies_beyond() {
    assert!(!holds(&[square([2000, 2000], 100)]), "far away");
    assert!(!holds(&[square([-100, 400], 300)]), "over the outline");
    assert!(!holds(&[square([-5, 400], 300)]), "a little over the outline");
    assert!(!holds(&[square([560, 360], 180)]), "over the hole");
    assert!(
        !holds(&[square([560, 360], 180), clockwise(square([605, 410], 80))]),
        "over some of it"
    );
    assert!(!holds(&[vec![[400, 800], [600, 800], [600, 900], [400, 900]]]), "over a notch");
    // The middles of its long sides lie between two notches.
    assert!(!holds(&[vec![[50, 100], [450, 100], [450, 200], [50, 200]]]), "over two notches");
    assert!(!holds(&[square([-50, -50], 2000)]), "over everything");
}

#[test]
fn lines_are_looked_at_between_their_points() {
    let region = region();
    let cut = Cut { region: &region, beyond: 3.0 };
    let holds = |line: &[[i64; 2]]| cut.holds_shape(&LayerShape::Line(points(line)));
    assert!(holds(&[[10, 500], [500, 600], [590, 600]]));
    assert!(holds(&[[0, 0], [0, 1000]]), "along the outline");
    assert!(holds(&[[-2, 0], [-2, 1000]]), "rounded");
    assert!(!holds(&[[-5, 0], [-5, 1000]]));
    assert!(!holds(&[[50, 100], [450, 100]]), "over two notches");
    assert!(!holds(&[[590, 450], [710, 450]]), "over the hole");
    assert!(!holds(&[[500, 650], [500, 800]]), "into a notch");
}

/// Cells of 16 m on level 0 of two levels, on a lattice of some millimetres; and cells so wide that
/// a lattice step is a metre.
#[test]
fn what_is_allowed_follows_the_cells() {
    let frame = corniche_testing::package::frame();
    let step_m = frame.lattice_step_m();
    let coarse_m = frame.level_cell(0).shorter_m();
    assert!((beyond_steps(&frame, 0) * step_m - 0.75 * coarse_m).abs() < 1e-9);
    let finest = beyond_steps(&frame, frame.max_level());
    assert!((finest - (0.3 / step_m).max(3.0)).abs() < 1e-9);
}
