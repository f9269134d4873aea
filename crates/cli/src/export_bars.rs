//! How exports tell how far they are, and what went wrong.

use std::{cell::RefCell, path::Path};

use corniche_export::{ExportError, Observer, Stage};
use indicatif::ProgressBar;

use crate::{exit::ExitCode, failure::Failure, interrupt, progress};

/// What could not be written is known to people by the name of the target, not of the file that becomes it.
pub(crate) fn named(error: ExportError, target: &Path) -> Failure {
    let is_unwritten = !error.is_unusable_input();
    let failure = Failure::from(error);
    if is_unwritten && failure.code() == ExitCode::Failed { failure.about(target) } else { failure }
}

/// A bar for each stage, where bars are drawn; and whether the program is asked to end.
#[derive(Default)]
pub(crate) struct Bars {
    running: RefCell<Option<(Stage, ProgressBar)>>,
}

impl Bars {
    pub(crate) fn end(&self) {
        if let Some((_, bar)) = self.running.take() {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Bars {
    fn done(&self, stage: Stage, done: u64, total: u64) {
        if self.running.borrow().as_ref().is_none_or(|(running, _)| *running != stage) {
            self.end();
            let title = match stage {
                Stage::Tiles => "reading tiles",
                Stage::Pieces => "writing features",
            };
            self.running.replace(Some((stage, progress::bar(title, Some(total)))));
        }
        if let Some((_, bar)) = &*self.running.borrow() {
            bar.set_position(done);
        }
    }

    fn should_stop(&self) -> bool {
        interrupt::is_noted()
    }
}
