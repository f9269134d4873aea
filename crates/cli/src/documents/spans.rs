//! Bridges and tunnels in the JSON documents of several commands.

use corniche_tileset::SpansRecord;
use serde::Serialize;

use super::lines::LineLevelDocument;

/// The bridges and tunnels of a package. Each is all ways of its kind that are connected; heights are estimates.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SpansDocument {
    /// How many bridges.
    bridges: u64,
    /// How many tunnels.
    tunnels: u64,
    /// Where they cross other roads or each other.
    crossings: u64,
    /// How often there is a reason to look at one, by its name.
    reasons: Vec<ReasonDocument>,
    /// What is off the ground on each level that has some, root first: runs are its parts.
    levels: Vec<LineLevelDocument>,
}

/// A reason to look at bridges or tunnels.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ReasonDocument {
    /// Its name.
    reason: String,
    /// How often.
    count: u64,
}

impl From<SpansRecord> for SpansDocument {
    fn from(SpansRecord { counts, levels }: SpansRecord) -> Self {
        let reasons = counts.reasons.into_iter();
        Self {
            bridges: counts.bridges,
            tunnels: counts.tunnels,
            crossings: counts.crossings,
            reasons: reasons.map(|(reason, count)| ReasonDocument { reason, count }).collect(),
            levels: levels.into_iter().map(Into::into).collect(),
        }
    }
}
