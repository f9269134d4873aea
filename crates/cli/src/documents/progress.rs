//! The records that `--json-progress` writes.

use std::time::Duration;

use serde::Serialize;

use crate::exit::ExitCode;

/// A line on standard error.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub(crate) enum ProgressRecord<'a> {
    /// How far a stage is.
    Stage(StageRecord<'a>),
    /// Something that should be seen.
    Warning {
        /// In words.
        warning: &'a str,
    },
    /// What the stages took, after the last of them.
    Costs {
        /// The stages, in the order in which they first began.
        summary: Vec<StageCostRecord<'a>>,
        /// The whole run.
        all: CostRecord,
    },
    /// The last line: how the run ended.
    End {
        /// How.
        end: EndRecord,
    },
}

/// How far a stage is.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct StageRecord<'a> {
    /// Its name, which does not change.
    pub(crate) stage: &'a str,
    /// Its name for people.
    pub(crate) title: &'a str,
    /// "begin", "running" or "end".
    pub(crate) state: &'a str,
    /// What `done`, `already` and `total` count: "bytes", "blocks", "objects", "ways", "areas", "tiles", "pieces" or "frames".
    pub(crate) unit: &'a str,
    /// Done in all, by an earlier run too.
    pub(crate) done: u64,
    /// Of that, by an earlier run.
    pub(crate) already: u64,
    /// To be done in all; null if that is not known.
    pub(crate) total: Option<u64>,
    /// Since the stage began.
    pub(crate) seconds: f64,
    /// Time of all threads since the stage began; null where the system does not tell.
    pub(crate) cpu_seconds: Option<f64>,
    /// Units per second over the last three quarters of the stage's time; null before anything was done.
    pub(crate) per_second: Option<f64>,
    /// Of this stage; null if that is not known.
    pub(crate) seconds_left: Option<f64>,
    /// Bytes that the program asked the system to read since the stage began; null where the system does not tell.
    pub(crate) read_bytes: Option<u64>,
    /// Bytes that the program asked the system to write since the stage began; null where the system does not tell.
    pub(crate) written_bytes: Option<u64>,
}

/// What a run took. What the system does not tell is null.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CostRecord {
    /// By the clock.
    pub(crate) seconds: f64,
    /// Time of all threads, user and system.
    pub(crate) cpu_seconds: Option<f64>,
    /// CPU time over time by the clock, for stages of 0.2 s or more.
    pub(crate) cores_busy: Option<f64>,
    /// The most resident memory since the program began.
    pub(crate) peak_memory_bytes: Option<u64>,
    /// Bytes that the program asked the system to read.
    pub(crate) read_bytes: Option<u64>,
    /// Bytes that the program asked the system to write.
    pub(crate) written_bytes: Option<u64>,
}

/// What a stage took.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct StageCostRecord<'a> {
    /// Its name, which does not change.
    pub(crate) stage: &'a str,
    /// Its name for people.
    pub(crate) title: &'a str,
    /// Done in all, by an earlier run too.
    pub(crate) done: u64,
    /// Of that, by an earlier run.
    pub(crate) already: u64,
    /// What this run did per second; null if it did nothing.
    pub(crate) per_second: Option<f64>,
    /// What it took.
    #[serde(flatten)]
    pub(crate) cost: CostRecord,
}

/// How a run ended.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct EndRecord {
    /// "done", "failed", "unusable", "exists" or "interrupted".
    #[cfg_attr(test, schemars(with = "String"))]
    pub(crate) result: ExitCode,
    /// The program's exit code: 0 to 4, in this order.
    pub(crate) exit_code: u8,
    /// Why it failed, in words; null when it did not, and for `verify` when a promise is broken.
    pub(crate) error: Option<String>,
    /// Since the program began.
    pub(crate) seconds: f64,
}

/// A time for programs.
pub(crate) fn seconds(time: Option<Duration>) -> Option<f64> {
    time.map(|time| time.as_secs_f64())
}
