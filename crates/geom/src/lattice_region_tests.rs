//! A region contains exactly the points that a search over all its edges finds.

use proptest::prelude::*;

use super::*;
use crate::NodeIndex;

fn points(corners: &[[i64; 2]]) -> Vec<LatticePoint> {
    corners.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect()
}

impl LatticeRegion {
    /// Asserts the invariants of every region.
    fn check_invariants(&self) {
        for edge in &self.edges {
            assert!(edge.low != edge.high && edge.low.v <= edge.high.v, "{edge:?}");
            assert!(self.bounds.contains(edge.low) && self.bounds.contains(edge.high), "{edge:?}");
            for v in [edge.low.v, edge.high.v] {
                assert!(self.edges_between(v, v).any(|found| found == edge), "{edge:?} at {v}");
            }
        }
        let all: Vec<&Edge> = self.edges_between(self.bounds.min.v, self.bounds.max.v).collect();
        assert_eq!(all.len(), self.edges.len(), "each edge once");
    }
}

fn region(polygons: &[&[&[[i64; 2]]]]) -> LatticeRegion {
    let polygons: Vec<Vec<Vec<LatticePoint>>> =
        polygons.iter().map(|rings| rings.iter().map(|ring| points(ring)).collect()).collect();
    let region = LatticeRegion::new(&polygons).unwrap();
    region.check_invariants();
    region
}

/// The inside nodes of a window from (0, 0) to (columns − 1, rows − 1), as rows of text from the
/// north.
fn picture(region: &LatticeRegion, steps: [i64; 2], columns: usize, rows: usize) -> Vec<String> {
    let corner = NodeIndex { i: 0, j: rows as i64 - 1 };
    let nodes = region.nodes(steps, &NodeWindow { corner, stride: 1, columns, rows });
    nodes
        .chunks(columns)
        .map(|row| row.iter().map(|&inside| if inside { '#' } else { '.' }).collect())
        .collect()
}

#[test]
fn a_rectangle_between_nodes_has_these_nodes() {
    let own = region(&[&[&[[10, 20], [30, 20], [30, 40], [10, 40]]]]);
    assert_eq!(
        picture(&own, [10, 10], 6, 6),
        ["......", ".###..", ".###..", ".###..", "......", "......"]
    );
}

#[test]
fn a_step_beyond_a_node_takes_the_next_cell() {
    let own = region(&[&[&[[9, 20], [30, 20], [30, 41], [9, 41]]]]);
    assert_eq!(
        picture(&own, [10, 10], 6, 6),
        ["####..", "####..", "####..", "####..", "......", "......"]
    );
}

#[test]
fn a_hole_has_no_nodes_but_those_of_cells_it_leaves_over() {
    // The hole removes the four cells around node (3, 3) completely, so only that node is outside.
    let hole: &[[i64; 2]] = &[[20, 20], [40, 20], [40, 40], [20, 40]];
    let outer: &[[i64; 2]] = &[[10, 10], [50, 10], [50, 50], [10, 50]];
    let own = region(&[&[outer, hole]]);
    assert_eq!(
        picture(&own, [10, 10], 7, 6),
        [".#####.", ".#####.", ".##.##.", ".#####.", ".#####.", "......."]
    );
    assert!(own.contains(LatticePoint::new(20, 30)), "the outline of a hole belongs to the region");
    assert!(!own.contains(LatticePoint::new(21, 30)));
    // Another polygon in the hole counts: the region is the union of all polygons.
    let both = region(&[&[outer, hole], &[&[[25, 25], [35, 25], [35, 35], [25, 35]]]]);
    assert!(both.contains(LatticePoint::new(30, 30)));
    assert!(!both.contains(LatticePoint::new(22, 30)));
}

#[test]
fn a_triangle_takes_the_cells_that_it_enters() {
    // The long side passes through corners of cells, and only enters the cells on the diagonal.
    let own = region(&[&[&[[0, 0], [40, 0], [40, 40]]]]);
    assert_eq!(
        picture(&own, [10, 10], 6, 6),
        ["......", "...##.", "..###.", ".####.", "#####.", "#####."]
    );
    // The same triangle in the opposite direction.
    let turned = region(&[&[&[[40, 40], [40, 0], [0, 0]]]]);
    assert_eq!(picture(&turned, [10, 10], 6, 6), picture(&own, [10, 10], 6, 6));
}

#[test]
fn an_area_within_a_cell_takes_that_cell() {
    let own = region(&[&[&[[11, 11], [12, 11], [12, 12]]]]);
    assert_eq!(picture(&own, [10, 10], 4, 4), ["....", ".##.", ".##.", "...."]);
}

