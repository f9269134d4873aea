//! Lines are cut at rectangles of degrees, also across the antimeridian and around the earth.

use super::*;

#[test]
fn rectangles_overlap_if_they_share_more_than_a_side() {
    let bounds = DegreeBounds::new([179.0, 10.0, -179.0, 12.0]).unwrap();
    for (rectangle, expected) in [
        ([[178.0, 9.0], [179.5, 10.5]], true),
        ([[-179.5, 11.0], [-178.0, 13.0]], true),
        ([[180.5, 11.0], [181.5, 13.0]], true),
        ([[170.0, 0.0], [190.0, 20.0]], true),
        ([[178.0, 10.0], [179.0, 12.0]], false),
        ([[-179.0, 10.0], [-178.0, 12.0]], false),
        ([[179.0, 12.0], [180.0, 13.0]], false),
        ([[0.0, 10.0], [10.0, 12.0]], false),
    ] {
        assert_eq!(bounds.overlaps(rectangle), expected, "{rectangle:?}");
    }
    let around = DegreeBounds::new([-180.0, -10.0, 180.0, 10.0]).unwrap();
    assert!(around.overlaps([[179.0, 0.0], [180.0, 1.0]]));
}

fn bounds(numbers: [f64; 4]) -> DegreeBounds {
    DegreeBounds::new(numbers).unwrap()
}

#[test]
fn what_is_no_rectangle_on_earth_is_refused() {
    for wrong in [
        [9.0, 47.0, 9.0, 48.0],
        [9.0, 48.0, 10.0, 47.0],
        [9.0, 47.0, 181.0, 48.0],
        [9.0, -91.0, 10.0, 48.0],
        [f64::NAN, 47.0, 10.0, 48.0],
        [9.0, 47.0, 10.0, f64::INFINITY],
    ] {
        assert_eq!(DegreeBounds::new(wrong), None, "{wrong:?}");
    }
}

#[test]
fn a_line_is_cut_where_it_crosses_the_rectangle() {
    let bounds = bounds([9.0, 47.0, 10.0, 48.0]);
    assert_eq!(bounds.inside([9.2, 47.2], [9.4, 47.6]), [[0.0, 1.0]]);
    assert_eq!(bounds.inside([8.5, 47.5], [9.5, 47.5]), [[0.5, 1.0]]);
    assert_eq!(bounds.inside([8.5, 47.5], [10.5, 47.5]), [[0.25, 0.75]]);
    assert!(bounds.inside([8.0, 47.5], [8.9, 47.5]).is_empty());
    assert_eq!(bounds.inside([9.5, 48.5], [9.5, 46.5]), [[0.25, 0.75]]);
    assert!(bounds.inside([9.5, 48.1], [9.6, 48.1]).is_empty(), "parallel to a side, beyond it");
}

/// West beyond east crosses 180°; a line is cut at the same shares whichever multiple of 360° is
/// added to its longitudes.
#[test]
fn a_rectangle_may_cross_the_antimeridian() {
    let bounds = bounds([179.0, 51.0, -179.0, 53.0]);
    for turn in [-360.0, 0.0, 360.0] {
        let [[first, last]] = bounds.inside([178.0 + turn, 52.0], [-178.0, 52.0])[..] else {
            panic!()
        };
        assert!((first - 0.25).abs() < 1e-12 && (last - 0.75).abs() < 1e-12, "{first} {last}");
    }
    assert!(bounds.inside([0.0, 52.0], [1.0, 52.0]).is_empty());
}

/// A rectangle all around the globe has no sides in the west and east, wherever it begins. In a
/// rectangle that almost closes, a line across the gap has two parts.
#[test]
fn a_rectangle_may_go_around_the_earth() {
    for around in [[-180.0, -90.0, 180.0, 90.0], [-180.0, 0.0, 180.0, 80.0]] {
        let bounds = bounds(around);
        for turn in [-360.0, 0.0, 360.0] {
            assert_eq!(
                bounds.inside([179.5 + turn, 52.0], [-179.5, 52.5]),
                [[0.0, 1.0]],
                "{around:?}"
            );
        }
    }
    let nearly = bounds([-179.0, 51.0, 179.0, 53.0]);
    assert_eq!(nearly.inside([178.0, 52.0], [-178.0, 52.0]), [[0.0, 0.25], [0.75, 1.0]]);
    assert_eq!(nearly.inside([-178.0, 52.0], [178.0, 52.0]), [[0.0, 0.25], [0.75, 1.0]]);
}

#[test]
fn tiles_that_cannot_meet_the_rectangle_are_left_out() {
    let bounds = bounds([179.0, 51.0, -179.0, 53.0]);
    assert!(bounds.may_meet(&[[179.5, 52.0], [180.5, 52.5]]));
    assert!(bounds.may_meet(&[[-180.5, 52.0], [-179.5, 52.5]]));
    assert!(bounds.may_meet(&[[170.0, 52.0], [190.0, 52.5]]));
    assert!(!bounds.may_meet(&[[10.0, 52.0], [11.0, 52.5]]));
    assert!(!bounds.may_meet(&[[179.5, 10.0], [180.5, 11.0]]));
    assert!(bounds.may_meet(&[[0.0, 89.0], [120.0, 89.0], [-120.0, 89.0]]), "around a pole");
    assert!(!bounds.may_meet(&[]));
}
