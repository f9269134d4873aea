//! What a user asks for when a package becomes a raster.

use corniche_dem::{Dem, GridPlan};

use crate::bounds::DegreeBounds;

/// What of a package becomes a raster, and with what it is compared.
pub struct GeoTiffRequest<'a> {
    /// The level whose TINs are taken; `None` is the finest.
    pub level: Option<u8>,
    /// The nodes around this rectangle are taken, rounded outwards.
    pub bounds: Option<DegreeBounds>,
    /// The files of a second band, which has the heights of the TINs minus those of these files.
    pub elevation: Option<Elevation<'a>>,
    /// How many blocks are made at the same time.
    pub threads: usize,
}

/// The elevation files that a package was made from.
#[derive(Debug, Clone, Copy)]
pub struct Elevation<'a> {
    /// Opened as the build did.
    pub dem: &'a Dem,
    /// The package's grid.
    pub plan: &'a GridPlan,
}