#[test]
fn rings_without_area_are_none() {
    assert_eq!(LatticeRegion::new(&[]), None);
    assert_eq!(LatticeRegion::new(&[vec![points(&[[0, 0], [5, 5], [10, 10]])]]), None);
    assert_eq!(LatticeRegion::new(&[vec![Vec::new()]]), None);
}

/// A star around (0, 0), which is a simple polygon with any number of corners.
fn star() -> impl Strategy<Value = Vec<LatticePoint>> {
    prop::collection::vec(5.0_f64..400.0, 3..200).prop_map(|radii| {
        let turn = std::f64::consts::TAU / radii.len() as f64;
        let corner = |(k, radius): (usize, &f64)| {
            let (sin, cos) = (turn * k as f64).sin_cos();
            LatticePoint::new((radius * cos).round() as i64, (radius * sin).round() as i64)
        };
        radii.iter().enumerate().map(corner).collect()
    })
}

/// Whether a point is inside or on the outline, edge by edge over all edges; points are in half
/// steps.
fn slow_contains(rings: &[Vec<LatticePoint>], [u2, v2]: [i64; 2]) -> bool {
    let mut crossings = 0;
    for [a, b] in rings.iter().flat_map(|ring| ring_edges(ring)) {
        let ([au, av], [bu, bv]) = ([2 * a.u, 2 * a.v], [2 * b.u, 2 * b.v]);
        let side = (bu - au) * (v2 - av) - (bv - av) * (u2 - au);
        let within = |a: i64, b: i64, at: i64| (a.min(b)..=a.max(b)).contains(&at);
        if side == 0 && within(au, bu, u2) && within(av, bv, v2) {
            return true;
        }
        if (av <= v2) != (bv <= v2) && (side > 0) == (bv > av) {
            crossings += 1;
        }
    }
    crossings % 2 == 1
}

proptest! {
    /// Points are inside according to the even-odd rule, for polygons that do not cross themselves.
    #[test]
    fn contains_agrees_with_the_even_odd_rule(star in star(), at in prop::array::uniform2(-900_i64..900)) {
        if let Some(region) = LatticeRegion::new(&[vec![star.clone()]]) {
            region.check_invariants();
            prop_assert_eq!(region.contains_half(at), slow_contains(&[star], at));
        }
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(corniche_testing::cases(12, 40, 256)))]

    /// A node counts exactly if a point in the interior of one of its four cells is in the region;
    /// the test checks cells point by point.
    #[test]
    fn nodes_agree_with_a_look_at_every_point(star in star(), steps in prop::array::uniform2(3_i64..40)) {
        let Some(region) = LatticeRegion::new(&[vec![star.clone()]]) else { return Ok(()) };
        let window = NodeWindow { corner: NodeIndex { i: -7, j: 6 }, stride: 1, columns: 14, rows: 12 };
        let nodes = region.nodes(steps, &window);
        // A region can pass between points at half steps: what they show is correct, but
        // incomplete.
        for (index, &inside) in nodes.iter().enumerate() {
            let node = window.node(index % 14, index / 14);
            let [u2, v2] = [2 * node.i * steps[0], 2 * node.j * steps[1]];
            let mut seen = false;
            for v in 1 - 2 * steps[1]..2 * steps[1] {
                for u in 1 - 2 * steps[0]..2 * steps[0] {
                    let is_border = u % (2 * steps[0]) == 0 || v % (2 * steps[1]) == 0;
                    seen |= !is_border && region.contains_half([u2 + u, v2 + v]);
                }
            }
            prop_assert!(inside || !seen, "{node:?} is outside, a point beside it is inside");
            let far = region.edges_near(&LatticeBounds {
                min: LatticePoint::new((node.i - 1) * steps[0], (node.j - 1) * steps[1]),
                max: LatticePoint::new((node.i + 1) * steps[0], (node.j + 1) * steps[1]),
            }).next().is_none();
            prop_assert!(!far || inside == seen, "{node:?} far from the outline");
        }
    }

}

proptest! {
    /// Whether a node counts does not depend on the window.
    #[test]
    fn nodes_do_not_depend_on_the_window(star in star(), west in -9_i64..3, north in -3_i64..9) {
        let Some(region) = LatticeRegion::new(&[vec![star]]) else { return Ok(()) };
        let steps = [37, 64];
        let wide = NodeWindow { corner: NodeIndex { i: -12, j: 12 }, stride: 1, columns: 25, rows: 25 };
        let narrow = NodeWindow { corner: NodeIndex { i: west, j: north }, stride: 1, columns: 5, rows: 4 };
        let (all, some) = (region.nodes(steps, &wide), region.nodes(steps, &narrow));
        for (index, &inside) in some.iter().enumerate() {
            let node = narrow.node(index % 5, index / 5);
            let at = (12 - node.j) as usize * 25 + (node.i + 12) as usize;
            prop_assert_eq!(all[at], inside, "{:?}", node);
        }
    }
}
