//! The records that `--json-progress` writes.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Serialize;

use crate::exit::ExitCode;

/// A line on standard error.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ProgressRecord<'a> {
    /// The progress of a stage.
    Stage(StageRecord<'a>),
    /// A warning.
    Warning {
        /// Text of the warning.
        warning: &'a str,
    },
    /// Time and resources of the stages, after the last of them.
    Costs {
        /// The stages, in the order in which they began.
        summary: Vec<StageCostRecord<'a>>,
        /// The whole run.
        all: CostRecord,
    },
    /// The last line: the result of the run.
    End {
        /// The result.
        end: EndRecord,
    },
}

/// The progress of a stage.
#[derive(Serialize, JsonSchema)]
pub(crate) struct StageRecord<'a> {
    /// Id of the stage, which never changes.
    pub stage: &'a str,
    /// Name of the stage for people.
    pub title: &'a str,
    /// "begin", "running" or "end".
    pub state: &'a str,
    /// What `done`, `already` and `total` count: "bytes", "blocks", "objects", "ways",
    /// "windows", "tiles", "chains", "pieces" or "frames".
    pub unit: &'a str,
    /// Units done so far, including those of an earlier run.
    pub done: u64,
    /// Units done by an earlier run.
    pub already: u64,
    /// Total number of units; null if it is unknown.
    pub total: Option<u64>,
    /// Seconds since the stage began.
    pub seconds: f64,
    /// CPU time of all threads since the stage began; null if the system does not report it.
    pub cpu_seconds: Option<f64>,
    /// Units per second over the last three quarters of the stage's time; null before anything was
    /// done.
    pub per_second: Option<f64>,
    /// Estimated seconds until the stage ends; null if unknown.
    pub seconds_left: Option<f64>,
    /// Bytes that the program requested to read since the stage began; null if the system does not
    /// report them.
    pub read_bytes: Option<u64>,
    /// Bytes that the program requested to write since the stage began; null if the system does not
    /// report them.
    pub written_bytes: Option<u64>,
}

/// Time and resources of a run or stage. Values that the system does not report are null.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CostRecord {
    /// Wall-clock time.
    pub seconds: f64,
    /// CPU time of all threads, user and system.
    pub cpu_seconds: Option<f64>,
    /// CPU time divided by wall-clock time, for stages of 0.2 s or more.
    pub cores_busy: Option<f64>,
    /// Peak resident memory since the program began.
    pub peak_memory_bytes: Option<u64>,
    /// Bytes that the program requested to read.
    pub read_bytes: Option<u64>,
    /// Bytes that the program requested to write.
    pub written_bytes: Option<u64>,
}

/// Time and resources of a stage.
#[derive(Serialize, JsonSchema)]
pub(crate) struct StageCostRecord<'a> {
    /// Id of the stage, which never changes.
    pub stage: &'a str,
    /// Name of the stage for people.
    pub title: &'a str,
    /// Units done, including those of an earlier run.
    pub done: u64,
    /// Units done by an earlier run.
    pub already: u64,
    /// Units per second in this run; null if it did nothing.
    pub per_second: Option<f64>,
    /// Time and resources.
    #[serde(flatten)]
    pub cost: CostRecord,
}

/// The result of a run.
#[derive(Serialize, JsonSchema)]
pub(crate) struct EndRecord {
    /// "done", "failed", "unusable", "exists" or "interrupted".
    #[schemars(with = "String")]
    pub result: ExitCode,
    /// The program's exit code: 0 to 4, in this order.
    pub exit_code: u8,
    /// Error message; null after success, and for `verify` when a promise is broken.
    pub error: Option<String>,
    /// Seconds since the program began.
    pub seconds: f64,
}

/// A time in seconds, rounded for programs.
pub(crate) fn seconds(time: Option<Duration>) -> Option<f64> {
    time.map(|time| time.as_secs_f64())
}
