//! A stretch between two heights contains its part of the segment.

use super::*;

#[test]
fn a_stretch_holds_the_segment_between_two_heights() {
    let point = LatticePoint::new;
    let [low, high] = stretch_u([point(0, 0), point(1000, 100)], [40, 60]);
    assert!((398..=400).contains(&low) && (600..=602).contains(&high));
    assert_eq!(stretch_u([point(7, 5), point(-3, 5)], [0, 9]), [-3, 7]);
    let [low, high] = stretch_u([point(1 << 40, 1 << 40), point(0, 0)], [-9, 1 << 41]);
    assert!(low <= 0 && high >= 1 << 40);
}
