//! Each text in packages names exactly one reason.

use super::*;

#[test]
fn each_reason_is_found_by_its_words() {
    for reason in LossReason::ALL {
        assert_eq!(LossReason::from_text(reason.text()), Some(reason));
    }
    assert_eq!(LossReason::from_text("another"), None);
}
