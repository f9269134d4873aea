//! The costs of the stages of a run: the table at its end.

use std::time::Duration;

use super::{
    texts::{StageReading, amount, rate},
    usage::Usage,
};
use crate::{
    documents::progress::{CostRecord, ProgressRecord, StageCostRecord, seconds},
    table::{Digits, Table, bytes},
};

/// The rate of a stage in this run, over its whole time; `None` if this run did nothing.
fn mean_per_second(stage: &StageReading) -> Option<f64> {
    let done = stage.done - stage.already;
    (done > 0 && !stage.elapsed.is_zero()).then(|| done as f64 / stage.elapsed.as_secs_f64())
}

/// Shorter stages have no figure for busy cores, because CPU time is known only in steps of 10 ms
/// at their begin and end.
const SHORTEST_WITH_CORES: Duration = Duration::from_millis(200);

/// The ratio of CPU time to wall-clock time; within 0.1.
fn cores_busy(wall: Duration, used: &Usage) -> Option<f64> {
    let cpu = used.cpu.filter(|_| wall >= SHORTEST_WITH_CORES)?;
    Some(cpu.as_secs_f64() / wall.as_secs_f64())
}

/// All ended stages, in the order in which they first began.
#[derive(Debug, Default)]
pub(crate) struct StageCosts(Vec<StageReading>);

impl StageCosts {
    /// Adds a stage; the costs of a repeated stage are added up.
    pub(crate) fn add(&mut self, cost: StageReading) {
        match self.0.iter_mut().find(|before| before.stage == cost.stage) {
            Some(before) => {
                before.done += cost.done;
                before.already += cost.already;
                before.elapsed += cost.elapsed;
                before.used = before.used.and(&cost.used);
            }
            None => self.0.push(cost),
        }
    }

    /// A row for each stage and one for the whole run, which took `wall` and used `used`. Columns
    /// without known values are omitted.
    pub(crate) fn to_text(&self, wall: Duration, used: &Usage, digits: Digits) -> String {
        let mut table = Table::new([
            "stage", "done", "wall", "CPU", "cores", "rate", "memory", "read", "written",
        ]);
        let row = |title: &str, done: String, wall: Duration, rate: String, used: &Usage| {
            let in_seconds = |time: Duration| format!("{:.2} s", time.as_secs_f64());
            let or_empty = |text: Option<String>| text.unwrap_or_default();
            [
                title.to_owned(),
                done,
                in_seconds(wall),
                or_empty(used.cpu.map(in_seconds)),
                or_empty(cores_busy(wall, used).map(|cores| format!("{cores:.2}"))),
                rate,
                or_empty(used.peak_memory_bytes.map(bytes)),
                or_empty(used.read_bytes.map(bytes)),
                or_empty(used.written_bytes.map(bytes)),
            ]
        };
        for cost in &self.0 {
            let unit = cost.stage.unit();
            let rate = mean_per_second(cost).map(|per_second| rate(per_second, unit, digits));
            let done = amount(cost.done, unit, digits);
            table.row(row(
                cost.stage.title(),
                done,
                cost.elapsed,
                rate.unwrap_or_default(),
                &cost.used,
            ));
        }
        table.row(row("all", String::new(), wall, String::new(), used));
        table.without_empty_columns().to_text()
    }

    /// The costs as a record for programs.
    pub(crate) fn record(&self, wall: Duration, used: &Usage) -> ProgressRecord<'static> {
        let stage = |cost: &StageReading| StageCostRecord {
            stage: cost.stage.id(),
            title: cost.stage.title(),
            done: cost.done,
            already: cost.already,
            per_second: mean_per_second(cost),
            cost: figures(cost.elapsed, &cost.used),
        };
        ProgressRecord::Costs {
            summary: self.0.iter().map(stage).collect(),
            all: figures(wall, used),
        }
    }
}

fn figures(wall: Duration, used: &Usage) -> CostRecord {
    CostRecord {
        seconds: wall.as_secs_f64(),
        cpu_seconds: seconds(used.cpu),
        cores_busy: cores_busy(wall, used),
        peak_memory_bytes: used.peak_memory_bytes,
        read_bytes: used.read_bytes,
        written_bytes: used.written_bytes,
    }
}

#[cfg(test)]
#[path = "costs_tests.rs"]
mod tests;
