//! Files that were found to be those of the build.

/// Files that are those of the build.
pub(crate) struct GivenFiles<T> {
    /// The files, to see at the end that they did not change.
    pub inputs: Inputs,
    pub found: T,
}
use corniche_spec::inputs::Inputs;
