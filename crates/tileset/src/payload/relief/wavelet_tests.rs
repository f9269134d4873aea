//! The inverse wavelet restores every value.

use corniche_testing::Random;

use super::*;

#[test]
fn the_inverse_gives_back_every_value() {
    let mut random = Random::new(9);
    for most in [0, 1, 1000, 1_i64 << 40] {
        let square: Vec<i64> = (0..SIDE * SIDE).map(|_| random.around(most)).collect();
        let mut changed = square.clone();
        forward(&mut changed);
        assert!(most == 0 || changed != square);
        inverse(&mut changed);
        assert_eq!(changed, square);
    }
}

/// A plane has no rough part, apart from the rounding and the mirror at the border.
#[test]
fn a_plane_is_smooth() {
    let mut square: Vec<i64> =
        (0..SIDE * SIDE).map(|k| 64 * (k % SIDE) as i64 - 32 * (k / SIDE) as i64).collect();
    forward(&mut square);
    for level in 0..2 {
        for band in rough_bands(level) {
            for row in 0..band.rows {
                for column in 0..band.columns {
                    let value = square[(band.top + row) * SIDE + band.left + column];
                    assert_eq!(value, 0, "level {level}, {column} {row}");
                }
            }
        }
    }
}

/// The bands cover the square without overlaps.
#[test]
fn bands_cover_each_value_once() {
    let mut seen = vec![0; SIDE * SIDE];
    let rough = (0..LEVELS).flat_map(rough_bands);
    for band in rough.chain([SMOOTH]) {
        for row in 0..band.rows {
            for column in 0..band.columns {
                seen[(band.top + row) * SIDE + band.left + column] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&times| times == 1));
}
