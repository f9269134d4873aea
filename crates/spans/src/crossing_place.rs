//! The places at which chains cross, with the properties of the chains there.

use std::cmp::Ordering;

use corniche_network::{ChainNumber, Network, NetworkWay};
use corniche_roads::grade_limit;

use crate::spans::SpanKind;

/// The grade assumed for ways without a known limit, which may be as steep as service roads,
/// percent.
const OTHER_LIMIT_PCT: f64 = 20.0;

/// A place on a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingPlace {
    /// The chain.
    pub chain: ChainNumber,
    /// OSM's id of the way there.
    pub way_id: i64,
    /// The distance along the chain, metres. It is 0 on the ground, where it is not needed.
    pub along_m: f64,
    /// The kind of span there; `None` on the ground.
    pub kind: Option<SpanKind>,
    /// OSM's `layer` of a bridge or a tunnel, which orders it among spans of its kind; 0 on the
    /// ground.
    pub layer: i8,
    /// The steepest grade with which roads or railways of the way's kind are built, rise over run.
    pub steepest: f64,
    /// Whether the way is a railway.
    pub is_railway: bool,
}

impl CrossingPlace {
    /// Returns which of two places is above the other: bridges are above the ground and tunnels
    /// below it, whatever their layers; of two spans of one kind, the one with the higher `layer`
    /// is above.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let rank = |own: &Self| (own.kind.map_or(0.0, SpanKind::away) as i8, own.layer);
        rank(self).cmp(&rank(other))
    }
}

/// Returns the steepest grade with which roads or railways of a way's kind are built, rise over
/// run.
pub(crate) fn steepest_of(network: &Network, way: &NetworkWay) -> f64 {
    let limit_pct = match way.railway {
        Some(railway) => railway.steepest_pct(),
        None => grade_limit(network.highway_of(way)).unwrap_or(OTHER_LIMIT_PCT),
    };
    limit_pct / 100.0
}
