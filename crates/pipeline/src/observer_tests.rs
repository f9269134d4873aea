use std::collections::BTreeSet;

use super::*;

/// The match has no `_`, so a new stage does not compile here until it has a place in the list.
#[test]
fn every_stage_is_listed_once_in_order() {
    for (place, stage) in Stage::ALL.into_iter().enumerate() {
        let expected = match stage {
            Stage::Hash => 0,
            Stage::MapAreas => 1,
            Stage::Roads => 2,
            Stage::Heights => 3,
            Stage::Photos => 4,
            Stage::CoarseTins => 5,
            Stage::Deviations => 6,
            Stage::Samples => 7,
            Stage::Tiles => 8,
            Stage::CoarseTiles => 9,
            Stage::Package => 10,
            Stage::Verify => 11,
        };
        assert_eq!(place, expected, "{stage:?}");
    }
    assert_eq!(Stage::ALL.len(), 12);
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
