//! Progress of all commands that take time: bars on a terminal, plain lines elsewhere, records
//! on request, or nothing; and the costs of the stages at the end.
//!
//! A separate thread checks twice a second whether something is to be reported, so that stages
//! without any steps for minutes are reported, too. Each step also checks.

mod costs;
mod efforts;
mod pace;
mod texts;
mod usage;

use std::{
    path::Path,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use corniche_spec::Defect;
use corniche_work::{Observer, Stage, locked};
use indicatif::{ProgressBar, ProgressStyle};
use tracing::Span;

use self::{costs::StageCosts, efforts::Efforts, pace::Pace, texts::StageReading, usage::Usage};
use crate::{
    args::{LogFormat, Voice},
    defects::DefectList,
    documents::{progress::seconds, to_line},
    failure::Result,
    free_memory, interrupt, messages,
    messages::write_line,
    output::existing_of,
    table::Digits,
};

/// The form of progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    Quiet,
    Bars,
    Lines,
    /// Records for programs: `--json-progress`.
    Json,
    /// `--log-format json`.
    Events,
}

impl Manner {
    /// The form of progress that the voice requests.
    fn for_voice(voice: Voice) -> Self {
        match voice {
            Voice { quiet: true, .. } => Self::Quiet,
            Voice { json_progress: true, .. } => Self::Json,
            Voice { log_format: LogFormat::Json, .. } => Self::Events,
            // Lines in between would break a bar.
            Voice { verbose: 0, .. } if messages::notes_are_seen() => Self::Bars,
            Voice { .. } => Self::Lines,
        }
    }

    /// Whether a running stage is to be reported: the last report was `since_told` ago, and steps
    /// were made since then or not.
    fn is_due(self, since_told: Duration, has_moved: bool) -> bool {
        match self {
            Self::Quiet => false,
            Self::Bars => since_told >= TICK / 2,
            Self::Lines | Self::Events => since_told >= LINE_INTERVAL,
            Self::Json => since_told >= if has_moved { TICK } else { IDLE_INTERVAL },
        }
    }
}

/// Reports a run on standard error; output for programs goes to standard output alone.
pub(crate) struct Progress {
    shared: Arc<Shared>,
    ticker: Option<JoinHandle<()>>,
    /// The list of defects, if it is requested.
    pub defects: Option<DefectList>,
}

struct Shared {
    manner: Manner,
    state: Mutex<State>,
    over: Condvar,
}

struct State {
    begun: Instant,
    used_before: Usage,
    running: Option<Running>,
    /// The efforts of the steps of the next stage.
    efforts: Option<Efforts>,
    costs: StageCosts,
    is_over: bool,
}

struct Running {
    manner: Manner,
    stage: Stage,
    span: Span,
    total: Option<u64>,
    done: u64,
    already: u64,
    pace: Pace,
    /// For steps of unequal effort: the efforts, and the pace in units of effort.
    efforts: Option<(Efforts, Pace)>,
    begun: Instant,
    used_before: Usage,
    told: Instant,
    told_done: u64,
    given_back: Instant,
    bar: Option<ProgressBar>,
}

/// Interval of the checks whether something is to be reported.
const TICK: Duration = Duration::from_millis(500);
/// Least time between two plain lines; together with a tick it is below ten seconds.
const LINE_INTERVAL: Duration = Duration::from_secs(9);
/// Time between two JSON lines if nothing was done in between; otherwise there is one at each tick.
const IDLE_INTERVAL: Duration = Duration::from_secs(5);
/// Interval at which free memory is returned to the system within a stage.
const GIVE_BACK_INTERVAL: Duration = Duration::from_secs(5);

impl Progress {
    pub(crate) fn new() -> Self {
        Self::in_manner(Manner::for_voice(messages::voice()))
    }

    /// Runs `work` and reports its progress. The reporting thread ends with it.
    pub(crate) fn show_during<R>(work: impl FnOnce(&Self) -> R) -> R {
        let progress = Self::new();
        let done = work(&progress);
        progress.finish();
        done
    }

    /// Reports a build, and lists its defects if a list is requested; the list must not be one of
    /// `others`.
    pub(crate) fn of_build(list: Option<&Path>, overwrite: bool, others: &[&Path]) -> Result<Self> {
        let create = |target| DefectList::create(target, existing_of(overwrite), others);
        let mut progress = Self::new();
        progress.defects = list.map(create).transpose()?;
        Ok(progress)
    }

