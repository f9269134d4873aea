//! Defects of a build: invalid input that was skipped and counted, and roads that were lost because
//! of it.

use corniche_roads::LossReason;
use corniche_spans::SpanReason;
use corniche_work::Silent;
use serde::{Deserialize, Serialize};

/// Invalid input that was skipped and counted, or what was lost because of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Defect {
    /// A defect of the extract.
    Osm(corniche_osm::ExtractDefect),
    /// A road, or a part of it, that is in no tile of the finest level.
    LostRoad {
        /// The id of its way.
        way_id: i64,
        /// The reason why it was lost.
        loss: Loss,
        /// Length in plan.
        length_m: f64,
        /// Whether the whole road was lost.
        is_whole: bool,
    },
    /// A note about a bridge or a tunnel.
    Span {
        /// The id of one of its ways.
        way_id: i64,
        /// The node concerned, if the note concerns a node.
        node_id: Option<i64>,
        /// The name of the note's reason.
        reason: String,
    },
}

corniche_roads::listed! {
    /// The reason why a road was lost, in the order of the manifest.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Loss {
        /// The road is outside the elevation data.
        OutsideData = LossReason::OutsideData.text(),
        /// The road is on the elevation data, but there is no ground.
        NoGround = LossReason::NoGround.text(),
        /// The road is outside the requested bounds. It is counted, but it is not a defect.
        OutsideBounds = LossReason::OutsideBounds.text(),
    }

    /// The reason in words: the name under which it is counted.
    pub fn reason() -> &'static str;
}

impl Defect {
    /// The kind of defect in words: the name under which it is counted.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Osm(defect) => defect.reason().to_owned(),
            Self::LostRoad { loss, .. } => loss.reason().to_owned(),
            Self::Span { reason, .. } => reason.clone(),
        }
    }
}

/// The names of all reasons to inspect a bridge or a tunnel, with their meanings.
pub fn span_reasons() -> impl Iterator<Item = (&'static str, &'static str)> {
    SpanReason::ALL.into_iter().map(|reason| (reason.id(), reason.words()))
}

/// The meaning of a reason to inspect a bridge or a tunnel, by its name.
#[must_use]
pub fn span_reason_words(name: &str) -> &'static str {
    span_reasons().find(|(own, _)| *own == name).map_or("a bridge or a tunnel", |(_, words)| words)
}

/// What a build or a check reports to its caller: its stages, as every task does, and the defects
/// of its inputs.
pub trait BuildObserver: corniche_work::Observer {
    /// Reports a defect of the input, which was skipped and counted. The order of reports depends
    /// on the inputs alone.
    fn defect(&self, _: &Defect) {}
}

impl BuildObserver for Silent {}

impl From<corniche_osm::ExtractDefect> for Defect {
    fn from(defect: corniche_osm::ExtractDefect) -> Self {
        Self::Osm(defect)
    }
}

#[cfg(test)]
#[path = "defect_tests.rs"]
mod tests;
