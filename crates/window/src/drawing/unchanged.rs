//! Reasons for which a drawn line was not changed as a person asked.

/// Why a line was not changed as asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unchanged {
    /// No point of a line is picked.
    #[error("pick a line first: click on one of its points")]
    NothingPicked,
    /// It has fewer than three different points.
    #[error("this needs at least three points")]
    FewPoints,
    /// It would have far more points than a person draws.
    #[error("the line has more than {most} points")]
    ManyPoints {
        /// How many may be rounded.
        most: usize,
    },
}
