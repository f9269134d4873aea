use super::*;

/// The match has no `_`, so a new kind does not compile here until it has a place in the list.
#[test]
fn every_kind_of_input_is_listed_once() {
    for (place, kind) in InputKind::ALL.into_iter().enumerate() {
        let expected = match kind {
            InputKind::Dem => 0,
            InputKind::DemPart => 1,
            InputKind::Osm => 2,
        };
        assert_eq!(place, expected, "{kind:?}");
    }
    assert_eq!(InputKind::ALL.len(), 3);
}
