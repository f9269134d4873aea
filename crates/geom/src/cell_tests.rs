//! Cells are printed as squares or as rectangles.

use super::*;

#[test]
fn cells_are_told_as_squares_or_rectangles() {
    assert_eq!(Cell::from(30.0).to_string(), "30 m");
    assert_eq!(Cell::from([20.0, 30.0]).to_string(), "20 × 30 m");
    assert_eq!(Cell::from([20.0, 30.0]).shorter_m(), 20.0);
}
