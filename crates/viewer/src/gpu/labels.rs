//! The labels of roads as samples of a picture have them: what stands for which road.
//!
//! ```text
//!   0                nothing
//!   2 … 19           tunnels        2 · (9 − class), plus 1 on a dash of the edge
//!  32 … 175          other roads    ┌──── 4 bits ────┬─ 4 bits ─┐
//!                                   │   10 − class   │   band   │
//!                                   └────────────────┴──────────┘
//! ```
//!
//! Of two labels the larger one stays. So a road above the ground hides every tunnel, a more important class hides a less
//! important one, and where two roads of a class meet, the inner bands of each lie on the outer ones of both.

use corniche_styles::RoadBands;

/// The label of a band of a road on the ground; band 0 is the whole road.
#[must_use]
pub fn road_label(class: u8, band: u8) -> u8 {
    (10 - class) * RoadBands::MOST as u8 + band
}

/// The label of a tunnel, on a dash of its edge or between two.
#[must_use]
pub fn tunnel_label(class: u8, is_dash: bool) -> u8 {
    (9 - class) * 2 + u8::from(is_dash)
}

/// Whether a label is that of a tunnel.
#[must_use]
pub fn is_tunnel(label: u8) -> bool {
    label != 0 && label < 2 * RoadBands::MOST as u8
}

/// The class of a road with this label; `None` without a road.
#[must_use]
pub fn class_of(label: u8) -> Option<u8> {
    match label {
        0 => None,
        _ if is_tunnel(label) => Some(9 - label / 2),
        _ => Some(10 - label / RoadBands::MOST as u8),
    }
}
