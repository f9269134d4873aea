//! Patterns are divided into shares, and invalid patterns are rejected.

#![expect(clippy::float_cmp, reason = "these numbers are exact")]

use super::*;

#[test]
fn a_pattern_is_divided_into_shares() {
    let dash = Dash::new(&[6.0, 2.0]).unwrap();
    assert_eq!((dash.ends, dash.least_px), ([0.375, 0.5, 0.875], 16.0));
    let dash = Dash::new(&[5.0, 2.0, 1.0, 2.0]).unwrap();
    assert_eq!((dash.ends, dash.least_px), ([0.5, 0.7, 0.8], 10.0));
    assert_eq!(Dash::new(&[]).unwrap(), Dash::SOLID);
}

#[test]
fn what_is_no_pattern_is_refused() {
    for wrong in [&[3.0][..], &[1.0, 2.0, 3.0], &[1.0; 5], &[4.0, 0.0], &[4.0, f32::NAN]] {
        assert!(Dash::new(wrong).is_err(), "{wrong:?}");
    }
}

#[test]
fn a_texture_says_how_wide_the_line_is() {
    let even = Dash::textured(20.0, &[0.5]).unwrap();
    assert_eq!((even.widths, even.least_px), (Some([0.5; Dash::WIDTHS]), 20.0));
    let own: Vec<f32> = (0..16).map(|place| place as f32 / 15.0).collect();
    assert_eq!(Dash::textured(20.0, &own).unwrap().widths.unwrap()[..], own[..]);
    // Two shares give a step that is as long as the distance between their middles.
    let step = Dash::textured(20.0, &[0.0, 1.0]).unwrap().widths.unwrap();
    assert!(
        step[..4].iter().all(|share| *share == 0.0) && step[12..].iter().all(|share| *share == 1.0)
    );
    assert!(step.is_sorted());
    assert_eq!(Dash::new(&[4.0, 4.0]).unwrap().widths, None);
}

#[test]
fn shapes_are_symmetric_or_point_ahead() {
    let dots = Dash::dots(12.0).unwrap().widths.unwrap();
    // Widths change linearly between the given shares.
    for place in 0..10 {
        assert!((dots[place] - dots[9 - place]).abs() < 1e-6, "{dots:?}");
    }
    assert!(dots[0] == 0.0 && dots[9..].iter().all(|share| *share == 0.0) && dots[4] > 0.97);
    assert!(Dash::beads(12.0).unwrap().widths.unwrap().iter().all(|share| *share >= 0.25));
    let arrows = Dash::arrows(12.0).unwrap().widths.unwrap();
    assert_eq!((arrows[0], arrows[1], arrows[15]), (0.0, 1.0, 0.0));
    assert!(arrows[1..].is_sorted_by(|a, b| a >= b));
}

#[test]
fn what_is_no_texture_is_refused() {
    for (length_px, shares) in [
        (20.0, &[][..]),
        (20.0, &[0.5; 17]),
        (20.0, &[1.5]),
        (20.0, &[f32::NAN]),
        (1.0, &[1.0]),
        (900.0, &[1.0]),
    ] {
        assert!(Dash::textured(length_px, shares).is_err(), "{length_px} {shares:?}");
    }
}
