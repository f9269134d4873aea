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
            Stage::Layers => 2,
            Stage::Roads => 3,
            Stage::Heights => 4,
            Stage::Photos => 5,
            Stage::CoarseTins => 6,
            Stage::Deviations => 7,
            Stage::Samples => 8,
            Stage::Tiles => 9,
            Stage::CoarseTiles => 10,
            Stage::Spans => 11,
            Stage::Package => 12,
            Stage::Verify => 13,
            Stage::VerifyPhotos => 14,
            Stage::VerifyLayers => 15,
            Stage::VerifySpans => 16,
            Stage::CompareHeights => 17,
            Stage::CompareRoads => 18,
            Stage::CompareLayers => 19,
            Stage::CompareSpans => 20,
            Stage::ComparePolygon => 21,
            Stage::ExportTiles => 22,
            Stage::ExportBlocks => 23,
            Stage::ExportChains => 24,
            Stage::ExportFeatures => 25,
            Stage::Match => 26,
            Stage::Fly => 27,
        };
        assert_eq!(place, expected, "{stage:?}");
    }
    assert_eq!(Stage::ALL.len(), 28);
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
