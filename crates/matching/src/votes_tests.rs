//! The best shift is found between whole steps, and straight roads do not determine the offset
//! along themselves.

use super::*;

#[test]
fn shifts_are_a_square_around_none() {
    let search = ShiftSearch::new(3.0, 1.0);
    let shifts: Vec<[f64; 2]> = search.shifts().collect();
    assert_eq!((shifts.len(), search.count()), (49, 49));
    assert_eq!((shifts[0], shifts[24], shifts[48]), ([-3.0, -3.0], [0.0, 0.0], [3.0, 3.0]));
    // No more than this number.
    let search = ShiftSearch::new(100.0, 0.1);
    assert_eq!((search.count(), search.step_m()), (41 * 41, 5.0));
}

#[test]
fn the_best_shift_is_found_between_steps() {
    let search = ShiftSearch::new(10.0, 1.0);
    let hill = |[east, north]: [f64; 2]| {
        let away = (east - 3.3_f64).powi(2) + (north + 6.8).powi(2);
        // Everywhere else, votes scatter.
        (100.0 * (-away / 8.0).exp() + (east * 7.0 + north * 13.0).sin()) as f32 + 10.0
    };
    let answers: Vec<f32> = search.shifts().map(hill).collect();
    let mut votes = Votes::default();
    votes.add(&answers, 12, [1.0, 0.0, 1.0]);
    let offset = votes.offset(&search).unwrap();
    assert!((offset.east_m - 3.3).abs() < 0.2 && (offset.north_m + 6.8).abs() < 0.2, "{offset:?}");
    assert!(offset.confidence > 30.0 && !offset.is_at_edge, "{offset:?}");
    let flat = vec![1.0; search.count()];
    let mut votes = Votes::default();
    votes.add(&flat, 1, [1.0, 0.0, 0.0]);
    assert_eq!(votes.offset(&search), None);
    assert_eq!(Votes::default().offset(&search), None);
}

#[test]
fn straight_roads_say_nothing_along() {
    let mut votes = Votes::default();
    // A road to the north-east.
    let half = 0.5_f64;
    votes.add(&[0.0], 1, [half, -half, half]);
    let (across, bends) = votes.across();
    assert!((across[0] - half.sqrt()).abs() < 1e-9 && (across[1] + half.sqrt()).abs() < 1e-9);
    assert!(bends.abs() < 1e-9);
    votes.add(&[0.0], 1, [half, half, half]);
    assert!((votes.across().1 - 1.0).abs() < 1e-9);
}
