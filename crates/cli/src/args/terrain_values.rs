//! Values of options of `export quantized-mesh`.

use clap::ValueEnum;
use corniche_export::{Availability, Tiling};

/// Grids of terrain tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TilingArg {
    Geographic,
    WebMercator,
}

impl From<TilingArg> for Tiling {
    fn from(tiling: TilingArg) -> Self {
        match tiling {
            TilingArg::Geographic => Self::Geographic,
            TilingArg::WebMercator => Self::WebMercator,
        }
    }
}

/// Where it is told which tiles there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AvailabilityArg {
    Layer,
    Tiles,
}

impl From<AvailabilityArg> for Availability {
    fn from(availability: AvailabilityArg) -> Self {
        match availability {
            AvailabilityArg::Layer => Self::Layer,
            AvailabilityArg::Tiles => Self::Tiles,
        }
    }
}

/// How terrain tiles are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TerrainCompress {
    None,
    Gzip,
}
