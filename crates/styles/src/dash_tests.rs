use super::*;

#[test]
fn a_pattern_is_divided_into_shares() {
    let dash = Dash::new(&[6.0, 2.0]).unwrap();
    assert_eq!((dash.ends(), dash.least_px()), ([0.375, 0.5, 0.875], 16.0));
    let dash = Dash::new(&[5.0, 2.0, 1.0, 2.0]).unwrap();
    assert_eq!((dash.ends(), dash.least_px()), ([0.5, 0.7, 0.8], 10.0));
    assert_eq!(Dash::new(&[]).unwrap(), Dash::SOLID);
}

#[test]
fn what_is_no_pattern_is_refused() {
    for wrong in [&[3.0][..], &[1.0, 2.0, 3.0], &[1.0; 5], &[4.0, 0.0], &[4.0, f32::NAN]] {
        assert!(Dash::new(wrong).is_err(), "{wrong:?}");
    }
}
