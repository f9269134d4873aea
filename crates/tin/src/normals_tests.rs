//! Decoded normals are within a degree of the ground's normals, and have unit length.

use super::*;
use crate::{TinSpec, triangulate};
use proptest::prelude::*;

proptest! {
    /// A decoded normal has unit length and is within a degree of the encoded direction.
    #[test]
    fn decodes_what_was_encoded(x in -3.0_f64..3.0, y in -3.0_f64..3.0) {
        let length = (x * x + y * y + 1.0).sqrt();
        let back = decode_normal(encode_normal([x, y, 1.0], 0)).map(f64::from);
        let cosine = (back[0] * x + back[1] * y + back[2]) / length;
        prop_assert!((back.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-6);
        prop_assert!(cosine > 1.0_f64.to_radians().cos(), "{cosine}");
    }
}

#[test]
fn a_plane_has_one_normal_also_beside_gaps() {
    // The ground rises 3 m per cell of 10 m to the east, and falls 1 m per cell of 20 m to the
    // south, so it rises to the north.
    let heights = HeightGrid::from_fn(9, 9, |c, r| {
        if (c, r) == (0, 4) || r == 8 { f32::NAN } else { 3.0 * c as f32 - r as f32 }
    });
    let tin = triangulate(&heights, TinSpec { max_error_m: 1.0, quantum_m: 1.0 / 32.0 }).unwrap();
    let codes = normals(&heights, &tin, Cell { east_m: 10.0, north_m: 20.0 }, 0);
    assert_eq!(codes.len(), tin.vertices().len());
    assert!(codes.iter().all(|&code| code == encode_normal([-0.3, -0.05, 1.0], 0)), "{codes:?}");
}

#[test]
fn level_ground_points_up() {
    assert_eq!(decode_normal([0, 0]).map(f32::to_bits), [0.0_f32, 0.0, 1.0].map(f32::to_bits));
}

/// A level's normals are no finer than its tolerance requires, and rounded to the nearest step.
#[test]
fn steps_follow_the_tolerance() {
    let cell = Cell { east_m: 32.0, north_m: 64.0 };
    let shifts = [0.9, 1.0, 1.9, 2.0, 16.0].map(|max_error_m| normal_shift(max_error_m, cell));
    assert_eq!(shifts, [0, 1, 1, 2, 2]);
    let code = |x: f64, shift: u8| encode_normal([x, 0.0, 1.0 - x.abs()], shift)[0];
    assert_eq!([0, 1, 2].map(|shift| code(-0.3, shift)), [-38, -38, -40]);
    assert_eq!([0, 1, 2].map(|shift| code(1.0, shift)), [127, 126, 124]);
}
