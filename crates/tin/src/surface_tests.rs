//! The search on a surface agrees with trying every triangle.

use super::*;
use crate::TinVertex;
use proptest::prelude::*;

impl Surface {
    /// Asserts the invariants on which every other method relies: twins are mutual and run in
    /// opposite directions, and fans list half-edges that start at their vertex.
    fn check_invariants(&self) {
        for half_edge in 0..self.twins.len() as u32 {
            let twin = self.twin(half_edge);
            if twin != NO_TWIN {
                assert_eq!(self.twin(twin), half_edge, "twins are mutual");
                let [a, b] = self.ends(half_edge);
                assert_eq!(self.ends(twin), [b, a], "twins run opposite ways");
            }
        }
        assert_eq!(self.fans.len(), self.twins.len());
        for vertex in 0..self.points.len() as u32 {
            assert!(self.fan(vertex).is_sorted());
            assert!(self.fan(vertex).iter().all(|&h| self.ends(h)[0] == vertex));
        }
    }
}

/// A grid of `columns` × `rows` nodes; bit n of `diagonals` flips the diagonal of cell n, bit n of
/// `holes` removes the cell.
fn grid(columns: u16, rows: u16, diagonals: &[bool], holes: &[bool], heights: &[i32]) -> Tin {
    let mut vertices = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let height_q = heights[vertices.len() % heights.len()];
            vertices.push(TinVertex { row, column, height_q });
        }
    }
    let node = |row: u16, column: u16| u32::from(row) * u32::from(columns) + u32::from(column);
    let mut triangles = Vec::new();
    let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column)));
    for (cell, (row, column)) in cells.enumerate() {
        let [nw, ne] = [node(row, column), node(row, column + 1)];
        let [sw, se] = [node(row + 1, column), node(row + 1, column + 1)];
        if holes[cell % holes.len()] {
            continue;
        }
        if diagonals[cell % diagonals.len()] {
            triangles.extend([[nw, sw, se], [nw, se, ne]]);
        } else {
            triangles.extend([[nw, sw, ne], [sw, se, ne]]);
        }
    }
    Tin::new(vertices, &triangles).unwrap()
}

fn placement(node_steps: i64) -> Placement {
    Placement {
        corner: LatticePoint::new(-7, 1_000_000_007),
        node_steps: [node_steps, node_steps],
        quantum_m: 0.25,
    }
}

prop_compose! {
    fn any_surface()(
        columns in 2_u16..9, rows in 2_u16..9,
        diagonals in prop::collection::vec(any::<bool>(), 64),
        holes in prop::collection::vec(prop::bool::weighted(0.2), 64),
        heights in prop::collection::vec(-4000..4000_i32, 81),
        node_steps in 1_i64..40,
    ) -> (Surface, LatticeBounds, i64) {
        let surface = Surface::new(&grid(columns, rows, &diagonals, &holes, &heights), placement(node_steps));
        let bounds = LatticeBounds::around(surface.points()).unwrap();
        (surface, bounds, node_steps)
    }
}

