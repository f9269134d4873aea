//! Checks the invariants of a TIN with simple methods.

use std::collections::HashSet;

use corniche_geom::HeightGrid;
use corniche_tin::Tin;

/// Checks the invariants of every TIN: canonical order, distinct nodes, counter-clockwise
/// triangles, every directed edge at most once (so that at most two triangles meet in an edge, from
/// both sides), and no vertex without a triangle.
///
/// # Panics
/// When an invariant is violated; the message names it.
pub fn check_tin(tin: &Tin) {
    let again = Tin::from_canonical(tin.vertices().to_vec(), tin.triangles().to_vec());
    assert_eq!(again.as_ref(), Ok(tin), "not canonical");
    let mut edges = HashSet::new();
    let mut used = vec![false; tin.vertices().len()];
    for &[a, b, c] in tin.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert!(edges.insert((from, to)), "edge {from}–{to} has two triangles on one side");
            used[from as usize] = true;
        }
    }
    let unused = used.iter().position(|used| !used);
    assert_eq!(unused, None, "a vertex without a triangle");
}

/// Checks that `tin` covers exactly the ground of `heights` (with its halo, as for
/// [`triangulate`](corniche_tin::triangulate)): the TIN has the area of the ground cells, and every
/// node on an edge with a triangle on only one side is next to a cell without ground, or on the
/// tile's border.
///
/// # Panics
/// When it does not.
pub fn check_covers_ground(tin: &Tin, heights: &HeightGrid) {
    let (columns, rows) = (heights.columns() - 2, heights.rows() - 2);
    let ground = |column: i64, row: i64| {
        column >= 0
            && row >= 0
            && column < columns as i64 - 1
            && row < rows as i64 - 1
            && heights.cell_has_ground(column as usize + 1, row as usize + 1)
    };
    let cells =
        (0..rows as i64).flat_map(|row| (0..columns as i64).map(move |column| (column, row)));
    let ground_cells = cells.filter(|&(column, row)| ground(column, row)).count() as i64;
    let at = |vertex: u32| {
        let vertex = tin.vertices()[vertex as usize];
        [i64::from(vertex.column), i64::from(vertex.row)]
    };
    let mut double_area = 0;
    let mut edges = HashSet::new();
    for &[a, b, c] in tin.triangles() {
        let [p, q, r] = [a, b, c].map(at);
        double_area += ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs();
        edges.extend([(a, b), (b, c), (c, a)]);
    }
    assert_eq!(double_area, 2 * ground_cells, "twice the area of the ground");
    for &(from, to) in edges.iter().filter(|&&(from, to)| !edges.contains(&(to, from))) {
        let (p, q) = (at(from), at(to));
        assert!(p[0] == q[0] || p[1] == q[1], "the boundary {p:?}–{q:?} runs across cells");
        // On every unit step of a boundary, one side is ground and the other is not.
        let (low, high) = (p.min(q), p.max(q));
        for step in 0..(high[0] - low[0]).max(high[1] - low[1]) {
            let sides = if p[1] == q[1] {
                [ground(low[0] + step, low[1] - 1), ground(low[0] + step, low[1])]
            } else {
                [ground(low[0] - 1, low[1] + step), ground(low[0], low[1] + step)]
            };
            assert_ne!(sides[0], sides[1], "the boundary {p:?}–{q:?} is not one of the ground");
        }
    }
}
