use super::*;

#[test]
fn sizes_of_memory() {
    assert_eq!(parse_memory("512M").unwrap(), 512 << 20);
    assert_eq!(parse_memory("4G").unwrap(), 4 << 30);
    assert_eq!(parse_memory("1073741824").unwrap(), 1 << 30);
    assert_eq!(parse_memory("1T").unwrap(), 1 << 40);
    for bad in ["", "G", "-1G", "1M", "99999999999G", "ä"] {
        assert!(parse_memory(bad).is_err(), "{bad}");
    }
}

#[test]
fn lengths_must_be_lengths() {
    assert!(positive("--max-error", Some(0.0)).is_err());
    assert!(positive("--max-error", Some(f64::NAN)).is_err());
    assert_eq!(positive("--max-error", Some(2.5)).unwrap(), Some(2.5));
}
