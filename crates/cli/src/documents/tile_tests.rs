//! The normals that `tile --json` prints are unit vectors that point up.

use super::*;

#[test]
fn normals_are_unit_vectors_that_point_up() {
    let is_near = |code, expected: [f64; 3]| {
        normal(code).iter().zip(expected).all(|(side, near)| (side - near).abs() < 1e-12)
    };
    assert!(is_near([0, 0], [0.0, 0.0, 1.0]) && is_near([127, 0], [1.0, 0.0, 0.0]));
    for u in -127..=127_i8 {
        for v in -127..=127_i8 {
            let [x, y, z] = normal([u, v]);
            assert!((x.hypot(y).hypot(z) - 1.0).abs() < 1e-12 && z >= 0.0, "{u} {v}");
            assert!(x * f64::from(u) >= 0.0 && y * f64::from(v) >= 0.0, "{u} {v}");
        }
    }
    // A slope of 45° to the east: (−1, 0, 1)/√2 has half of the octahedron's length along x.
    let [x, _, z] = normal([-64, 0]);
    assert!((x + z).abs() < 0.02, "{x} {z}");
}
