//! The elevation files that a package was made from, for exports that read them again.

use corniche_dem::{Dem, GridPlan};

/// The elevation files that a package was made from.
#[derive(Debug, Clone, Copy)]
pub struct Elevation<'a> {
    /// Opened as the build did.
    pub dem: &'a Dem,
    /// The package's grid.
    pub plan: &'a GridPlan,
}
