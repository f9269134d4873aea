//! The fates of all parts of a road determine whether it is kept or lost, in any order.

use corniche_spec::artifacts::ArtifactError;
use std::sync::Mutex;

use corniche_store::MemoryStore;
use corniche_testing::MemoryScratch;
use proptest::{collection::vec, prelude::*};

use super::*;
use crate::roads::totals::{RoadLength, lengths_writer};

/// Records defects.
#[derive(Default)]
struct Told(Mutex<Vec<Defect>>);

impl corniche_work::Observer for Told {}

impl BuildObserver for Told {
    fn defect(&self, defect: &Defect) {
        self.0.lock().unwrap().push(defect.clone());
    }
}

fn stored(lengths: &[RoadLength]) -> (MemoryStore, RoadTotals) {
    let store = MemoryStore::default();
    let mut writer = lengths_writer(&store);
    for &length in lengths {
        writer.push(length).unwrap();
    }
    writer.finish().unwrap();
    let totals = RoadTotals { roads: lengths.len() as u64, ..RoadTotals::default() };
    (store, totals)
}

fn road(way_id: i64, outside_um: u64) -> RoadLength {
    let structure = Structure::ALL[way_id as usize % 3];
    RoadLength { way_id, structure, length_um: 1_000_000, outside_um, padding_um: 0, beyond_um: 0 }
}

fn fate(kept_um: u64, void_um: u64) -> RoadFate {
    RoadFate { kept_um, void_um }
}

/// Folds `fates`, tile by tile.
fn folded(lengths: &[RoadLength], tiles: &[Vec<(u32, RoadFate)>]) -> (Sums, Vec<Defect>) {
    let ((store, totals), scratch) = (stored(lengths), MemoryScratch::default());
    let mut fold = LossFold::new(&scratch, 0);
    for tile in tiles {
        fold.add(tile).unwrap();
    }
    let told = Told::default();
    let sums = fold.finish(&totals, &store, &told).unwrap();
    (sums, told.0.into_inner().unwrap())
}

#[test]
fn roads_are_kept_or_lost_by_what_became_of_all_their_parts() {
    let lengths = [road(10, 0), road(11, 700_000), road(12, 2_000), road(13, 0)];
    let tiles = [
        vec![(0, fate(600_000, 0)), (1, fate(0, 300_000)), (3, fate(1_500, 5_000))],
        vec![(0, fate(399_000, 1_000)), (2, fate(998_000, 0)), (3, fate(1_500, 992_000))],
    ];
    let (sums, defects) = folded(&lengths, &tiles);
    assert_eq!((sums.roads_kept, sums.roads_kept_um), (3, 2_000_000));
    let lost: Vec<_> = sums.lost.iter().map(|loss| (loss.roads, loss.length_um)).collect();
    assert_eq!(lost, [(1, 702_000), (0, 300_000 + 1_000 + 997_000)]);
    let lost =
        |way_id, loss, length_m, is_whole| Defect::LostRoad { way_id, loss, length_m, is_whole };
    let expected = [
        lost(11, Loss::OutsideData, 0.7, true),
        lost(11, Loss::NoGround, 0.3, true),
        lost(13, Loss::NoGround, 0.997, false),
    ];
    assert_eq!(defects, expected);
}

/// Length without ground in the padding of the data's tiles is outside the data.
#[test]
fn padding_is_outside_the_data() {
    let in_padding = |way_id, padding_um| RoadLength { padding_um, ..road(way_id, 0) };
    // The first road is wholly in the padding, the second half in it and half over a void, and the
    // third is partly kept. The second is measured a micrometre too long.
    let lengths = [in_padding(1, 1_000_000), in_padding(2, 400_000), in_padding(3, 300_001)];
    let tiles =
        [vec![(0, fate(0, 1_000_000)), (1, fate(0, 1_000_000)), (2, fate(700_000, 300_000))]];
    let (sums, defects) = folded(&lengths, &tiles);
    let of = |lost: &[RoadLoss]| -> Vec<(u64, u64)> {
        lost.iter().map(|loss| (loss.roads, loss.length_um)).collect()
    };
    assert_eq!(of(&sums.lost), [(1, 1_000_000 + 400_000 + 300_000), (1, 600_000)]);
    assert_eq!(of(&sums.lost_by_tiles), [(0, 0), (2, 2_300_000)]);
    assert_eq!((sums.roads_kept, sums.roads_kept_um), (1, 700_000));
    let told: Vec<_> = defects
        .iter()
        .map(|defect| match defect {
            Defect::LostRoad { way_id, loss, .. } => (*way_id, *loss),
            Defect::Osm(_) | Defect::Span { .. } => panic!("{defect:?}"),
        })
        .collect();
    let (beside, void) = (Loss::OutsideData, Loss::NoGround);
    assert_eq!(told, [(1, beside), (2, beside), (2, void), (3, beside)]);
}

