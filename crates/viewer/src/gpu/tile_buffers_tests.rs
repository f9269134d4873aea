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

#[test]
fn bounds_in_16_bits_are_never_too_low_and_hardly_too_high() {
    // As IEEE 754 has it: 10 digits after the first.
    let value_of = |bits: u16| {
        let digits = 1.0 + f64::from(bits & 0x3FF) / 1024.0;
        digits * 2.0_f64.powi(i32::from(bits >> 10) - 15)
    };
    assert_eq!((f16_above(0.0), f16_above(1.0), f16_above(65_504.0)), (0, 0x3C00, 0x7BFF));
    for k in 0..4000 {
        let value = 1e-4 * 1.005_f32.powi(k);
        let coded = value_of(f16_above(value));
        let exact = f64::from(value.min(65_504.0));
        assert!((exact..=exact * 1.001).contains(&coded), "{value} became {coded}");
    }
    assert!(value_of(f16_above(1e-9)) < 1e-4 && value_of(f16_above(f32::INFINITY)) > 65_503.0);
}

#[test]
fn triangles_that_share_an_edge_have_it_once() {
    assert_eq!(edges(&[0, 1, 2, 2, 1, 3]), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
    assert!(edges(&[]).is_empty());
}
