//! The parts of lines inside and outside a region of any outline add up to the whole lines.

use proptest::prelude::*;

use super::*;
use crate::{OwnedBorders, clip_parts};

fn points(corners: &[[i64; 2]]) -> Vec<LatticePoint> {
    corners.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect()
}

fn line(corners: &[[i64; 2]]) -> Polyline {
    Polyline::new(points(corners)).unwrap()
}

fn square(from: i64, to: i64) -> Vec<LatticePoint> {
    points(&[[from, from], [to, from], [to, to], [from, to]])
}

fn clipped(corners: &[[i64; 2]], region: &LatticeRegion) -> Vec<(Vec<[i64; 2]>, Vec<usize>)> {
    clip_region(&line(corners), region)
        .into_iter()
        .map(|part| {
            let points = part.line.points().iter().map(|point| [point.u, point.v]).collect();
            (points, part.segments)
        })
        .collect()
}

#[test]
fn a_line_is_cut_at_outlines_and_holes() {
    let region = LatticeRegion::new(&[vec![square(0, 100), square(40, 60)]]).unwrap();
    assert_eq!(
        clipped(&[[-50, 50], [150, 50]], &region),
        [(vec![[0, 50], [40, 50]], vec![0]), (vec![[60, 50], [100, 50]], vec![0])]
    );
    // The first line is completely inside, the second crosses the hole's corner, the third is
    // completely outside.
    assert_eq!(
        clipped(&[[10, 10], [20, 30], [30, 10]], &region),
        [(vec![[10, 10], [20, 30], [30, 10]], vec![0, 1])]
    );
    assert_eq!(
        clipped(&[[30, 50], [50, 30]], &region),
        [(vec![[30, 50], [50, 30]], vec![0])],
        "a point of the hole's outline belongs to the region"
    );
    assert_eq!(clipped(&[[-10, -10], [-20, -30]], &region), []);
    assert_eq!(clipped(&[[45, 45], [55, 50]], &region), []);
}

#[test]
fn a_line_along_an_outline_is_inside() {
    let region = LatticeRegion::new(&[vec![square(0, 100)]]).unwrap();
    for corners in [[[-5, 0], [50, 0]], [[-5, 100], [50, 100]]] {
        let kept = [vec![[0, corners[0][1]], [50, corners[0][1]]]];
        let found: Vec<_> = clipped(&corners, &region).into_iter().map(|(line, _)| line).collect();
        assert_eq!(found, kept);
    }
    let tilted = LatticeRegion::new(&[vec![points(&[[0, 0], [300, 100], [0, 200]])]]).unwrap();
    assert_eq!(clipped(&[[-3, -1], [303, 101]], &tilted), [(vec![[0, 0], [300, 100]], vec![0])]);
}

#[test]
fn polygons_side_by_side_do_not_cut() {
    let east = points(&[[100, 0], [200, 0], [200, 100], [100, 100]]);
    let region = LatticeRegion::new(&[vec![square(0, 100)], vec![east]]).unwrap();
    assert_eq!(
        clipped(&[[-50, 50], [150, 50], [250, 50]], &region),
        [(vec![[0, 50], [150, 50], [200, 50]], vec![0, 1])]
    );
}

/// The length of the parts inside, in lattice steps.
fn length(parts: &[ClippedPart]) -> f64 {
    parts.iter().map(|part| corniche_testing::length_steps(&part.line)).sum()
}

proptest! {
    /// For a rectangle, the clip against regions gives the same parts as the exact clip against
    /// rectangles.
    #[test]
    fn a_rectangle_is_cut_as_by_the_clip_against_rectangles(
        corners in prop::collection::vec(prop::array::uniform2(-5000_i64..5000), 2..12),
        west in -4000_i64..0, south in -4000_i64..0, east in 1_i64..4000, north in 1_i64..4000,
    ) {
        let Ok(line) = Polyline::new(points(&corners)) else { return Ok(()) };
        let ring = points(&[[west, south], [east, south], [east, north], [west, north]]);
        let region = LatticeRegion::new(&[vec![ring]]).unwrap();
        let bounds = LatticeBounds { min: LatticePoint::new(west, south), max: LatticePoint::new(east, north) };
        let (own, exact) = (clip_region(&line, &region), clip_parts(&line, &bounds, OwnedBorders::ALL));
        prop_assert!((length(&own) - length(&exact)).abs() <= 4.0 * corners.len() as f64);
        for part in &own {
            prop_assert_eq!(part.segments.len() + 1, part.line.points().len());
            for &point in part.line.points() {
                prop_assert!(bounds.contains(point), "{:?}", point);
            }
        }
    }

    /// The parts inside a polygon, and those inside a rectangle with the polygon as a hole, add up
    /// to the line.
    #[test]
    fn inside_and_outside_add_up(
        corners in prop::collection::vec(prop::array::uniform2(-5000_i64..5000), 2..12),
        radii in prop::collection::vec(100.0_f64..4900.0, 3..60),
    ) {
        let Ok(line) = Polyline::new(points(&corners)) else { return Ok(()) };
        let turn = std::f64::consts::TAU / radii.len() as f64;
        let ring: Vec<LatticePoint> = radii.iter().enumerate().map(|(k, radius)| {
            let (sin, cos) = (turn * k as f64).sin_cos();
            LatticePoint::new((radius * cos).round() as i64, (radius * sin).round() as i64)
        }).collect();
        let Some(inside) = LatticeRegion::new(&[vec![ring.clone()]]) else { return Ok(()) };
        let outside = LatticeRegion::new(&[vec![square(-6000, 6000), ring]]).unwrap();
        let both = length(&clip_region(&line, &inside)) + length(&clip_region(&line, &outside));
        // Each crossing is rounded to a step, and may add or remove a stretch of two steps.
        let crossings = (corners.len() * radii.len()) as f64;
        prop_assert!((both - corniche_testing::length_steps(&line)).abs() <= 4.0 * crossings, "{both}");
    }
}
