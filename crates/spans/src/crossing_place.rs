//! Places at which chains cross: what lies there.

use std::cmp::Ordering;

use corniche_network::{ChainNumber, Network, NetworkWay};
use corniche_roads::grade_limit;

use crate::spans::SpanKind;

/// Ways for which no grade is known may be as steep as service roads, percent.
const OTHER_LIMIT_PCT: f64 = 20.0;

/// A place on a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingPlace {
    /// The chain.
    pub chain: ChainNumber,
    /// OSM's id of the way there.
    pub way_id: i64,
    /// The distance along the chain, metres; on the ground nobody needs it, and it is 0.
    pub along_m: f64,
    /// What it is there; `None` on the ground.
    pub kind: Option<SpanKind>,
    /// OSM's `layer` of a bridge or a tunnel, which orders it among its kind; on the ground 0.
    pub layer: i8,
    /// The steepest grade with which roads of its kind are built, rise over run.
    pub steepest: f64,
}

impl CrossingPlace {
    /// What is above what: bridges above the ground, tunnels below it, whatever their layers; of two of a kind the higher `layer`.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let rank = |own: &Self| (own.kind.map_or(0.0, SpanKind::away) as i8, own.layer);
        rank(self).cmp(&rank(other))
    }
}

/// The steepest grade with which roads of a way's kind are built, rise over run.
pub(crate) fn steepest_of(network: &Network, way: &NetworkWay) -> f64 {
    grade_limit(network.highway_of(way)).unwrap_or(OTHER_LIMIT_PCT) / 100.0
}
