//! The roads of a tile: lines as the package has them, cut into the pieces that are uploaded.

mod ends;
mod ground_beside;
mod lines;
mod list;
mod segments;
mod volumes;

pub(crate) use self::segments::Piece;
pub use self::{
    ends::{RoadEnd, Side},
    ground_beside::{Bed, NearHeights},
    lines::{BadRoad, GroundLine, PlanLine, TileLines},
    list::RoadList,
    segments::{RoadSegment, RoadSegments},
    volumes::{RoadVolume, RoadVolumes},
};

#[cfg(test)]
#[path = "roads_tests.rs"]
mod tests;
