//! The median is that of recent frames.

use super::*;

#[test]
fn half_of_the_frames_took_no_longer_than_the_median() {
    let mut times = FrameTimes::default();
    assert_eq!(times.quantile_ms(0.5), None);
    for ms in [5.0, 1.0, 4.0, 2.0, 3.0] {
        times.push(ms);
    }
    assert_eq!(times.quantile_ms(0.5), Some(3.0));
    assert_eq!(times.quantile_ms(0.95), Some(5.0));
    assert_eq!(times.quantile_ms(0.2), Some(1.0));
    assert_eq!(times.last_ms(), Some(3.0));
}

#[test]
fn old_frames_are_forgotten() {
    let mut times = FrameTimes::default();
    for ms in 0..1000 {
        times.push(f64::from(ms));
    }
    assert_eq!(times.iter().len(), REMEMBERED);
    assert_eq!(times.quantile_ms(1e-9), Some(1000.0 - REMEMBERED as f64));
}
