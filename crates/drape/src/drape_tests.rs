//! Cases in which plain arithmetic fails, each with a name. The ground:
//!
//! ```text
//!     0 ───── 1 ───── 2        nodes 10 steps apart, 0 at (0, 0), south is negative v;
//!     │ \     │     / │        the square 4–5–8–7 is a void
//!     │   \   │   /   │
//!     │     \ │ /     │
//!     3 ───── 4 ───── 5
//!     │     / │       │
//!     │   /   │ void  │
//!     │ /     │       │
//!     6 ───── 7 ─ ─ ─ 8
//! ```

use corniche_geom::{LatticePoint, Polyline};
use corniche_tin::{Placement, Surface, Tin, TinVertex};

use crate::{BadLine, Drape, DrapedLine, DrapedVertex, check, drape, positions};

fn surface() -> Surface {
    let vertices = (0..9_u16)
        .map(|n| TinVertex { row: n / 3, column: n % 3, height_q: i32::from(n) })
        .collect();
    let triangles = [[0, 3, 4], [0, 4, 1], [1, 4, 2], [4, 5, 2], [3, 6, 4], [6, 7, 4]];
    let tin = Tin::new(vertices, &triangles).unwrap();
    Surface::new(
        &tin,
        Placement { corner: LatticePoint::new(0, 0), node_steps: [10; 2], quantum_m: 1.0 },
    )
}

fn line(points: &[(i64, i64)]) -> Polyline {
    Polyline::new(points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect()).unwrap()
}

/// A line's parts as text: `s` and a position for source points, `a×b` for crossings, `@v` for TIN
/// vertices, leads in parentheses.
fn spell(drape: &Drape) -> Vec<String> {
    let lead = |point: Option<LatticePoint>| point.map(|p| format!("({} {})", p.u, p.v));
    let vertex = |vertex: &DrapedVertex| match vertex {
        DrapedVertex::Source { point, .. } => format!("s{},{}", point.u, point.v),
        DrapedVertex::Crossing { a, b } => format!("{a}×{b}"),
        DrapedVertex::Vertex { vertex } => format!("@{vertex}"),
    };
    let part = |line: &DrapedLine| {
        let words = lead(line.lead_in).into_iter().chain(line.vertices.iter().map(vertex));
        words.chain(lead(line.lead_out)).collect::<Vec<_>>().join(" ")
    };
    drape.lines.iter().map(part).collect()
}

#[track_caller]
fn assert_drapes(points: &[(i64, i64)], parts: &[&str], off_ground_steps: f64) {
    assert_drapes_on(&surface(), points, parts, off_ground_steps);
}

#[track_caller]
fn assert_drapes_on(
    surface: &Surface,
    points: &[(i64, i64)],
    parts: &[&str],
    off_ground_steps: f64,
) {
    let line = line(points);
    let draped = drape(&line, surface);
    assert_eq!(spell(&draped), parts);
    let off = crate::oracle_tests::off_ground_steps(&line, &draped);
    assert!((off - off_ground_steps).abs() < 1e-9, "{off} off");
    for part in &draped.lines {
        assert_eq!(check(part, surface), Ok(()));
        assert_eq!(positions(part, surface).unwrap().len(), part.vertices.len());
    }
}

#[test]
fn through_the_inside_of_edges() {
    assert_drapes(&[(9, -1), (9, -19)], &["s9,-1 0×4 3×4 4×6 s9,-19"], 0.0);
    assert_drapes(&[(2, -4), (18, -4)], &["s2,-4 0×4 1×4 2×4 s18,-4"], 0.0);
}

#[test]
fn within_one_triangle_nothing_is_added() {
    assert_drapes(&[(1, -5), (2, -6), (3, -9)], &["s1,-5 s2,-6 s3,-9"], 0.0);
}

#[test]
fn a_line_through_a_vertex_names_it() {
    assert_drapes(&[(6, -2), (14, -18)], &["s6,-2 @4 (14 -18)"], 4.0 * 5_f64.sqrt());
    assert_drapes(&[(8, -1), (14, -28)], &["s8,-1 @4 (14 -28)"], 340_f64.sqrt());
}

#[test]
fn along_edges_and_over_their_ends_both_ways() {
    assert_drapes(&[(0, -10), (20, -10)], &["s0,-10 @4 s20,-10"], 0.0);
    assert_drapes(&[(20, -10), (0, -10)], &["s20,-10 @4 s0,-10"], 0.0);
    assert_drapes(&[(3, -10), (7, -10)], &["s3,-10 s7,-10"], 0.0);
    assert_drapes(&[(0, 0), (10, -10)], &["s0,0 s10,-10"], 0.0);
    assert_drapes(&[(5, -5), (15, -5)], &["s5,-5 1×4 s15,-5"], 0.0);
}

