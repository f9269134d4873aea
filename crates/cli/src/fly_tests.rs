//! A method that is given twice is flown once.

use super::*;

#[test]
fn what_is_given_twice_is_flown_once() {
    assert_eq!(once_each(&[Roads::Sv, Roads::Geo, Roads::Sv]), [Roads::Sv, Roads::Geo]);
    assert!(once_each::<Roads>(&[]).is_empty());
}
