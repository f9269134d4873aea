//! Texels without a photo do not darken the mean of their neighbours.

use super::*;

fn texels_from(columns: usize, rgba: &[[u8; 4]]) -> Texels {
    Texels::new(columns, rgba.len() / columns, rgba.concat()).unwrap()
}

#[test]
fn texels_without_photo_do_not_darken_the_mean() {
    let whole = [10, 20, 30, 255];
    let other = [13, 21, 30, 255];
    for (four, expected) in [
        ([whole, whole, whole, whole], whole),
        ([whole, other, whole, other], [12, 21, 30, 255]),
        ([whole, other, NONE, NONE], [12, 21, 30, 255]),
        ([whole, whole, other, NONE], [11, 20, 30, 255]),
        ([whole, NONE, NONE, NONE], NONE),
        ([NONE; 4], NONE),
    ] {
        assert_eq!(texels_from(2, &four).halved().at(0, 0), expected, "{four:?}");
    }
}

#[test]
fn a_value_between_two_is_rounded_up_and_white_stays_white() {
    let four = [[255, 0, 1, 255], [255, 1, 1, 255], [255, 0, 1, 255], [255, 1, 2, 255]];
    assert_eq!(texels_from(2, &four).halved().at(0, 0), [255, 1, 1, 255]);
}

#[test]
fn only_whole_texels_are_taken() {
    assert!(Texels::new(1, 1, vec![0; 3]).is_none());
    assert!(Texels::new(1, 1, vec![1, 2, 3, 128]).is_none());
    assert!(Texels::new(1, 1, vec![1, 2, 3, 0]).is_none());
    assert!(Texels::new(usize::MAX, 2, Vec::new()).is_none());
}

#[test]
fn a_part_lies_where_it_was_cut() {
    let all =
        Texels::new(3, 2, (0..24).map(|k| if k % 4 == 3 { 255 } else { k }).collect()).unwrap();
    let part = all.part([1, 1], [2, 1]);
    assert_eq!([part.at(0, 0), part.at(1, 0)], [[16, 17, 18, 255], [20, 21, 22, 255]]);
}