#[test]
fn a_road_that_does_not_exist_and_missing_lengths_are_damage() {
    let ((store, totals), scratch) = (stored(&[road(1, 0)]), MemoryScratch::default());
    let mut fold = LossFold::new(&scratch, 0);
    fold.add(&[(1, fate(1, 0))]).unwrap();
    let error = fold.finish(&totals, &store, &corniche_work::Silent).unwrap_err();
    assert!(matches!(error, ExtractError::Artifact(ArtifactError::Damaged { .. })), "{error}");
    let more = RoadTotals { roads: 2, ..RoadTotals::default() };
    let error =
        LossFold::new(&scratch, 0).finish(&more, &store, &corniche_work::Silent).unwrap_err();
    assert!(matches!(error, ExtractError::Artifact(ArtifactError::Damaged { .. })), "{error}");
    let error = LossFold::new(&scratch, 0)
        .finish(&totals, &MemoryStore::default(), &corniche_work::Silent)
        .unwrap_err();
    assert!(matches!(error, ExtractError::Artifact(ArtifactError::Damaged { .. })), "{error}");
}

proptest! {
    /// The sums and the reports do not depend on the order of tiles, or on the distribution of
    /// fates to tiles: they equal those of each road's own sums.
    #[test]
    fn no_order_and_no_grouping_matters(
        outside_um in vec(prop_oneof![Just(0), 0..4_000_u64, 0..9_000_000_u64], 1..30),
        fates in vec((any::<prop::sample::Index>(), 0..4_000_u64, 0..4_000_u64), 0..90),
        group in 1..9_usize,
    ) {
        let lengths: Vec<RoadLength> = (100..).zip(&outside_um).map(|(way_id, &um)| road(way_id, um)).collect();
        let fates: Vec<(u32, RoadFate)> = fates
            .iter()
            .map(|(at, kept_um, void_um)| (at.index(lengths.len()) as u32, fate(*kept_um, *void_um)))
            .collect();
        let one_tile = folded(&lengths, std::slice::from_ref(&fates));
        let mut backwards: Vec<Vec<_>> = fates.chunks(group).map(<[_]>::to_vec).collect();
        backwards.reverse();
        prop_assert_eq!(&folded(&lengths, &backwards), &one_tile);
        let mut of_road = vec![RoadFate::default(); lengths.len()];
        for (ordinal, fate) in &fates {
            of_road[*ordinal as usize].merge(fate);
        }
        let merged: Vec<_> = (0..).zip(of_road.iter().copied()).collect();
        prop_assert_eq!(&folded(&lengths, &[merged]), &one_tile);
        let kept_um: u64 = fates.iter().map(|(_, fate)| fate.kept_um).sum();
        prop_assert_eq!(one_tile.0.roads_kept_um, kept_um);
        for (number, &structure) in Structure::ALL.iter().enumerate() {
            let of_structure = lengths.iter().zip(&of_road).filter(|(road, _)| road.structure == structure);
            let kept_um: u64 = of_structure.map(|(_, fate)| fate.kept_um).sum();
            prop_assert_eq!(one_tile.0.kept_by_structure_um[number], kept_um);
        }
        let kept = of_road.iter().filter(|fate| fate.kept_um > 2_000).count() as u64;
        let lost: u64 = one_tile.0.lost.iter().map(|loss| loss.roads).sum();
        prop_assert_eq!((one_tile.0.roads_kept, lost), (kept, lengths.len() as u64 - kept));
    }
}
