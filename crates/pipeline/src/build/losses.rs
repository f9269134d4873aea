//! What became of every road at the finest level, and which were lost and why.

use corniche_tileset::RoadLoss;

use super::{
    roads::ReadRoads,
    tiles::{RoadFate, Tiles},
};
use crate::{BuildError, Defect, Loss, Observer};

/// A road's length at the finest level, by what became of it; each part measured by itself.
#[expect(clippy::struct_field_names, reason = "the unit is part of every name")]
struct Lengths {
    length_steps: f64,
    kept_steps: f64,
    outside_steps: f64,
    void_steps: f64,
}

impl Lengths {
    /// A cut moves a point by less than a lattice step; a length no greater than that is none.
    fn is_some(&self, steps: f64) -> bool {
        steps > 2.0 + self.length_steps * 1e-9
    }

    fn is_kept(&self) -> bool {
        self.is_some(self.kept_steps)
    }

    fn losses(&self) -> [(Loss, f64); 2] {
        [(Loss::OutsideData, self.outside_steps), (Loss::NoGround, self.void_steps)]
    }

    /// What a road that is lost altogether is counted under: the greater part.
    fn reason(&self) -> Loss {
        if self.void_steps >= self.outside_steps { Loss::NoGround } else { Loss::OutsideData }
    }
}

fn lengths(roads: &ReadRoads<'_>, tiles: &Tiles) -> impl Iterator<Item = Lengths> {
    roads.lengths_steps.iter().zip(&roads.outside_steps).zip(&tiles.roads).map(
        |((&length_steps, &outside_steps), &RoadFate { kept_steps, void_steps })| Lengths {
            length_steps,
            kept_steps,
            outside_steps,
            void_steps,
        },
    )
}

/// Sums over all roads.
pub(crate) struct Sums {
    pub(crate) roads_kept: u64,
    pub(crate) roads_kept_m: f64,
    pub(crate) lost: Vec<RoadLoss>,
}

/// Roads kept and lost, in count and length; `step_m` is the lattice's.
pub(crate) fn sums(roads: &ReadRoads<'_>, tiles: &Tiles, step_m: f64) -> Sums {
    let mut sums = Sums { roads_kept: 0, roads_kept_m: 0.0, lost: Vec::new() };
    let mut losses = [(Loss::OutsideData, 0, 0.0), (Loss::NoGround, 0, 0.0)];
    for road in lengths(roads, tiles) {
        sums.roads_kept_m += road.kept_steps * step_m;
        sums.roads_kept += u64::from(road.is_kept());
        for ((loss, count, length_m), (_, steps)) in losses.iter_mut().zip(road.losses()) {
            *length_m += steps * step_m;
            *count += u64::from(!road.is_kept() && road.reason() == *loss);
        }
    }
    sums.lost = losses
        .into_iter()
        .map(|(loss, roads, length_m)| RoadLoss {
            reason: loss.reason().to_owned(),
            roads,
            length_m,
        })
        .collect();
    sums
}

/// Tells of every road that was lost, or lost in part, in the order in which roads were read.
pub(crate) fn report(
    roads: &ReadRoads<'_>,
    tiles: &Tiles,
    step_m: f64,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    for (ordinal, road) in (0..).zip(lengths(roads, tiles)) {
        for (loss, steps) in road.losses() {
            // A road of no length to speak of is lost as a whole, or not at all.
            let is_counted = !road.is_kept() && road.reason() == loss;
            if is_counted || road.is_some(steps) {
                observer.defect(&Defect::LostRoad {
                    way_id: roads.log.load(ordinal)?.way_id,
                    loss,
                    length_m: steps * step_m,
                    is_whole: !road.is_kept(),
                });
            }
        }
    }
    Ok(())
}
