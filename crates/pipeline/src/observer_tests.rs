use std::collections::BTreeSet;

use super::*;

/// The match has no `_`, so a new stage does not compile here until it has a place in the list.
#[test]
fn every_stage_is_listed_once_in_order() {
    for (place, stage) in Stage::ALL.into_iter().enumerate() {
        let expected = match stage {
            Stage::Hash => 0,
            Stage::Roads => 1,
            Stage::Heights => 2,
            Stage::Photos => 3,
            Stage::CoarseTins => 4,
            Stage::Deviations => 5,
            Stage::Samples => 6,
            Stage::Tiles => 7,
            Stage::CoarseTiles => 8,
            Stage::Package => 9,
            Stage::Verify => 10,
        };
        assert_eq!(place, expected, "{stage:?}");
    }
    assert_eq!(Stage::ALL.len(), 11);
}

#[test]
fn names_of_stages_differ_and_fit_their_column() {
    let ids: BTreeSet<&str> = Stage::ALL.into_iter().map(Stage::id).collect();
    let titles: BTreeSet<&str> = Stage::ALL.into_iter().map(Stage::title).collect();
    assert_eq!((ids.len(), titles.len()), (Stage::ALL.len(), Stage::ALL.len()));
    for id in ids {
        assert!(id.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{id}");
    }
    for title in titles {
        assert!((1..=22).contains(&title.chars().count()), "{title}");
    }
}
