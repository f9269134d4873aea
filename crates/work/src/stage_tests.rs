//! Every stage is listed once, in order, under a name of its own.

use std::collections::BTreeSet;

use super::*;

/// The match has no `_`, so a new stage does not compile here until it has a place in the list.
#[test]
fn every_stage_is_listed_once_in_order() {
    for (place, stage) in Stage::ALL.into_iter().enumerate() {
        let expected = match stage {
            Stage::Hash => 0,
            Stage::MapAreas => 1,
            Stage::Boundaries => 2,
            Stage::Roads => 3,
            Stage::Heights => 4,
            Stage::Photos => 5,
            Stage::CoarseTins => 6,
            Stage::Deviations => 7,
            Stage::Samples => 8,
            Stage::Tiles => 9,
            Stage::CoarseTiles => 10,
            Stage::Package => 11,
            Stage::Verify => 12,
            Stage::ExportTiles => 13,
            Stage::ExportBlocks => 14,
            Stage::ExportFeatures => 15,
            Stage::Match => 16,
            Stage::Fly => 17,
        };
        assert_eq!(place, expected, "{stage:?}");
    }
    assert_eq!(Stage::ALL.len(), 18);
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
