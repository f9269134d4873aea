//! No ground around a line for shadow volumes is outside the range of its segment.

use super::*;
use crate::height_range::PAD;
use corniche_tin::{Placement, Tin, TinVertex};
use proptest::prelude::*;

const STEPS: i64 = 1000;

/// Ground of 17 × 17 nodes, without the cells for which `hole` returns true.
pub(crate) fn ground(
    height_q: impl Fn(i32, i32) -> i32,
    hole: impl Fn(u32, u32) -> bool,
) -> Surface {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..17_u32 {
        for column in 0..17_u32 {
            let height_q = height_q(column as i32, row as i32);
            vertices.push(TinVertex { row: row as u16, column: column as u16, height_q });
            let (nw, sw) = (row * 17 + column, (row + 1) * 17 + column);
            if row < 16 && column < 16 && !hole(column, row) {
                triangles.extend([[nw, sw, nw + 1], [sw, sw + 1, nw + 1]]);
            }
        }
    }
    let placement = Placement {
        corner: LatticePoint::new(0, 16 * STEPS),
        node_steps: [STEPS; 2],
        quantum_m: 0.5,
    };
    Surface::new(&Tin::new(vertices, &triangles).unwrap(), placement)
}

fn line(points: &[(i64, i64)]) -> Polyline {
    Polyline::new(points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect()).unwrap()
}

proptest! {
    /// On a plane the range is that of the rectangle's corners.
    #[test]
    fn a_plane_has_the_range_of_the_corners(
        p in (4000_i64..12000, 4000_i64..12000), q in (4000_i64..12000, 4000_i64..12000),
        margin in 0_i64..2000, east in -50_i32..50, south in -50_i32..50,
    ) {
        prop_assume!(p != q);
        let surface = ground(|column, row| east * column + south * row, |_, _| false);
        let lines = extrude(&line(&[p, q]), &surface, margin);
        let [low, high] = lines[0].ground_range_m[0];
        let (along_u, along_v) = ((q.0 - p.0) as f64, (q.1 - p.1) as f64);
        let length = along_u.hypot(along_v);
        let (unit_u, unit_v) = (along_u / length, along_v / length);
        let height_m = |u: f64, v: f64| {
            0.5 * (f64::from(east) * u + f64::from(south) * (16_000.0 - v)) / STEPS as f64
        };
        let reach = margin as f64;
        let mut heights_m = Vec::new();
        for (end, outward) in [(p, -1.0), (q, 1.0)] {
            for across in [-1.0, 1.0] {
                heights_m.push(height_m(
                    end.0 as f64 + reach * (outward * unit_u - across * unit_v),
                    end.1 as f64 + reach * (outward * unit_v + across * unit_u),
                ));
            }
        }
        let lowest = heights_m.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = heights_m.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The slack is one more step of margin on each axis, and the padding.
        let slack = 0.5 * f64::from(east.abs() + south.abs()) * 2.0 / STEPS as f64 + 1e-3;
        prop_assert!(low <= lowest && lowest - low <= slack, "{low} {lowest}");
        prop_assert!(high >= highest && high - highest <= slack, "{high} {highest}");
    }

    /// No ground within the rectangle is above or below the range.
    #[test]
    fn all_ground_around_is_within_the_range(
        p in (0_i64..16000, 0_i64..16000), q in (0_i64..16000, 0_i64..16000), margin in 0_i64..3000, seed in 0_i32..1000,
        samples in prop::collection::vec((0.0..=1.0_f64, -1.0..=1.0_f64), 50),
    ) {
        prop_assume!(p != q);
        let rough = |column: i32, row: i32| (column * 7919 + row * 104_729 + seed * 31).rem_euclid(997);
        let surface = ground(rough, |column, row| (column * 5 + row * 3) % 7 == 0);
        let lines = extrude(&line(&[p, q]), &surface, margin);
        let (along_u, along_v) = ((q.0 - p.0) as f64, (q.1 - p.1) as f64);
        let length = along_u.hypot(along_v);
        for (along, across) in samples {
            let (along, across) = (along * (length + 2.0 * margin as f64) - margin as f64, across * margin as f64);
            let u = p.0 as f64 + (along * along_u - across * along_v) / length;
            let v = p.1 as f64 + (along * along_v + across * along_u) / length;
            let at = LatticePoint::new(u.trunc() as i64, v.trunc() as i64);
            // A sample that is truncated towards zero may be up to a step outside; on the steepest
            // slope this is half a metre.
            if let Some(triangle) = surface.locate(at) {
                let height_m = surface.height_at_point_m(triangle, at);
                let [low, high] = lines[0].ground_range_m[0];
                prop_assert!((low - 2.0..=high + 2.0).contains(&height_m), "{height_m} not in {low}..{high}");
            }
        }
    }
}

