use std::process;

/// How the program ends; the numbers are part of its interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ExitCode {
    /// Done.
    Done,
    /// Processing failed; for `verify`, a promise is broken.
    Failed,
    /// Wrong usage or unusable input.
    Unusable,
    /// The target exists.
    Exists,
    /// Interrupted.
    Interrupted,
}

impl From<ExitCode> for process::ExitCode {
    fn from(code: ExitCode) -> Self {
        Self::from(match code {
            ExitCode::Done => 0,
            ExitCode::Failed => 1,
            ExitCode::Unusable => 2,
            ExitCode::Exists => 3,
            ExitCode::Interrupted => 4,
        })
    }
}
