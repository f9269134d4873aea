//! The counts of shares add up.

use super::share;

#[test]
fn shares_add_up() {
    let parts = [3, 0, 7, 1, 0, 0, 0, 0, 90];
    assert_eq!((0..9).map(|index| share(1000, &parts, index)).sum::<u64>(), 1000);
    assert_eq!(share(1000, &[0; 9], 3), 0);
}
