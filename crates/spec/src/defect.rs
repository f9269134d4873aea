//! Defects of a build: bad input that was skipped and counted, and roads that were lost by it.

use corniche_roads::LossReason;
use corniche_spans::SpanReason;
use corniche_work::Silent;
use serde::{Deserialize, Serialize};

/// Bad input that was skipped and counted, or what was lost by it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Defect {
    /// A defect of the extract.
    Osm(corniche_osm::Defect),
    /// A road, or a part of it, that no tile of the finest level holds.
    LostRoad {
        /// Its way.
        way_id: i64,
        /// Why it was lost.
        loss: Loss,
        /// Length in plan.
        length_m: f64,
        /// Whether nothing of the road is kept.
        is_whole: bool,
    },
    /// Something to know of a bridge or a tunnel.
    Span {
        /// A way of it.
        way_id: i64,
        /// The node at which it is so, if it is so at a node.
        node_id: Option<i64>,
        /// The name of the reason.
        reason: String,
    },
}

/// Why a road was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Loss {
    /// It lies beside the elevation data.
    OutsideData,
    /// It lies on the elevation data, but where they have no ground.
    NoGround,
    /// It lies outside the bounds that were asked for. It is counted, but it is no defect.
    OutsideBounds,
}

impl Loss {
    /// All of them, in the order of the manifest.
    pub const ALL: [Self; 3] = [Self::OutsideData, Self::NoGround, Self::OutsideBounds];

    /// Why, in words: the name under which it is counted.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Self::OutsideData => LossReason::OutsideData,
            Self::NoGround => LossReason::NoGround,
            Self::OutsideBounds => LossReason::OutsideBounds,
        }
        .text()
    }
}

impl Defect {
    /// What kind of defect it is, in words: the name under which it is counted.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Osm(defect) => defect.reason().to_owned(),
            Self::LostRoad { loss, .. } => loss.reason().to_owned(),
            Self::Span { reason, .. } => reason.clone(),
        }
    }
}

/// The reasons to look at a bridge or a tunnel by their names, with what they mean.
pub fn span_reasons() -> impl Iterator<Item = (&'static str, &'static str)> {
    SpanReason::ALL.into_iter().map(|reason| (reason.id(), reason.words()))
}

/// What a reason to look at a bridge or a tunnel means, by its name.
#[must_use]
pub fn span_reason_words(name: &str) -> &'static str {
    span_reasons().find(|(own, _)| *own == name).map_or("a bridge or a tunnel", |(_, words)| words)
}

/// What a build or a check reports to its caller: its stages, as all work does, and the defects of its inputs.
pub trait Observer: corniche_work::Observer {
    /// A defect of the input was skipped and counted. The order of reports depends on the inputs alone.
    fn defect(&self, _: &Defect) {}
}

impl Observer for Silent {}

impl From<corniche_osm::Defect> for Defect {
    fn from(defect: corniche_osm::Defect) -> Self {
        Self::Osm(defect)
    }
}

#[cfg(test)]
#[path = "defect_tests.rs"]
mod tests;
