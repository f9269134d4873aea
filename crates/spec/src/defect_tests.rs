//! The list of losses is complete and in order.

use super::*;

/// The match has no `_`, so a new reason does not compile here until it has a place in the order.
#[test]
fn every_loss_is_listed_once_in_order() {
    for (place, loss) in Loss::ALL.into_iter().enumerate() {
        let expected = match loss {
            Loss::OutsideData => 0,
            Loss::NoGround => 1,
            Loss::OutsideBounds => 2,
        };
        assert_eq!(place, expected, "{loss:?}");
    }
    assert_eq!(Loss::ALL.len(), 3);
}
