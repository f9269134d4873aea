//! The error for an output file whose name ends in no known format.

use std::path::Path;

use crate::failure::Failure;

/// A file whose name says no format of those with these endings, and none was named.
pub(crate) fn unknown_ending(output: &Path, endings: &str) -> Failure {
    Failure::unusable(format!(
        "the ending of {} says no format; use one of {endings}, or name it with --format",
        output.display()
    ))
}
