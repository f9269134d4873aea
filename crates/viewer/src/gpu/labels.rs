//! The labels of roads in the samples of a picture, and their meaning.
//!
//! ```text
//!   0                nothing
//!   2 … 19           tunnels        2 · (9 − class), plus 1 on a dash of the edge and on the tick of a portal
//!  21 … 29           service roads  20 + (9 − class)
//!  32 … 175          other roads    ┌──── 4 bits ────┬─ 4 bits ─┐
//!                                   │   10 − class   │   band   │
//!                                   └────────────────┴──────────┘
//! ```
//!
//! Of two labels the larger one stays. So a road above the ground hides every tunnel, every other
//! road hides a service road, and a more important class hides a less important one. Where two
//! roads of a class meet, the inner bands of both are above the outer bands of both.

use corniche_styles::RoadBands;

/// Labels below this are labels of tunnels.
const SERVICE_LABELS: u8 = 20;

/// Whether a label is the label of a tunnel.
#[must_use]
pub fn is_tunnel(label: u8) -> bool {
    label != 0 && label < SERVICE_LABELS
}

/// Whether a label is the label of a service road.
#[must_use]
pub fn is_service(label: u8) -> bool {
    (SERVICE_LABELS..2 * RoadBands::MOST as u8).contains(&label)
}

/// Returns the class of a road with this label; `None` without a road.
#[must_use]
pub fn class_of(label: u8) -> Option<u8> {
    match label {
        0 => None,
        _ if is_tunnel(label) => Some(9 - label / 2),
        _ if is_service(label) => Some(9 - (label - SERVICE_LABELS)),
        _ => Some(10 - label / RoadBands::MOST as u8),
    }
}
