//! Lists of files in messages.

/// Most files that a message names.
const MAX_NAMES: usize = 3;

/// The first few names, and how many more there are.
pub(crate) fn first_names(names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(MAX_NAMES);
    let told = names.take(MAX_NAMES).collect::<Vec<_>>().join(", ");
    if more == 0 { told } else { format!("{told} and {more} more") }
}
