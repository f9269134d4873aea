//! Progress in words and numbers.

use std::time::Duration;

use corniche_work::{Stage, Unit};

use super::usage::Usage;
use crate::{
    documents::progress::{ProgressRecord, StageRecord, seconds},
    table::{Digits, bytes},
};

/// The state of a stage at one moment.
#[derive(Debug, Clone)]
pub(crate) struct StageReading {
    pub stage: Stage,
    /// Units done so far, including those of an earlier run.
    pub done: u64,
    /// Units done by an earlier run.
    pub already: u64,
    pub total: Option<u64>,
    /// Time since the stage began.
    pub elapsed: Duration,
    pub per_second: Option<f64>,
    pub left: Option<Duration>,
    /// Resources used since the stage began.
    pub used: Usage,
}

impl StageReading {
    /// The text of a running stage, without its title: done of total, time left, rate, bytes.
    pub(crate) fn running(&self, digits: Digits) -> String {
        let unit = self.stage.unit();
        let mut parts = vec![match self.total {
            None => amount(self.done, unit, digits),
            Some(0) => "nothing to do".to_owned(),
            Some(total) => {
                let percent = u128::from(self.done) * 100 / u128::from(total);
                let (done, total) = (number(self.done, unit, digits), amount(total, unit, digits));
                format!("{done} of {total} ({percent} %)")
            }
        }];
        if let Some(left) = self.left.filter(|_| self.total != Some(0)) {
            parts.push(format!("{} left", time(left)));
        }
        parts.extend(self.per_second.map(|per_second| rate(per_second, unit, digits)));
        parts.extend(self.used.read_bytes.map(|read| format!("{} read", bytes(read))));
        parts.extend(self.used.written_bytes.map(|written| format!("{} written", bytes(written))));
        parts.join(", ")
    }

    /// The text of an ended stage, without its title.
    pub(crate) fn ended(&self, digits: Digits) -> String {
        let seconds = self.elapsed.as_secs_f64();
        match (self.done, self.already) {
            (0, _) if self.total == Some(0) => "nothing to do".to_owned(),
            (done, 0) => format!("{} in {seconds:.2} s", amount(done, self.stage.unit(), digits)),
            (done, already) if done == already => {
                format!("{}, all by an earlier run", amount(done, self.stage.unit(), digits))
            }
            (done, already) => {
                let unit = self.stage.unit();
                let (done, already) = (amount(done, unit, digits), number(already, unit, digits));
                format!("{done}, {already} of them by an earlier run, in {seconds:.2} s")
            }
        }
    }

    /// The state of the stage as a record for programs.
    pub(crate) fn record(&self, state: &'static str) -> ProgressRecord<'static> {
        ProgressRecord::Stage(StageRecord {
            stage: self.stage.id(),
            title: self.stage.title(),
            state,
            unit: self.stage.unit().plural(),
            done: self.done,
            already: self.already,
            total: self.total,
            seconds: self.elapsed.as_secs_f64(),
            cpu_seconds: seconds(self.used.cpu),
            per_second: self.per_second,
            seconds_left: seconds(self.left),
            read_bytes: self.used.read_bytes,
            written_bytes: self.used.written_bytes,
        })
    }
}

/// A number without its unit, except for bytes.
fn number(number: u64, unit: Unit, digits: Digits) -> String {
    if unit == Unit::Bytes { bytes(number) } else { digits.count(number) }
}

/// A number with its unit.
pub(crate) fn amount(number: u64, unit: Unit, digits: Digits) -> String {
    match (unit, number) {
        (Unit::Bytes, _) => bytes(number),
        (_, 1) => format!("1 {}", unit.plural().trim_end_matches('s')),
        _ => format!("{} {}", digits.count(number), unit.plural()),
    }
}

/// A rate; slow ones are per minute or hour, so that no rate is a small fraction.
pub(crate) fn rate(per_second: f64, unit: Unit, digits: Digits) -> String {
    if unit == Unit::Bytes {
        return format!("{}/s", bytes(per_second.round() as u64));
    }
    let (number, per) = match per_second {
        1.0.. => (per_second, "s"),
        0.016_666.. => (per_second * 60.0, "min"),
        _ => (per_second * 3600.0, "h"),
    };
    let number =
        if number < 100.0 { format!("{number:.1}") } else { digits.count(number.round() as u64) };
    format!("{number} {}/{per}", unit.plural())
}

/// A time in at most two units.
pub(crate) fn time(time: Duration) -> String {
    const DAY_S: u64 = 86_400;
    let s = (time.as_secs_f64().round()) as u64;
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{} min {:02} s", s / 60, s % 60),
        3600..DAY_S => format!("{} h {:02} min", s / 3600, s % 3600 / 60),
        _ => format!("{} d {:02} h", s / DAY_S, s % DAY_S / 3600),
    }
}

#[cfg(test)]
#[path = "texts_tests.rs"]
mod tests;
