//! Coefficients of every size round-trip.

use corniche_testing::Random;

use super::*;
use crate::payload::range_coder::{BitReader, BitWriter};
use crate::payload::relief::wavelet::{SMOOTH, rough_bands};

#[test]
fn numbers_of_every_size_come_back() {
    let mut random = Random::new(3);
    let mut numbers: Vec<i64> = (0..5000).map(|k| random.around(1 << (k % 40))).collect();
    numbers.extend([0, 1, -1, 13, 14, 15, -14, (1 << 40) - 1, 1 - (1 << 40)]);
    let mut writer = BitWriter::new(Vec::new());
    let mut coder = NumberModel::new();
    for (k, &number) in numbers.iter().enumerate() {
        assert_eq!(coder.code(&mut writer, k as i64 % 300, number), number);
    }
    let bytes = writer.finish();
    let (mut reader, mut coder) = (BitReader::new(&bytes), NumberModel::new());
    for (k, &number) in numbers.iter().enumerate() {
        assert_eq!(coder.code(&mut reader, k as i64 % 300, 0), number);
    }
    assert!(reader.is_exact());
}

/// Codes a mask and all bands.
fn all<B: Bits>(bits: &mut B, square: &mut [i64], mask: &mut [bool]) {
    code_mask(bits, mask);
    code_smooth(bits, square, SMOOTH);
    let mut numbers = NumberModel::new();
    for level in (0..5).rev() {
        for (k, band) in rough_bands(level).into_iter().enumerate() {
            let parent = (level < 4).then(|| rough_bands(level + 1)[k]);
            code_band(bits, &mut numbers, square, band, parent);
        }
    }
}

#[test]
fn bands_and_masks_come_back() {
    let mut random = Random::new(4);
    let square: Vec<i64> =
        (0..SIDE * SIDE).map(|k| if k % 7 < 4 { 0 } else { random.around(20) }).collect();
    let mask: Vec<bool> = (0..SIDE * SIDE).map(|k| k % SIDE > k / SIDE || k % 1000 == 0).collect();
    let mut writer = BitWriter::new(Vec::new());
    all(&mut writer, &mut square.clone(), &mut mask.clone());
    let bytes = writer.finish();
    let (mut found, mut found_mask) = (vec![0; SIDE * SIDE], vec![false; SIDE * SIDE]);
    let mut reader = BitReader::new(&bytes);
    all(&mut reader, &mut found, &mut found_mask);
    assert_eq!((found, found_mask), (square, mask));
    assert!(reader.is_exact());
}
