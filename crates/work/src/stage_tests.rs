//! Every stage is listed once, in order, under a unique name.

use std::collections::BTreeSet;

use super::*;

/// The match has no `_`, so that a new stage does not compile here until it has a place in the
/// list.
#[test]
fn every_stage_is_listed_once_in_order() {
    for (place, stage) in Stage::ALL.iter().copied().enumerate() {
        let expected = match stage {
            Stage::Hash => 0,
            Stage::Extract => 1,
            Stage::MapAreas => 2,
            Stage::Boundaries => 3,
            Stage::Roads => 4,
            Stage::Heights => 5,
            Stage::Photos => 6,
            Stage::CoarseTins => 7,
            Stage::Deviations => 8,
            Stage::Samples => 9,
            Stage::Tiles => 10,
            Stage::CoarseTiles => 11,
            Stage::Spans => 12,
            Stage::Package => 13,
            Stage::Verify => 14,
            Stage::VerifyPhotos => 15,
            Stage::VerifyAreas => 16,
            Stage::VerifyBoundaries => 17,
            Stage::VerifySpans => 18,
            Stage::CompareHeights => 19,
            Stage::CompareRoads => 20,
            Stage::CompareAreas => 21,
            Stage::CompareBoundaries => 22,
            Stage::CompareSpans => 23,
            Stage::ComparePolygon => 24,
            Stage::ExportTiles => 25,
            Stage::ExportBlocks => 26,
            Stage::ExportChains => 27,
            Stage::ExportFeatures => 28,
            Stage::Match => 29,
            Stage::Fly => 30,
        };
        assert_eq!(place, expected, "{stage:?}");
    }
    assert_eq!(Stage::ALL.len(), 31);
}

#[test]
fn names_of_stages_differ_and_fit_their_column() {
    let ids: BTreeSet<&str> = Stage::ALL.iter().copied().map(Stage::id).collect();
    let titles: BTreeSet<&str> = Stage::ALL.iter().copied().map(Stage::title).collect();
    assert_eq!((ids.len(), titles.len()), (Stage::ALL.len(), Stage::ALL.len()));
    for id in ids {
        assert!(id.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{id}");
    }
    for title in titles {
        assert!((1..=22).contains(&title.chars().count()), "{title}");
    }
}
