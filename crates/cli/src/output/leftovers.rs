//! Leftovers of older versions next to targets: they have no id of their owner, so they are
//! reported and not removed.

use std::path::Path;

use crate::names::file_name;

/// The suffixes of names that older versions used.
const ENDINGS: [&str; 2] = ["unfinished.files", "replaced"];

/// Reports files next to a target whose names older versions used.
pub(crate) fn tell(target: &Path) {
    let name = file_name(target);
    for left in ENDINGS.map(|end| target.with_file_name(format!(".{name}.{end}"))) {
        if left.symlink_metadata().is_ok() {
            warning!(
                "{left:?} may be a leftover of an older version; not deleted, since this is not certain. Check and delete it yourself"
            );
        }
    }
}
