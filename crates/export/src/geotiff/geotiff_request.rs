//! What a user asks for when a package becomes a raster.

use crate::{bounds::DegreeBounds, elevation::Elevation};

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
