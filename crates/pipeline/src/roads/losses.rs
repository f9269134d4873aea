//! Which roads were kept at the finest level, which were lost, and why.

use corniche_tileset::RoadLoss;

use super::{
    lay::{LaidSums, RoadFate},
    lengths::UM,
    read::ReadRoads,
};
use crate::{BuildError, Defect, Loss, Observer};

/// A road's true length at the finest level, micrometres, by what became of it; each part measured by itself.
#[expect(clippy::struct_field_names, reason = "the unit is part of every name")]
struct Lengths {
    kept_um: u64,
    outside_um: u64,
    void_um: u64,
}

/// A cut moves a point by less than a lattice step, which is at most a millimetre, so lengths up to 2 mm count as 0.
fn is_some(length_um: u64) -> bool {
    length_um > 2_000
}

impl Lengths {
    fn is_kept(&self) -> bool {
        is_some(self.kept_um)
    }

    fn losses(&self) -> [(Loss, u64); 2] {
        Loss::ALL.map(|loss| match loss {
            Loss::OutsideData => (loss, self.outside_um),
            Loss::NoGround => (loss, self.void_um),
        })
    }

    /// The reason under which a completely lost road is counted: that of the longer lost part.
    fn reason(&self) -> Loss {
        if self.void_um >= self.outside_um { Loss::NoGround } else { Loss::OutsideData }
    }
}

fn lengths(roads: &ReadRoads<'_>, laid: &LaidSums) -> impl Iterator<Item = Lengths> {
    roads.outside_um.iter().zip(&laid.fates).map(|(&outside_um, &RoadFate { kept_um, void_um })| {
        Lengths { kept_um, outside_um, void_um }
    })
}

/// Sums over all roads.
pub(crate) struct Sums {
    pub(crate) roads_kept: u64,
    pub(crate) roads_kept_um: u64,
    pub(crate) lost: Vec<RoadLoss>,
}

/// Roads kept and lost, in count and length.
pub(crate) fn sums(roads: &ReadRoads<'_>, laid: &LaidSums) -> Sums {
    let mut sums = Sums { roads_kept: 0, roads_kept_um: 0, lost: Vec::new() };
    let mut losses = Loss::ALL.map(|loss| (loss, 0, 0));
    for road in lengths(roads, laid) {
        sums.roads_kept_um += road.kept_um;
        sums.roads_kept += u64::from(road.is_kept());
        for ((loss, count, length_um), (_, lost_um)) in losses.iter_mut().zip(road.losses()) {
            *length_um += lost_um;
            *count += u64::from(!road.is_kept() && road.reason() == *loss);
        }
    }
    sums.lost = losses
        .into_iter()
        .map(|(loss, roads, length_um)| RoadLoss {
            reason: loss.reason().to_owned(),
            roads,
            length_um,
        })
        .collect();
    sums
}

/// Reports every road that was lost completely or in part, in the order in which roads were read.
pub(crate) fn report(
    roads: &ReadRoads<'_>,
    laid: &LaidSums,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    for (ordinal, road) in (0..).zip(lengths(roads, laid)) {
        for (loss, lost_um) in road.losses() {
            // A road shorter than 2 mm has no length to lose, but it can be lost as a whole.
            let is_counted = !road.is_kept() && road.reason() == loss;
            if is_counted || is_some(lost_um) {
                observer.defect(&Defect::LostRoad {
                    way_id: roads.log.load(ordinal)?.way_id,
                    loss,
                    length_m: lost_um as f64 / UM,
                    is_whole: !road.is_kept(),
                });
            }
        }
    }
    Ok(())
}
