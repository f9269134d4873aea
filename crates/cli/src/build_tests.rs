use super::*;

#[test]
fn lengths_must_be_lengths() {
    assert!(positive("--max-error", Some(0.0)).is_err());
    assert!(positive("--max-error", Some(f64::NAN)).is_err());
    assert_eq!(positive("--max-error", Some(2.5)).unwrap(), Some(2.5));
}