    fn in_manner(manner: Manner) -> Self {
        let state = State {
            begun: Instant::now(),
            used_before: Usage::now(),
            running: None,
            efforts: None,
            costs: StageCosts::default(),
            is_over: false,
        };
        let shared = Arc::new(Shared { manner, state: Mutex::new(state), over: Condvar::new() });
        let ticking = Arc::clone(&shared);
        // If the system cannot start another thread, only the steps check whether something is to
        // be reported.
        let ticker = (manner != Manner::Quiet)
            .then(|| thread::Builder::new().name("progress".into()).spawn(move || ticking.tick()))
            .and_then(Result::ok);
        Self { shared, ticker, defects: None }
    }

    /// Announces that steps of the next stage take unequal time: pairs of a number of consecutive
    /// steps and the time of each.
    pub(crate) fn expect_efforts(&self, parts: Vec<(u64, f64)>) {
        self.shared.state().efforts = Some(Efforts(parts));
    }

    /// Ends the running stage.
    pub(crate) fn finish(&self) {
        self.shared.state().end_running();
    }

    /// Reports the costs of the stages: as one JSON object, or as a table for people who requested
    /// details.
    pub(crate) fn tell_costs(&self) {
        let state = self.shared.state();
        let wall = state.begun.elapsed();
        let used = Usage::now().since(&state.used_before);
        match self.shared.manner {
            Manner::Json => write_line(&to_line(&state.costs.record(wall, &used))),
            Manner::Lines if messages::is_detailed() => {
                let table = state.costs.to_text(wall, &used, Digits::of_notes());
                write_line(&format!("\n{}", table.trim_end()));
            }
            Manner::Events => tracing::info!(
                seconds = wall.as_secs_f64(),
                cpu_seconds = seconds(used.cpu),
                peak_memory_bytes = used.peak_memory_bytes,
                read_bytes = used.read_bytes,
                written_bytes = used.written_bytes,
                "all stages"
            ),
            Manner::Quiet | Manner::Bars | Manner::Lines => {}
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.shared.state().is_over = true;
        self.shared.over.notify_all();
        if let Some(ticker) = self.ticker.take() {
            let _ = ticker.join();
        }
    }
}

/// A progress bar; a spinner if the total is unknown.
fn bar(title: &'static str, total: Option<u64>) -> ProgressBar {
    let bar = total.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    let drawing = if total.is_some() { "{bar:20}" } else { "{spinner}" };
    if let Ok(style) =
        ProgressStyle::with_template(&format!("{{prefix:22}} {drawing} {{wide_msg}}"))
    {
        bar.set_style(style);
    }
    bar.with_prefix(title)
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        locked(&self.state)
    }

    /// Reports what is due, until the run is over.
    fn tick(&self) {
        let mut state = self.state();
        while !state.is_over {
            state = self.over.wait_timeout(state, TICK).unwrap_or_else(PoisonError::into_inner).0;
            if let Some(running) = &mut state.running {
                running.tell_if_due();
            }
        }
    }

    /// Applies `act` to the stage if it is running.
    fn with(&self, stage: Stage, act: impl FnOnce(&mut Running)) {
        let mut state = self.state();
        if let Some(running) = state.running.as_mut().filter(|running| running.stage == stage) {
            act(running);
            running.tell_if_due();
            running.give_back_if_due();
        }
    }
}

impl State {
    /// Begins a stage, and ends the previous one.
    fn begin(&mut self, stage: Stage, total: Option<u64>, manner: Manner) {
        self.end_running();
        let efforts = self.efforts.take().map(|efforts| (efforts, Pace::new()));
        let running = Running { efforts, ..Running::new(stage, total, manner) };
        if manner == Manner::Json {
            write_line(&to_line(&running.read().record("begin")));
        }
        self.running = Some(running);
    }

    fn end_running(&mut self) {
        let Some(running) = self.running.take() else { return };
        let reading = running.read();
        if let Some(bar) = &running.bar {
            bar.finish_and_clear();
        }
        running.tell(&reading, true);
        tracing::debug!(
            parent: &running.span, done = reading.done, seconds = reading.elapsed.as_secs_f64(), "ended"
        );
        self.costs.add(reading);
    }
}

impl Running {
    fn new(stage: Stage, total: Option<u64>, manner: Manner) -> Self {
        let now = Instant::now();
        let span = tracing::info_span!("stage", id = stage.id());
        tracing::debug!(parent: &span, total, unit = stage.unit().plural(), "begins");
        Self {
            manner,
            stage,
            span,
            total,
            done: 0,
            already: 0,
            pace: Pace::new(),
            efforts: None,
            begun: now,
            used_before: Usage::now(),
            told: now,
            told_done: 0,
            given_back: now,
            bar: (manner == Manner::Bars).then(|| bar(stage.title(), total)),
        }
    }

