//! The exit codes of the program and the words for them in error documents.

use std::process;

use serde::Serialize;

/// How the program ends; the numbers are part of its interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ExitCode {
    /// The command did all that it was asked to do.
    Done = 0,
    /// Processing failed; for `verify`, a promise is broken.
    Failed = 1,
    /// Wrong usage or unusable input.
    Unusable = 2,
    /// The target exists.
    Exists = 3,
    /// A signal ended the run.
    Interrupted = 4,
}

impl ExitCode {
    /// What the system is told.
    pub(crate) const fn number(self) -> u8 {
        self as u8
    }
}

impl From<ExitCode> for process::ExitCode {
    fn from(code: ExitCode) -> Self {
        Self::from(code.number())
    }
}
