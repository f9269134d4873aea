//! Files that were found to be those of the build.

use crate::inputs::Inputs;

/// Files that are those of the build.
pub(crate) struct GivenFiles<T> {
    /// The files, to see at the end that they did not change.
    pub(crate) inputs: Inputs,
    pub(crate) found: T,
}
