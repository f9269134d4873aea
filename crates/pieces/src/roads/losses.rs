//! Which roads were kept on the finest level, which were lost, and why.

use corniche_roads::Structure;
use corniche_spec::artifacts::ArtifactError;
use corniche_spec::{BuildObserver, Defect, Loss, true_lengths::UM};
use corniche_store::{Artifacts, ScratchSpace, SerdeRecord, Sorter};
use corniche_tileset::{ManifestCounts, RoadLoss, SampleCounts};
use serde::{Deserialize, Serialize};

use super::{
    lay::RoadFate,
    totals::{BLOCK_ROADS, RoadLength, RoadTotals, lengths_of_block},
};
use crate::ExtractError;

/// A road's true length on the finest level, micrometres, divided by fate; each part is measured
/// separately.
struct Lengths {
    kept_um: u64,
    /// In the order of [`Loss::ALL`].
    lost_um: [u64; Loss::ALL.len()],
}

/// Whether a length counts as more than 0. A cut moves a point by less than a lattice step, which
/// is at most a millimetre, so lengths up to 2 mm count as 0.
fn is_some(length_um: u64) -> bool {
    length_um > 2_000
}

impl Lengths {
    fn is_kept(&self) -> bool {
        is_some(self.kept_um)
    }

    fn losses(&self) -> impl Iterator<Item = (Loss, u64)> {
        Loss::ALL.into_iter().zip(self.lost_um)
    }

    /// The reason under which a completely lost road is counted: the reason of its longest lost
    /// part.
    fn reason(&self) -> Loss {
        let [outside_um, void_um, beyond_um] = self.lost_um;
        if beyond_um > void_um.max(outside_um) {
            Loss::OutsideBounds
        } else if void_um >= outside_um {
            Loss::NoGround
        } else {
            Loss::OutsideData
        }
    }
}

/// Sums over all roads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sums {
    /// The number of roads of which at least a part is kept.
    pub roads_kept: u64,
    /// The kept length, micrometres.
    pub roads_kept_um: u64,
    /// The kept length by structure, in the order of [`Structure::ALL`].
    pub(crate) kept_by_structure_um: [u64; Structure::ALL.len()],
    pub(crate) lost: Vec<RoadLoss>,
    /// The losses as older packages record them: only roads outside the data's tiles are outside
    /// the data.
    pub lost_by_tiles: Vec<RoadLoss>,
}

/// The counts of the manifest: what was read, what was kept, what was lost and why; per road, then
/// summed.
#[must_use]
pub fn road_counts(samples: SampleCounts, roads: &RoadTotals, losses: &Sums) -> ManifestCounts {
    let extract = &roads.extract;
    ManifestCounts {
        samples,
        roads_in: roads.roads,
        roads_in_um: roads.length_um,
        classes: roads.classes.clone(),
        defects: roads.defects.iter().map(|(name, &count)| (name.clone(), count)).collect(),
        unknown_highways: extract.unknown_highways.clone(),
        tags_taken_otherwise: extract.tags_taken_otherwise.clone(),
        blobs_passed_over: extract.blobs_passed_over,
        highways_in: extract.highways_in,
        highways_left_out: extract.highways_left_out.clone(),
        left_out: extract.left_out.clone(),
        roads_kept: losses.roads_kept,
        roads_kept_um: losses.roads_kept_um,
        roads_lost: losses.lost.clone(),
    }
}

/// Sums up the fates of each road in all tiles. Its memory is capped, however many roads there are.
pub struct LossFold<'a> {
    fates: Sorter<'a, FateRecord>,
}

