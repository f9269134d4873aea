//! No ground near a piece of a road is outside its bed.

use proptest::prelude::*;

use super::*;
use crate::{DrapedLine, DrapedVertex, extrude::tests::ground, source_segments};

/// A piece between two points of a triangle, in plan and with the plane's heights; `None` if its
/// length is 0.
fn piece_in(
    surface: &Surface,
    triangle: u32,
    places: [[f64; 2]; 2],
    has_caps: [bool; 2],
) -> Option<GroundSegment> {
    let corners = surface.triangles()[triangle as usize]
        .map(|vertex| surface.points()[vertex as usize].in_steps());
    let ends = places.map(|[b, c]| {
        // Beyond the diagonal is the other triangle of a parallelogram: mirror the point back.
        let [b, c] = if b + c > 1.0 { [1.0 - b, 1.0 - c] } else { [b, c] };
        [0, 1].map(|k: usize| {
            corners[0][k]
                + b * (corners[1][k] - corners[0][k])
                + c * (corners[2][k] - corners[0][k])
        })
    });
    let heights_m = ends.map(|end| surface.height_in_triangle_m(triangle, end));
    let way = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let length = way[0].hypot(way[1]);
    let direction = way.map(|part| part / length);
    (length > 0.0).then_some(GroundSegment {
        start: ends[0],
        direction,
        length,
        heights_m,
        has_caps,
    })
}

proptest! {
    /// All ground within the reach, across a piece and around its caps, is within the limits of the
    /// bed.
    #[test]
    fn no_ground_is_out_of_the_bed(
        triangle in 0_usize..200, places in [[0.0..1.0_f64, 0.0..1.0_f64], [0.0..1.0_f64, 0.0..1.0_f64]],
        has_caps in [any::<bool>(), any::<bool>()],
        reach in 1_i64..4000, seed in 0_i32..1000, holes in 2_u32..60, steep in 1_i32..40,
        samples in prop::collection::vec((0.0..=1.0_f64, -1.0..=1.0_f64, -1.0..=1.0_f64), 100),
    ) {
        let rough = |column: i32, row: i32| steep * (column * 7919 + row * 104_729 + seed * 31).rem_euclid(97);
        let surface = ground(rough, |column, row| (column * 5 + row * 3) % holes == 1);
        let triangle = (triangle % surface.triangles().len()) as u32;
        let Some(piece) = piece_in(&surface, triangle, places, has_caps) else { return Ok(()) };
        let reach = reach as f64;
        let bed = road_bed(&piece, &surface, reach, &StepBudget::unlimited());
        let ([east, north], along_rise_m) =
            (piece.direction, (piece.heights_m[1] - piece.heights_m[0]) / piece.length);
        for (share, forward, left) in samples {
            // Points anywhere around the piece, most of them near.
            let (along, across) = (share * piece.length + forward * reach, left * reach);
            let at = LatticePoint::new(
                (piece.start[0] + along * east - across * north).round() as i64,
                (piece.start[1] + along * north + across * east).round() as i64,
            );
            let from = [0, 1].map(|axis: usize| at.in_steps()[axis] - piece.start[axis]);
            let (along, across) = (from[0] * east + from[1] * north, from[1] * east - from[0] * north);
            let beyond = [-along, along - piece.length];
            let is_beside = (0..2).all(|end| has_caps[end] || beyond[end] <= 0.0);
            let away = beyond[0].max(beyond[1]).max(0.0).hypot(across);
            if !is_beside || away > reach {
                continue;
            }
            let Some(triangle) = surface.locate(at) else { continue };
            let plane_m = piece.heights_m[0] + along_rise_m * along + bed.cross_rise_m * across;
            let leaves_m = surface.height_at_point_m(triangle, at) - plane_m;
            // Heights here are some thousand metres, and steep slopes multiply rounding errors.
            let slack_m = 1e-6;
            for (leaves_m, side) in [(-leaves_m, 0), (leaves_m, 1)] {
                prop_assert!(leaves_m <= bed.most_m[side] + slack_m, "{leaves_m} of {bed:?}");
                prop_assert!(leaves_m <= bed.rises_m[side] * away + slack_m, "{leaves_m} at {away} of {bed:?}");
            }
        }
    }
}

/// On a plane the bed is that plane, without deviations; the expected values have a closed form.
#[test]
fn on_a_plane_the_bed_is_the_plane() {
    // The slope is 3 in 4 eastwards, with 0.5 m per step of height; the piece runs north-east.
    let surface = ground(|column, _| 1500 * column, |_, _| false);
    let half = 0.5_f64.sqrt();
    let piece = GroundSegment {
        start: [4100.0, 8200.0],
        direction: [half, half],
        length: 300.0,
        heights_m: [0.75 * 4100.0, 0.75 * (4100.0 + 300.0 * half)],
        has_caps: [true, false],
    };
    let bed = road_bed(&piece, &surface, 1000.0, &StepBudget::unlimited());
    assert!((bed.cross_rise_m - -0.75 * half).abs() < 1e-9, "{bed:?}");
    assert!(bed.most_m.iter().chain(&bed.rises_m).all(|m| (-1e-9..0.01).contains(m)), "{bed:?}");
}

#[test]
fn beside_a_hole_only_what_is_there_bounds_the_bed() {
    let surface = ground(|column, row| 10 * column * row, |column, row| column == 9 && row == 8);
    let near = |x: f64| {
        let triangle = surface.locate(LatticePoint::new(x as i64, 7400)).unwrap();
        let heights_m = [7400.0, 7500.0].map(|y| surface.height_in_triangle_m(triangle, [x, y]));
        let piece = GroundSegment {
            start: [x, 7400.0],
            direction: [0.0, 1.0],
            length: 100.0,
            heights_m,
            has_caps: [false; 2],
        };
        road_bed(&piece, &surface, 1000.0, &StepBudget::unlimited())
    };
    assert!(near(5200.0).rises_m.iter().all(|rise_m| rise_m.is_finite()), "far from it");
    let beside = near(8800.0);
    assert!(beside.rises_m.iter().all(|rise_m| rise_m.is_infinite()), "{beside:?}");
    assert!(beside.most_m.iter().all(|most_m| most_m.is_finite()), "{beside:?}");
}

#[test]
fn each_edge_of_a_line_knows_its_source_segment() {
    let point = |u| LatticePoint::new(u, 0);
    let source = |u| DrapedVertex::Source { point: point(u), triangle: 0 };
    let crossing = DrapedVertex::Crossing { a: 0, b: 1 };
    let passed = DrapedVertex::Vertex { vertex: 3 };
    let line = DrapedLine {
        lead_in: Some(point(0)),
        vertices: vec![crossing, passed, source(10), source(20), crossing, crossing],
        lead_out: Some(point(30)),
    };
    let found: Vec<_> = source_segments(&line).into_iter().map(|[p, q]| [p.u, q.u]).collect();
    assert_eq!(found, [[0, 10], [0, 10], [10, 20], [20, 30], [20, 30]]);
}