proptest! {
    /// Examining few triangles gives the same result, to the last bit, as examining all of them.
    #[test]
    fn ranges_are_those_of_all_triangles(
        points in prop::collection::vec((-3000_i64..19_000, -3000_i64..19_000), 2..12),
        shrink in 1_i64..40, margin in 0_i64..6000, seed in 0_i32..1000, holes in 1_u32..8,
    ) {
        let rough = |column: i32, row: i32| (column * 7919 + row * 104_729 + seed * 31).rem_euclid(997);
        let surface = ground(rough, |column, row| (column * 5 + row * 3) % holes == 1);
        // Either long segments, or many short ones that share a search.
        let points = points.iter().map(|&(u, v)| LatticePoint::new(8000 + u / shrink, 8000 + v / shrink));
        let Ok(line) = Polyline::new(points.collect()) else { return Ok(()) };
        let mut expected = Vec::new();
        for pair in line.points().windows(2) {
            let around = SegmentRectangle::new([pair[0], pair[1]].map(LatticePoint::in_steps), (margin + 1) as f64);
            let parts = (0..surface.triangles().len() as u32).map(|t| around.part_of(t, &surface));
            let heights_m: Vec<f64> = parts.flat_map(|part| part.corners().iter().map(|c| c[2]).collect::<Vec<_>>()).collect();
            let low = heights_m.iter().copied().fold(f64::INFINITY, f64::min);
            let high = heights_m.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if low <= high {
                let pad = PAD * low.abs().max(high.abs()).max(high - low);
                expected.push(([pair[0], pair[1]], [low - pad, high + pad]));
            }
        }
        let lines = extrude(&line, &surface, margin);
        let found: Vec<_> = lines
            .iter()
            .flat_map(|line| line.points.windows(2).map(|pair| [pair[0], pair[1]]).zip(line.ground_range_m.iter().copied()))
            .collect();
        prop_assert_eq!(found, expected);
    }
}

#[test]
fn segments_without_ground_split_the_line() {
    let surface = ground(|_, _| 10, |column, _| (6..10).contains(&column));
    let across = line(&[
        (1000, 8000),
        (5000, 8000),
        (7000, 8000),
        (9000, 8000),
        (11000, 8000),
        (15000, 8000),
    ]);
    let lines = extrude(&across, &surface, 500);
    let ends: Vec<_> =
        lines.iter().map(|line| (line.points[0].u, line.points[line.points.len() - 1].u)).collect();
    assert_eq!(ends, [(1000, 7000), (9000, 15000)]);
    for line in &lines {
        assert_eq!(line.points.len(), line.ground_range_m.len() + 1);
        for [low, high] in &line.ground_range_m {
            assert!((low - 5.0).abs() < 1e-4 && (high - 5.0).abs() < 1e-4 && low < high);
        }
    }
    assert_eq!(
        extrude(&across, &surface, 1500).len(),
        1,
        "a wider margin reaches ground everywhere"
    );
}

#[test]
fn the_margin_counts_ground_beside_the_line_only() {
    // There is a spike two cells north of the line, and one in the line's own cell row far to the
    // east.
    let surface = ground(|column, row| if (column, row) == (4, 6) { 100 } else { 0 }, |_, _| false);
    let along = line(&[(2000, 8000), (6000, 8000)]);
    let highest = |margin| extrude(&along, &surface, margin)[0].ground_range_m[0][1];
    assert!(highest(900) < 1e-3);
    assert!((highest(1500) - 25.0).abs() < 0.1, "half way up the spike");
    assert!((highest(2500) - 50.0).abs() < 1e-3);
}