#[test]
fn along_the_boundary_is_on_ground() {
    assert_drapes(&[(0, 0), (20, 0)], &["s0,0 @1 s20,0"], 0.0);
    assert_drapes(&[(10, -20), (10, -10), (20, -10)], &["s10,-20 s10,-10 s20,-10"], 0.0);
    assert_drapes(&[(10, -25), (10, 5)], &["(10 -25) @7 @4 @1 (10 5)"], 10.0);
}

#[test]
fn touching_ground_at_a_point_leaves_nothing() {
    assert_drapes(&[(-5, -5), (5, 5)], &[], 50_f64.sqrt() * 2.0);
    assert_drapes(&[(15, 5), (20, 0), (25, 5)], &[], 50_f64.sqrt() * 2.0);
    assert_drapes(&[(15, -15), (10, -15), (15, -18)], &[], 5.0 + 34_f64.sqrt());
}

#[test]
fn outside_nothing_is_left() {
    assert_drapes(&[(100, 100), (200, 100)], &[], 100.0);
    assert_drapes(&[(12, -12), (18, -18)], &[], 72_f64.sqrt());
}

#[test]
fn leaves_and_comes_back() {
    assert_drapes(
        &[(5, -18), (15, -18), (15, -8)],
        &["s5,-18 4×7 (15 -18)", "(15 -18) 4×5 s15,-8"],
        5.0 + 8.0,
    );
    assert_drapes(&[(-10, -5), (30, -5)], &["(-10 -5) 0×3 0×4 1×4 2×4 2×5 (30 -5)"], 20.0);
}

#[test]
fn far_longer_than_the_tile() {
    assert_drapes(
        &[(-1_000_000_000, -5), (1_000_000_000, -5)],
        &["(-1000000000 -5) 0×3 0×4 1×4 2×4 2×5 (1000000000 -5)"],
        2e9 - 20.0,
    );
}

#[test]
fn source_points_on_edges_and_vertices_are_only_source_points() {
    assert_drapes(&[(2, -4), (10, -4), (18, -4)], &["s2,-4 0×4 s10,-4 2×4 s18,-4"], 0.0);
    assert_drapes(&[(2, -4), (10, -10), (2, -16)], &["s2,-4 s10,-10 s2,-16"], 0.0);
}

#[test]
fn hairpins_return_over_the_same_edges() {
    assert_drapes(&[(8, -2), (12, -2), (8, -2)], &["s8,-2 1×4 s12,-2 1×4 s8,-2"], 0.0);
}

#[test]
fn along_several_edges_in_part_both_ways() {
    assert_drapes(&[(10, -3), (10, -17)], &["s10,-3 @4 s10,-17"], 0.0);
    assert_drapes(&[(10, -17), (10, -3)], &["s10,-17 @4 s10,-3"], 0.0);
    assert_drapes(&[(10, 7), (10, -17)], &["(10 7) @1 @4 s10,-17"], 7.0);
}

#[test]
fn hairpins_along_an_edge_return_in_part() {
    let back_and_forth = [(10, -2), (10, -9), (10, -5), (10, -12)];
    assert_drapes(&back_and_forth, &["s10,-2 s10,-9 s10,-5 @4 s10,-12"], 0.0);
}

#[test]
fn pieces_without_length_and_of_one_step_add_nothing() {
    assert_drapes(&[(5, -2), (5, -2), (6, -2), (6, -2)], &["s5,-2 s6,-2"], 0.0);
    assert_drapes(&[(9, -5), (10, -5), (11, -5)], &["s9,-5 s10,-5 s11,-5"], 0.0);
}

#[test]
fn rings_close_and_lines_may_cross_themselves() {
    assert_drapes(&[(8, -2), (12, -2), (10, -8), (8, -2)], &["s8,-2 1×4 s12,-2 s10,-8 s8,-2"], 0.0);
    assert_drapes(
        &[(8, -2), (12, -4), (12, -2), (8, -4)],
        &["s8,-2 1×4 s12,-4 s12,-2 1×4 s8,-4"],
        0.0,
    );
}

