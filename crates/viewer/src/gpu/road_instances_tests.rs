//! Adjacent road classes are drawn in one call.

use super::*;

#[test]
fn classes_side_by_side_are_drawn_at_once() {
    let class = |number| FunctionalRoadClass::new(number).unwrap();
    let class_ranges = [0..2, 2..2, 2..5, 5..6, 6..6, 6..6, 6..9, 9..9, 9..9];
    let roads = RoadBuffers { class_ranges, ..RoadBuffers::default() };
    let check = |left_out: &[u8], expected: &[Range<u32>]| {
        let classes =
            left_out.iter().fold(ClassSet::ALL, |set, number| set.without(class(*number)));
        assert_eq!(roads.runs(classes), expected);
    };
    check(&[], std::slice::from_ref(&(0..9)));
    check(&[4], std::slice::from_ref(&(0..9)));
    check(&[2], &[0..2, 5..9]);
    check(&[0, 6], std::slice::from_ref(&(2..6)));
}
