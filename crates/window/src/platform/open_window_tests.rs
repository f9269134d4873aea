//! A device may be lost now and then, but not twice in a row.

use super::*;

#[test]
fn a_device_may_be_lost_now_and_then_but_not_twice_in_a_row() {
    assert!(!is_soon_after(None, 3.0), "the first time");
    assert!(is_soon_after(Some(3.0), 4.0));
    assert!(!is_soon_after(Some(3.0), 3.0 + 2.0 * SOON_S));
}
