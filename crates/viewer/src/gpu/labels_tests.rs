//! The labels of roads that tests expect, as defined in `gpu/labels.rs`.

use corniche_styles::RoadBands;

/// The label of a band of a road on the ground; band 0 is the whole road.
pub(crate) fn road_label(class: u8, band: u8) -> u8 {
    (10 - class) * RoadBands::MOST as u8 + band
}

/// The label of a tunnel, on a dash of its edge or in a gap.
pub(crate) fn tunnel_label(class: u8, is_dash: bool) -> u8 {
    (9 - class) * 2 + u8::from(is_dash)
}

/// The label of a service road.
pub(crate) fn service_label(class: u8) -> u8 {
    20 + 9 - class
}
