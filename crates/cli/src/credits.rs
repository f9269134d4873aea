//! Credits: those that are given are checked, those of a package are told with what is made of it.

use corniche_tileset::{Manifest, check_credit};

use crate::{escaped::in_line, failure::Failure};

/// Refuses credits that cannot be shown everywhere, before any work is done.
pub(crate) fn check(credits: &[String]) -> Result<(), Failure> {
    for credit in credits {
        check_credit(credit).map_err(|error| {
            Failure::unusable(format!(
                "the attribution \"{}\" cannot be used: {error}",
                in_line(credit)
            ))
        })?;
    }
    Ok(())
}

/// The last line of what is told of an export, from the line break before it; nothing where a package has no credits.
pub(crate) fn credits_line(manifest: &Manifest) -> String {
    let credits = manifest.attribution.join("; ");
    if credits.is_empty() {
        return String::new();
    }
    format!("\nto be shown with it: {}", in_line(&credits))
}
