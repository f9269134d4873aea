//! Each size of a photo is the mean of the previous one and keeps the border.

use super::*;

#[test]
fn each_size_is_half_of_the_one_before_and_keeps_the_border() {
    let side = 272;
    let rgba = (0..side * side)
        .flat_map(|at: usize| if at % side < 8 { [200, 100, 0, 255] } else { [0, 0, 0, 0] })
        .collect();
    let image = PhotoImage::new(Photo { levels: 0, rgba });
    let lengths: Vec<usize> = image.sizes().map(|(_, size)| size.len()).collect();
    assert_eq!(lengths, [272, 136, 68, 34].map(|side| side * side * 4));
    assert_eq!(image.bytes(), lengths.iter().sum::<usize>() as u64);
    for ((_, size), border) in image.sizes().zip([8, 4, 2, 1]) {
        let row: Vec<u8> = size.chunks_exact(4).take(10).map(|texel| texel[3]).collect();
        assert!(row[..border].iter().all(|alpha| *alpha == 255), "{row:?}");
        assert!(row[border..].iter().all(|alpha| *alpha == 0), "{row:?}");
    }
}

#[test]
fn means_are_rounded_to_the_nearest() {
    assert_eq!(
        halved(&[0, 1, 1, 255, 1, 1, 2, 255, 0, 1, 2, 255, 0, 0, 2, 255], 2),
        [0, 1, 2, 255]
    );
}
