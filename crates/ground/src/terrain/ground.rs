//! Where a build has its ground from.

use corniche_dem::{Dem, GridPlan};
use corniche_gis::{CrsError, DemProjection};

use super::recorded::RecordedTerrain;

/// Elevation files, or a package that was made from them.
pub enum GroundSource {
    /// Elevation files.
    Dem(Box<Dem>),
    /// A package.
    Package(Box<RecordedTerrain>),
}

impl GroundSource {
    /// WGS84 ⇄ the grid's working CRS: the same positions, to the last bit, from either source.
    ///
    /// # Errors
    /// See [`CrsError`].
    pub fn projection(&self, grid: &GridPlan) -> Result<DemProjection, CrsError> {
        match self {
            Self::Dem(dem) => dem.projection(grid),
            Self::Package(package) => package.projection(),
        }
    }

    /// The package, if it is one.
    #[must_use]
    pub fn package(&self) -> Option<&RecordedTerrain> {
        match self {
            Self::Dem(_) => None,
            Self::Package(package) => Some(package),
        }
    }
}
