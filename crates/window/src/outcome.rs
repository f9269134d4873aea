//! How a window ended.

use std::path::PathBuf;

use crate::{NotSaved, WindowError};

/// What came of a window.
#[derive(Debug)]
pub struct Closed {
    /// Why it is closed.
    pub end: Result<End, WindowError>,
    /// What became of the files that were saved after the last frame, for which the window could show no message any more.
    pub last_files: Vec<Result<PathBuf, NotSaved>>,
}

/// How a window ends when nothing fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The person closed it.
    Closed,
    /// [`WindowRequest::is_stopped`](crate::WindowRequest::is_stopped) said so.
    Stopped,
}
