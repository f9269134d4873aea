//! Numbers of all sizes round-trip in all contexts.

use super::*;
use crate::payload::range_coder::{BitReader, BitWriter};

/// Numbers of all sizes round-trip in all contexts.
#[test]
fn numbers_come_back() {
    let largest = (1_i64 << 32) - 1;
    let numbers: Vec<i64> = (0..33)
        .flat_map(|shift| [-1, 0, 1].map(|by| ((1_i64 << shift) + by).clamp(0, largest)))
        .flat_map(|magnitude| [magnitude, -magnitude])
        .collect();
    let context = |k: usize| [k % 5, k % 7];
    let mut writer = BitWriter::new(Vec::new());
    let mut magnitudes = Magnitudes::<4, 6>::default();
    for (k, &number) in numbers.iter().enumerate() {
        magnitudes.code(&mut writer, context(k), number);
    }
    let bytes = writer.finish();
    let mut reader = BitReader::new(&bytes);
    let mut magnitudes = Magnitudes::<4, 6>::default();
    for (k, &number) in numbers.iter().enumerate() {
        assert_eq!(magnitudes.code(&mut reader, context(k), 0), number);
    }
    assert!(reader.is_exact());
}

/// Classes grow with the number and divide each octave in two.
#[test]
fn classes_are_half_octaves() {
    let sums = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 16, u64::MAX];
    let classes = sums.map(half_octave);
    assert_eq!(classes, [0, 1, 2, 3, 4, 4, 5, 5, 6, 6, 7, 8, 127]);
}
