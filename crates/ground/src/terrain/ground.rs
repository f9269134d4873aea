//! The source of a build's ground.

use corniche_dem::{Dem, GridPlan};
use corniche_gis::{CrsError, DemProjection};

use super::recorded::RecordedTerrain;

/// The source of the ground: elevation files, or a package that was built from them.
pub enum GroundSource {
    /// Elevation files.
    Dem(Box<Dem>),
    /// A package.
    Package(Box<RecordedTerrain>),
}

impl GroundSource {
    /// WGS84 ⇄ the grid's working CRS: both sources give the same positions, to the last bit.
    ///
    /// # Errors
    /// See [`CrsError`].
    pub fn projection(&self, grid: &GridPlan) -> Result<DemProjection, CrsError> {
        match self {
            Self::Dem(dem) => dem.projection(grid),
            Self::Package(package) => package.projection(),
        }
    }

    /// The package, if the ground comes from one.
    #[must_use]
    pub fn package(&self) -> Option<&RecordedTerrain> {
        match self {
            Self::Dem(_) => None,
            Self::Package(package) => Some(package),
        }
    }
}
