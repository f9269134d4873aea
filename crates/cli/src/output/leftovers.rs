//! What older versions left beside targets: it has no id that says whose it is, so it is told and left alone.

use std::path::Path;

use crate::{messages, names::file_name};

/// The endings of names that older versions gave.
const ENDINGS: [&str; 2] = ["unfinished.files", "replaced"];

/// Tells what lies beside a target under a name that an older version gave.
pub(crate) fn tell(target: &Path) {
    let name = file_name(target);
    for left in ENDINGS.map(|end| target.with_file_name(format!(".{name}.{end}"))) {
        if left.symlink_metadata().is_ok() {
            messages::warning(&format!(
                "{} may be what an older version left; nothing says so, so it stays: look at it and remove it",
                left.display()
            ));
        }
    }
}
