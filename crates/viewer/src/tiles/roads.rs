//! The roads of a tile: lines as the package has them, cut into the pieces that are uploaded.

mod dashes;
pub(crate) mod ends;
mod flat_ends;
mod ground_beside;
mod lines;
mod list;
mod look;
mod parts;
mod records;
mod segments;
mod volumes;

pub use self::{
    dashes::DashPlace,
    lines::{BadRoads, GroundLine, PlanLine, TileLines},
    list::RoadList,
    look::RoadLook,
    segments::{RoadSegment, RoadSegments},
    volumes::{RoadVolume, RoadVolumes},
};
pub(crate) use self::{
    dashes::dash_of_segment_m,
    ends::RoadEnd,
    ground_beside::{Bed, NearHeights},
    parts::OPEN_M,
    segments::Piece,
};

#[cfg(test)]
#[path = "roads_tests.rs"]
mod tests;
