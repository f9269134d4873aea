//! Fractions are compared exactly, even if their products do not fit in 128 bits.

use super::*;
use proptest::prelude::*;

proptest! {
    /// The order is that of cross products, if these fit.
    #[test]
    fn order_is_that_of_cross_products(a in -99_i128..99, b in 1_i128..99, c in -99_i128..99, d in 1_i128..99) {
        prop_assert_eq!(Fraction::new(a, b).cmp(&Fraction::new(c, d)), (a * d).cmp(&(c * b)));
        prop_assert_eq!(Fraction::new(-a, -b).cmp(&Fraction::new(c, d)), (a * d).cmp(&(c * b)));
    }

    /// Neighbouring fractions too close for 128-bit cross products or for f64 are distinguished.
    #[test]
    fn huge_fractions_are_told_apart(n in 1_i128 << 113..1 << 114, d in 1_i128 << 114..1 << 115) {
        prop_assert!(Fraction::new(n, d) < Fraction::new(n + 1, d));
        prop_assert!(Fraction::new(n, d) > Fraction::new(n, d + 1));
        prop_assert_eq!(Fraction::new(n, d), Fraction::new(2 * n, 2 * d));
    }
}