impl<'a> LossFold<'a> {
    /// Creates an empty fold that uses at most about `memory_bytes` of memory.
    pub fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        Self { fates: Sorter::new(scratch, memory_bytes) }
    }

    /// Adds the fates of roads in one tile. The order of tiles does not matter.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn add(&mut self, fates: &[(u32, RoadFate)]) -> Result<(), ExtractError> {
        for &(ordinal, fate) in fates {
            self.fates.push(FateRecord { ordinal, fate })?;
        }
        Ok(())
    }

    /// Combines the fates with the lengths of all roads. Reports every road that was lost
    /// completely or in part, in the order in which roads were read.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn finish(
        self,
        totals: &RoadTotals,
        store: &dyn Artifacts,
        observer: &dyn BuildObserver,
    ) -> Result<Sums, ExtractError> {
        let mut fates = self.fates.finish()?.peekable();
        let (mut sums, mut lost, mut by_tiles) =
            (Sums::default(), Lost::default(), Lost::default());
        for block in 0..totals.roads.div_ceil(BLOCK_ROADS) {
            let first = block * BLOCK_ROADS;
            let roads = BLOCK_ROADS.min(totals.roads - first);
            for (ordinal, length) in (first..).zip(lengths_of_block(store, block, roads)?) {
                let mut fate = RoadFate::default();
                let is_other = |record: &FateRecord| u64::from(record.ordinal) != ordinal;
                while let Some(record) =
                    fates.next_if(|record| !record.as_ref().is_ok_and(is_other))
                {
                    fate.merge(&record?.fate);
                }
                let RoadFate { kept_um, void_um } = fate;
                let RoadLength { outside_um, padding_um, beyond_um, .. } = length;
                by_tiles.add(&Lengths { kept_um, lost_um: [outside_um, void_um, beyond_um] });
                // The padding of tiles has no ground. The two lengths are measured along different
                // cuts.
                let beside_um = padding_um.min(void_um);
                let lost_um = [outside_um + beside_um, void_um - beside_um, beyond_um];
                let road = Lengths { kept_um, lost_um };
                lost.add(&road);
                sums.roads_kept += u64::from(road.is_kept());
                sums.roads_kept_um += kept_um;
                sums.kept_by_structure_um[length.structure as usize] += kept_um;
                road.report(length.way_id, observer);
            }
        }
        if let Some(FateRecord { ordinal, .. }) = fates.next().transpose()? {
            let what =
                format!("a tile names road {ordinal}, but there are only {} roads", totals.roads);
            return Err(ArtifactError::Damaged { what }.into());
        }
        Ok(Sums { lost: lost.records(), lost_by_tiles: by_tiles.records(), ..sums })
    }
}

/// The fate of a road in one tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct FateRecord {
    ordinal: u32,
    fate: RoadFate,
}

impl SerdeRecord for FateRecord {}

/// The number of lost roads and the lost length in micrometres, in the order of [`Loss::ALL`].
#[derive(Default)]
struct Lost([(u64, u64); Loss::ALL.len()]);

impl Lost {
    fn add(&mut self, road: &Lengths) {
        for ((count, length_um), (loss, lost_um)) in self.0.iter_mut().zip(road.losses()) {
            *length_um += lost_um;
            *count += u64::from(!road.is_kept() && road.reason() == loss);
        }
    }

    fn records(self) -> Vec<RoadLoss> {
        // Without bounds, nothing is lost because of them, and the reason is not listed.
        let all = Loss::ALL.into_iter().zip(self.0);
        all.filter(|&(loss, lost)| loss != Loss::OutsideBounds || lost != (0, 0))
            .map(|(loss, (roads, length_um))| RoadLoss {
                reason: loss.reason().to_owned(),
                roads,
                length_um,
            })
            .collect()
    }
}

impl Lengths {
    fn report(&self, way_id: i64, observer: &dyn BuildObserver) {
        // Roads outside the user's own bounds are not defects.
        let told = self.losses().filter(|&(loss, _)| loss != Loss::OutsideBounds);
        for (loss, lost_um) in told {
            // A road shorter than 2 mm has no length to lose, but it can be lost as a whole.
            let is_counted = !self.is_kept() && self.reason() == loss;
            if is_counted || is_some(lost_um) {
                observer.defect(&Defect::LostRoad {
                    way_id,
                    loss,
                    length_m: lost_um as f64 / UM,
                    is_whole: !self.is_kept(),
                });
            }
        }
    }
}

#[cfg(test)]
#[path = "losses_tests.rs"]
mod tests;
