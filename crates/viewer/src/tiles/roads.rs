//! The roads of a tile: lines as in the package, cut into the pieces that are uploaded.

mod cut;
mod dashes;
mod deck_line;
mod decks;
pub(crate) mod ends;
mod flat_ends;
mod ground_beside;
mod lines;
mod list;
mod look;
mod parts;
mod records;
mod road_line;
mod segments;
mod unmapped;
mod volumes;

pub(crate) use self::{
    cut::OffGroundRoads,
    dashes::dash_of_segment_m,
    deck_line::deck_lines,
    decks::GroundNet,
    ends::RoadEnd,
    ground_beside::{Bed, NearHeights},
    lines::{draped_points_m, portals},
    parts::{InNet, OPEN_M},
    segments::LinePiece,
};
pub use self::{
    dashes::DashPlace,
    deck_line::DeckLine,
    decks::{DeckPiece, DeckPieces},
    lines::{BadRoads, GroundLine, PlanLine, TileLines},
    list::RoadList,
    look::{RoadKind, RoadLook},
    segments::{RoadSegment, RoadSegments},
    volumes::{RoadVolume, RoadVolumes},
};

#[cfg(test)]
#[path = "roads_tests.rs"]
mod tests;