/// ```text
///     0 ── 1            Two squares that touch at a corner.
///     │ ╱  │
///     2 ── 3 ── 4
///          │ ╱  │
///          5 ── 6
/// ```
#[test]
fn islands_that_touch_at_a_corner_are_connected_there() {
    let nodes = [(0, 0), (0, 1), (1, 0), (1, 1), (1, 2), (2, 1), (2, 2)];
    let vertices =
        nodes.iter().map(|&(row, column)| TinVertex { row, column, height_q: 3 }).collect();
    let tin = Tin::new(vertices, &[[0, 2, 1], [1, 2, 3], [3, 5, 4], [4, 5, 6]]).unwrap();
    let corner = LatticePoint::new(0, 0);
    let surface = Surface::new(&tin, Placement { corner, node_steps: [10; 2], quantum_m: 1.0 });
    let across = ["s2,-2 1×2 @3 4×5 s18,-18"];
    assert_drapes_on(&surface, &[(2, -2), (18, -18)], &across, 0.0);
    assert_drapes_on(&surface, &[(0, -10), (20, -10)], &["s0,-10 @3 s20,-10"], 0.0);
    assert_drapes_on(&surface, &[(5, -15), (15, -5)], &[], 200_f64.sqrt());
}

#[test]
fn at_the_ends_of_the_lattice_nothing_overflows() {
    let end = (1_i64 << 60) - 1;
    let across = drape(&line(&[(-end, -5), (end, -5)]), &surface());
    let name = |west: i64, east: i64| format!("({west} -5) 0×3 0×4 1×4 2×4 2×5 ({east} -5)");
    assert_eq!(spell(&across), [name(-end, end)]);
    let diagonal = drape(&line(&[(-end, end), (end, -end)]), &surface());
    assert_eq!(spell(&diagonal), [format!("({} {end}) @0 @4 ({end} {})", -end, -end)]);
}

#[test]
fn steep_edges_of_the_boundary_start_a_part_with_a_lead() {
    assert_drapes(&[(-3, -3), (3, -3)], &["(-3 -3) 0×3 s3,-3"], 3.0);
}

#[test]
fn damaged_lines_are_refused_without_panic() {
    let surface = surface();
    let good = drape(&line(&[(2, -4), (18, -4)]), &surface).lines.remove(0);
    let with = |at: usize, vertex: DrapedVertex| {
        let mut bad = good.clone();
        bad.vertices[at] = vertex;
        bad
    };
    let source = |u, v, triangle| DrapedVertex::Source { point: LatticePoint::new(u, v), triangle };
    let cases = [
        (
            with(1, DrapedVertex::Crossing { a: 0, b: 99 }),
            BadLine::NoSuchVertex { at: 1, vertex: 99 },
        ),
        (with(1, DrapedVertex::Crossing { a: 4, b: 0 }), BadLine::NoCrossing { at: 1, a: 4, b: 0 }),
        (with(1, DrapedVertex::Crossing { a: 3, b: 4 }), BadLine::NoCrossing { at: 1, a: 3, b: 4 }),
        (with(1, DrapedVertex::Vertex { vertex: 1 }), BadLine::NotPassed { at: 1, vertex: 1 }),
        (with(0, DrapedVertex::Crossing { a: 0, b: 3 }), BadLine::Loose { at: 0 }),
        (with(0, source(2, -4, 77)), BadLine::NoSuchTriangle { at: 0, triangle: 77 }),
        (
            with(0, source(i64::MIN, 0, 0)),
            BadLine::OutOfRange { point: LatticePoint::new(i64::MIN, 0) },
        ),
    ];
    for (bad, error) in cases {
        assert_eq!(positions(&bad, &surface), Err(error));
        assert_eq!(check(&bad, &surface), Err(error));
    }
    // Beyond 2^50 steps positions would be inexact, so they are errors: for lines, leads and TINs
    // alike.
    let far = LatticePoint::new(0, 1 << 50);
    let led = DrapedLine { lead_in: Some(far), ..with(0, DrapedVertex::Crossing { a: 0, b: 1 }) };
    assert_eq!(positions(&led, &surface), Err(BadLine::OutOfRange { point: far }));
    // Errors that only `check` detects.
    let subtle = [
        (with(0, source(2, -4, 1)), BadLine::OutsideTriangle { at: 0, triangle: 1 }),
        (with(1, DrapedVertex::Crossing { a: 1, b: 4 }), BadLine::Apart { at: 1 }),
        (with(2, DrapedVertex::Crossing { a: 0, b: 4 }), BadLine::Disorder { at: 2 }),
        (
            DrapedLine { lead_in: Some(LatticePoint::new(0, 0)), ..good.clone() },
            BadLine::Loose { at: 0 },
        ),
    ];
    for (bad, error) in subtle {
        assert_eq!(check(&bad, &surface), Err(error));
    }
    let short = DrapedLine { lead_in: None, vertices: vec![], lead_out: None };
    assert_eq!(positions(&short, &surface), Err(BadLine::TooShort { vertices: 0 }));
}
