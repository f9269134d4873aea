//! The exit codes of the program and their names in JSON.

use std::process;

use serde::Serialize;

/// The result of the program; the numbers are part of its interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ExitCode {
    /// The command succeeded.
    Done = 0,
    /// Processing failed; for `verify`, a promise is broken.
    Failed = 1,
    /// Wrong usage or unusable input.
    Unusable = 2,
    /// The target already exists.
    Exists = 3,
    /// A signal ended the run.
    Interrupted = 4,
}

impl ExitCode {
    /// The exit code for the system.
    pub(crate) const fn number(self) -> u8 {
        self as u8
    }
}

impl From<ExitCode> for process::ExitCode {
    fn from(code: ExitCode) -> Self {
        Self::from(code.number())
    }
}