proptest! {
    /// The located triangle is the first of all that contain the point, found by trying every
    /// triangle.
    #[test]
    fn locate_finds_the_first_triangle((surface, bounds, steps) in any_surface(), picks in prop::collection::vec((0_u32..1000, 0_u32..1000), 40)) {
        surface.check_invariants();
        let around = bounds.expanded(steps);
        for (east, north) in picks {
            let along = |min: i64, max: i64, pick: u32| min + (max - min) * i64::from(pick) / 999;
            let point = LatticePoint::new(along(around.min.u, around.max.u, east), along(around.min.v, around.max.v, north));
            let first = (0..surface.triangles().len() as u32).find(|&t| surface.triangle_holds(t, point));
            prop_assert_eq!(surface.locate(point), first);
        }
    }

    /// Searching by rectangle gives the same result as trying every triangle and half-edge, in the
    /// same order.
    #[test]
    fn near_finds_all_that_meet((surface, bounds, _) in any_surface(), a in (0_i64..300, 0_i64..300), size in (0_i64..200, 0_i64..200)) {
        let min = LatticePoint::new(bounds.min.u - 20 + a.0, bounds.min.v - 20 + a.1);
        let window = LatticeBounds { min, max: LatticePoint::new(min.u + size.0, min.v + size.1) };
        let mut found = Vec::new();
        surface.triangles_near(window, &mut found);
        let meets = |vertices: &[u32]| surface.bounds_of(vertices).intersects(&window);
        let all = 0..surface.triangles().len() as u32;
        let expected: Vec<u32> = all.clone().filter(|&t| meets(&surface.triangles()[t as usize])).collect();
        prop_assert_eq!(&found, &expected);
        surface.boundary_near(window, &mut found);
        let half_edges = 0..3 * all.end;
        let expected: Vec<u32> =
            half_edges.filter(|&h| surface.twin(h) == NO_TWIN && meets(&surface.ends(h))).collect();
        prop_assert_eq!(found, expected);
    }

    /// Searching along a segment finds every triangle with a corner, or a middle, near the segment.
    #[test]
    fn along_finds_all_that_lie_near((surface, bounds, _) in any_surface(), ends in prop::array::uniform4(-100_i64..400), around in 1_i64..60) {
        let at = |k: usize| [(bounds.min.u + ends[k]) as f64, (bounds.min.v + ends[k + 1]) as f64];
        let (p, q) = (at(0), at(2));
        let mut found = Vec::new();
        surface.triangles_along([p, q], around as f64, &mut found);
        prop_assert!(found.is_sorted_by(|a, b| a < b));
        let is_near = |[u, v]: [f64; 2]| (0..=1000).any(|k| {
            let share = f64::from(k) / 1000.0;
            let on = [0, 1].map(|axis| p[axis] + share * (q[axis] - p[axis]));
            (u - on[0]).abs() <= around as f64 && (v - on[1]).abs() <= around as f64
        });
        for (number, corners) in (0..).zip(surface.triangles()) {
            let at = corners.map(|vertex| surface.points()[vertex as usize].in_steps());
            let middle = [0, 1].map(|axis| at.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0);
            let is_wanted = is_near(middle) || at.into_iter().any(is_near);
            prop_assert!(!is_wanted || found.contains(&number), "{:?} near {:?} {:?}", at, p, q);
        }
    }

    /// Corners have their own height to the last bit, and both sides of an edge agree along it.
    #[test]
    fn heights_agree_along_edges((surface, _, _) in any_surface(), part in 0.0..1.0_f64) {
        for half_edge in 0..3 * surface.triangles().len() as u32 {
            let [a, b] = surface.ends(half_edge);
            let (p, q) = (surface.points()[a as usize], surface.points()[b as usize]);
            let height_m = surface.height_at_point_m(half_edge / 3, p);
            prop_assert_eq!(height_m.to_bits(), surface.heights_m()[a as usize].to_bits());
            let twin = surface.twin(half_edge);
            if twin != NO_TWIN {
                let at = [p.u as f64 + part * (q.u - p.u) as f64, p.v as f64 + part * (q.v - p.v) as f64];
                let gap_m = surface.height_in_triangle_m(half_edge / 3, at) - surface.height_in_triangle_m(twin / 3, at);
                // Half an ulp of a coordinate of 10^9 steps, on a slope of 8000 quanta per step.
                prop_assert!(gap_m.abs() < 1e-3, "{} m", gap_m);
            }
        }
    }
}

#[test]
fn a_plane_is_reproduced_at_tile_scale() {
    // 257 nodes at a distance of 2^15 steps: 30 m cells; heights rise by 3 and 5 quanta per node.
    let rows = 0..257_u16;
    let heights: Vec<i32> =
        rows.flat_map(|row| (0..257).map(move |c| 3 * c - 5 * i32::from(row))).collect();
    let tin = grid(257, 257, &[true, false, true], &[false], &heights);
    let corner = LatticePoint::new(1 << 33, 1 << 34);
    let surface =
        Surface::new(&tin, Placement { corner, node_steps: [1 << 15; 2], quantum_m: 0.125 });
    surface.check_invariants();
    for step in 0..10_000_i64 {
        let (east, south) = (step * 838, step * 7919 % (1 << 23));
        let point = LatticePoint::new(corner.u + east, corner.v - south);
        let triangle = surface.locate(point).unwrap();
        let expected_m = (3.0 * east as f64 - 5.0 * south as f64) / f64::from(1 << 15) * 0.125;
        assert!((surface.height_at_point_m(triangle, point) - expected_m).abs() < 1e-9);
        let at = [point.u as f64, point.v as f64];
        assert!((surface.height_in_triangle_m(triangle, at) - expected_m).abs() < 1e-9);
        let [east_m, north_m] = surface.gradient_m(triangle).map(|m| m * f64::from(1 << 15));
        assert!((east_m - 0.375).abs() < 1e-9 && (north_m - 0.625).abs() < 1e-9);
    }
}

#[test]
fn a_tin_without_triangles_is_nowhere() {
    let surface = Surface::new(&Tin::default(), placement(10));
    assert_eq!(surface.locate(LatticePoint::new(-7, 1_000_000_007)), None);
    let mut found = vec![1];
    surface.triangles_near(
        LatticeBounds { min: LatticePoint::new(-100, 0), max: LatticePoint::new(100, 1 << 40) },
        &mut found,
    );
    assert!(found.is_empty());
}

#[test]
fn a_broken_tin_with_a_tripled_edge_has_no_twin_there() {
    let at = |row, column| TinVertex { row, column, height_q: 0 };
    let vertices = vec![at(0, 0), at(2, 2), at(3, 0), at(4, 0), at(0, 4)];
    let tin = Tin::new(vertices, &[[0, 2, 1], [0, 3, 1], [0, 1, 4]]).unwrap();
    let surface = Surface::new(&tin, placement(4));
    surface.check_invariants();
    assert!((0..9).all(|h| surface.twin(h) == NO_TWIN));
}
