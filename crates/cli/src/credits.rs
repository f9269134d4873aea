//! Attribution: the given texts are checked, and those of a package are printed with everything
//! that is exported from it.

use corniche_tileset::{Manifest, check_credit};

use crate::{escaped::in_line, failure::Result};

/// Rejects attribution that cannot be shown everywhere, before any work is done.
pub(crate) fn check(credits: &[String]) -> Result<()> {
    for credit in credits {
        check_credit(credit).map_err(|error| {
            unusable!("the attribution \"{}\" cannot be used: {error}", in_line(credit))
        })?;
    }
    Ok(())
}

/// The attribution line at the end of an export's report, starting with a line break; empty for a
/// package without attribution.
pub(crate) fn credits_line(manifest: &Manifest) -> String {
    let credits = manifest.attribution.join("; ");
    if credits.is_empty() {
        return String::new();
    }
    format!("\nattribution (must be displayed): {}", in_line(&credits))
}
