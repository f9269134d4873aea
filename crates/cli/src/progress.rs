//! Progress: bars on a terminal, plain lines elsewhere, JSON lines on request, or nothing.

use std::{
    borrow::Cow,
    io::{IsTerminal as _, Write as _, stderr},
    path::Path,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

use corniche_pipeline::{Observer, Stage};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

use crate::{args::ReportArgs, interrupt};

/// How progress is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    Quiet,
    Bars,
    Lines,
    Json,
}

/// Tells of a run on standard error; output meant for programs stays alone on standard output.
pub(crate) struct Progress {
    manner: Manner,
    running: Mutex<Option<Running>>,
}

struct Running {
    stage: Stage,
    total: Option<u64>,
    done: u64,
    since: Instant,
    told: Instant,
    bar: Option<ProgressBar>,
}

/// Least time between two JSON lines.
const JSON_INTERVAL: Duration = Duration::from_millis(500);

impl Progress {
    pub(crate) fn new(args: &ReportArgs) -> Self {
        let manner = if args.quiet {
            Manner::Quiet
        } else if args.json_progress {
            Manner::Json
        } else if stderr().is_terminal() {
            Manner::Bars
        } else {
            Manner::Lines
        };
        Self { manner, running: Mutex::new(None) }
    }
}

/// A progress bar; a spinner if the total is unknown.
pub(crate) fn bar(title: impl Into<Cow<'static, str>>, total: Option<u64>) -> ProgressBar {
    let bar = total.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    let template = if total.is_some() {
        "{msg:22} {bar:30} {pos}/{len} {eta}"
    } else {
        "{msg:22} {spinner} {pos}"
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.with_message(title)
}

impl Running {
    fn tell_json(&self, state: &str) {
        let line = json!({
            "stage": format!("{:?}", self.stage).to_lowercase(), "state": state, "done": self.done,
            "total": self.total, "seconds": self.since.elapsed().as_secs_f64(),
        });
        // Standard error may be closed; the work goes on.
        let _ = writeln!(stderr(), "{line}");
    }
}

impl Observer for Progress {
    fn begin(&self, stage: Stage, total: Option<u64>) {
        let bar = (self.manner == Manner::Bars).then(|| bar(stage.title(), total));
        let now = Instant::now();
        let running = Running { stage, total, done: 0, since: now, told: now, bar };
        if self.manner == Manner::Json {
            running.tell_json("begin");
        }
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = Some(running);
    }

    fn advance(&self, _: Stage, steps: u64) {
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(running) = &mut *running else { return };
        running.done += steps;
        if let Some(bar) = &running.bar {
            bar.set_position(running.done);
        }
        if self.manner == Manner::Json && running.told.elapsed() >= JSON_INTERVAL {
            running.told = Instant::now();
            running.tell_json("running");
        }
    }

    fn end(&self, stage: Stage) {
        let Some(running) = self.running.lock().unwrap_or_else(PoisonError::into_inner).take()
        else {
            return;
        };
        if let Some(bar) = &running.bar {
            bar.finish_and_clear();
        }
        match self.manner {
            Manner::Quiet => {}
            Manner::Json => running.tell_json("end"),
            Manner::Bars | Manner::Lines => {
                let seconds = running.since.elapsed().as_secs_f64();
                let _ = writeln!(
                    stderr(),
                    "{:22} {:>8} in {seconds:.2} s",
                    stage.title(),
                    running.done
                );
            }
        }
    }

    fn temporary(&self, folder: &Path) {
        interrupt::remove_at_end(folder);
    }

    /// Warnings are printed with `--quiet`, too.
    fn warning(&self, text: &str) {
        let line = match self.manner {
            Manner::Json => json!({ "warning": text }).to_string(),
            Manner::Quiet | Manner::Bars | Manner::Lines => format!("corniche: warning: {text}"),
        };
        let running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let tell = || {
            let _ = writeln!(stderr(), "{line}");
        };
        match running.as_ref().and_then(|running| running.bar.as_ref()) {
            Some(bar) => bar.suspend(tell),
            None => tell(),
        }
    }

    fn is_cancelled(&self) -> bool {
        interrupt::is_noted()
    }
}