    /// Sets the total number of steps done.
    fn reach(&mut self, done: u64) {
        self.done = done;
        tracing::trace!(parent: &self.span, done, "counted");
        let elapsed = self.begun.elapsed();
        self.pace.record(elapsed, done - self.already);
        if let Some((efforts, pace)) = &mut self.efforts {
            pace.record(elapsed, efforts.until(done, self.total));
        }
    }

    /// Sets the number of steps done and a total that became known or changed.
    fn reach_of(&mut self, done: u64, total: u64) {
        self.total = Some(total);
        self.reach(done.max(self.done));
    }

    fn read(&self) -> StageReading {
        let elapsed = self.begun.elapsed();
        let remaining = self.total.map(|total| total.saturating_sub(self.done));
        let left = match &self.efforts {
            Some((efforts, pace)) => pace.left(elapsed, efforts.after(self.done, self.total)),
            None => remaining.and_then(|remaining| self.pace.left(elapsed, remaining)),
        };
        StageReading {
            stage: self.stage,
            done: self.done,
            already: self.already,
            total: self.total,
            elapsed,
            per_second: self.pace.per_second(elapsed),
            left,
            used: Usage::now().since(&self.used_before),
        }
    }

    fn give_back_if_due(&mut self) {
        if self.given_back.elapsed() >= GIVE_BACK_INTERVAL {
            free_memory::give_back_all();
            self.given_back = Instant::now();
        }
    }

    fn tell_if_due(&mut self) {
        if !self.manner.is_due(self.told.elapsed(), self.done > self.told_done) {
            return;
        }
        (self.told, self.told_done) = (Instant::now(), self.done);
        self.tell(&self.read(), false);
    }

    /// Reports the progress or the end of the stage.
    fn tell(&self, reading: &StageReading, is_over: bool) {
        let title = self.stage.title();
        let text = |digits| if is_over { reading.ended(digits) } else { reading.running(digits) };
        match (self.manner, &self.bar) {
            (Manner::Quiet, _) => {}
            (Manner::Json, _) => {
                let state = if is_over { "end" } else { "running" };
                write_line(&to_line(&reading.record(state)));
            }
            (Manner::Events, _) => tracing::info!(
                parent: &self.span,
                done = reading.done,
                already = is_over.then_some(reading.already),
                total = reading.total.filter(|_| !is_over),
                seconds = reading.elapsed.as_secs_f64(),
                cpu_seconds = seconds(reading.used.cpu.filter(|_| is_over)),
                "{title}: {}", text(Digits::Plain)
            ),
            (_, Some(bar)) if !is_over => {
                if let Some(total) = self.total {
                    bar.set_length(total);
                }
                bar.set_position(self.done);
                bar.set_message(text(Digits::of_notes()));
            }
            (Manner::Bars | Manner::Lines, _) => {
                write_line(&format!("{title:22} {}", text(Digits::of_notes())));
            }
        }
    }
}

impl Observer for Progress {
    fn begin(&self, stage: Stage, total: Option<u64>) {
        self.shared.state().begin(stage, total, self.shared.manner);
    }

    fn already(&self, stage: Stage, steps: u64) {
        self.shared.with(stage, |running| {
            running.already += steps;
            running.done += steps;
        });
    }

    fn advance(&self, stage: Stage, steps: u64) {
        self.shared.with(stage, |running| running.reach(running.done + steps));
    }

    fn reached(&self, stage: Stage, done: u64, total: u64) {
        self.shared.with(stage, |running| running.reach_of(done, total));
    }

    fn end(&self, _: Stage) {
        self.finish();
        free_memory::give_back_all();
    }

    fn temporary(&self, folder: &Path) {
        tracing::debug!(path = %folder.display(), "temporary files");
        interrupt::remove_at_end(folder);
    }

    fn keeps(&self, folder: &Path) {
        tracing::debug!(path = %folder.display(), "intermediate results");
        interrupt::keep(folder);
    }

    fn warning(&self, text: &str) {
        let state = self.shared.state();
        match state.running.as_ref().and_then(|running| running.bar.as_ref()) {
            Some(bar) => bar.suspend(|| messages::warning(text)),
            None => messages::warning(text),
        }
    }

    fn is_cancelled(&self) -> bool {
        interrupt::is_noted()
    }
}

impl corniche_spec::BuildObserver for Progress {
    fn defect(&self, defect: &Defect) {
        if let Some(defects) = &self.defects {
            defects.add(defect);
        }
    }
}

#[cfg(test)]
#[path = "progress_tests.rs"]
mod tests;
