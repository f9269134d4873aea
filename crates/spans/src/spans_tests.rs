//! Every reason to check a span is listed, named and explained exactly once.

use std::collections::BTreeSet;

use super::SpanReason;

/// Returns the index of a reason in the list. A new reason must be added here, or this does not
/// compile.
fn place(reason: SpanReason) -> usize {
    match reason {
        SpanReason::NoSupport => 0,
        SpanReason::OneSupport => 1,
        SpanReason::OpenEnd => 2,
        SpanReason::GroundWayOnDeck => 3,
        SpanReason::KindChange => 4,
        SpanReason::LayerTie => 5,
        SpanReason::OrderUnreachable => 6,
        SpanReason::OrderReversed => 7,
        SpanReason::NoGround => 8,
        SpanReason::TooIntricate => 9,
        SpanReason::TooManyCrossings => 10,
        SpanReason::GradeOverLimit => 11,
        SpanReason::DeckInGround => 12,
        SpanReason::TunnelAboveGround => 13,
    }
}

#[test]
fn every_reason_is_listed_and_has_a_name_and_words_of_its_own() {
    let all = SpanReason::ALL;
    assert!(all.iter().enumerate().all(|(at, reason)| place(*reason) == at));
    let ids: BTreeSet<&str> = all.iter().map(|reason| reason.id()).collect();
    let words: BTreeSet<&str> = all.iter().map(|reason| reason.words()).collect();
    assert_eq!([ids.len(), words.len()], [14, 14]);
}
