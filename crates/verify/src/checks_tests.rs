//! Ids of checks are short and different, and findings of several workers add up in order.

use super::*;

#[test]
fn ids_are_short_different_and_plain() {
    let mut ids: Vec<_> = CheckId::ALL.iter().map(|check| check.id()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), CheckId::ALL.len());
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '.';
    assert!(ids.iter().all(|id| id.len() <= 24 && id.chars().all(plain)), "{ids:?}");
}

#[test]
fn findings_of_two_workers_add_up_in_the_order_of_the_list() {
    let (mut one, mut other) = (Findings::default(), Findings::default());
    one.look(CheckId::Seams, true, String::new);
    other.look(CheckId::Whole, false, || "a".to_owned());
    other.look(CheckId::Seams, false, || "b".to_owned());
    one.merge(other);
    let checks = one.into_checks(&[Needs::Package]);
    assert_eq!(
        checks[0],
        Check { id: CheckId::Whole, checked: 1, broken: 1, examples: vec!["a".to_owned()] }
    );
    let seams = checks.iter().find(|check| check.id == CheckId::Seams).unwrap();
    assert_eq!((seams.checked, seams.broken), (2, 1));
    assert!(checks.iter().all(|check| check.id.needs() == Needs::Package));
}
